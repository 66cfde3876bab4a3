#include <dspace/tracks/TrackDraft.h>

#include <algorithm>
#include <cmath>

namespace dspace {
namespace {

constexpr double LongestLine = 1.0; // [m]
constexpr double Turn = 0.0087;     // [rad] of headings

bool OnLine(const KeptContact& from, const KeptContact& to, const KeptContact& c,
            double tolerance) {
  const Eigen::Vector2d a(from.x, from.y);
  const Eigen::Vector2d along = Eigen::Vector2d(to.x, to.y) - a;
  const Eigen::Vector2d offset = Eigen::Vector2d(c.x, c.y) - a;
  const double squared = along.squaredNorm();
  const double t = squared > 0.0 ? std::clamp(offset.dot(along) / squared, 0.0, 1.0) : 0.0;
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

} // namespace

void TrackDraft::Append(const TrackContact& given, bool exact, double tolerance, double scale) {
  std::vector<KeptContact>& line = this->contacts;
  KeptContact c{given.place.x(), given.place.y(), given.rolled, float(given.heading),
                float(given.sinkage)};
  if (line.empty()) {
    c.rolled = std::isnan(c.rolled) ? 0.0 : c.rolled;
    line.push_back(c);
    return;
  }
  const double moved = std::hypot(c.x - line.back().x, c.y - line.back().y);
  if (std::isnan(c.rolled)) {
    c.rolled = line.back().rolled + moved / scale;
  }
  if (exact) {
    this->skipped.clear();
    line.push_back(c);
    return;
  }
  const double still = 0.1 * tolerance;
  if (moved <= still && std::abs(c.rolled - line.back().rolled) <= still &&
      std::abs(c.sinkage - line.back().sinkage) <= still) {
    return; // it stands
  }
  if (line.size() >= 2 && this->skipped.size() < MaximumSkipped) {
    const KeptContact& from = line[line.size() - 2];
    const auto onLine = [&](const KeptContact& between) {
      return OnLine(from, c, between, tolerance);
    };
    if (std::hypot(c.x - from.x, c.y - from.y) <= LongestLine && onLine(line.back()) &&
        std::all_of(this->skipped.begin(), this->skipped.end(), onLine)) {
      this->skipped.push_back(line.back());
      line.back() = c;
      return;
    }
  }
  this->skipped.clear();
  line.push_back(c);
}

} // namespace dspace
