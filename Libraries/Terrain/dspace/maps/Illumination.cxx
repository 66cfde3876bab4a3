#include <dspace/maps/Illumination.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include <dspace/Checks.h>
#include <dspace/horizon/LitFraction.h>
#include <dspace/maps/HorizonTile.h>
#include <dspace/maps/LitCells.h>

namespace dspace {
namespace {

constexpr int IlluminationVersion = 3;

using Quantity = IlluminationOptions::Quantity;

const char* NameOf(Quantity quantity) {
  switch (quantity) {
  case Quantity::LitFraction:
    return "lit fraction of the time";
  case Quantity::LongestNight:
    return "longest night [s]";
  case Quantity::PermanentShadow:
    return "permanent shadow";
  case Quantity::StationFraction:
    return "fraction of the time with a station in sight";
  default:
    return "fraction of the time with the Earth in sight";
  }
}

// Adds a step in which the disc is a point or cut by another one.
void AddOdd(const SeenRow& row, double radius, double perAzimuth, const HorizonTile* eclipsed,
            std::size_t begin, std::vector<double>& lit, const LitCounts& counts) {
  for (int i = 0; i < row.count; ++i) {
    const double part = LitFraction(row.above[i], row.rise[i] * perAzimuth * row.secant[i], radius);
    lit[begin + std::size_t(i)] += eclipsed ? part * eclipsed->LeftAt(int(begin) + i) : part;
    counts.night[i] = part > 0.0 ? 0 : counts.night[i] + 1;
    counts.longest[i] = std::max(counts.longest[i], counts.night[i]);
  }
}

void Check(const IlluminationOptions& options) {
  const std::string about = "illumination map";
  Require(!options.sun_S.empty() && options.sun_S.size() <= IlluminationOptions::MostSteps, about,
          "the number of steps", double(options.sun_S.size()), "1 to 10,000,000");
  Require(options.step_s > 0.0 && std::isfinite(options.step_s), about, "the step", options.step_s,
          "more than 0 s");
  Require(options.sunRadius >= 0.0 && std::isfinite(options.sunRadius), about, "the Sun's radius",
          options.sunRadius, "0 m or more");
  Require(options.eclipserRadius >= 0.0 && std::isfinite(options.eclipserRadius), about,
          "the radius of the body that eclipses the Sun", options.eclipserRadius, "0 m or more");
  if (!options.eclipser_S.empty() && options.eclipser_S.size() != options.sun_S.size()) {
    Reject(about,
           "the body that eclipses the Sun has " + std::to_string(options.eclipser_S.size()) +
               " places; accepted: none, or one a step, " + std::to_string(options.sun_S.size()));
  }
  Require(!options.quantities.empty(), about, "the number of quantities", 0.0, "one or more");
  for (const Quantity quantity : options.quantities) {
    if (quantity == Quantity::StationFraction &&
        options.stations_S.size() != options.sun_S.size()) {
      Reject(about, "stations have places at " + std::to_string(options.stations_S.size()) +
                        " steps; accepted: at every step, " + std::to_string(options.sun_S.size()));
    }
    if (quantity == Quantity::EarthFraction && options.earth_S.size() != options.sun_S.size()) {
      Reject(about, "the Earth has " + std::to_string(options.earth_S.size()) +
                        " places; accepted: one a step, " + std::to_string(options.sun_S.size()));
    }
  }
  for (const std::vector<Eigen::Vector3d>* places :
       {&options.sun_S, &options.earth_S, &options.eclipser_S}) {
    for (const Eigen::Vector3d& p_S : *places) {
      RequireFinite(about, "a place of a body", p_S);
    }
  }
  for (const std::vector<Eigen::Vector3d>& places : options.stations_S) {
    for (const Eigen::Vector3d& p_S : places) {
      RequireFinite(about, "a place of a station", p_S);
    }
  }
}

void Add(const Eigen::Vector3d& p_S, InputHash& hash) {
  for (const double value : {p_S.x(), p_S.y(), p_S.z()}) {
    hash.Add(value);
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
  bool sees = false;  // the Earth
  bool links = false; // with stations
  for (const Quantity quantity : options.quantities) {
    layout.bands.emplace_back(NameOf(quantity));
    hash.Add(layout.bands.back());
    sees |= quantity == Quantity::EarthFraction;
    links |= quantity == Quantity::StationFraction;
  }
  for (const std::vector<Eigen::Vector3d>* places :
       {&options.sun_S, &options.earth_S, &options.eclipser_S}) {
    hash.Add(std::uint64_t(places->size()));
    for (const Eigen::Vector3d& p_S : *places) {
      Add(p_S, hash);
    }
  }
  if (links) {
    for (const std::vector<Eigen::Vector3d>& places : options.stations_S) {
      hash.Add(std::uint64_t(places.size()));
      for (const Eigen::Vector3d& p_S : places) {
        Add(p_S, hash);
      }
    }
  }
  hash.Add(options.step_s);
  hash.Add(options.sunRadius);
  hash.Add(options.eclipserRadius);
  layout.hash = hash.Get();
  layout.metadata["DSPACE_KIND"] = "illumination map";
  layout.metadata["DSPACE_VERSION"] = std::to_string(IlluminationVersion);
  layout.metadata["DSPACE_TERRAIN"] = horizons.Terrain();
  layout.metadata["DSPACE_HEIGHT_M"] = NumberText(horizons.Height());
  layout.metadata["DSPACE_STEPS"] = std::to_string(options.sun_S.size());
  layout.metadata["DSPACE_STEP_S"] = NumberText(options.step_s);
  layout.metadata["DSPACE_ECLIPSES"] = options.eclipser_S.empty() ? "no" : "yes";
  TileFile file(path, layout, control.replace);
  const auto steps = double(options.sun_S.size());
  const double perAzimuth = double(horizons.Azimuths()) / (2.0 * M_PI);
  const auto make = [&](int column, int row, std::vector<float>& values,
                        const std::atomic<bool>& stop) {
    HorizonTile tile(horizons, column * TileFile::Side, row * TileFile::Side);
    const auto count = std::size_t(tile.Width()) * std::size_t(tile.Height());
    std::vector<double> lit(count, 0.0);    // parts of the disc
    std::vector<float> latest(count, 0.0f); // that are not in `lit` yet
    std::vector<std::uint32_t> night(count, 0);
    std::vector<std::uint32_t> longest(count, 0);
    std::vector<std::uint32_t> earth(count, 0);
    std::vector<std::uint32_t> linked(count, 0);
    std::vector<std::uint32_t> stations(links ? count : 0); // in sight at one step
    std::array<float, TileFile::Side> above, rise, secant;
    const SeenRow seen = {above.data(), rise.data(), secant.data(), tile.Width()};
    const auto see = [&](int j) {
      tile.SeeRow(j, above.data(), rise.data(), secant.data());
      return std::size_t(j) * std::size_t(tile.Width()); // of the row's first cell
    };
    for (std::size_t k = 0; k < options.sun_S.size() && !stop; ++k) {
      const Eigen::Vector3d& sun_S = options.sun_S[k];
      const double radius = std::asin(std::min(1.0, options.sunRadius / sun_S.norm()));
      const bool eclipsed =
          !options.eclipser_S.empty() &&
          tile.Eclipse(sun_S, options.sunRadius, options.eclipser_S[k], options.eclipserRadius);
      tile.LookAt(sun_S);
      for (int j = 0; j < tile.Height(); ++j) {
        const std::size_t begin = see(j);
        const LitCounts counts = {&latest[begin], &night[begin], &longest[begin]};
        if (eclipsed || radius == 0.0) {
          AddOdd(seen, radius, perAzimuth, eclipsed ? &tile : nullptr, begin, lit, counts);
        } else {
          AddLit(seen, float(radius), float(perAzimuth), counts);
        }
      }
      if ((k + 1) % MostLitSteps == 0 || k + 1 == options.sun_S.size()) {
        std::transform(lit.begin(), lit.end(), latest.begin(), lit.begin(), std::plus<>());
        std::fill(latest.begin(), latest.end(), 0.0f);
      }
      if (sees) {
        tile.LookAt(options.earth_S[k]);
        for (int j = 0; j < tile.Height(); ++j) {
          CountAbove(seen, &earth[see(j)]);
        }
      }
      if (links && !options.stations_S[k].empty()) {
        std::fill(stations.begin(), stations.end(), 0);
        for (const Eigen::Vector3d& station_S : options.stations_S[k]) {
          tile.LookAt(station_S);
          for (int j = 0; j < tile.Height(); ++j) {
            CountAbove(seen, &stations[see(j)]);
          }
        }
        for (std::size_t i = 0; i < count; ++i) {
          linked[i] += stations[i] > 0 ? 1 : 0;
        }
      }
    }
    for (int j = 0; j < tile.Height(); ++j) {
      for (int i = 0; i < tile.Width(); ++i) {
        const auto at = std::size_t(j * tile.Width() + i);
        for (std::size_t b = 0; b < options.quantities.size(); ++b) {
          const Quantity quantity = options.quantities[b];
          double value = std::numeric_limits<double>::quiet_NaN();
          if (tile.HasData(int(at))) {
            value = quantity == Quantity::LitFraction    ? lit[at] / steps
                    : quantity == Quantity::LongestNight ? longest[at] * options.step_s
                    : quantity == Quantity::PermanentShadow
                        ? double(longest[at] == options.sun_S.size())
                    : quantity == Quantity::EarthFraction ? earth[at] / steps
                                                          : linked[at] / steps;
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
