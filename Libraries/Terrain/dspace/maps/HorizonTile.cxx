#include <dspace/maps/HorizonTile.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include <dspace/DiscLeft.h>
#include <dspace/horizon/ForProcessors.h>
#include <dspace/maps/TileFile.h>

namespace dspace {
namespace {

constexpr double Straight = 0.01; // [rad] of turn between two nodes
constexpr double Degree = M_PI / 180.0;
constexpr float NothingInSight = -90.0f;

// A piece of a row with the horizons of two azimuths: `share` between them at the first cell.
DSPACE_FOR_PROCESSORS
void SeeBetween(const float* a, const float* b, int count, float share, float shareStep,
                float elevation, float elevationStep, float* above, float* rise) {
  for (int i = 0; i < count; ++i) {
    const float step = float(i);
    const float between = b[i] - a[i];
    const float e = elevation + step * elevationStep;
    above[i] = e - (a[i] + (share + step * shareStep) * between);
    rise[i] = between;
  }
}

} // namespace

HorizonTile::Node HorizonTile::NodeAt(const PostPlacement& placement, const Eigen::Vector2d& post) {
  return {ChartAxesAt(placement, post),
          placement.OnBody() ? placement.ToScene(post, 0.0) : Eigen::Vector3d::Zero().eval()};
}

HorizonTile::HorizonTile(const HorizonMap& map, int column, int row)
    : Width_(std::min(TileFile::Side, map.Columns() - column)),
      Height_(std::min(TileFile::Side, map.Rows() - row)), Azimuths_(map.Azimuths()),
      Horizons_(map.Read(column, row, Width_, Height_)) {
  const PostPlacement& placement = map.Placement();
  const bool plane = !placement.OnBody();
  for (float& h : this->Horizons_) {
    // On a plane the ground beyond the data is level.
    h = h == NothingInSight || (plane && h < 0.0f) ? 0.0f : h * float(Degree);
  }
  if (plane) {
    this->Nodes_.push_back(NodeAt(placement, Eigen::Vector2d::Zero()));
    this->Step_ = TileFile::Side;
  } else {
    for (const int step : {32, 16, 8, 1}) {
      this->Step_ = step;
      this->Across_ = TileFile::Side / step + 1;
      this->Nodes_.clear();
      for (int j = 0; j <= TileFile::Side; j += step) {
        for (int i = 0; i <= TileFile::Side; i += step) {
          this->Nodes_.push_back(NodeAt(placement, map.Cells().Post(column + i, row + j)));
        }
      }
      if (this->LargestTurn() < Straight) {
        break;
      }
    }
  }
  this->Azimuth_.resize(this->Nodes_.size());
  this->Elevation_.resize(this->Nodes_.size());
  this->Secant_.resize(this->Nodes_.size());
}

double HorizonTile::LargestTurn() const {
  double chord = 0.0;
  for (std::size_t n = 0; n < this->Nodes_.size(); ++n) {
    const Eigen::Vector3d& east = this->Nodes_[n].axes.east;
    const std::size_t right = n + 1, below = n + std::size_t(this->Across_);
    if (right % std::size_t(this->Across_) != 0) {
      chord = std::max(chord, (this->Nodes_[right].axes.east - east).norm());
    }
    if (below < this->Nodes_.size()) {
      chord = std::max(chord, (this->Nodes_[below].axes.east - east).norm());
    }
  }
  return 2.0 * std::asin(std::min(1.0, 0.5 * chord));
}

bool HorizonTile::HasData(int cell) const {
  return !std::isnan(this->Horizons_[std::size_t(cell)]);
}

void HorizonTile::LookAt(const Eigen::Vector3d& p_S) {
  for (std::size_t n = 0; n < this->Nodes_.size(); ++n) {
    const Node& node = this->Nodes_[n];
    const Eigen::Vector3d d = p_S - node.p_S;
    const double east = node.axes.east.dot(d);
    const double north = node.axes.north.dot(d);
    this->Azimuth_[n] = std::atan2(east, north);
    const double up = node.axes.up.dot(d);
    const double level = std::sqrt(east * east + north * north);
    this->Elevation_[n] = std::atan2(up, level);
    this->Secant_[n] = std::min(std::sqrt(level * level + up * up) / level, MostSecant);
  }
}

void HorizonTile::SeePiece(int row, const Piece& piece, float* above, float* rise,
                           float* secant) const {
  const auto cells = std::size_t(this->Width_) * std::size_t(this->Height_);
  const auto at = std::size_t(row) * std::size_t(this->Width_) + std::size_t(piece.first);
  const double perStep = double(this->Azimuths_) / (2.0 * M_PI);
  const double step = piece.azimuthStep * perStep;
  double x = piece.azimuth * perStep; // azimuths of the map
  x -= std::floor(x / this->Azimuths_) * this->Azimuths_;
  for (int done = 0; done < piece.count;) {
    x = x < 0.0 ? x + this->Azimuths_ : x;
    x = x >= this->Azimuths_ ? x - this->Azimuths_ : x;
    const int first = std::min(int(x), this->Azimuths_ - 1);
    const int second = first + 1 == this->Azimuths_ ? 0 : first + 1;
    // The cells up to the next azimuth of the map.
    const double room = step > 0.0   ? (first + 1 - x) / step
                        : step < 0.0 ? (x - first) / -step
                                     : 1e9;
    const int count = std::clamp(int(std::ceil(std::min(room, 1e6))), 1, piece.count - done);
    const auto begin = at + std::size_t(done);
    SeeBetween(&this->Horizons_[std::size_t(first) * cells + begin],
               &this->Horizons_[std::size_t(second) * cells + begin], count, float(x - first),
               float(step), float(piece.elevation + done * piece.elevationStep),
               float(piece.elevationStep), above + piece.first + done, rise + piece.first + done);
    for (int i = done; i < done + count; ++i) {
      secant[piece.first + i] = float(piece.secant) + float(i) * float(piece.secantStep);
    }
    done += count;
    x += count * step;
  }
}

void HorizonTile::SeeRow(int row, float* above, float* rise, float* secant) const {
  if (this->Nodes_.size() == 1) {
    this->SeePiece(
        row,
        {0, this->Width_, this->Azimuth_[0], 0.0, this->Elevation_[0], 0.0, this->Secant_[0], 0.0},
        above, rise, secant);
    return;
  }
  const double v = double(row % this->Step_) / this->Step_;
  for (int block = 0; block * this->Step_ < this->Width_; ++block) {
    const std::size_t node = std::size_t(row / this->Step_ * this->Across_ + block);
    const double a0 = this->Azimuth_[node];
    const auto near = [&](std::size_t other) {
      return a0 + std::remainder(this->Azimuth_[other] - a0, 2.0 * M_PI);
    };
    const auto below = node + std::size_t(this->Across_);
    const auto ends = [&](const std::vector<double>& at) {
      return std::pair(at[node] + v * (at[below] - at[node]),
                       at[node + 1] + v * (at[below + 1] - at[node + 1]));
    };
    const double left = a0 + v * (near(below) - a0);
    const double right = near(node + 1) + v * (near(below + 1) - near(node + 1));
    const auto [low, high] = ends(this->Elevation_);
    const auto [narrow, narrower] = ends(this->Secant_);
    const int first = block * this->Step_;
    this->SeePiece(row,
                   {first, std::min(this->Step_, this->Width_ - first), left,
                    (right - left) / this->Step_, low, (high - low) / this->Step_, narrow,
                    (narrower - narrow) / this->Step_},
                   above, rise, secant);
  }
}

bool HorizonTile::Eclipse(const Eigen::Vector3d& sun_S, double sunRadius,
                          const Eigen::Vector3d& other_S, double otherRadius) {
  const auto left = [&](const Node& node) {
    const Eigen::Vector3d sun = sun_S - node.p_S;
    const Eigen::Vector3d other = other_S - node.p_S;
    const auto radius = [](double r, double distance) {
      return std::asin(std::min(1.0, r / distance));
    };
    return DiscLeft(radius(sunRadius, sun.norm()), radius(otherRadius, other.norm()),
                    std::atan2(sun.cross(other).norm(), sun.dot(other)));
  };
  // Nodes are less than 2 x `apart` from the first one, by which both directions turn.
  const double apart = (this->Nodes_.front().p_S - this->Nodes_.back().p_S).norm();
  const Eigen::Vector3d sun = sun_S - this->Nodes_.front().p_S;
  const Eigen::Vector3d other = other_S - this->Nodes_.front().p_S;
  const double reach = std::asin(std::min(1.0, (sunRadius + 2.0 * apart) / sun.norm())) +
                       std::asin(std::min(1.0, (otherRadius + 2.0 * apart) / other.norm()));
  if (std::atan2(sun.cross(other).norm(), sun.dot(other)) > reach) {
    return false;
  }
  this->Left_.resize(this->Nodes_.size());
  bool any = false;
  for (std::size_t n = 0; n < this->Nodes_.size(); ++n) {
    this->Left_[n] = left(this->Nodes_[n]);
    any |= this->Left_[n] < 1.0;
  }
  return any;
}

double HorizonTile::LeftAt(int cell) const {
  if (this->Nodes_.size() == 1) {
    return this->Left_[0];
  }
  const int i = cell % this->Width_, j = cell / this->Width_;
  const double u = double(i % this->Step_) / this->Step_;
  const double v = double(j % this->Step_) / this->Step_;
  const std::size_t node = std::size_t(j / this->Step_ * this->Across_ + i / this->Step_);
  const std::size_t below = node + std::size_t(this->Across_);
  const std::vector<double>& left = this->Left_;
  return (1.0 - v) * ((1.0 - u) * left[node] + u * left[node + 1]) +
         v * ((1.0 - u) * left[below] + u * left[below + 1]);
}

} // namespace dspace
