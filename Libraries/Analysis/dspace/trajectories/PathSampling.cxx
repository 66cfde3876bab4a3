#include <dspace/trajectories/PathSampling.h>

#include <algorithm>
#include <cmath>
#include <queue>

#include <dspace/Checks.h>

namespace dspace {
namespace {

constexpr std::size_t FirstChords = 64; // before any is compared with the path

struct Chord {
  double begin, end;
  Eigen::Vector3d from, to;
  double error; // [m]
  double bend;  // as PathSampling::flatness
  bool operator<(const Chord& other) const { return this->bend < other.bend; }
};

double DistanceFrom(const Eigen::Vector3d& p, const Eigen::Vector3d& from,
                    const Eigen::Vector3d& to) {
  const Eigen::Vector3d along = to - from;
  const double length = along.squaredNorm();
  const double share = length > 0.0 ? std::clamp((p - from).dot(along) / length, 0.0, 1.0) : 0.0;
  return (p - from - share * along).norm();
}

Chord Compare(const Trajectory& path, double begin, double end, const Eigen::Vector3d& from,
              const Eigen::Vector3d& to) {
  Chord chord{begin, end, from, to, 0.0, 0.0};
  for (const double share : {0.5, 0.25}) {
    const Eigen::Vector3d p = path.At(begin + share * (end - begin)).position;
    chord.error = std::max(chord.error, DistanceFrom(p, from, to));
  }
  const double length = (to - from).norm();
  chord.bend = length > 0.0 ? chord.error / length : (chord.error > 0.0 ? HUGE_VAL : 0.0);
  return chord;
}

} // namespace

std::vector<double> SampleTimes(const Trajectory& trajectory, const TimeSpan& span,
                                const PathSampling& by, const std::string& object) {
  Require(by.flatness >= 1e-6 && by.flatness <= 0.5, object, "the flatness of the path",
          by.flatness, "1e-6 to 0.5");
  Require(by.most >= 3 && by.most <= 10000000, object, "the greatest number of points",
          double(by.most), "3 to 10000000");
  RequireFinite(object, "the begin of its path", span.begin);
  RequireFinite(object, "the end of its path", span.end);
  Require(span.end > span.begin, object, "the duration of its path", span.end - span.begin,
          "more than 0 s");
  const std::size_t chords = std::min(FirstChords, by.most - 1);
  std::vector<double> times;
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i <= chords; ++i) {
    times.push_back(
        i == chords ? span.end : span.begin + (span.end - span.begin) * double(i) / double(chords));
    points.push_back(trajectory.At(times.back()).position);
  }
  std::priority_queue<Chord> open;
  for (std::size_t i = 0; i < chords; ++i) {
    open.push(Compare(trajectory, times[i], times[i + 1], points[i], points[i + 1]));
  }
  while (times.size() < by.most && !open.empty() && open.top().bend > by.flatness) {
    const Chord worst = open.top();
    open.pop();
    const double middle = 0.5 * (worst.begin + worst.end);
    if (!(middle > worst.begin && middle < worst.end)) {
      continue; // as near as doubles are
    }
    const Eigen::Vector3d p = trajectory.At(middle).position;
    times.push_back(middle);
    open.push(Compare(trajectory, worst.begin, middle, worst.from, p));
    open.push(Compare(trajectory, middle, worst.end, p, worst.to));
  }
  std::sort(times.begin(), times.end());
  return times;
}

} // namespace dspace
