#include <dspace/tracks/TrackStroke.h>

#include <algorithm>
#include <cmath>

#include <dspace/Error.h>

namespace dspace {
namespace {

constexpr double FarthestContact = 1e9; // [m]

} // namespace

void CheckStroke(const TrackStroke& stroke, const std::string& on) {
  const std::string track = "track '" + stroke.name + "' on " + on;
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
  require(within(p.rimHeight, p.MaximumRim), "the height of its rims", p.rimHeight, "0 to 0.5 m");
  require(within(p.treadDepth, p.MaximumTread), "its tread's depth", p.treadDepth, "0 to 0.25 m");
  require(p.treadPitch == 0.0 || (p.treadPitch >= 1e-3 && p.treadPitch <= 100.0),
          "its tread's pitch", p.treadPitch, "0 (none) or 0.001 to 100 m");
  const auto check = [&](const TrackContact& c) {
    for (const double value : c.place) {
      require(std::abs(value) <= FarthestContact, "a coordinate of a contact", value,
              "finite numbers up to 1e9 m");
    }
    require(within(c.sinkage, p.MaximumSinkage), "the sinkage of a contact", c.sinkage, "0 to 1 m");
    require(!std::isinf(c.heading), "the heading of a contact", c.heading, "a finite number");
    require(std::isnan(c.rolled) || std::abs(c.rolled) <= FarthestContact, "the distance rolled",
            c.rolled, "finite numbers up to 1e9 m");
  };
  std::for_each(stroke.contacts.begin(), stroke.contacts.end(), check);
  std::for_each(stroke.skipped.begin(), stroke.skipped.end(), check);
}

} // namespace dspace
