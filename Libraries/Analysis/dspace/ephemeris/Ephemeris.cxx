#include <dspace/ephemeris/Ephemeris.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>

#include <Eigen/Geometry>

#include <dspace/Checks.h>
#include <dspace/ephemeris/Fallbacks.h>
#include <dspace/time/UtcText.h>

namespace dspace {
namespace {

constexpr std::size_t LongestChain = 20;

// One body's way towards the barycentre.
struct Way {
  std::array<int, LongestChain> bodies;
  std::array<std::size_t, LongestChain> sources; // of the link from each body to the next
  // Columns: position and velocity of the way's first body from each. Those behind the last are not
  // set, which is half of the time of a state.
  Eigen::Matrix<double, 6, int(LongestChain)> states;
  std::size_t length = 1;
  bool ended = false;

  explicit Way(int body) {
    this->bodies[0] = body;
    this->states.col(0).setZero();
  }
  int Last() const { return this->bodies[this->length - 1]; }
  // Index of `body`; `length`: it is not on the way.
  std::size_t Find(int body) const {
    return std::size_t(std::find(this->bodies.begin(), this->bodies.begin() + this->length, body) -
                       this->bodies.begin());
  }
  void Add(int body, const State& state, std::size_t source) {
    const auto last = Eigen::Index(this->length - 1);
    this->sources[this->length - 1] = source;
    this->bodies[this->length] = body;
    this->states.col(last + 1) = this->states.col(last);
    this->states.col(last + 1).head<3>() += state.position;
    this->states.col(last + 1).tail<3>() += state.velocity;
    ++this->length;
  }
};

bool IsConverged(Correction correction) {
  return correction == Correction::Converged || correction == Correction::ConvergedStar;
}

// Moves a target's state to where an observer sees it who moves at `velocity` and accelerates: the
// position turns towards the velocity by asin(|u x v| / c), u towards the target. This is
// SPICE's (STELAB), without relativity: to first order it is exact, and 1e-8 rad remain.
State Aberrated(const State& target, const Eigen::Vector3d& velocity,
                const Eigen::Vector3d& acceleration) {
  const double distance = target.position.norm();
  if (!(distance > 0.0)) {
    return target;
  }
  const Eigen::Vector3d u = target.position / distance;
  const Eigen::Vector3d uRate = (target.velocity - u * u.dot(target.velocity)) / distance;
  const Eigen::Vector3d h = u.cross(velocity) / SpeedOfLight;
  const Eigen::Vector3d hRate = (uRate.cross(velocity) + u.cross(acceleration)) / SpeedOfLight;
  const double cosine = std::sqrt(1.0 - h.squaredNorm());
  // h is perpendicular to the position, so that the turn about it is this sum.
  return {target.position * cosine + h.cross(target.position),
          target.velocity * cosine - target.position * (h.dot(hRate) / cosine) +
              hRate.cross(target.position) + h.cross(target.velocity)};
}

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}

} // namespace

Correction CorrectionOf(const std::string& text) {
  std::string upper = text;
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return char(std::toupper(c)); });
  for (const Correction correction :
       {Correction::None, Correction::LightTime, Correction::LightTimeStar, Correction::Converged,
        Correction::ConvergedStar}) {
    if (upper == CorrectionText(correction)) {
      return correction;
    }
  }
  Reject("correction '" + text + "'", "it is unknown; accepted: NONE, LT, LT+S, CN, CN+S");
}

const char* CorrectionText(Correction correction) {
  switch (correction) {
  case Correction::None:
    return "NONE";
  case Correction::LightTime:
    return "LT";
  case Correction::LightTimeStar:
    return "LT+S";
  case Correction::Converged:
    return "CN";
  case Correction::ConvergedStar:
    break;
  }
  return "CN+S";
}

bool HasStar(Correction correction) {
  return correction == Correction::LightTimeStar || correction == Correction::ConvergedStar;
}

Ephemeris::Ephemeris() : Frames_(std::make_shared<const InertialTurns>()) {}

Ephemeris::~Ephemeris() = default;

void Ephemeris::Load(std::shared_ptr<const StateSource> source, Priority priority) {
  if (!source) {
    Reject("ephemeris", "a source is absent; accepted: any other");
  }
  for (const auto& other : this->Sources_) {
    if (other->Name() == source->Name()) {
      throw Error(Error::Kind::AlreadyExists, source->Name(),
                  "a source of this name is loaded; accepted: another, or this after Unload");
    }
  }
  this->Sources_.insert(priority == Priority::First ? this->Sources_.begin() : this->Sources_.end(),
                        std::move(source));
  this->First_ += priority == Priority::First ? 1 : 0;
  this->Index();
}

void Ephemeris::Unload(const std::string& name) {
  const auto found = std::find_if(this->Sources_.begin(), this->Sources_.end(),
                                  [&](const auto& source) { return source->Name() == name; });
  if (found == this->Sources_.end()) {
    std::vector<std::string> names;
    for (const auto& source : this->Sources_) {
      names.push_back("'" + source->Name() + "'");
    }
    throw Error(Error::Kind::NotFound, "source '" + name + "'",
                "it is not loaded; accepted: " + (names.empty() ? "none" : Joined(names)));
  }
  this->First_ -= std::size_t(found - this->Sources_.begin()) < this->First_ ? 1 : 0;
  this->Sources_.erase(found);
  this->Index();
}

const std::vector<std::shared_ptr<const StateSource>>& Ephemeris::Sources() const {
  return this->Sources_;
}

void Ephemeris::Index() {
  this->ByBody_.clear();
  for (std::size_t i = 0; i < this->Sources_.size(); ++i) {
    for (const StateSource::Coverage& coverage : this->Sources_[i]->Coverages()) {
      auto& order = this->ByBody_[coverage.body];
      if (order.empty() || order.back() != i) {
        order.push_back(i);
      }
    }
  }
}

void Ephemeris::SetFrames(std::shared_ptr<const FrameTurns> frames) {
  this->Frames_ = frames ? std::move(frames) : std::make_shared<const InertialTurns>();
}

std::optional<Ephemeris::Known> Ephemeris::LinkOf(int body, double tdb) const {
  const auto found = this->ByBody_.find(body);
  if (found == this->ByBody_.end()) {
    return std::nullopt;
  }
  for (const std::size_t index : found->second) {
    if (std::optional<StateSource::Link> link = this->Sources_[index]->Find(body, tdb)) {
      return Known{*link, index};
    }
  }
  return std::nullopt;
}

std::string Ephemeris::WarningOf(int body, std::size_t source) const {
  const StateSource& used = *this->Sources_[source];
  std::string warning = used.Warning(body);
  const std::size_t first = this->ByBody_.at(body).front();
  if (!warning.empty() || source < this->First_ || first >= this->First_) {
    return warning;
  }
  const std::string accuracy = used.Accuracy(body);
  return "body " + this->Names_.NameOf(body) + " is taken from " + used.Name() +
         (accuracy.empty() ? "" : " (" + accuracy + ")") + ", since " +
         this->Sources_[first]->Name() + " does not cover the time";
}

State Ephemeris::AxesJ2000(const StateSource::Link& link, double tdb) const {
  return link.frame == FrameJ2000 ? link.state
                                  : this->Frames_->Turn(link.frame, FrameJ2000, tdb) * link.state;
}

State Ephemeris::Geometric(int target, int observer, double tdb, std::vector<int>* used) const {
  if (!std::isfinite(tdb)) {
    Reject("ephemeris", "a time is " + NumberText(tdb) + "; accepted: finite seconds past J2000");
  }
  if (target == observer) {
    return {};
  }
  // Both ways grow in turn until one meets the other: at the body closest to both.
  Way ways[2] = {Way(target), Way(observer)};
  for (int turn = 0;; turn = 1 - turn) {
    Way& way = ways[turn];
    const Way& other = ways[1 - turn];
    if (!way.ended) {
      const int body = way.Last();
      const std::optional<Known> known = body == 0 ? std::nullopt : this->LinkOf(body, tdb);
      if (!known) {
        way.ended = true;
      } else {
        if (way.length == LongestChain || way.Find(known->link.center) != way.length) {
          throw Error(Error::Kind::Corrupt, "ephemeris",
                      "the centres of body " + this->Names_.NameOf(way.bodies[0]) +
                          " lead in a circle at body " + this->Names_.NameOf(body) + " (" +
                          this->Sources_[known->source]->Name() + ")");
        }
        way.Add(known->link.center, this->AxesJ2000(known->link, tdb), known->source);
        const std::size_t met = other.Find(way.Last());
        if (met != other.length) {
          const std::size_t last = way.length - 1;
          const std::size_t ends[2] = {turn == 0 ? last : met, turn == 0 ? met : last};
          for (int i = 0; i < 2; ++i) {
            for (std::size_t k = 0; k < ends[i]; ++k) {
              FallbackScope::Note(this->WarningOf(ways[i].bodies[k], ways[i].sources[k]));
            }
            if (used) {
              used->insert(used->end(), ways[i].bodies.begin(), ways[i].bodies.begin() + ends[i]);
            }
          }
          const Eigen::Matrix<double, 6, 1> state =
              ways[0].states.col(Eigen::Index(ends[0])) - ways[1].states.col(Eigen::Index(ends[1]));
          return {state.head<3>(), state.tail<3>()};
        }
      }
    }
    if (ways[0].ended && ways[1].ended) {
      // The way that ended before the barycentre lacks a link; both: the target's.
      this->Missing(ways[0].Last() != 0 ? ways[0].Last() : ways[1].Last(), tdb);
    }
  }
}

State Ephemeris::FromBarycenter(int body, double tdb) const {
  return this->Geometric(body, 0, tdb);
}

Ephemeris::Result Ephemeris::Apparent(int target, int observer, double tdb, Correction correction,
                                      double* lightTimeRate) const {
  Result result;
  if (correction == Correction::None) {
    result.state = this->Geometric(target, observer, tdb);
    const double distance = result.state.position.norm();
    result.lightTime = distance / SpeedOfLight;
    return result;
  }
  // SPICE's SPKLTC: one iteration, or until the light time repeats.
  const State seer = this->FromBarycenter(observer, tdb);
  State emitter = this->FromBarycenter(target, tdb);
  double lightTime = (emitter.position - seer.position).norm() / SpeedOfLight;
  const int iterations = IsConverged(correction) ? 5 : 1;
  for (int i = 0; i < iterations; ++i) {
    emitter = this->FromBarycenter(target, tdb - lightTime);
    const double before = lightTime;
    lightTime = (emitter.position - seer.position).norm() / SpeedOfLight;
    if (std::abs(lightTime - before) <= 1e-17 * std::max(1.0, std::abs(tdb))) {
      break;
    }
  }
  State state = emitter - seer;
  const double distance = state.position.norm();
  double rate = 0.0;
  if (distance > 0.0) {
    const Eigen::Vector3d u = state.position / (distance * SpeedOfLight);
    rate = u.dot(state.velocity) / (1.0 + u.dot(emitter.velocity));
  }
  state.velocity = emitter.velocity * (1.0 - rate) - seer.velocity;
  if (HasStar(correction)) {
    // As SPICE does, the acceleration from velocities a second apart on both sides.
    const Eigen::Vector3d acceleration = (this->FromBarycenter(observer, tdb + 1.0).velocity -
                                          this->FromBarycenter(observer, tdb - 1.0).velocity) /
                                         2.0;
    state = Aberrated(state, seer.velocity, acceleration);
  }
  if (lightTimeRate) {
    *lightTimeRate = rate;
  }
  return {state, lightTime};
}

Ephemeris::Result Ephemeris::Evaluate(const Query& query, int frame, double tdb,
                                      const StateTurn* turn) const {
  double rate = 0.0;
  Result result = this->Apparent(query.target, query.observer, tdb, query.correction, &rate);
  if (turn) {
    result.state = *turn * result.state;
  } else if (frame != FrameJ2000) {
    // A turning frame is seen as its centre is: delayed by the light time.
    double delay = 0.0;
    double delayRate = 0.0;
    if (query.correction != Correction::None) {
      const int center = this->Frames_->Center(frame);
      if (center == query.target) {
        delay = result.lightTime;
        delayRate = rate;
      } else if (center != query.observer) {
        const Correction plain =
            IsConverged(query.correction) ? Correction::Converged : Correction::LightTime;
        delay = this->Apparent(center, query.observer, tdb, plain, &delayRate).lightTime;
      }
    }
    StateTurn moving = this->Frames_->Turn(FrameJ2000, frame, tdb - delay);
    moving.rate *= 1.0 - delayRate;
    result.state = moving * result.state;
  }
  return result;
}

Ephemeris::Result Ephemeris::Find(const Query& query, double tdb) const {
  Result result;
  this->FindMany(query, &tdb, 1, &result);
  return result;
}

void Ephemeris::FindMany(const Query& query, const double* tdb, std::size_t count,
                         Result* results) const {
  const int frame = this->Frames_->FrameId(query.frame);
  std::optional<StateTurn> turn;
  if (frame != FrameJ2000 && this->Frames_->IsInertial(frame)) {
    turn = this->Frames_->Turn(FrameJ2000, frame, 0.0);
  }
  for (std::size_t i = 0; i < count; ++i) {
    FallbackScope::Begin(tdb[i]);
    results[i] = this->Evaluate(query, frame, tdb[i], turn ? &*turn : nullptr);
  }
}

State Ephemeris::Find(const std::string& target, const std::string& observer, double tdb,
                      const std::string& frame, Correction correction) const {
  return this
      ->Find(Query{this->Names_.IdOf(target), this->Names_.IdOf(observer), frame, correction}, tdb)
      .state;
}

std::vector<Ephemeris::Used> Ephemeris::Explain(const Query& query, double tdb) const {
  const FallbackScope aside; // nothing is computed from these states
  std::vector<int> bodies;
  this->Geometric(query.target, query.observer, tdb, &bodies);
  std::vector<Used> all;
  for (const int body : bodies) {
    Used used;
    used.body = body;
    bool first = true;
    for (const std::size_t index : this->ByBody_.at(body)) {
      const StateSource& source = *this->Sources_[index];
      const std::optional<StateSource::Link> link = source.Find(body, tdb);
      if (!link) {
        continue;
      }
      if (!first) {
        used.hidden.push_back(source.Name());
        continue;
      }
      first = false;
      used.center = link->center;
      used.source = source.Name();
      used.segment = source.Coverages()[std::size_t(link->part)].name;
      used.accuracy = source.Accuracy(body);
      used.warning = this->WarningOf(body, index);
    }
    all.push_back(std::move(used));
  }
  return all;
}

std::vector<StateSource::Coverage> Ephemeris::CoverageOf(int body) const {
  std::vector<StateSource::Coverage> coverages;
  for (const auto& source : this->Sources_) {
    for (const StateSource::Coverage& coverage : source->Coverages()) {
      if (coverage.body == body) {
        coverages.push_back(coverage);
      }
    }
  }
  return coverages;
}

void Ephemeris::Missing(int body, double tdb) const {
  const std::string label =
      "body " + this->Names_.NameOf(body) +
      (this->Names_.NameOf(body) == std::to_string(body) ? std::string()
                                                         : " (" + std::to_string(body) + ")");
  std::vector<std::pair<double, double>> spans;
  for (const StateSource::Coverage& coverage : this->CoverageOf(body)) {
    spans.emplace_back(coverage.begin, coverage.end);
  }
  if (spans.empty()) {
    std::set<int> known;
    for (const auto& source : this->Sources_) {
      for (const StateSource::Coverage& coverage : source->Coverages()) {
        known.insert(coverage.body);
      }
    }
    std::vector<std::string> names;
    for (const int other : known) {
      if (names.size() == 24) {
        names.emplace_back("...");
        break;
      }
      names.push_back(this->Names_.NameOf(other));
    }
    throw Error(Error::Kind::NotFound, label,
                "no loaded source knows its states; accepted: " +
                    (names.empty() ? "none" : Joined(names)));
  }
  std::sort(spans.begin(), spans.end());
  std::vector<std::pair<double, double>> joined;
  for (const auto& span : spans) {
    if (!joined.empty() && span.first <= joined.back().second) {
      joined.back().second = std::max(joined.back().second, span.second);
    } else {
      joined.push_back(span);
    }
  }
  std::vector<std::string> texts;
  for (const auto& span : joined) {
    if (texts.size() == 8) {
      texts.emplace_back("...");
      break;
    }
    texts.push_back(TimeLabel(span.first, this->Scales_) + " to " +
                    TimeLabel(span.second, this->Scales_));
  }
  Reject(label, "its state at " + TimeLabel(tdb, this->Scales_) + " (" + NumberText(tdb) +
                    " s past J2000 TDB) is outside of what the loaded sources cover; accepted: " +
                    Joined(texts));
}

} // namespace dspace
