#include <dspace/layers/raster/NormalTurn.h>

#include <algorithm>
#include <cmath>

namespace dspace {
namespace {

constexpr int Spacing = 32;      // texels between places
constexpr double Alike = 0.1;    // of two matrices: 4 degrees
constexpr double HalfPost = 0.5; // half of what a direction is found across

// Scene directions of map x and y of a plane.
Eigen::Matrix2d SceneAxes(const ColorGrid& grid) {
  Eigen::Matrix2d axes = grid.placement.PostToScene().linear() * grid.postToMap.linear().inverse();
  axes.colwise().normalize();
  return axes;
}

// Directions of a pole's columns, and against its rows, as (east, north).
Eigen::Matrix2d PoleAxes(const PostPlacement& placement, const Eigen::Vector2d& post) {
  const Eigen::Vector3d here = placement.ToScene(post, 0.0);
  const Eigen::Vector3d north = placement.North(here);
  const Eigen::Vector3d east = north.cross(placement.Up(here));
  Eigen::Matrix2d axes;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d half = (axis == 0 ? HalfPost : -HalfPost) * Eigen::Vector2d::Unit(axis);
    const Eigen::Vector3d along =
        placement.ToScene(post + half, 0.0) - placement.ToScene(post - half, 0.0);
    axes.col(axis) = Eigen::Vector2d(along.dot(east), along.dot(north)).normalized();
  }
  return axes;
}

} // namespace

NormalTurn::NormalTurn(const ColorGrid& grid, const Crs* raster) {
  const bool plane = !grid.placement.OnBody();
  const bool same =
      raster && (!raster->Ogr() || !grid.crs.Ogr() || raster->GetWkt() == grid.crs.GetWkt());
  if (plane && same) {
    return;
  }
  if (plane) {
    this->GridAxes_ = std::make_unique<GroundAxes>(grid.crs);
  }
  if (raster) {
    this->RasterAxes_ = std::make_unique<GroundAxes>(*raster);
    if (!same) {
      this->ToRaster_ = std::make_unique<CrsTransform>(grid.crs, *raster);
    }
  }
}

std::vector<Eigen::Matrix2d> NormalTurn::At(const ColorGrid& grid, int zoom,
                                            const Eigen::Matrix2Xd& texels) const {
  const Eigen::Matrix2Xd posts = grid.TexelToPost(zoom) * texels;
  Eigen::Matrix2Xd places = grid.postToMap * posts;
  const auto count = std::size_t(texels.cols());
  std::vector<Eigen::Matrix2d> turns(count, Eigen::Matrix2d::Identity());
  if (this->GridAxes_) {
    const std::vector<Eigen::Matrix2d> axes = this->GridAxes_->At(places);
    std::transform(axes.begin(), axes.end(), turns.begin(),
                   [](const Eigen::Matrix2d& there) { return there.inverse(); });
  }
  if (grid.placement.GetKind() == PostPlacement::Kind::Pole) {
    for (std::size_t i = 0; i < count; ++i) {
      turns[i] = PoleAxes(grid.placement, posts.col(Eigen::Index(i))).inverse();
    }
  }
  if (this->RasterAxes_) {
    if (this->ToRaster_) {
      this->ToRaster_->TryApply(places);
    }
    const std::vector<Eigen::Matrix2d> axes = this->RasterAxes_->At(places);
    for (std::size_t i = 0; i < count; ++i) {
      turns[i] = turns[i] * axes[i];
    }
  }
  if (!grid.placement.OnBody()) {
    const Eigen::Matrix2d scene = SceneAxes(grid);
    for (Eigen::Matrix2d& turn : turns) {
      turn = scene * turn;
    }
  }
  return turns;
}

std::vector<Eigen::Matrix2d> NormalTurn::Of(const ColorGrid& grid, const ColorBlock& block) const {
  const Eigen::Vector2d first(double(block.column), double(block.row));
  const int columns = (block.width - 1) / Spacing + 2;
  const int rows = (block.height - 1) / Spacing + 2;
  Eigen::Matrix2Xd places(2, columns * rows);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      places.col(j * columns + i) = first + double(Spacing) * Eigen::Vector2d(i, j);
    }
  }
  const std::vector<Eigen::Matrix2d> nodes = this->At(grid, block.zoom, places);
  std::vector<Eigen::Matrix2d> turns(std::size_t(block.width) * block.height);
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const Eigen::Matrix2d* top = &nodes[std::size_t(j * columns + i)];
      const Eigen::Matrix2d* bottom = top + columns;
      // Written so that what is not finite fails.
      const bool alike = (top[1] - top[0]).norm() <= Alike &&
                         (bottom[0] - top[0]).norm() <= Alike &&
                         (bottom[1] - top[0]).norm() <= Alike;
      const int width = std::min(Spacing, block.width - i * Spacing);
      const int height = std::min(Spacing, block.height - j * Spacing);
      std::vector<Eigen::Matrix2d> each;
      if (!alike) {
        Eigen::Matrix2Xd texels(2, width * height);
        for (int k = 0; k < width * height; ++k) {
          texels.col(k) =
              first + Eigen::Vector2d(i * Spacing + k % width + 0.5, j * Spacing + k / width + 0.5);
        }
        each = this->At(grid, block.zoom, texels);
      }
      for (int k = 0; k < width * height; ++k) {
        const double u = (k % width + 0.5) / Spacing;
        const double v = (k / width + 0.5) / Spacing;
        Eigen::Matrix2d& turn =
            turns[std::size_t(j * Spacing + k / width) * block.width + i * Spacing + k % width];
        turn = alike ? Eigen::Matrix2d((1.0 - v) * ((1.0 - u) * top[0] + u * top[1]) +
                                       v * ((1.0 - u) * bottom[0] + u * bottom[1]))
                     : each[std::size_t(k)];
      }
    }
  }
  return turns;
}

} // namespace dspace
