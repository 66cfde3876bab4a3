#include <dspace/clipmap/ClipmapBlocks.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace dspace {

// Of a block's cells, in level-0 posts of the lattice.
Eigen::AlignedBox2d ClipmapBlocks::PostsOf(int level, int column, int row) const {
  const ClipmapWindow& window = this->Levels_.Window(level);
  const int cells = this->Levels_.Geometry().Cells();
  const double step = std::ldexp(1.0, level);
  const auto post = [&](std::int64_t first, int block) {
    return double(first + std::min(block * ClipmapIndices::BlockCells, cells)) * step;
  };
  Eigen::AlignedBox2d box(
      Eigen::Vector2d(post(window.column, column), post(window.row, row)),
      Eigen::Vector2d(post(window.column, column + 1), post(window.row, row + 1)));
  const double last = double(this->Levels_.Lattice().rows - 1);
  box.min().y() = std::clamp(box.min().y(), 0.0, last);
  box.max().y() = std::clamp(box.max().y(), 0.0, last);
  return box;
}

// The hull of its corners at the least and the greatest height.
bool ClipmapBlocks::OutsideOnPlane(const ClipmapViewVolume& sight,
                                   const Eigen::AlignedBox2d& block) const {
  Eigen::Matrix<double, 4, 8> corners;
  for (int i = 0; i < 4; ++i) {
    for (const int j : {0, 1}) {
      corners.col(2 * i + j) =
          this->Placement_
              .ToScene(block.corner(Eigen::AlignedBox2d::CornerType(i)), this->Heights_[j])
              .homogeneous();
    }
  }
  return std::any_of(sight.planes.begin(), sight.planes.end(),
                     [&corners](const Eigen::Vector4d& plane) {
                       return (plane.transpose() * corners).maxCoeff() < 0.0;
                     });
}

// A ball about the block, or the horizon before it.
bool ClipmapBlocks::HiddenOnBody(const ClipmapViewVolume& sight,
                                 const Eigen::AlignedBox2d& block) const {
  const PostPlacement& placement = this->Placement_;
  const std::array<double, 2>& heights = this->Heights_;
  const double middle = 0.5 * (heights[0] + heights[1]);
  const Eigen::Vector3d center = placement.ToScene(block.center(), middle);
  // No two places of it are further apart along the body than its two sides together; a
  // stereographic plane only shrinks towards its rim.
  Eigen::Vector2d step = placement.Step().cwiseAbs();
  if (placement.GetKind() == PostPlacement::Kind::Pole) {
    step.setConstant(2.0 * placement.PlaneStep());
  }
  // Verticals of an ellipsoid turn less than the directions from its centre, at the poles, and the
  // ground about them is wider.
  const double stretch = 1.0 / (1.0 - placement.Body().Squash());
  const double angle = 0.5 * stretch * block.sizes().dot(step);
  if (angle > 0.5) {
    return false; // too much of the body for a ball
  }
  const double radius = (placement.Radius() + heights[1]) * angle + 0.5 * (heights[1] - heights[0]);
  for (const Eigen::Vector4d& plane : sight.planes) {
    if (plane.head<3>().dot(center) + plane[3] < -radius * plane.head<3>().norm()) {
      return true;
    }
  }
  const double least = placement.Body().Polar() + heights[0];
  const double seen = std::acos(least / std::max(sight.camera.norm(), least)) +
                      std::acos(least / std::max(placement.Radius() + heights[1], least));
  const double apart =
      std::acos(std::clamp(center.normalized().dot(sight.camera.normalized()), -1.0, 1.0));
  return apart - angle > seen;
}

std::vector<ClipmapIndices::Run> ClipmapBlocks::Seen(const ClipmapIndices& indices,
                                                     const ClipmapViewVolume& sight, int level,
                                                     int finest) const {
  std::optional<Eigen::Vector2i> inner;
  if (level > finest) {
    inner = this->Levels_.Geometry().InnerCell(this->Levels_.Window(level - 1),
                                               this->Levels_.Window(level));
  }
  const bool body = this->Placement_.OnBody();
  std::vector<ClipmapIndices::Run> runs;
  for (int row = 0; row < indices.BlocksAcross(); ++row) {
    for (int column = 0; column < indices.BlocksAcross(); ++column) {
      const ClipmapIndices::Run run = indices.Block(inner, column, row);
      if (run.count == 0) {
        continue;
      }
      const Eigen::AlignedBox2d block = this->PostsOf(level, column, row);
      if (body ? this->HiddenOnBody(sight, block) : this->OutsideOnPlane(sight, block)) {
        continue;
      }
      if (!runs.empty() && runs.back().first + runs.back().count == run.first) {
        runs.back().count += run.count;
      } else {
        runs.push_back(run);
      }
    }
  }
  return runs;
}

} // namespace dspace
