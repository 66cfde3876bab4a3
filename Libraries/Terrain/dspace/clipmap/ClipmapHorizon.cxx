#include <dspace/clipmap/ClipmapHorizon.h>

#include <algorithm>
#include <cmath>

#include <dspace/horizon/HorizonPath.h>

namespace dspace {
namespace {

constexpr int Side = HorizonBlocks::Side;
constexpr int NodePosts = 8;
constexpr int Nodes = Side / NodePosts + 1;
constexpr double Step = HorizonBlocks::StepDegrees * M_PI / 180.0; // [rad]
constexpr int MostSteps = 4;                                       // of azimuths over one block
constexpr int WidestStep = 64;                                     // of HorizonBlocks' azimuths
constexpr double Still = 1e-6;  // [rad] that the Sun moves before an interactive picture follows
constexpr double Dark = -0.6;   // [rad] below every horizon of ground
constexpr float Lowest = -0.5f; // [rad] of horizons where nothing is in sight

double AzimuthOf(const Eigen::Vector3d& d) {
  return std::atan2(d.x(), d.y());
}

} // namespace

ClipmapHorizon::BlockSun ClipmapHorizon::SunOver(int level, const Place& place,
                                                 const Eigen::Vector3d& toSun_S) const {
  const PostPlacement& placement = this->Blocks_->Sweep().Placement();
  const PostLattice& lattice = this->Blocks_->Sweep().Pyramid()->Lattice();
  const bool plane = placement.GetKind() == PostPlacement::Kind::Plane;
  BlockSun sun;
  double low = 0.0;
  double high = 0.0;
  double top = -M_PI;
  double middle = 0.0;
  for (int j = 0; j < Nodes; ++j) {
    for (int i = 0; i < Nodes; ++i) {
      if (plane && !sun.nodes.empty()) {
        sun.nodes.push_back(sun.nodes.front());
        continue;
      }
      const Eigen::Vector2d post(
          std::ldexp(double(place.first * Side + i * NodePosts), level),
          std::clamp(std::ldexp(double(place.second * Side + j * NodePosts), level), 0.0,
                     double(lattice.rows - 1)));
      const ChartAxes axes = ChartAxesAt(placement, post);
      const Eigen::Vector3d seen(axes.east.dot(toSun_S), axes.north.dot(toSun_S),
                                 axes.up.dot(toSun_S));
      const double azimuth = AzimuthOf(seen);
      middle = sun.nodes.empty() ? azimuth : middle;
      const double apart = std::remainder(azimuth - middle, 2.0 * M_PI);
      low = std::min(low, apart);
      high = std::max(high, apart);
      top = std::max(top, std::asin(std::clamp(seen.z(), -1.0, 1.0)));
      sun.nodes.push_back(seen);
    }
  }
  sun.dark = top < Dark;
  while ((high - low) / Step > MostSteps * sun.step && sun.step < WidestStep) {
    sun.step *= 2;
  }
  const double steps = Step * sun.step;
  const double first = std::floor((middle + low) / steps);
  const double last = std::floor((middle + high) / steps) + 1.0;
  sun.count = std::min(int(last - first) + 1, HorizonBlocks::Around / sun.step + 1);
  sun.first = int(first) * sun.step;
  return sun;
}

// Without `shown` from the coarser level.
void ClipmapHorizon::Compose(const ClipmapLevels& levels, int index, const Place& place,
                             const Shown* shown) {
  const ClipmapGeometry& geometry = levels.Geometry();
  const ClipmapWindow& window = levels.Window(index);
  const bool plane = this->Blocks_->Sweep().Placement().GetKind() == PostPlacement::Kind::Plane;
  Level& level = this->Levels_[std::size_t(index)];
  const std::int64_t left = std::max(place.first * Side, window.column - 1);
  const std::int64_t right =
      std::min(place.first * Side + Side, window.column + geometry.Cells() + 2);
  const std::int64_t top = std::max(place.second * Side, window.row - 1);
  const std::int64_t bottom =
      std::min(place.second * Side + Side, window.row + geometry.Cells() + 2);
  const std::vector<HorizonTexel>* coarser = std::size_t(index) + 1 < this->Levels_.size()
                                                 ? &this->Levels_[std::size_t(index) + 1].texels
                                                 : nullptr;
  const double steps = shown ? Step * shown->sun.step : Step;
  const double from = shown ? shown->sun.first * Step : 0.0;
  const auto side = std::size_t(geometry.Texels());
  // The Sun at a post, and the azimuths about it.
  struct Bearing {
    float elevation = 0.0f;
    float share = 0.0f;  // of the second azimuth
    float across = 1.0f; // steps of azimuth a radian along the horizon
    std::size_t first = 0;
  };
  const double last = shown ? double(shown->azimuths.size()) - 1.0 : 0.0;
  const auto bearingOf = [&](const Eigen::Vector3d& sun) {
    const double level0 = std::hypot(sun.x(), sun.y());
    // In steps from the first azimuth; what is held for another Sun may lie beside it.
    double x = std::remainder(AzimuthOf(sun) - from, 2.0 * M_PI) / steps;
    x += x < -2.0 ? 2.0 * M_PI / steps : 0.0;
    x = std::clamp(x, -1.0, last + 1.0);
    Bearing bearing;
    bearing.first = std::size_t(std::clamp(std::floor(x), 0.0, last - 1.0));
    bearing.share = float(x - double(bearing.first));
    bearing.across = float(1.0 / (steps * std::max(level0, 1e-3)));
    bearing.elevation = float(std::atan2(sun.z(), level0));
    return bearing;
  };
  const bool swept = shown && !shown->sun.dark;
  Bearing bearing = swept ? bearingOf(shown->sun.nodes.front()) : Bearing();
  const float least = plane ? 0.0f : Lowest;
  for (std::int64_t r = top; r < bottom; ++r) {
    HorizonTexel* row = &level.texels[std::size_t(geometry.Texel(r)) * side];
    for (std::int64_t c = left; c < right; ++c) {
      HorizonTexel& texel = row[geometry.Texel(c)];
      if (!swept) {
        texel = shown ? HorizonTexel{-1.5f, -1.5f} : HorizonTexel();
        if (!shown && coarser && !coarser->empty()) {
          texel = (*coarser)[std::size_t(geometry.Texel(r >> 1)) * side +
                             std::size_t(geometry.Texel(c >> 1))];
        }
        continue;
      }
      const auto i = std::size_t(c - place.first * Side);
      const auto j = std::size_t(r - place.second * Side);
      if (!plane) {
        const std::size_t node = j / NodePosts * Nodes + i / NodePosts;
        const double u = double(i % NodePosts) / NodePosts;
        const double v = double(j % NodePosts) / NodePosts;
        const std::vector<Eigen::Vector3d>& n = shown->sun.nodes;
        bearing = bearingOf((1.0 - v) * ((1.0 - u) * n[node] + u * n[node + 1]) +
                            v * ((1.0 - u) * n[node + Nodes] + u * n[node + Nodes + 1]));
      }
      const std::size_t at = j * Side + i;
      const auto above = [&](const std::vector<float>& a, const std::vector<float>& b) {
        if (std::isnan(a[at]) || std::isnan(b[at])) {
          return 1.5f;
        }
        const float h0 = std::max(a[at], least);
        const float h1 = std::max(b[at], least);
        const float slope = (h1 - h0) * bearing.across;
        const float angle = bearing.elevation - (h0 + bearing.share * (h1 - h0));
        return std::clamp(angle / std::sqrt(1.0f + slope * slope), -1.5f, 1.5f);
      };
      const HorizonBlock& a = *shown->azimuths[bearing.first];
      const HorizonBlock& b = *shown->azimuths[bearing.first + 1];
      texel = {above(a.all, b.all), above(a.distant, b.distant)};
    }
  }
}

bool ClipmapHorizon::Update(const ClipmapLevels& levels, const ClipmapLevels::State& state,
                            const Eigen::Vector3d& toSun_S, const std::optional<double>& wait,
                            const Upload& upload) {
  this->Levels_.resize(std::size_t(levels.Count()));
  const bool moved =
      !this->Sun_ || (wait ? *this->Sun_ != toSun_S : (*this->Sun_ - toSun_S).norm() > Still);
  const std::uint64_t arrivals = this->Blocks_->Arrivals();
  bool same = !moved && arrivals == this->Arrivals_ && state.finest == this->Finest_ &&
              (this->Complete_ || !wait);
  for (int index = state.finest; index < levels.Count() && same; ++index) {
    same = this->Levels_[std::size_t(index)].window == levels.Window(index);
  }
  if (same) {
    return this->Complete_;
  }
  if (moved) {
    if (this->Sun_) {
      const ChartAxes axes = ChartAxesAt(this->Blocks_->Sweep().Placement(), state.place);
      const auto azimuth = [&](const Eigen::Vector3d& d) {
        return std::atan2(axes.east.dot(d), axes.north.dot(d));
      };
      this->Turning_ = std::remainder(azimuth(toSun_S) - azimuth(*this->Sun_), 2.0 * M_PI);
    }
    this->Sun_ = toSun_S;
  }
  const Eigen::Vector3d& sun = *this->Sun_;
  this->Arrivals_ = arrivals;
  this->Finest_ = state.finest;

  // What is needed, coarsest first, and what will be soon.
  struct Wanted {
    int level;
    Place place;
    BlockSun sun;
    std::size_t first; // of its keys
  };
  std::vector<Wanted> wanted;
  std::vector<HorizonBlocks::Key> keys;
  const auto add = [&keys](const Wanted& one, int azimuth) {
    const int around = HorizonBlocks::Around;
    keys.push_back(
        {one.level, one.place.first, one.place.second, ((azimuth % around) + around) % around});
  };
  const auto posts = std::int64_t(levels.Geometry().Cells()) + 2; // to the window's last
  for (int index = levels.Count() - 1; index >= state.finest; --index) {
    const ClipmapWindow& window = levels.Window(index);
    const PostLattice& lattice = levels.Lattice();
    std::int64_t left = window.column - 1;
    std::int64_t right = window.column - 1 + posts;
    const std::int64_t top = std::max<std::int64_t>(window.row - 1, 0);
    const std::int64_t bottom = std::min(window.row - 1 + posts, lattice.RowsAt(index) - 1);
    if (!lattice.periodic) {
      left = std::max<std::int64_t>(left, 0);
      right = std::min(right, lattice.ColumnsAt(index) - 1);
    }
    for (std::int64_t r = FloorDiv(top, Side); r <= FloorDiv(bottom, Side); ++r) {
      for (std::int64_t c = FloorDiv(left, Side); c <= FloorDiv(right, Side); ++c) {
        Wanted one{index, {c, r}, this->SunOver(index, {c, r}, sun), keys.size()};
        for (int k = 0; k < one.sun.count && !one.sun.dark; ++k) {
          add(one, one.sun.first + k * one.sun.step);
        }
        wanted.push_back(std::move(one));
      }
    }
  }
  if (!wait && this->Turning_ != 0.0) {
    for (const Wanted& one : wanted) {
      if (!one.sun.dark) {
        add(one, one.sun.first + (this->Turning_ > 0.0 ? one.sun.count : -1) * one.sun.step);
      }
    }
  }
  const std::vector<HorizonBlocks::Pointer> found =
      wait ? this->Blocks_->Get(keys, *wait) : this->Blocks_->TryGet(keys);

  this->Complete_ = true;
  bool coarserChanged = false;
  for (std::size_t i = 0; i < wanted.size();) {
    const int index = wanted[i].level;
    Level& level = this->Levels_[std::size_t(index)];
    const auto texels = std::size_t(levels.Geometry().Texels());
    std::map<Place, Shown> blocks;
    std::vector<Place> missing;
    bool changed = moved || level.texels.empty() || level.window != levels.Window(index);
    bool whole = true;
    for (; i < wanted.size() && wanted[i].level == index; ++i) {
      const Wanted& one = wanted[i];
      Shown shown;
      shown.sun = one.sun;
      bool there = true;
      for (int k = 0; k < one.sun.count && !one.sun.dark; ++k) {
        shown.azimuths.push_back(found[one.first + std::size_t(k)]);
        there = there && shown.azimuths.back();
      }
      const auto held = level.blocks.find(one.place);
      if (!there) {
        whole = false;
        if (held == level.blocks.end() || held->second.azimuths.empty()) {
          missing.push_back(one.place);
          continue;
        }
        shown.azimuths = held->second.azimuths; // of the Sun as it was
        shown.sun.first = held->second.sun.first;
        shown.sun.step = held->second.sun.step;
      }
      changed = changed || held == level.blocks.end() || !(held->second == shown);
      blocks.emplace(one.place, std::move(shown));
    }
    this->Complete_ = this->Complete_ && whole;
    changed = changed || (coarserChanged && !missing.empty());
    level.blocks = std::move(blocks);
    level.window = levels.Window(index);
    if (changed) {
      level.texels.resize(texels * texels);
      for (const auto& [place, shown] : level.blocks) {
        this->Compose(levels, index, place, &shown);
      }
      for (const Place& place : missing) {
        this->Compose(levels, index, place, nullptr);
      }
      upload(index, level.texels);
    }
    coarserChanged = changed;
  }
  return this->Complete_;
}

} // namespace dspace
