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
ClipmapBlocks::Bounds ClipmapBlocks::OnPlane(const Eigen::AlignedBox2d& block,
                                             const ClipmapRanges::Range& heights) const {
  Bounds bounds;
  bounds.heights = heights;
  for (int i = 0; i < 4; ++i) {
    for (const double height : heights) {
      bounds.points.push_back(
          this->Placement_.ToScene(block.corner(Eigen::AlignedBox2d::CornerType(i)), height));
    }
  }
  return bounds;
}

// A ball about the block.
ClipmapBlocks::Bounds ClipmapBlocks::OnBody(const Eigen::AlignedBox2d& block,
                                            const ClipmapRanges::Range& heights) const {
  const PostPlacement& placement = this->Placement_;
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
    return {}; // too much of the body for a ball
  }
  Bounds ball;
  ball.points.push_back(placement.ToScene(block.center(), 0.5 * (heights[0] + heights[1])));
  ball.radius = (placement.Radius() + heights[1]) * angle + 0.5 * (heights[1] - heights[0]);
  return ball;
}

// The body's own horizon stands before it. `top` [m]: its greatest height.
bool ClipmapBlocks::BehindBody(const ClipmapViewVolume& sight, const Bounds& ball,
                               double top) const {
  const PostPlacement& placement = this->Placement_;
  const double least = placement.Body().Polar() + this->Heights_[0];
  const double seen = std::acos(least / std::max(sight.camera.norm(), least)) +
                      std::acos(least / std::max(placement.Radius() + top, least));
  const Eigen::Vector3d& center = ball.points.front();
  const double apart =
      std::acos(std::clamp(center.normalized().dot(sight.camera.normalized()), -1.0, 1.0));
  return apart - ball.radius / least > seen;
}

std::vector<ClipmapBlocks::Block> ClipmapBlocks::Seen(const ClipmapIndices& indices,
                                                      const ClipmapViewVolume& sight, int level,
                                                      int finest) const {
  std::optional<Eigen::Vector2i> inner;
  if (level > finest) {
    inner = this->Levels_.Geometry().InnerCell(this->Levels_.Window(level - 1),
                                               this->Levels_.Window(level));
  }
  const bool body = this->Placement_.OnBody();
  std::vector<Block> blocks;
  for (int row = 0; row < indices.BlocksAcross(); ++row) {
    for (int column = 0; column < indices.BlocksAcross(); ++column) {
      Block block;
      block.run = indices.Block(inner, column, row);
      const ClipmapRanges::Range heights = this->Ranges_.Of(this->Levels_, level, column, row);
      if (block.run.count == 0 || heights[0] > heights[1]) {
        continue;
      }
      const Eigen::AlignedBox2d posts = this->PostsOf(level, column, row);
      block.bounds = body ? this->OnBody(posts, heights) : this->OnPlane(posts, heights);
      const Bounds& bounds = block.bounds;
      const bool outside =
          !bounds.points.empty() &&
          std::any_of(sight.planes.begin(), sight.planes.end(),
                      [&bounds](const Eigen::Vector4d& plane) {
                        const double room = bounds.radius * plane.head<3>().norm();
                        return std::all_of(bounds.points.begin(), bounds.points.end(),
                                           [&](const Eigen::Vector3d& point) {
                                             return plane.head<3>().dot(point) + plane[3] < -room;
                                           });
                      });
      if (outside ||
          (body && !bounds.points.empty() && this->BehindBody(sight, bounds, heights[1]))) {
        continue;
      }
      blocks.push_back(std::move(block));
    }
  }
  return blocks;
}

std::vector<ClipmapIndices::Run> ClipmapBlocks::Runs(const std::vector<Block>& blocks) {
  std::vector<ClipmapIndices::Run> runs;
  for (const Block& block : blocks) {
    if (!runs.empty() && runs.back().first + runs.back().count == block.run.first) {
      runs.back().count += block.run.count;
    } else {
      runs.push_back(block.run);
    }
  }
  return runs;
}

} // namespace dspace
