#include <dspace/clipmap/VisibleTiles.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>

namespace dspace {
namespace {

struct Candidate {
  ColorTile tile;
  double distance = 0.0;   // [m] from the camera to the nearest it may be
  double coarseness = 0.0; // a texel's side over that of the pixel that sees it best
  bool operator<(const Candidate& o) const { return this->coarseness < o.coarseness; }
};

// A ball about a tile's ground.
struct Ball {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;
  double texel = 0.0; // the greater side of a texel [m]
};

class Search {
public:
  Search(const ColorGrid& grid, int chart, const LayerView& view)
      : Grid_(grid), Chart_(chart), View_(view) {}

  std::optional<Candidate> At(int zoom, std::int64_t column, std::int64_t row) const {
    const Eigen::Vector2d texels = Eigen::Vector2d::Constant(ColorGrid::TileTexels);
    const Eigen::Affine2d toPost = this->Grid_.TexelToPost(zoom);
    const Eigen::Vector2d corner = {double(column), double(row)};
    Eigen::AlignedBox2d box(
        Eigen::Vector2d(toPost * corner.cwiseProduct(texels)),
        Eigen::Vector2d(toPost * (corner + Eigen::Vector2d::Ones()).cwiseProduct(texels)));
    const Eigen::Vector2d whole = box.sizes();
    box = box.intersection(this->Grid_.extent);
    if (box.isEmpty() || !(box.volume() > 0.0)) {
      return std::nullopt;
    }
    Candidate candidate;
    candidate.tile = {this->Chart_, zoom, column, row};
    const Ball ball = this->BallAbout(box, whole);
    if (this->Hidden(ball)) {
      return std::nullopt;
    }
    const Eigen::Vector3d to = ball.center - this->View_.sight.camera;
    candidate.distance = std::max(to.norm() - ball.radius, 0.0);
    candidate.coarseness = ball.texel / this->PixelOn(ball, to, candidate.distance);
    return candidate;
  }

private:
  Ball BallAbout(const Eigen::AlignedBox2d& box, const Eigen::Vector2d& whole) const {
    const PostPlacement& placement = this->Grid_.placement;
    const int side = placement.OnBody() && this->Large(box) ? 9 : 3;
    std::array<Eigen::Vector3d, 81> places;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        const Eigen::Vector2d part(double(i) / (side - 1), double(j) / (side - 1));
        const Eigen::Vector2d post = box.min() + box.sizes().cwiseProduct(part);
        const double height = this->View_.height(post);
        low = std::min(low, height);
        high = std::max(high, height);
        places[std::size_t(j * side + i)] = placement.ToScene(post, height);
      }
    }
    Ball ball;
    Eigen::AlignedBox3d bounds;
    for (int k = 0; k < side * side; ++k) {
      bounds.extend(places[std::size_t(k)]);
    }
    ball.center = bounds.center();
    double gap = 0.0; // between samples
    Eigen::Vector2d length = Eigen::Vector2d::Zero();
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        const std::size_t k = std::size_t(j * side + i);
        ball.radius = std::max(ball.radius, (places[k] - ball.center).norm());
        if (i > 0) {
          length.x() = std::max(length.x(), (places[k] - places[k - 1]).norm());
        }
        if (j > 0) {
          length.y() = std::max(length.y(), (places[k] - places[k - std::size_t(side)]).norm());
        }
      }
    }
    gap = length.maxCoeff();
    // What the ground does between samples is not known: as much again as between them.
    ball.radius += 0.25 * gap + (high - low) / (side - 1);
    const Eigen::Vector2d texels = // of the part that lies within the extent
        box.sizes().cwiseQuotient(whole) * ColorGrid::TileTexels / double(side - 1);
    ball.texel = length.cwiseQuotient(texels).maxCoeff();
    return ball;
  }

  bool Large(const Eigen::AlignedBox2d& box) const {
    const PostPlacement& placement = this->Grid_.placement;
    if (placement.GetKind() == PostPlacement::Kind::Pole) {
      return box.sizes().maxCoeff() * placement.PlaneStep() > 0.2;
    }
    return box.sizes().cwiseProduct(placement.Step().cwiseAbs()).maxCoeff() > 0.4;
  }

  bool Hidden(const Ball& ball) const {
    for (const Eigen::Vector4d& plane : this->View_.sight.planes) {
      if (plane.head<3>().dot(ball.center) + plane[3] < -ball.radius * plane.head<3>().norm()) {
        return true;
      }
    }
    const PostPlacement& placement = this->Grid_.placement;
    if (!placement.OnBody() || ball.radius > 0.7 * ball.center.norm()) {
      return false;
    }
    const Eigen::Vector3d& camera = this->View_.sight.camera;
    const double least = placement.Body().Polar() + this->View_.heights[0];
    const double most = placement.Radius() + this->View_.heights[1];
    const double seen = std::acos(least / std::max(camera.norm(), least)) +
                        std::acos(least / std::max(most, least));
    const double apart =
        std::acos(std::clamp(ball.center.normalized().dot(camera.normalized()), -1.0, 1.0));
    return apart - std::asin(std::min(ball.radius / ball.center.norm(), 1.0)) > seen;
  }

  // The least side of ground [m] that a pixel covers there, along the way that it covers most.
  double PixelOn(const Ball& ball, const Eigen::Vector3d& to, double distance) const {
    const Eigen::Vector3d up = this->Grid_.placement.Up(ball.center);
    const Eigen::Vector3d& forward = this->View_.forward;
    const double depth = std::max(to.dot(forward) - ball.radius, distance * this->View_.cosCorner);
    const double pixel =
        this->View_.parallel ? this->View_.pixel : std::max(this->View_.pixel * depth, 1e-9);
    // Ground seen at a low angle is drawn out in the pixel; slopes of up to 30 degrees may face it.
    const Eigen::Vector3d ray = this->View_.parallel ? forward : Eigen::Vector3d(to.normalized());
    const double range = std::max(distance, 1e-9);
    // The vertical turns across a large tile of a body.
    const double turn = this->Grid_.placement.OnBody() ? ball.radius / ball.center.norm() : 0.0;
    const double rise = this->View_.parallel ? std::abs(ray.dot(up)) + turn
                                             : (std::abs(to.dot(up)) + ball.radius) / range;
    return pixel / std::clamp(rise + 0.5, 0.5, 1.0);
  }

  const ColorGrid& Grid_;
  int Chart_;
  const LayerView& View_;
};

} // namespace

std::vector<ColorTile> VisibleTiles(const ColorGrid& grid, int chart, const LayerView& view,
                                    int finest, std::size_t most) {
  const Search search(grid, chart, view);
  std::priority_queue<Candidate> open; // the coarsest on the screen first
  std::vector<Candidate> seen;
  const auto take = [&](int zoom, std::int64_t column, std::int64_t row) {
    const std::optional<Candidate> found = search.At(zoom, column, row);
    if (found && seen.size() < most) {
      seen.push_back(*found);
      if (zoom < finest && found->coarseness > 1.0) {
        open.push(*found);
      }
    }
  };
  for (int column = 0; column < grid.rootColumns; ++column) {
    take(0, column, 0);
  }
  while (!open.empty() && seen.size() + 4 <= most) {
    const ColorTile tile = open.top().tile;
    open.pop();
    for (const int j : {0, 1}) {
      for (const int i : {0, 1}) {
        take(tile.zoom + 1, 2 * tile.column + i, 2 * tile.row + j);
      }
    }
  }
  std::sort(seen.begin(), seen.end(), [](const Candidate& a, const Candidate& b) {
    return a.tile.zoom != b.tile.zoom ? a.tile.zoom < b.tile.zoom : a.distance < b.distance;
  });
  std::vector<ColorTile> tiles;
  for (const Candidate& candidate : seen) {
    tiles.push_back(candidate.tile);
  }
  return tiles;
}

} // namespace dspace
