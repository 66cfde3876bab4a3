#include <dspace/trajectories/StateTable.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include <dspace/Checks.h>

namespace dspace {
namespace {

constexpr int HighestDegree = 31;

using Column = Eigen::Matrix<double, 3, HighestDegree + 1>; // a vector for each node

std::string CountText(std::size_t n) {
  return std::to_string(n);
}

} // namespace

std::size_t Interpolation::StatesNeeded() const {
  switch (this->kind) {
  case Kind::Linear:
    return 2;
  case Kind::Lagrange:
    return std::size_t(this->degree) + 1;
  default:
    return (std::size_t(this->degree) + 1) / 2;
  }
}

StateTable::StateTable(std::string name, Content content)
    : Name_(std::move(name)), Content_(std::move(content)) {
  const Content& c = this->Content_;
  const std::size_t n = c.times.size();
  if (c.positions.size() != n || (!c.velocities.empty() && c.velocities.size() != n)) {
    Reject(this->Name_, "it has " + CountText(n) + " times, " + CountText(c.positions.size()) +
                            " positions and " + CountText(c.velocities.size()) +
                            " velocities; accepted: as many of each, or no velocities");
  }
  const Interpolation& by = c.interpolation;
  Require(by.degree >= 1 && by.degree <= HighestDegree, this->Name_, "the degree of interpolation",
          by.degree, "1 to 31");
  if (n < by.StatesNeeded()) {
    Reject(this->Name_,
           "it has " + CountText(n) + " states; accepted for an interpolation of degree " +
               std::to_string(by.degree) + ": " + CountText(by.StatesNeeded()) + " and more");
  }
  if (by.kind == Interpolation::Kind::Hermite) {
    Require(by.degree % 2 == 1, this->Name_, "the degree of Hermite's interpolation", by.degree,
            "odd numbers, since each state gives a position and a velocity");
    if (c.velocities.empty()) {
      Reject(this->Name_, "it has no velocities; accepted for Hermite's interpolation: states with "
                          "velocities");
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    RequireFinite(this->Name_, "a time", c.times[i]);
    RequirePosition(this->Name_, "a position", c.positions[i]);
    if (!c.velocities.empty()) {
      RequireFinite(this->Name_, "a velocity", c.velocities[i]);
    }
    if (i > 0 && c.times[i] <= c.times[i - 1]) {
      char text[160];
      std::snprintf(text, sizeof(text),
                    "state %zu has the time %.6f s, the one before it %.6f s; accepted: ascending "
                    "times",
                    i + 1, c.times[i], c.times[i - 1]);
      Reject(this->Name_, text);
    }
  }
  this->Span_ = {std::max(c.times.front(), c.useable.begin),
                 std::min(c.times.back(), c.useable.end)};
  if (!(this->Span_.begin <= this->Span_.end)) {
    Reject(this->Name_,
           "no state lies in its useable span; accepted: a span that reaches into that "
           "of the states");
  }
}

State StateTable::At(double time_s) const {
  RequireInSpan(this->Name_, time_s, this->Span_);
  switch (this->Content_.interpolation.kind) {
  case Interpolation::Kind::Linear:
    return this->Linear(time_s);
  case Interpolation::Kind::Lagrange:
    return this->Lagrange(time_s);
  default:
    return this->Hermite(time_s);
  }
}

// Of an even number of nodes as many lie before the time as after it; of an odd number the nearest
// is in the middle.
std::size_t StateTable::FirstFor(double time_s, std::size_t count) const {
  const std::vector<double>& times = this->Content_.times;
  const auto after = std::upper_bound(times.begin(), times.end(), time_s);
  std::ptrdiff_t before = std::max<std::ptrdiff_t>(0, after - times.begin() - 1);
  const auto last = std::ptrdiff_t(times.size()) - 1;
  if (count % 2 == 1 && before < last &&
      times[std::size_t(before) + 1] - time_s < time_s - times[std::size_t(before)]) {
    ++before;
  }
  const std::ptrdiff_t first = before - std::ptrdiff_t(count - 1) / 2;
  return std::size_t(std::clamp<std::ptrdiff_t>(first, 0, last + 1 - std::ptrdiff_t(count)));
}

State StateTable::Linear(double time_s) const {
  const Content& c = this->Content_;
  const std::size_t i = this->FirstFor(time_s, 2);
  const double step = c.times[i + 1] - c.times[i];
  const double share = (time_s - c.times[i]) / step;
  const Eigen::Vector3d between = c.positions[i + 1] - c.positions[i];
  State state;
  state.position = share == 1.0 ? c.positions[i + 1] : c.positions[i] + share * between;
  state.velocity = c.velocities.empty()
                       ? Eigen::Vector3d(between / step)
                       : c.velocities[i] + share * (c.velocities[i + 1] - c.velocities[i]);
  return state;
}

// Neville's scheme, with the derivatives of its polynomials beside them.
State StateTable::Lagrange(double time_s) const {
  const Content& c = this->Content_;
  const std::size_t n = c.interpolation.StatesNeeded();
  const std::size_t first = this->FirstFor(time_s, n);
  Column p;
  Column d = Column::Zero();
  Column v;
  const bool velocities = !c.velocities.empty();
  for (std::size_t i = 0; i < n; ++i) {
    p.col(Eigen::Index(i)) = c.positions[first + i];
    if (velocities) {
      v.col(Eigen::Index(i)) = c.velocities[first + i];
    }
  }
  for (std::size_t order = 1; order < n; ++order) {
    for (std::size_t i = 0; i + order < n; ++i) {
      const double step = c.times[first + i + order] - c.times[first + i];
      const double left = (c.times[first + i + order] - time_s) / step;
      const double right = (time_s - c.times[first + i]) / step;
      const auto k = Eigen::Index(i);
      d.col(k) = left * d.col(k) + right * d.col(k + 1) + (p.col(k + 1) - p.col(k)) / step;
      p.col(k) = left * p.col(k) + right * p.col(k + 1);
      if (velocities) {
        v.col(k) = left * v.col(k) + right * v.col(k + 1);
      }
    }
  }
  State state;
  state.position = p.col(0);
  state.velocity = velocities ? v.col(0) : d.col(0);
  return state;
}

// Newton's form on each node twice. Times are divided by their spread, so that differences of high
// order keep their size.
State StateTable::Hermite(double time_s) const {
  const Content& c = this->Content_;
  const std::size_t nodes = c.interpolation.StatesNeeded();
  const std::size_t first = this->FirstFor(time_s, nodes);
  const auto exact = std::lower_bound(c.times.begin(), c.times.end(), time_s);
  if (exact != c.times.end() && *exact == time_s) {
    const auto i = std::size_t(exact - c.times.begin());
    return {c.positions[i], c.velocities[i]};
  }
  const std::size_t n = 2 * nodes;
  const double origin = c.times[first];
  const double scale = nodes > 1 ? c.times[first + nodes - 1] - origin : 1.0;
  std::array<double, HighestDegree + 1> x;
  Column f;
  const Eigen::Vector3d base = c.positions[first];
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = (c.times[first + i / 2] - origin) / scale;
    f.col(Eigen::Index(i)) = c.positions[first + i / 2] - base;
  }
  for (std::size_t order = 1; order < n; ++order) {
    for (std::size_t i = n - 1; i >= order; --i) {
      const auto k = Eigen::Index(i);
      if (order == 1 && i % 2 == 1) {
        f.col(k) = c.velocities[first + i / 2] * scale;
      } else {
        f.col(k) = (f.col(k) - f.col(k - 1)) / (x[i] - x[i - order]);
      }
    }
  }
  const double at = (time_s - origin) / scale;
  Eigen::Vector3d p = f.col(Eigen::Index(n) - 1);
  Eigen::Vector3d d = Eigen::Vector3d::Zero();
  for (std::size_t i = n - 1; i-- > 0;) {
    d = d * (at - x[i]) + p;
    p = p * (at - x[i]) + f.col(Eigen::Index(i));
  }
  return {base + p, d / scale};
}

JoinedTables::JoinedTables(std::string name, std::vector<std::shared_ptr<const StateTable>> tables)
    : Name_(std::move(name)), Tables_(std::move(tables)) {
  if (this->Tables_.empty()) {
    Reject(this->Name_, "it has no table of states; accepted: one and more");
  }
  std::sort(this->Tables_.begin(), this->Tables_.end(),
            [](const auto& a, const auto& b) { return a->Span().begin < b->Span().begin; });
  for (std::size_t i = 1; i < this->Tables_.size(); ++i) {
    const TimeSpan before = this->Tables_[i - 1]->Span();
    const TimeSpan next = this->Tables_[i]->Span();
    if (next.begin < before.end) {
      char text[240];
      std::snprintf(
          text, sizeof(text),
          "two of its blocks overlap: one is useable to %.3f s, the next from %.3f s past "
          "J2000; accepted: blocks that share at most a point",
          before.end, next.begin);
      Reject(this->Name_, text);
    }
  }
}

TimeSpan JoinedTables::Span() const {
  return {this->Tables_.front()->Span().begin, this->Tables_.back()->Span().end};
}

std::vector<TimeSpan> JoinedTables::Parts() const {
  std::vector<TimeSpan> parts;
  for (const auto& table : this->Tables_) {
    parts.push_back(table->Span());
  }
  return parts;
}

State JoinedTables::At(double time_s) const {
  RequireInSpan(this->Name_, time_s, this->Span());
  auto next = std::upper_bound(this->Tables_.begin(), this->Tables_.end(), time_s,
                               [](double t, const auto& table) { return t < table->Span().begin; });
  const StateTable& table = **std::prev(next);
  if (time_s > table.Span().end) {
    char text[200];
    std::snprintf(text, sizeof(text),
                  "the time is %.3f s, in a gap; accepted: to %.3f s, and from %.3f s past J2000",
                  time_s, table.Span().end, (*next)->Span().begin);
    Reject(this->Name_, text);
  }
  return table.At(time_s);
}

} // namespace dspace
