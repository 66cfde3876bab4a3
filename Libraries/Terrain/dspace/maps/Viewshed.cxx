#include <dspace/maps/Viewshed.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <dspace/Checks.h>
#include <dspace/horizon/HeldPosts.h>
#include <dspace/maps/ViewshedEye.h>

namespace dspace {
namespace {

constexpr int ViewshedVersion = 2;
constexpr std::int64_t MostViewedPosts = std::int64_t(1) << 28; // posts, 1 GB
constexpr double MostViewHeight = 1e6;                          // [m]
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

const char* NameOf(ViewshedOptions::Quantity quantity) {
  switch (quantity) {
  case ViewshedOptions::Quantity::Visible:
    return "visible";
  case ViewshedOptions::Quantity::LeastHeight:
    return "least height [m]";
  default:
    return "observers";
  }
}

void Check(const ViewshedOptions& options) {
  const std::string about = "viewshed";
  Require(!options.observers.empty() && options.observers.size() <= ViewshedOptions::MostObservers,
          about, "the number of observers", double(options.observers.size()), "1 to 10,000");
  Require(options.targetHeight >= 0.0 && options.targetHeight <= MostViewHeight, about,
          "the height of the targets", options.targetHeight, "0 to 1e6 m");
  Require(options.radius > 0.0, about, "the radius", options.radius, "more than 0 m");
  Require(!options.quantities.empty(), about, "the number of quantities", 0.0, "one or more");
  for (const ViewshedObserver& observer : options.observers) {
    Require(observer.height >= 0.0 && observer.height <= MostViewHeight, about,
            "the height of an observer", observer.height, "0 to 1e6 m");
  }
}

} // namespace

double LeastSeenHeight(const MapGround& ground, const HeldPosts& held,
                       const ViewshedObserver& observer, const Eigen::Vector2d& to) {
  const ViewshedEye eye(ground, held, observer);
  ViewshedEye::Memory memory;
  return eye.HasGround() ? eye.Least(to, std::numeric_limits<double>::infinity(), memory) : NaN;
}

bool WriteViewshed(const MapGround& ground, const ViewshedOptions& options, const std::string& path,
                   const MapControl& control) {
  Check(options);
  if (HeldPosts::CountOf(ground.pyramid->Lattice()) > MostViewedPosts) {
    throw Error(Error::Kind::Resource, ground.name,
                "a viewshed holds its " +
                    std::to_string(HeldPosts::CountOf(ground.pyramid->Lattice())) +
                    " posts (those of a full circle twice); accepted: up to " +
                    std::to_string(MostViewedPosts) +
                    ": a smaller part of the terrain, or fewer subdivisions");
  }
  const auto proceed = [&] { return !control.progress || control.progress({}); };
  const std::uint64_t before = ground.pyramid->LatestChange();
  const std::optional<GroundSurvey> survey = Survey(ground, proceed);
  const auto held = survey ? HeldPosts::Read(*ground.pyramid, 1, 1, proceed) : nullptr;
  if (!held) {
    return false;
  }
  std::vector<ViewshedEye> eyes;
  for (const ViewshedObserver& observer : options.observers) {
    eyes.emplace_back(ground, *held, observer);
    if (!eyes.back().HasGround()) {
      const Eigen::Vector2d map = ground.postToMap * observer.post;
      Reject(ground.name, "the observer at map x " + NumberText(map.x()) + ", y " +
                              NumberText(map.y()) +
                              " is off its data; accepted: places with ground");
    }
  }
  TileFileLayout layout;
  const MapCells& cells = options.cells;
  layout.columns = cells.columns;
  layout.rows = cells.rows;
  layout.cellToMap = cells.CellToMap(ground);
  layout.crs = ground.crs;
  InputHash hash;
  hash.Add(survey->hash);
  for (const std::int64_t value :
       {std::int64_t(ViewshedVersion), cells.column, cells.row, std::int64_t(cells.columns),
        std::int64_t(cells.rows), std::int64_t(cells.every)}) {
    hash.Add(std::uint64_t(value));
  }
  for (const ViewshedOptions::Quantity quantity : options.quantities) {
    layout.bands.emplace_back(NameOf(quantity));
    hash.Add(layout.bands.back());
  }
  for (const ViewshedObserver& observer : options.observers) {
    for (const double value : {observer.post.x(), observer.post.y(), observer.height}) {
      hash.Add(value);
    }
  }
  hash.Add(options.targetHeight);
  hash.Add(options.radius);
  hash.Add(ground.name);
  layout.hash = hash.Get();
  layout.metadata["DSPACE_KIND"] = "viewshed";
  layout.metadata["DSPACE_VERSION"] = std::to_string(ViewshedVersion);
  layout.metadata["DSPACE_TERRAIN"] = ground.name;
  layout.metadata["DSPACE_TARGET_HEIGHT_M"] = NumberText(options.targetHeight);
  layout.metadata["DSPACE_RADIUS_M"] = NumberText(options.radius);
  layout.metadata["DSPACE_OBSERVERS"] = std::to_string(options.observers.size());
  TileFile file(path, layout, control.replace);
  using Q = ViewshedOptions::Quantity;
  const auto wants = [&](Q quantity) {
    return std::find(options.quantities.begin(), options.quantities.end(), quantity) !=
           options.quantities.end();
  };
  const bool wantsHeight = wants(Q::LeastHeight);
  const bool wantsAll = wantsHeight || wants(Q::Count); // observers, also after the first that sees
  const auto make = [&](int column, int row, std::vector<float>& values,
                        const std::atomic<bool>& stop) {
    std::vector<ViewshedEye::Memory> memories(eyes.size());
    for (int j = 0; j < std::min(TileFile::Side, cells.rows - row * TileFile::Side) && !stop; ++j) {
      for (int i = 0; i < std::min(TileFile::Side, cells.columns - column * TileFile::Side); ++i) {
        const Eigen::Vector2d to =
            cells.Post(column * TileFile::Side + i, row * TileFile::Side + j);
        double least = std::numeric_limits<double>::infinity();
        int seen = 0;
        bool near = false;
        for (std::size_t e = 0; e < eyes.size() && (wantsAll || seen == 0); ++e) {
          if (stop) {
            return;
          }
          if (wantsHeight) {
            const double height = eyes[e].Least(to, options.radius, memories[e]);
            near |= !std::isnan(height);
            least = height < least ? height : least;
            seen += height <= options.targetHeight;
          } else if (const auto sees =
                         eyes[e].Sees(to, options.radius, options.targetHeight, memories[e])) {
            near = true;
            seen += *sees;
          }
        }
        for (std::size_t b = 0; b < options.quantities.size(); ++b) {
          const Q quantity = options.quantities[b];
          const double value = !near                        ? NaN
                               : quantity == Q::Visible     ? double(seen > 0)
                               : quantity == Q::LeastHeight ? least
                                                            : double(seen);
          values[(b * TileFile::Side + std::size_t(j)) * TileFile::Side + std::size_t(i)] =
              float(value);
        }
      }
    }
    if (ground.pyramid->LatestChange() != before) {
      throw Error(Error::Kind::Io, ground.name,
                  "its ground changed while a map of it was computed; accepted: a terrain that "
                  "stays as it is until the map is done");
    }
  };
  return FillTiles(file, options.quantities.size(), control, make);
}

} // namespace dspace
