// Which contacts of a wheel are accepted, and which are kept.
#include <dspace/tracks/WheelTracks.h>

#include <algorithm>
#include <cmath>

#include <dspace/Error.h>

namespace dspace {
namespace {

constexpr double LongestLine = 1.0; // [m]
constexpr double Turn = 0.0087;     // [rad] of headings
constexpr double FarthestContact = 1e9;    // [m]

} // namespace

void WheelTracks::Check(const TrackStroke& stroke) const {
  const std::string track = "track '" + stroke.name + "' on " + this->Name_;
  const auto require = [&track](bool holds, const std::string& what, double value,
                                const std::string& accepted) {
    if (!holds) {
      throw Error(Error::Kind::InvalidArgument, track,
                  what + " is " + std::to_string(value) + "; accepted: " + accepted);
    }
  };
  const TrackProfile& p = stroke.profile;
  const auto within = [](double v, double most) { return v >= 0.0 && v <= most; };
  require(p.width > 0.0 && p.width <= 10.0, "its width", p.width, "more than 0, at most 10 m");
  require(within(p.wall, 2.0), "the width of its walls", p.wall, "0 to 2 m");
  require(within(p.rimWidth, 2.0), "the width of its rims", p.rimWidth, "0 to 2 m");
  require(within(p.rimHeight, p.MostRim), "the height of its rims", p.rimHeight, "0 to 0.5 m");
  require(within(p.treadDepth, p.MostTread), "its tread's depth", p.treadDepth, "0 to 0.25 m");
  require(p.treadPitch == 0.0 || (p.treadPitch >= 1e-3 && p.treadPitch <= 100.0),
          "its tread's pitch", p.treadPitch, "0 (none) or 0.001 to 100 m");
  const auto check = [&](const TrackContact& c) {
    for (const double value : c.place) {
      require(std::abs(value) <= FarthestContact, "a coordinate of a contact", value,
              "finite numbers up to 1e9 m");
    }
    require(within(c.sinkage, p.MostSinkage), "the sinkage of a contact", c.sinkage, "0 to 1 m");
    require(!std::isinf(c.heading), "the heading of a contact", c.heading, "a finite number");
    require(std::isnan(c.rolled) || std::abs(c.rolled) <= FarthestContact, "the distance rolled", c.rolled,
            "finite numbers up to 1e9 m");
  };
  std::for_each(stroke.contacts.begin(), stroke.contacts.end(), check);
  std::for_each(stroke.skipped.begin(), stroke.skipped.end(), check);
}

WheelTracks::Draft WheelTracks::Begin(const TrackAddition& addition) const {
  Draft draft;
  draft.name = addition.name;
  draft.profile = addition.profile;
  draft.stroke = this->Strokes_.size();
  const auto latest = this->Latest_.find(addition.name);
  if (addition.begin || latest == this->Latest_.end()) {
    return draft;
  }
  const Stroke& stroke = this->Strokes_[latest->second];
  if (!(stroke.profile == addition.profile)) {
    draft.contacts = {stroke.contacts.back()};
    return draft;
  }
  draft.stroke = latest->second;
  draft.kept = stroke.contacts.size() - std::min<std::size_t>(stroke.contacts.size(), 2);
  draft.contacts.assign(stroke.contacts.begin() + std::ptrdiff_t(draft.kept),
                        stroke.contacts.end());
  draft.skipped = stroke.skipped;
  return draft;
}

bool WheelTracks::OnLine(const Contact& from, const Contact& to, const Contact& c) const {
  const Eigen::Vector2d a(from.x, from.y);
  const Eigen::Vector2d along = Eigen::Vector2d(to.x, to.y) - a;
  const Eigen::Vector2d offset = Eigen::Vector2d(c.x, c.y) - a;
  const double squared = along.squaredNorm();
  const double t = squared > 0.0 ? std::clamp(offset.dot(along) / squared, 0.0, 1.0) : 0.0;
  const double tolerance = this->Options_.tolerance;
  const auto departs = [t](double x, double y, double z) { return std::abs(x + t * (y - x) - z); };
  if ((offset - t * along).norm() > tolerance ||
      departs(from.sinkage, to.sinkage, c.sinkage) > tolerance ||
      departs(from.rolled, to.rolled, c.rolled) > tolerance) {
    return false;
  }
  if (std::isnan(from.heading) || std::isnan(to.heading) || std::isnan(c.heading)) {
    return std::isnan(from.heading) && std::isnan(to.heading) && std::isnan(c.heading);
  }
  return std::abs(std::remainder(double(from.heading) - c.heading, 2.0 * M_PI)) <= Turn &&
         std::abs(std::remainder(double(to.heading) - c.heading, 2.0 * M_PI)) <= Turn;
}

void WheelTracks::Append(Draft& draft, const TrackContact& given, bool exact) const {
  std::vector<Contact>& kept = draft.contacts;
  Contact c{given.place.x(), given.place.y(), given.rolled, float(given.heading),
            float(given.sinkage)};
  if (kept.empty()) {
    c.rolled = std::isnan(c.rolled) ? 0.0 : c.rolled;
    kept.push_back(c);
    return;
  }
  const double moved = std::hypot(c.x - kept.back().x, c.y - kept.back().y);
  if (std::isnan(c.rolled)) {
    c.rolled = kept.back().rolled + moved;
  }
  if (exact) {
    draft.skipped.clear();
    kept.push_back(c);
    return;
  }
  const double still = 0.1 * this->Options_.tolerance;
  if (moved <= still && std::abs(c.rolled - kept.back().rolled) <= still &&
      std::abs(c.sinkage - kept.back().sinkage) <= still) {
    return; // it stands
  }
  if (kept.size() >= 2 && draft.skipped.size() < MostSkipped) {
    const Contact& from = kept[kept.size() - 2];
    const auto onLine = [&](const Contact& between) { return this->OnLine(from, c, between); };
    if (std::hypot(c.x - from.x, c.y - from.y) <= LongestLine && onLine(kept.back()) &&
        std::all_of(draft.skipped.begin(), draft.skipped.end(), onLine)) {
      draft.skipped.push_back(kept.back());
      kept.back() = c;
      return;
    }
  }
  draft.skipped.clear();
  kept.push_back(c);
}

} // namespace dspace
