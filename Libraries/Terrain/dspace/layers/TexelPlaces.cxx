#include "TexelPlaces.h"

#include <algorithm>
#include <cmath>

#include "BlockSampler.h"

namespace dspace {
namespace {

constexpr double Tolerance = 0.01; // of a pixel or of a texel
constexpr double Margin = 2.0;     // texels beyond the extent that are told all the same

} // namespace

TexelPlaces::TexelPlaces(const ColorGrid& grid, int zoom, std::int64_t column, std::int64_t row,
                         const PixelFinder& finder, double turn)
    : Finder_(finder), Turn_(turn), Corners_(std::size_t(Side + 1) * (Side + 1)),
      States_(std::size_t(Side) * Side, State::Absent) {
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
  this->Fill(0, 0, Side);
}

Eigen::Vector2d TexelPlaces::Exact(double x, double y) const {
  return this->Finder_.Find(this->TexelToMap_ * Eigen::Vector2d(x, y));
}

// In the turn in which it is nearest.
Eigen::Vector2d TexelPlaces::Near(const Eigen::Vector2d& p, const Eigen::Vector2d& to) const {
  Eigen::Vector2d near = p;
  if (this->Turn_ > 0.0) {
    near.x() -= this->Turn_ * std::round((p.x() - to.x()) / this->Turn_);
  }
  return near;
}

TexelCorners TexelPlaces::CornersOf(int x, int y) const {
  const auto corner = [&](int i, int j) {
    return this->Corners_[std::size_t(j) * (Side + 1) + std::size_t(i)];
  };
  const Eigen::Vector2d a = corner(x, y);
  return {{a, this->Near(corner(x + 1, y), a), this->Near(corner(x, y + 1), a),
           this->Near(corner(x + 1, y + 1), a)}};
}

void TexelPlaces::Fill(int x, int y, int size) {
  const Eigen::AlignedBox2d square(Eigen::Vector2d(x - Margin, y - Margin),
                                   Eigen::Vector2d(x + size + Margin, y + size + Margin));
  if (!square.intersects(this->Extent_)) {
    return;
  }
  const Eigen::Vector2d a = this->Exact(x, y);
  const auto exact = [&](double u, double v) {
    return this->Near(this->Exact(x + u * size, y + v * size), a);
  };
  const TexelCorners corners{{a, exact(1, 0), exact(0, 1), exact(1, 1)}};
  const Eigen::Vector2d texel =
      (corners.Across().cwiseAbs() + corners.Down().cwiseAbs()) / double(size);
  const Eigen::Array2d tolerance = Tolerance * texel.array().max(1.0);
  bool good = true;
  for (const auto& [u, v] : {std::pair(0.5, 0.5), {0.5, 0.0}, {0.5, 1.0}, {0.0, 0.5}, {1.0, 0.5}}) {
    // Written so that what is not finite fails.
    good = good && ((corners.Inside(u, v) - exact(u, v)).array().abs() <= tolerance).all();
  }
  if (!good && size > 1) {
    const int half = size / 2;
    for (const int j : {0, 1}) {
      for (const int i : {0, 1}) {
        this->Fill(x + i * half, y + j * half, half);
      }
    }
    return;
  }
  for (int j = 0; j <= size; ++j) {
    for (int i = 0; i <= size; ++i) {
      this->Corner(x + i, y + j) = corners.Inside(double(i) / size, double(j) / size);
      if (i < size && j < size) {
        this->States_[std::size_t(y + j) * Side + std::size_t(x + i)] =
            good ? State::Regular : State::Torn;
      }
    }
  }
}

} // namespace dspace
