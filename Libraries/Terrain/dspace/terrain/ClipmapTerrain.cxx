#include <dspace/terrain/ClipmapTerrain.h>

#include <algorithm>
#include <cmath>

#include <dspace/Error.h>
#include <dspace/terrain/ClipmapLevels.h>

namespace dspace {
namespace {

BoundingSphere BoundsOf(const PostLattice& lattice, const PostPlacement& placement,
                        const std::array<double, 2>& heights) {
  BoundingSphere sphere;
  if (placement.GetKind() == PostPlacement::Kind::Sphere) {
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

} // namespace

ClipmapTerrain::ClipmapTerrain(std::shared_ptr<ElevationPyramid> pyramid,
                               const PostPlacement& placement, const ClipmapOptions& options)
    : Pyramid_(std::move(pyramid)), Placement_(placement), Options_(options),
      Bounds_(BoundsOf(Pyramid_->Lattice(), placement, options.heights)) {
  const std::string& name = this->Pyramid_->Source().GetName();
  ClipmapLevels(this->Pyramid_, options.cells); // refuses what cannot be drawn
  if (options.cells > 252) {
    throw Error(Error::Kind::InvalidArgument, name,
                "level size " + std::to_string(options.cells) +
                    " is refused; accepted is 12 to 252");
  }
  if (!(options.heights[0] <= options.heights[1]) || !std::isfinite(options.heights[0]) ||
      !std::isfinite(options.heights[1])) {
    throw Error(Error::Kind::InvalidArgument, name,
                "its least height must not exceed its greatest");
  }
  if (!this->Options_.material) {
    this->Options_.material = std::make_shared<const Material>();
  }
}

void ClipmapTerrain::SetStyle(const ClipmapStyle& style) {
  style.Check(this->Pyramid_->Source().GetName());
  this->Style_ = style;
  ++this->StyleRevision_;
}

} // namespace dspace
