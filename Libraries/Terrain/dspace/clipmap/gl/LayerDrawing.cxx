#include <dspace/clipmap/gl/LayerDrawing.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "vtk_glew.h"

#include "vtkShaderProgram.h"

#include <dspace/layers/ColorTiles.h>

namespace dspace {
namespace {

constexpr int Texels = ColorGrid::TileTexels;

// A chain of some twenty zooms with their neighbours, and several times what covers the picture,
// since ground lies at an angle and tiles hold others. The same for the same view.
int SlotsFor(const DrawView& view, int samples) {
  const double pixels = double(view.width) * view.height / (samples * samples);
  return 160 + int(std::min(12.0 * pixels / (Texels * Texels), 864.0));
}

// What is composed, from the ground up.
std::vector<LayerChoice> PlanesOf(LayerContent content, const LayerStack& stack,
                                  const DrawFilter& filter, bool styled) {
  using Part = LayerChoice::Part;
  std::vector<LayerChoice> planes;
  if (content == LayerContent::Normals) {
    planes.push_back({Part::Normals, filter.hiddenFragments});
  } else if (styled && !stack.Empty({Part::Marks, filter.hiddenFragments})) {
    for (const Part part : {Part::Unmarked, Part::Marks}) {
      planes.push_back({part, filter.hiddenFragments});
    }
  } else {
    planes.push_back({Part::All, filter.hiddenFragments});
  }
  planes.erase(std::remove_if(planes.begin(), planes.end(),
                              [&](const LayerChoice& choice) { return stack.Empty(choice); }),
               planes.end());
  return planes;
}

} // namespace

bool LayerDrawing::Prepare(const CustomDrawing& drawing, bool styled, std::size_t chart,
                           const ClipmapLevels& levels, const ClipmapLevels::State& state,
                           const ClipmapViewVolume& sight, const std::array<double, 2>& heights) {
  const LayerStack* stack = this->Terrain_.Layers().get();
  const DrawFilter& filter = drawing.list.Filter();
  this->Planes_ =
      stack ? PlanesOf(this->Content_, *stack, filter, styled) : std::vector<LayerChoice>();
  if (!this->Shown()) {
    return true;
  }
  const DrawView& drawn = drawing.view;
  const int slots = SlotsFor(drawn, drawing.samples);
  if (!this->Atlas_ || this->Slots_ < slots) {
    this->Atlas_.reset();
    this->Atlas_ = std::make_unique<LayerAtlas>(drawing.window, this->Content_, slots);
    this->Slots_ = slots;
  }
  this->Grid_ = &this->Terrain_.Grids()[chart];
  const bool normals = this->Content_ == LayerContent::Normals;
  this->Finest_ = this->Grid_->ZoomFor(stack->PixelSize(
      {normals ? LayerChoice::Part::Normals : LayerChoice::Part::All, filter.hiddenFragments}));
  this->Place_ = state.place;
  const Eigen::Vector2d texel = this->Grid_->TexelToPost(this->Finest_).inverse() * state.place;
  this->Corner_ = (texel / Texels).array().floor();

  LayerView view;
  view.sight = sight;
  const Eigen::Matrix3d X_OV = drawing.object.X_VO.linear().inverse();
  view.forward = (X_OV * -Eigen::Vector3d::UnitZ()).normalized();
  const Projection& projection = drawn.projection;
  view.parallel = projection.kind == Projection::Kind::Orthographic;
  view.pixel = drawing.samples * projection.MetresPerPixel(1.0, drawn.height) * X_OV.col(0).norm();
  view.cosCorner = 1.0;
  for (const double x : {-0.5, drawn.width - 0.5}) {
    for (const double y : {-0.5, drawn.height - 0.5}) {
      view.cosCorner = std::min(view.cosCorner,
                                projection.PixelRay(x, y, drawn.width, drawn.height).direction.z());
    }
  }
  view.heights = heights;
  view.height = [&levels, &state](const Eigen::Vector2d& post) {
    return levels.HeightNear(post, state.finest).value_or(state.groundHeight);
  };
  const std::vector<ColorTile> tiles =
      VisibleTiles(*this->Grid_, int(chart), view, this->Finest_,
                   std::size_t(std::min(slots, this->Atlas_->Slots())));
  std::optional<double> wait;
  if (drawn.complete) {
    wait = this->Terrain_.Options().deadline;
  }
  return this->Atlas_->Show(this->Terrain_.Tiles(), this->Planes_, tiles, wait, drawing.statistics);
}

std::string LayerDrawing::Defines() const {
  std::string defines;
  if (this->Content_ == LayerContent::Normals) {
    return this->Shown() ? "#define DSPACE_LAYER_NORMALS 0\n" : defines;
  }
  for (std::size_t plane = 0; plane < this->Planes_.size(); ++plane) {
    defines += this->Planes_[plane].part == LayerChoice::Part::Marks ? "#define DSPACE_MARKS "
                                                                     : "#define DSPACE_PAINT ";
    defines += std::to_string(plane * LayerAtlas::Zooms) + "\n"; // its first page table
  }
  return defines.empty() ? defines : "#define DSPACE_LAYERS\n" + defines;
}

void LayerDrawing::SetLook(vtkShaderProgram* program, int samples) const {
  this->Atlas_->Bind(program);
  program->SetUniformi(this->Named("Zoom").c_str(), this->Finest_);
  // The camera may be turns away: whole turns are taken off.
  const auto around = double(this->Grid_->ColumnsAt(this->Finest_));
  const double turns = this->Grid_->periodic ? std::floor(this->Corner_.x() / around) : 0.0;
  const int corner[2] = {int(this->Corner_.x() - turns * around), int(this->Corner_.y())};
  program->SetUniform2i(this->Named("Corner").c_str(), corner);
  program->SetUniformi(this->Named("Around").c_str(),
                       this->Grid_->periodic ? this->Grid_->rootColumns : 0);
  // Of a degree grid's texels, below the camera.
  Eigen::Vector2d metres;
  for (int axis = 0; axis < 2; ++axis) {
    const PostPlacement& placement = this->Grid_->placement;
    const Eigen::Vector2d step =
        1e-3 * this->Grid_->rootPosts[axis] / Texels * Eigen::Vector2d::Unit(axis);
    metres[axis] =
        (placement.ToScene(this->Place_ + step, 0.0) - placement.ToScene(this->Place_ - step, 0.0))
            .norm();
  }
  metres /= metres.maxCoeff();
  const float scale[3] = {float(metres.x()), float(metres.y()), float(samples)};
  program->SetUniform3f(this->Named("Scale").c_str(), scale);
}

void LayerDrawing::SetLevel(vtkShaderProgram* program, const Eigen::Vector2d& first,
                            double step) const {
  const Eigen::Affine2d toTexel = this->Grid_->TexelToPost(this->Finest_).inverse();
  const Eigen::Vector2d origin = toTexel * Eigen::Vector2d(first * step) - Texels * this->Corner_;
  const float values[2] = {float(origin.x()), float(origin.y())};
  const bool normals = this->Content_ == LayerContent::Normals;
  program->SetUniform2f(normals ? "originNormal" : "originLayer", values);
  const Eigen::Vector2d post = toTexel.linear().diagonal() * step;
  const float across[2] = {float(post.x()), float(post.y())};
  program->SetUniform2f(normals ? "postNormal" : "postLayer", across);
}

} // namespace dspace
