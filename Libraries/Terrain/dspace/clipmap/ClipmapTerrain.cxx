#include <dspace/clipmap/ClipmapTerrain.h>

#include <algorithm>
#include <cmath>

#include <dspace/Error.h>
#include <dspace/clipmap/ClipmapLevels.h>

namespace dspace {
namespace {

BoundingSphere BoundsOf(const PostLattice& lattice, const PostPlacement& placement,
                        const std::array<double, 2>& heights) {
  BoundingSphere sphere;
  if (placement.OnBody()) {
    sphere.radius = placement.Radius() + std::max(heights[0], heights[1]);
    return sphere;
  }
  Eigen::AlignedBox3d box;
  for (const double c : {0.0, double(lattice.columns - 1)}) {
    for (const double r : {0.0, double(lattice.rows - 1)}) {
      for (const double h : heights) {
        box.extend(placement.ToScene({c, r}, h));
      }
    }
  }
  sphere.center = box.center();
  sphere.radius = 0.5 * box.diagonal().norm();
  return sphere;
}

// IEC 61966-2-1.
double Linear(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

// Of all pixels, in linear light.
Eigen::Vector3d MeanOf(const Image& image) {
  std::array<double, 256> linear;
  for (std::size_t v = 0; v < linear.size(); ++v) {
    linear[v] = Linear(double(v) / 255.0);
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const std::size_t count = std::size_t(image.width) * image.height;
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      sum[Eigen::Index(k)] += linear[image.pixels[i * channels + (channels < 3 ? 0 : k)]];
    }
  }
  return (sum / double(count)).cwiseMax(1e-4);
}

} // namespace

ClipmapTerrain::ClipmapTerrain(std::shared_ptr<ElevationPyramid> pyramid,
                               const PostPlacement& placement, const ClipmapOptions& options,
                               std::vector<ClipmapChart> poles, std::vector<ColorGrid> grids)
    : Charts_{{std::move(pyramid), placement}}, Options_(options),
      Bounds_(BoundsOf(Charts_[0].pyramid->Lattice(), placement, options.heights)),
      Grids_(std::move(grids)) {
  const std::string& name = this->Pyramid()->Source().GetName();
  for (ClipmapChart& pole : poles) {
    this->Charts_.push_back(std::move(pole));
  }
  if (options.cells > 252) {
    throw Error(Error::Kind::InvalidArgument, name,
                "level size " + std::to_string(options.cells) +
                    " is rejected; accepted is 12 to 252");
  }
  for (const ClipmapChart& chart : this->Charts_) {
    ClipmapLevels(chart.pyramid, options.cells); // rejects what cannot be drawn
  }
  if (!(options.heights[0] <= options.heights[1]) || !std::isfinite(options.heights[0]) ||
      !std::isfinite(options.heights[1])) {
    throw Error(Error::Kind::InvalidArgument, name,
                "its least height must not exceed its greatest");
  }
  if (!this->Grids_.empty() && this->Grids_.size() != this->Charts_.size()) {
    throw Error(Error::Kind::InvalidArgument, name,
                std::to_string(this->Grids_.size()) +
                    " grids of colour layers are rejected; accepted: " +
                    std::to_string(this->Charts_.size()) + ", one a chart, or none");
  }
  if (!this->Grids_.empty()) {
    this->Layers_ = std::make_shared<LayerStack>(name);
  }
  if (!this->Options_.material) {
    this->Options_.material = std::make_shared<const Material>();
  }
}

std::uint64_t ClipmapTerrain::Revision() const {
  std::uint64_t revision = this->StyleRevision_ + (this->Layers_ ? this->Layers_->Revision() : 0);
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    revision += this->Tiles_ ? this->Tiles_->Arrivals() : 0;
    for (const std::shared_ptr<HorizonBlocks>& horizons : this->Horizons_) {
      revision += horizons ? horizons->Arrivals() : 0;
    }
  }
  for (const ClipmapChart& chart : this->Charts_) {
    revision += chart.pyramid->Arrivals();
  }
  return revision;
}

ColorTiles& ClipmapTerrain::Tiles() const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  if (!this->Tiles_) {
    this->Tiles_ = std::make_unique<ColorTiles>(this->Layers_, this->Grids_);
  }
  return *this->Tiles_;
}

ColorTilesStatistics ClipmapTerrain::TileStatistics() const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  return this->Tiles_ ? this->Tiles_->Statistics() : ColorTilesStatistics();
}

std::size_t ClipmapTerrain::ChartAt(const Eigen::Vector3d& p_S) const {
  const double sine = p_S.z() / std::max(p_S.norm(), 1e-300);
  for (std::size_t i = 1; i < this->Charts_.size(); ++i) {
    // 60 degrees: there a degree of longitude is half as long as one of latitude.
    if ((this->Charts_[i].placement.South() ? -sine : sine) > std::sqrt(0.75)) {
      return i;
    }
  }
  return 0;
}

void ClipmapTerrain::SetStyle(const ClipmapStyle& style) {
  style.Check(this->Pyramid()->Source().GetName());
  if (!style.details.empty() && this->Placement().OnBody()) {
    throw Error(Error::Kind::Unsupported, this->Pyramid()->Source().GetName(),
                "details tile a plane; accepted on a body: none");
  }
  ClipmapStyle taken = style;
  for (ClipmapStyle::Detail& detail : taken.details) {
    detail.mean = MeanOf(*detail.image);
  }
  this->Style_ = std::move(taken);
  ++this->StyleRevision_;
}

void ClipmapTerrain::SetStyleIn(const std::string& viewport,
                                const std::optional<ClipmapStyle>& style) {
  if (!style) {
    this->StyleRevision_ += this->Styles_.erase(viewport);
    return;
  }
  const std::string& name = this->Pyramid()->Source().GetName();
  style->Check(name);
  if (!style->details.empty() || style->noise) {
    throw Error(Error::Kind::InvalidArgument, name,
                "the style of viewport '" + viewport + "' has " +
                    (style->noise ? "noise" : "details") +
                    ", which are the same in all viewports; accepted: none");
  }
  this->Styles_[viewport] = *style;
  ++this->StyleRevision_;
}

ClipmapStyle ClipmapTerrain::StyleIn(const std::string& viewport) const {
  const auto found = this->Styles_.find(viewport);
  if (found == this->Styles_.end()) {
    return this->Style_;
  }
  ClipmapStyle style = found->second;
  style.details = this->Style_.details;
  style.noise = this->Style_.noise;
  return style;
}

std::shared_ptr<HorizonBlocks> ClipmapTerrain::Horizons(std::size_t chart) const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  this->Horizons_.resize(this->Charts_.size());
  std::shared_ptr<HorizonBlocks>& horizons = this->Horizons_.at(chart);
  if (!horizons) {
    HorizonOptions options;
    options.near = 8; // posts that the pixels of planes of numbers follow by themselves
    options.heights = this->Options_.heights;
    horizons = std::make_shared<HorizonBlocks>(
        HorizonSweep(this->Charts_[chart].pyramid, this->Charts_[chart].placement, options));
  }
  return horizons;
}

std::vector<CustomGeometry::Member> ClipmapTerrain::Members() const {
  std::vector<Member> members = this->Style_.Members();
  for (const auto& [viewport, style] : this->Styles_) {
    for (Member& member : style.Members()) {
      members.push_back({member.name + " in viewport '" + viewport + "'", member.membership});
    }
  }
  if (this->Layers_) {
    for (const StackedLayer& layer : this->Layers_->Layers()) {
      members.push_back({"layer '" + layer.name + "'", layer.member});
    }
  }
  return members;
}

} // namespace dspace
