#include <dspace/scene/trajectories/TrajectoryLine.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include <dspace/Checks.h>

namespace dspace {
namespace {

constexpr int Finest = 24; // halvings of a chord towards the scene's time

bool IsFinite(double value) {
  return std::isfinite(value);
}

} // namespace

TrajectoryLine::TrajectoryLine(const std::string& object, std::vector<Strip> strips,
                               std::vector<Tick> ticks, Path path)
    : Strips_(std::move(strips)), Ticks_(std::move(ticks)), Path_(std::move(path)) {
  Check(object, this->Strips_);
  for (std::size_t i = 0; i < this->Ticks_.size(); ++i) {
    RequirePosition(object, "a tick", this->Ticks_[i].point);
    if (i > 0 && !(this->Ticks_[i].time > this->Ticks_[i - 1].time)) {
      Reject(object, "its ticks do not ascend; accepted: ascending times");
    }
  }
  this->FindBounds();
  this->FindDetail();
}

void TrajectoryLine::Check(const std::string& object, const std::vector<Strip>& strips) {
  if (strips.empty()) {
    Reject(object, "it has no points; accepted: two and more");
  }
  double before = -std::numeric_limits<double>::infinity();
  for (const Strip& strip : strips) {
    const std::size_t n = strip.points.size();
    if (n < 2 || strip.times.size() != n || (!strip.colors.empty() && strip.colors.size() != n)) {
      Reject(object, "a part of it has " + std::to_string(n) + " points, " +
                         std::to_string(strip.times.size()) + " times and " +
                         std::to_string(strip.colors.size()) +
                         " colours; accepted: as many of each, two and more, or no colours");
    }
    for (std::size_t i = 0; i < n; ++i) {
      RequireFinite(object, "a time", strip.times[i]);
      RequirePosition(object, "a point", strip.points[i]);
      // A strip may begin when the one before it ends.
      if (i > 0 ? strip.times[i] <= before : strip.times[i] < before) {
        Reject(object, "a point has the time " + NumberText(strip.times[i]) + " s after one of " +
                           NumberText(before) + " s; accepted: ascending times");
      }
      before = strip.times[i];
    }
  }
}

void TrajectoryLine::FindBounds() {
  Eigen::AlignedBox3d box;
  this->TranslucentColors_ = false;
  for (const Strip& strip : this->Strips_) {
    this->TranslucentColors_ |= std::any_of(strip.colors.begin(), strip.colors.end(),
                                            [](const Color& color) { return color[3] < 255; });
    for (const Eigen::Vector3d& p : strip.points) {
      box.extend(p);
    }
  }
  this->Bounds_.center = box.center();
  this->Bounds_.radius = 0.505 * box.diagonal().norm(); // curves reach beyond their chords
}

void TrajectoryLine::SetStrips(const std::string& object, std::vector<Strip> strips) {
  Check(object, strips);
  this->Strips_ = std::move(strips);
  this->FindBounds();
  this->FindDetail();
  ++this->PointsRevision_;
  ++this->Revision_;
}

void TrajectoryLine::SetLook(const std::string& object, const TrajectoryLook& look) {
  for (const double c : look.color) {
    RequireFraction(object, "the colour", c);
  }
  RequireFraction(object, "the opacity", look.opacity);
  RequireFraction(object, "the opacity ahead", look.ahead);
  Require(look.before >= 0.0, object, "the time before", look.before, "0 s and more");
  Require(look.after >= 0.0, object, "the time after", look.after, "0 s and more");
  Require(look.tickSize >= 0.0 && look.tickSize <= 64.0, object, "the size of ticks", look.tickSize,
          "0 to 64 pixels");
  Require(look.fontSize >= 6 && look.fontSize <= 64, object, "the font size", look.fontSize,
          "6 to 64 pixels");
  this->Look_ = look;
  ++this->Revision_;
}

bool TrajectoryLine::IsTranslucent() const {
  return this->TranslucentColors_ || this->Look_.opacity < 1.0 || this->Look_.fade ||
         this->Look_.ahead < 1.0;
}

bool TrajectoryLine::FollowsTime() const {
  return this->Look_.fade || this->Look_.ahead != 1.0 || IsFinite(this->Look_.before) ||
         IsFinite(this->Look_.after);
}

std::array<double, 2> TrajectoryLine::FadeLengths() const {
  const double first = this->Strips_.front().times.front();
  const double last = this->Strips_.back().times.back();
  return {IsFinite(this->Look_.before) ? this->Look_.before : std::max(0.0, this->Time_ - first),
          IsFinite(this->Look_.after) ? this->Look_.after : std::max(0.0, last - this->Time_)};
}

void TrajectoryLine::SetTime(double time_s) {
  if (time_s == this->Time_) {
    return;
  }
  this->Time_ = time_s;
  const bool had = !this->Detail_.points.points.empty();
  this->FindDetail();
  if (had || !this->Detail_.points.points.empty() || this->FollowsTime()) {
    ++this->Revision_;
  }
}

void TrajectoryLine::FindDetail() {
  this->Detail_ = {};
  if (!this->Path_) {
    return;
  }
  const double now = this->Time_;
  for (std::size_t s = 0; s < this->Strips_.size(); ++s) {
    const Strip& strip = this->Strips_[s];
    const std::size_t n = strip.times.size();
    if (now < strip.times.front() || now > strip.times.back()) {
      continue;
    }
    const auto next = std::upper_bound(strip.times.begin(), strip.times.end(), now);
    const std::size_t at =
        std::min(n - 2, std::size_t(std::max<std::ptrdiff_t>(0, next - strip.times.begin() - 1)));
    Detail found; // put in its place when `path` has given all
    found.strip = s;
    found.first = at > 0 ? at - 1 : 0; // the neighbours too: near `now` may be near an end
    found.last = std::min(n - 1, at + 2);
    const double begin = strip.times[found.first];
    const double end = strip.times[found.last];
    std::vector<double> times;
    for (int k = 0; k <= Finest; ++k) {
      times.push_back(now + (begin - now) * std::ldexp(1.0, -k));
    }
    times.push_back(now);
    for (int k = Finest; k >= 0; --k) {
      times.push_back(now + (end - now) * std::ldexp(1.0, -k));
    }
    times.erase(std::unique(times.begin(), times.end()), times.end());
    Strip& detail = found.points;
    for (const double t : times) {
      if (!detail.times.empty() && !(t > detail.times.back())) {
        continue;
      }
      // Between which points of the strip: their ends stay, and colours change between them.
      const auto after = std::upper_bound(strip.times.begin(), strip.times.end(), t);
      const std::size_t i = std::min(
          n - 2, std::size_t(std::max<std::ptrdiff_t>(0, after - strip.times.begin() - 1)));
      const double share =
          std::clamp((t - strip.times[i]) / (strip.times[i + 1] - strip.times[i]), 0.0, 1.0);
      const bool own = share == 0.0 || share == 1.0;
      const Eigen::Vector3d p = own ? strip.points[share == 0.0 ? i : i + 1] : this->Path_(t);
      detail.times.push_back(t);
      detail.points.push_back(p);
      if (!strip.colors.empty()) {
        Color color;
        for (std::size_t c = 0; c < 4; ++c) {
          color[c] = std::uint8_t(
              std::lround(double(strip.colors[i][c]) +
                          share * (double(strip.colors[i + 1][c]) - double(strip.colors[i][c]))));
        }
        detail.colors.push_back(color);
      }
    }
    this->Detail_ = std::move(found);
    return;
  }
}

} // namespace dspace
