#include <dspace/layers/raster/TexelPlaces.h>

#include <algorithm>
#include <cmath>

#include <dspace/layers/raster/BlockSampler.h>

namespace dspace {
namespace {

constexpr double Tolerance = 0.01; // of a pixel or of a texel
constexpr double Margin = 2.0;     // texels beyond the extent that are included

} // namespace

TexelPlaces::TexelPlaces(const ColorGrid& grid, int zoom, std::int64_t column, std::int64_t row,
                         const PixelFinder& finder, double turn)
    : Turn_(turn) {
  const Eigen::Vector2d first(static_cast<double>(column), static_cast<double>(row));
  this->TexelToMap_ = grid.TexelToMap(zoom) * Eigen::Translation2d(first);
  const Eigen::Affine2d postToTexel = grid.TexelToPost(zoom).inverse();
  for (const Eigen::Vector2d& corner : {grid.extent.min(), grid.extent.max()}) {
    this->Extent_.extend(Eigen::Vector2d(postToTexel * corner - first));
  }
  if (grid.periodic) {
    this->Extent_.min().x() = 0.0;
    this->Extent_.max().x() = Side;
  }
  Eigen::Matrix2Xd p(2, 4);
  p << 0, Side, 0, Side, 0, 0, Side, Side;
  p = (this->TexelToMap_ * p).eval();
  finder.Find(p);
  this->Fill(finder, 0, 0, Side, {{p.col(0), p.col(1), p.col(2), p.col(3)}});
  this->Tear(finder);
}

// In the turn in which it is nearest.
Eigen::Vector2d TexelPlaces::Near(const Eigen::Vector2d& p, const Eigen::Vector2d& to) const {
  Eigen::Vector2d near = p;
  if (this->Turn_ > 0.0) {
    near.x() -= this->Turn_ * std::round((p.x() - to.x()) / this->Turn_);
  }
  return near;
}

void TexelPlaces::Fill(const PixelFinder& finder, int x, int y, int size,
                       const TexelCorners& corners) {
  const Eigen::AlignedBox2d square(Eigen::Vector2d(x - Margin, y - Margin),
                                   Eigen::Vector2d(x + size + Margin, y + size + Margin));
  if (!square.intersects(this->Extent_)) {
    return;
  }
  TexelPatch patch{x, y, size, -1, corners};
  for (Eigen::Vector2d& corner : patch.corners.at) {
    corner = this->Near(corner, corners.at[0]);
  }
  const Eigen::Vector2d texel =
      (patch.corners.Across().cwiseAbs() + patch.corners.Down().cwiseAbs()) / double(size);
  const Eigen::Array2d tolerance = Tolerance * texel.array().max(1.0);
  Eigen::Matrix2Xd p(2, 5); // the middle, then those of the edges: top, bottom, left, right
  p << 0.5, 0.5, 0.5, 0.0, 1.0, 0.5, 0.0, 1.0, 0.5, 0.5;
  const Eigen::Matrix2Xd parts = p;
  p = this->TexelToMap_ * (p * size + Eigen::Vector2d(x, y).replicate(1, 5));
  finder.Find(p);
  bool good = true;
  for (Eigen::Index i = 0; i < p.cols(); ++i) {
    // Written so that what is not finite fails.
    const Eigen::Vector2d off =
        patch.corners.Inside(parts(0, i), parts(1, i)) - this->Near(p.col(i), patch.corners.at[0]);
    good = good && (off.array().abs() <= tolerance).all();
  }
  if (good || size == 1) {
    patch.torn = good ? -1 : 0;
    this->Patches_.push_back(patch);
    return;
  }
  const int half = size / 2;
  const auto& at = corners.at;
  this->Fill(finder, x, y, half, {{at[0], p.col(1), p.col(3), p.col(0)}});
  this->Fill(finder, x + half, y, half, {{p.col(1), at[1], p.col(0), p.col(4)}});
  this->Fill(finder, x, y + half, half, {{p.col(3), p.col(0), at[2], p.col(2)}});
  this->Fill(finder, x + half, y + half, half, {{p.col(0), p.col(4), p.col(2), at[3]}});
}

// All places of texels that are torn, at once.
void TexelPlaces::Tear(const PixelFinder& finder) {
  constexpr int Places = TexelPatch::TornPlaces;
  std::vector<Eigen::Vector2d>& torn = this->Torn_;
  for (TexelPatch& patch : this->Patches_) {
    if (patch.torn < 0) {
      continue;
    }
    patch.torn = int(torn.size());
    for (int j = 0; j < Places; ++j) {
      for (int i = 0; i < Places; ++i) {
        torn.emplace_back(this->TexelToMap_ * Eigen::Vector2d(patch.x + (i + 0.5) / Places,
                                                              patch.y + (j + 0.5) / Places));
      }
    }
  }
  if (!torn.empty()) {
    Eigen::Matrix2Xd p = Eigen::Map<const Eigen::Matrix2Xd>(torn[0].data(), 2, torn.size());
    finder.Find(p);
    for (std::size_t i = 0; i < torn.size(); ++i) {
      torn[i] = p.col(Eigen::Index(i));
    }
  }
}

} // namespace dspace
