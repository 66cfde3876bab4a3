#include <dspace/maps/Illumination.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/Checks.h>
#include <dspace/horizon/HorizonPath.h>
#include <dspace/horizon/LitFraction.h>

namespace dspace {
namespace {

constexpr int IlluminationVersion = 2;

constexpr double Straight = 0.01; // [rad] of turn between two nodes
constexpr double Degree = M_PI / 180.0;
constexpr float NothingInSight = -90.0f;
// Of the elevation of a disc whose slope across the sky counts: towards the zenith azimuths have no
// width.
constexpr double MostSecant = 4.0;

using Quantity = IlluminationOptions::Quantity;

const char* NameOf(Quantity quantity) {
  switch (quantity) {
  case Quantity::LitFraction:
    return "lit fraction of the time";
  case Quantity::LongestNight:
    return "longest night [s]";
  case Quantity::PermanentShadow:
    return "permanent shadow";
  default:
    return "fraction of the time with the Earth in sight";
  }
}

// The cells of a tile and the directions that they see.
class Tile {
public:
  Tile(const HorizonMap& map, int column, int row)
      : Map_(map), Width_(std::min(TileFile::Side, map.Columns() - column)),
        Height_(std::min(TileFile::Side, map.Rows() - row)), Azimuths_(map.Azimuths()),
        Horizons_(map.Read(column, row, Width_, Height_)) {
    const PostPlacement& placement = map.Placement();
    const bool plane = !placement.OnBody();
    for (float& h : this->Horizons_) {
      // On a plane the ground beyond the data is level.
      h = h == NothingInSight || (plane && h < 0.0f) ? 0.0f : h * float(Degree);
    }
    if (plane) {
      this->Nodes_.push_back(this->NodeAt(placement, Eigen::Vector2d::Zero()));
      this->Step_ = TileFile::Side;
      return;
    }
    const auto post = [&](int i, int j) { return map.Cells().Post(column + i, row + j); };
    const auto turn = [&](int i, int j) { // of the east between two nodes
      return std::acos(std::clamp(ChartAxesAt(placement, post(i, j))
                                      .east.dot(ChartAxesAt(placement, post(i + 8, j + 8)).east),
                                  -1.0, 1.0));
    };
    this->Step_ = std::max(turn(0, 0), turn(0, TileFile::Side - 8)) < Straight ? 8 : 1;
    this->Across_ = TileFile::Side / this->Step_ + 1;
    for (int j = 0; j <= TileFile::Side; j += this->Step_) {
      for (int i = 0; i <= TileFile::Side; i += this->Step_) {
        this->Nodes_.push_back(this->NodeAt(placement, post(i, j)));
      }
    }
    this->Azimuth_.resize(this->Nodes_.size());
    this->Elevation_.resize(this->Nodes_.size());
  }

  int Width() const { return this->Width_; }
  int Height() const { return this->Height_; }
  bool HasData(int cell) const { return !std::isnan(this->Horizons_[std::size_t(cell)]); }

  // Calls visit(cell, how far above the horizon [rad], rise of the horizon to the next azimuth
  // [rad], elevation [rad]) for each cell.
  template<typename Visit> void See(const Eigen::Vector3d& p_S, const Visit& visit) {
    const double perStep = double(this->Azimuths_) / (2.0 * M_PI);
    if (this->Nodes_.size() == 1) {
      const auto [azimuth, elevation] = Seen(this->Nodes_[0], p_S);
      const double x = azimuth * perStep;
      for (int cell = 0; cell < this->Width_ * this->Height_; ++cell) {
        this->Offer(cell, x, elevation, visit);
      }
      return;
    }
    for (std::size_t n = 0; n < this->Nodes_.size(); ++n) {
      const auto [azimuth, elevation] = Seen(this->Nodes_[n], p_S);
      this->Azimuth_[n] = azimuth;
      this->Elevation_[n] = elevation;
    }
    for (int j = 0; j < this->Height_; ++j) {
      const double v = double(j % this->Step_) / this->Step_;
      for (int block = 0; block * this->Step_ < this->Width_; ++block) {
        const std::size_t node = std::size_t(j / this->Step_ * this->Across_ + block);
        const double a0 = this->Azimuth_[node];
        const auto near = [&](std::size_t other) {
          return a0 + std::remainder(this->Azimuth_[other] - a0, 2.0 * M_PI);
        };
        const auto below = node + std::size_t(this->Across_);
        const double left = a0 + v * (near(below) - a0);
        const double right = near(node + 1) + v * (near(below + 1) - near(node + 1));
        const double low =
            this->Elevation_[node] + v * (this->Elevation_[below] - this->Elevation_[node]);
        const double high = this->Elevation_[node + 1] +
                            v * (this->Elevation_[below + 1] - this->Elevation_[node + 1]);
        const int first = block * this->Step_;
        const int last = std::min(first + this->Step_, this->Width_);
        for (int i = first; i < last; ++i) {
          const double u = double(i - first) / this->Step_;
          this->Offer(j * this->Width_ + i, (left + u * (right - left)) * perStep,
                      low + u * (high - low), visit);
        }
      }
    }
  }

private:
  struct Node {
    ChartAxes axes;
    Eigen::Vector3d p_S;
  };
  static Node NodeAt(const PostPlacement& placement, const Eigen::Vector2d& post) {
    return {ChartAxesAt(placement, post),
            placement.OnBody() ? placement.ToScene(post, 0.0) : Eigen::Vector3d::Zero().eval()};
  }
  static std::pair<double, double> Seen(const Node& node, const Eigen::Vector3d& p_S) {
    const Eigen::Vector3d d = p_S - node.p_S;
    const double east = node.axes.east.dot(d);
    const double north = node.axes.north.dot(d);
    return {std::atan2(east, north), std::atan2(node.axes.up.dot(d), std::hypot(east, north))};
  }
  template<typename Visit>
  void Offer(int cell, double x, double elevation, const Visit& visit) const {
    x = x < 0.0 ? x + this->Azimuths_ : x;
    x = x >= this->Azimuths_ ? x - this->Azimuths_ : x;
    const int first = std::min(int(x), this->Azimuths_ - 1);
    const int second = first + 1 == this->Azimuths_ ? 0 : first + 1;
    const auto cells = std::size_t(this->Width_) * std::size_t(this->Height_);
    const double a = this->Horizons_[std::size_t(first) * cells + std::size_t(cell)];
    const double b = this->Horizons_[std::size_t(second) * cells + std::size_t(cell)];
    visit(cell, elevation - (a + (x - first) * (b - a)), b - a, elevation);
  }

  const HorizonMap& Map_;
  int Width_;
  int Height_;
  int Azimuths_;
  std::vector<float> Horizons_; // [rad], azimuth after azimuth
  int Step_ = 1;                // cells between nodes
  int Across_ = 1;              // nodes
  std::vector<Node> Nodes_;
  std::vector<double> Azimuth_; // of the nodes [rad]
  std::vector<double> Elevation_;
};

void Check(const IlluminationOptions& options) {
  const std::string about = "illumination map";
  Require(!options.sun_S.empty() && options.sun_S.size() <= IlluminationOptions::MostSteps, about,
          "the number of steps", double(options.sun_S.size()), "1 to 10,000,000");
  Require(options.step_s > 0.0 && std::isfinite(options.step_s), about, "the step", options.step_s,
          "more than 0 s");
  Require(options.sunRadius >= 0.0 && std::isfinite(options.sunRadius), about, "the Sun's radius",
          options.sunRadius, "0 m or more");
  Require(!options.quantities.empty(), about, "the number of quantities", 0.0, "one or more");
  for (const Quantity quantity : options.quantities) {
    if (quantity == Quantity::EarthFraction && options.earth_S.size() != options.sun_S.size()) {
      Reject(about, "the Earth has " + std::to_string(options.earth_S.size()) +
                        " places; accepted: one a step, " + std::to_string(options.sun_S.size()));
    }
  }
  for (const std::vector<Eigen::Vector3d>* places : {&options.sun_S, &options.earth_S}) {
    for (const Eigen::Vector3d& p_S : *places) {
      RequireFinite(about, "a place of the Sun or the Earth", p_S);
    }
  }
}

} // namespace

bool WriteIllumination(const HorizonMap& horizons, const IlluminationOptions& options,
                       const std::string& path, const MapControl& control) {
  Check(options);
  TileFileLayout layout;
  layout.columns = horizons.Columns();
  layout.rows = horizons.Rows();
  layout.cellToMap = horizons.CellToMap();
  layout.crs = horizons.GetCrs();
  InputHash hash;
  hash.Add(std::uint64_t(IlluminationVersion));
  hash.Add(horizons.InputHash());
  bool sees = false; // the Earth
  for (const Quantity quantity : options.quantities) {
    layout.bands.emplace_back(NameOf(quantity));
    hash.Add(layout.bands.back());
    sees |= quantity == Quantity::EarthFraction;
  }
  for (const std::vector<Eigen::Vector3d>* places : {&options.sun_S, &options.earth_S}) {
    for (const Eigen::Vector3d& p_S : *places) {
      for (const double value : {p_S.x(), p_S.y(), p_S.z()}) {
        hash.Add(value);
      }
    }
  }
  hash.Add(options.step_s);
  hash.Add(options.sunRadius);
  layout.hash = hash.Get();
  layout.metadata["DSPACE_KIND"] = "illumination map";
  layout.metadata["DSPACE_VERSION"] = std::to_string(IlluminationVersion);
  layout.metadata["DSPACE_TERRAIN"] = horizons.Terrain();
  layout.metadata["DSPACE_HEIGHT_M"] = NumberText(horizons.Height());
  layout.metadata["DSPACE_STEPS"] = std::to_string(options.sun_S.size());
  layout.metadata["DSPACE_STEP_S"] = NumberText(options.step_s);
  TileFile file(path, layout, control.replace);
  const auto steps = double(options.sun_S.size());
  const double perAzimuth = double(horizons.Azimuths()) / (2.0 * M_PI);
  const auto make = [&](int column, int row, std::vector<float>& values,
                        const std::atomic<bool>& stop) {
    Tile tile(horizons, column * TileFile::Side, row * TileFile::Side);
    const auto count = std::size_t(tile.Width()) * std::size_t(tile.Height());
    std::vector<double> lit(count, 0.0);
    std::vector<std::uint32_t> night(count, 0);
    std::vector<std::uint32_t> longest(count, 0);
    std::vector<std::uint32_t> earth(count, 0);
    for (std::size_t k = 0; k < options.sun_S.size() && !stop; ++k) {
      const Eigen::Vector3d& sun_S = options.sun_S[k];
      const double radius = std::asin(std::min(1.0, options.sunRadius / sun_S.norm()));
      tile.See(sun_S, [&](int cell, double above, double rise, double elevation) {
        double part = above >= 0.0 ? 1.0 : 0.0;
        const double rising = rise * perAzimuth; // over azimuth, which is narrower in the sky
        if (std::abs(above) < radius * (1.0 + MostSecant * std::abs(rising))) {
          const double secant = std::min(1.0 / std::cos(elevation), MostSecant);
          part = LitFraction(above, rising * secant, radius);
        }
        const auto at = std::size_t(cell);
        lit[at] += part;
        night[at] = part > 0.0 ? 0 : night[at] + 1;
        longest[at] = std::max(longest[at], night[at]);
      });
      if (sees) {
        tile.See(options.earth_S[k], [&](int cell, double above, double, double) {
          earth[std::size_t(cell)] += above >= 0.0;
        });
      }
    }
    for (int j = 0; j < tile.Height(); ++j) {
      for (int i = 0; i < tile.Width(); ++i) {
        const auto at = std::size_t(j * tile.Width() + i);
        for (std::size_t b = 0; b < options.quantities.size(); ++b) {
          const Quantity quantity = options.quantities[b];
          double value = std::numeric_limits<double>::quiet_NaN();
          if (tile.HasData(int(at))) {
            value = quantity == Quantity::LitFraction       ? lit[at] / steps
                    : quantity == Quantity::LongestNight    ? longest[at] * options.step_s
                    : quantity == Quantity::PermanentShadow ? double(lit[at] == 0.0)
                                                            : earth[at] / steps;
          }
          values[(b * TileFile::Side + std::size_t(j)) * TileFile::Side + std::size_t(i)] =
              float(value);
        }
      }
    }
  };
  return FillTiles(file, options.quantities.size(), control, make);
}

} // namespace dspace
