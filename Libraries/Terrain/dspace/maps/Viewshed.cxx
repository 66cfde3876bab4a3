#include <dspace/maps/Viewshed.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <dspace/Checks.h>
#include <dspace/horizon/EdgeCrossings.h>
#include <dspace/horizon/HeldPosts.h>
#include <dspace/horizon/HorizonPath.h>

namespace dspace {
namespace {

constexpr int ViewshedVersion = 1;
constexpr std::int64_t MostViewedPosts = std::int64_t(1) << 28; // posts, 1 GB
constexpr double MostViewHeight = 1e6;                          // [m]
constexpr double Snap = 1e-9;    // of an edge: a place on a post needs no other one
constexpr double Stretch = 32.0; // posts that are looked over at once
constexpr double Touch = 1e-6;   // posts: ground so near an end is no obstacle

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

// A level place at an observer, from which heights of the ground are seen.
class Eye {
public:
  Eye(const MapGround& ground, const HeldPosts& held, const ViewshedObserver& observer)
      : Ground_(ground), Held_(held), Post_(observer.post) {
    const double c = std::floor(this->Post_.x());
    const double r = std::floor(this->Post_.y());
    const double u = this->Post_.x() - c;
    const double v = this->Post_.y() - r;
    const auto at = [&](int right, int down, double share) {
      return share == 0.0 ? 0.0
                          : share * this->HeightAt(std::int64_t(c) + right, std::int64_t(r) + down);
    };
    const bool below = v > u;
    this->Floor_ = at(0, 0, 1.0 - std::max(u, v)) + at(1, 1, std::min(u, v)) +
                   (below ? at(0, 1, v - u) : at(1, 0, u - v));
    this->Height_ = this->Floor_ + observer.height;
  }

  bool HasGround() const { return !std::isnan(this->Floor_); }

  // As LeastSeenHeight(); NaN beyond the radius.
  double Least(const Eigen::Vector2d& to, double radius) const {
    const double height = this->HeightAt(std::llround(to.x()), std::llround(to.y()));
    if (std::isnan(height) || !this->HasGround()) {
      return NaN;
    }
    return this->Ground_.placement.OnBody() ? this->LeastOnBody(to, height, radius)
                                            : this->LeastOnPlane(to, height, radius);
  }

private:
  double HeightAt(std::int64_t c, std::int64_t r) const {
    const PostLattice& lattice = this->Ground_.pyramid->Lattice();
    if (r < 0 || r >= lattice.rows || (!lattice.periodic && (c < 0 || c >= lattice.columns))) {
      return NaN;
    }
    return this->Held_.Heights()[this->Held_.At(lattice.Wrapped(0, c), r)];
  }

  // On an edge; NaN without data.
  double HeightOn(std::int64_t c, std::int64_t r, int right, int down, double share) const {
    if (share < Snap) {
      return this->HeightAt(c, r);
    }
    const double second = this->HeightAt(c + right, r + down);
    if (share > 1.0 - Snap) {
      return second;
    }
    const double first = this->HeightAt(c, r);
    return first + share * (second - first);
  }

  // Bounds of the heights of the ground about a line between two places.
  HeightSpan SpanOf(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    constexpr int Margin = 4; // posts
    const Eigen::Vector2d low = a.cwiseMin(b);
    const Eigen::Vector2d high = a.cwiseMax(b);
    PostBlock box;
    box.column = std::int64_t(std::floor(low.x())) - Margin;
    box.row = std::int64_t(std::floor(low.y())) - Margin;
    box.width = int(std::int64_t(std::floor(high.x())) + Margin + 2 - box.column);
    box.height = int(std::int64_t(std::floor(high.y())) + Margin + 2 - box.row);
    return this->Held_.SpanOf(box);
  }

  // Whether no ground between two places of a great circle over a body rises above a tangent. About
  // a pole of a degree grid the places between may lie outside the box of a straight line.
  bool IsBelow(const HorizonPath::Point& a, const HorizonPath::Point& b, double tangent) const {
    const PostPlacement& placement = this->Ground_.placement;
    constexpr double Polar = 80.0 * M_PI / 180.0;
    if (placement.GetKind() == PostPlacement::Kind::Sphere &&
        std::max(std::abs(placement.Angles(a.post).y()), std::abs(placement.Angles(b.post).y())) >
            Polar) {
      return false;
    }
    const PostLattice& lattice = this->Ground_.pyramid->Lattice();
    if (lattice.periodic && (std::min(a.post.x(), b.post.x()) < -0.4 * double(lattice.columns) ||
                             std::max(a.post.x(), b.post.x()) > 1.4 * double(lattice.columns))) {
      return false;
    }
    const HeightSpan span = this->SpanOf(a.post, b.post);
    if (!(span.least <= span.greatest)) {
      return true; // no data
    }
    const double high = span.greatest;
    const double top = a.fall + std::max(a.rise * high, b.rise * high) - this->Height_;
    const double least = a.away + std::min({a.spread * span.least, b.spread * span.least, 0.0});
    const double most = b.away + std::max(b.spread * high, 0.0);
    return least > 0.0 && (top > 0.0 ? top / least : top / most) <= tangent - 1e-12;
  }

  double LeastOnPlane(const Eigen::Vector2d& to, double height, double radius) const {
    const Eigen::Vector2d way = to - this->Post_;
    const double length = (this->Ground_.placement.PostToScene().linear() * way).norm();
    const double posts = way.norm();
    if (length > radius) {
      return NaN;
    }
    double steepest = -std::numeric_limits<double>::infinity(); // times the length
    const double first = Touch / std::max(posts, Touch);
    for (double from = 0.0; from < 1.0;) {
      const double till = posts > Stretch ? std::min(from + Stretch / posts, 1.0) : 1.0;
      const Eigen::Vector2d a = this->Post_ + from * way;
      const Eigen::Vector2d b = till < 1.0 ? Eigen::Vector2d(this->Post_ + till * way) : to;
      const double highest = from > 0.0 ? this->SpanOf(a, b).greatest - this->Height_ : 0.0;
      if (from == 0.0 || (highest > 0.0 ? highest / from : highest / till) > steepest) {
        ForEachCrossing(
            a.x(), a.y(), b.x(), b.y(),
            [&](double t, std::int64_t c, std::int64_t r, int right, int down, double share) {
              const double at = from + t * (till - from);
              if (at > first && at < 1.0 - first) {
                const double rise = (this->HeightOn(c, r, right, down, share) - this->Height_) / at;
                steepest = rise > steepest ? rise : steepest;
              }
            });
      }
      from = till;
    }
    return std::max(0.0, this->Height_ + steepest - height);
  }

  double LeastOnBody(const Eigen::Vector2d& to, double height, double radius) const {
    const PostPlacement& placement = this->Ground_.placement;
    const Eigen::Vector3d from_S = placement.ToScene(this->Post_, 0.0);
    const Eigen::Vector3d to_S = placement.ToScene(to, 0.0);
    const Eigen::Vector3d up = placement.Up(from_S);
    const Eigen::Vector3d other = placement.Up(to_S);
    const double angle = std::atan2(up.cross(other).norm(), up.dot(other));
    const double length = angle * placement.Radius();
    if (length > radius) {
      return NaN;
    }
    if (angle > 0.5 * M_PI) {
      return std::numeric_limits<double>::infinity();
    }
    const double post = placement.CellSize(this->Post_);
    if (length < Touch * post) {
      return 0.0;
    }
    const ChartDirection direction = ChartDirectionAt(placement, this->Post_, to_S - from_S);
    const HorizonPath path(placement, this->Post_, direction.azimuth_deg);
    double steepest = -std::numeric_limits<double>::infinity();
    const double first = Touch * post;
    HorizonPath::Point a = path.At(0.0);
    for (double s = 0.0; s < length;) {
      // Ground that cannot be higher than what is found is not followed.
      const double far = std::min(s + Stretch * post, length);
      const HorizonPath::Point end = path.At(far);
      if (s > 0.0 && this->IsBelow(a, end, steepest)) {
        s = far;
        a = end;
        continue;
      }
      while (s < far) {
        double next = s + path.FineStep(a, s, post);
        next = next > far - 0.005 * post ? far : next;
        const HorizonPath::Point b = next == far ? end : path.At(next);
        // Linear between them but for the fall, which bends as the sphere does.
        const double bend = 0.5 * (next - s) * (next - s) / placement.Radius();
        const auto mix = [](double from, double till, double t) {
          return from + t * (till - from);
        };
        ForEachCrossing(
            a.post.x(), a.post.y(), b.post.x(), b.post.y(),
            [&](double t, std::int64_t c, std::int64_t r, int right, int down, double share) {
              const double at = s + t * (next - s);
              if (at > first && at < length - first) {
                const double h = this->HeightOn(c, r, right, down, share);
                const double tangent = (mix(a.fall, b.fall, t) + bend * t * (1.0 - t) +
                                        mix(a.rise, b.rise, t) * h - this->Height_) /
                                       (mix(a.away, b.away, t) + mix(a.spread, b.spread, t) * h);
                steepest = tangent > steepest ? tangent : steepest;
              }
            });
        s = next;
        a = b;
      }
    }
    if (!std::isfinite(steepest)) {
      return 0.0; // nothing is between them
    }
    const double rise = a.rise - steepest * a.spread;
    return rise > 0.0 ? std::max(0.0, (steepest * a.away - a.fall + this->Height_) / rise - height)
                      : std::numeric_limits<double>::infinity();
  }

  const MapGround& Ground_;
  const HeldPosts& Held_;
  Eigen::Vector2d Post_;
  double Floor_ = 0.0;
  double Height_ = 0.0;
};

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
  return Eye(ground, held, observer).Least(to, std::numeric_limits<double>::infinity());
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
  std::vector<Eye> eyes;
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
  const auto make = [&](int column, int row, std::vector<float>& values,
                        const std::atomic<bool>& stop) {
    for (int j = 0; j < std::min(TileFile::Side, cells.rows - row * TileFile::Side) && !stop; ++j) {
      for (int i = 0; i < std::min(TileFile::Side, cells.columns - column * TileFile::Side); ++i) {
        const Eigen::Vector2d to =
            cells.Post(column * TileFile::Side + i, row * TileFile::Side + j);
        double least = std::numeric_limits<double>::infinity();
        int seen = 0;
        bool near = false;
        for (const Eye& eye : eyes) {
          if (stop) {
            return;
          }
          const double height = eye.Least(to, options.radius);
          near |= !std::isnan(height);
          least = height < least ? height : least;
          seen += height <= options.targetHeight;
        }
        for (std::size_t b = 0; b < options.quantities.size(); ++b) {
          using Q = ViewshedOptions::Quantity;
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
