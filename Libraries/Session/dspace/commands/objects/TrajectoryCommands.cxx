// Trajectories.
#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/commands/objects/TrajectoryMessages.h>
#include <dspace/messages/Convert.h>
#include <dspace/time/UtcText.h>
#include <dspace/trajectories/Orbit.h>
#include <dspace/trajectories/PathSampling.h>

namespace dspace::session {
namespace {

constexpr double MostTicks = 100000;
constexpr double Day = 86400.0; // [s]

TrajectoryObject& FindTrajectory(const Context& context, ObjectId id) {
  context.GetScene().Object(id); // throws where there is none
  const auto found = context.scene->trajectories.find(id);
  if (found == context.scene->trajectories.end()) {
    Reject(ObjectLabel(context.GetScene(), id), "it is not a trajectory");
  }
  return *found->second;
}

TrajectoryLook ToLook(const v1::TrajectoryLook& from, TrajectoryLook look,
                      const std::string& object) {
  look.color = from.has_color() ? ToColor(from.color(), object) : look.color;
  look.opacity = from.has_opacity() ? from.opacity() : look.opacity;
  look.before = from.has_before_s() ? from.before_s() : look.before;
  look.after = from.has_after_s() ? from.after_s() : look.after;
  look.ahead = from.has_ahead() ? from.ahead() : look.ahead;
  look.fade = from.has_fade() ? from.fade() : look.fade;
  look.tickSize = from.has_tick_size() ? from.tick_size() : look.tickSize;
  look.tickLabels = from.has_tick_labels() ? from.tick_labels() : look.tickLabels;
  look.fontSize = from.has_font_size() ? ToInt(from.font_size()) : look.fontSize;
  return look;
}

// With all fields, so that the last command is enough.
void PutLook(const TrajectoryLook& from, v1::TrajectoryLook* to) {
  Put(from.color, to->mutable_color());
  to->set_opacity(from.opacity);
  to->set_before_s(from.before);
  to->set_after_s(from.after);
  to->set_ahead(from.ahead);
  to->set_fade(from.fade);
  to->set_tick_size(from.tickSize);
  to->set_tick_labels(from.tickLabels);
  to->set_font_size(std::uint32_t(from.fontSize));
}

// An osculating orbit has no times.
void RequireNoTimes(const TrajectoryLook& look, const std::string& object) {
  if (look.fade || look.ahead != 1.0 || std::isfinite(look.before) || std::isfinite(look.after)) {
    Reject(object,
           "it is an osculating orbit with a window of time, fading, or another look ahead; "
           "accepted for osculating orbits: none of them");
  }
}

// The colours of points at times.
class Colors {
public:
  Colors(const v1::CreateTrajectory& from, const std::string& object) {
    this->Times_ = DoublesOf(from.color_time(), 1, 0, object, "color_time");
    if (from.color_at().size() != 4 * this->Times_.size()) {
      Reject(object, "color_at has " + std::to_string(from.color_at().size()) +
                         " bytes; accepted: " + std::to_string(4 * this->Times_.size()) +
                         ", four for each time");
    }
    for (std::size_t i = 0; i < this->Times_.size(); ++i) {
      RequireFinite(object, "a time of its colours", this->Times_[i]);
      if (i > 0 && this->Times_[i] <= this->Times_[i - 1]) {
        Reject(object, "time " + std::to_string(i + 1) +
                           " of its colours is not after the one before "
                           "it; accepted: ascending times");
      }
      TrajectoryLine::Color color;
      for (std::size_t k = 0; k < 4; ++k) {
        color[k] = std::uint8_t(from.color_at()[4 * i + k]);
      }
      this->Colors_.push_back(color);
    }
  }
  bool Given() const { return !this->Times_.empty(); }
  const std::vector<double>& Times() const { return this->Times_; }
  TrajectoryLine::Color At(double time_s) const {
    const auto next = std::upper_bound(this->Times_.begin(), this->Times_.end(), time_s);
    if (next == this->Times_.begin()) {
      return this->Colors_.front();
    }
    const auto i = std::size_t(next - this->Times_.begin()) - 1;
    if (next == this->Times_.end()) {
      return this->Colors_.back();
    }
    const double share = (time_s - this->Times_[i]) / (this->Times_[i + 1] - this->Times_[i]);
    TrajectoryLine::Color color;
    for (std::size_t k = 0; k < 4; ++k) {
      color[k] = std::uint8_t(std::lround((1.0 - share) * double(this->Colors_[i][k]) +
                                          share * double(this->Colors_[i + 1][k])));
    }
    return color;
  }

private:
  std::vector<double> Times_;
  std::vector<TrajectoryLine::Color> Colors_;
};

// The parts of what is known that are drawn.
std::vector<TimeSpan> DrawnParts(const v1::CreateTrajectory& command, const Trajectory& shown,
                                 const std::string& object) {
  const TimeSpan span = shown.Span();
  const TimeSpan wanted = {command.has_begin_s() ? command.begin_s() : span.begin,
                           command.has_end_s() ? command.end_s() : span.end};
  if (!std::isfinite(wanted.begin) || !std::isfinite(wanted.end) || !(wanted.begin < wanted.end)) {
    Reject(object, "it is drawn from " + NumberText(wanted.begin) + " to " +
                       NumberText(wanted.end) +
                       " s; accepted: finite times, the begin before the end (a conic needs both)");
  }
  RequireInSpan(object, wanted.begin, span);
  RequireInSpan(object, wanted.end, span);
  std::vector<TimeSpan> parts;
  for (const TimeSpan& part : shown.Parts()) {
    const TimeSpan drawn = Common(part, wanted);
    if (drawn.begin < drawn.end) {
      parts.push_back(drawn);
    }
  }
  if (parts.empty()) {
    Reject(object, "no state is known when it is drawn; accepted: times with states");
  }
  return parts;
}

std::vector<TrajectoryLine::Strip> StripsOf(const v1::CreateTrajectory& command,
                                            const Trajectory& shown, const Colors& colors,
                                            const std::vector<TimeSpan>& parts,
                                            const std::string& object) {
  PathSampling by;
  by.flatness = command.has_flatness() ? command.flatness() : by.flatness;
  by.most = command.has_most_points() ? command.most_points() : by.most;
  std::vector<TrajectoryLine::Strip> strips;
  for (const TimeSpan& part : parts) {
    TrajectoryLine::Strip strip;
    strip.times = SampleTimes(shown, part, by, object);
    // Where colours change, there is a point.
    for (const double t : colors.Times()) {
      if (t > part.begin && t < part.end) {
        strip.times.push_back(t);
      }
    }
    std::sort(strip.times.begin(), strip.times.end());
    strip.times.erase(std::unique(strip.times.begin(), strip.times.end()), strip.times.end());
    for (const double t : strip.times) {
      strip.points.push_back(shown.At(t).position);
      if (colors.Given()) {
        strip.colors.push_back(colors.At(t));
      }
    }
    strips.push_back(std::move(strip));
  }
  return strips;
}

std::string TickText(double clock_s, double tdb, double interval, bool utc) {
  if (!utc) {
    return NumberText(clock_s) + " s";
  }
  // "2022-11-28T21:04:34": what the interval tells apart.
  const std::string text = UtcText(tdb, TrajectoryClock(), 0);
  if (interval >= Day && std::fmod(interval, Day) == 0.0) {
    return text.substr(0, 10);
  }
  std::string day = text.substr(5, 5) + " ";
  return day + (std::fmod(interval, 60.0) == 0.0 ? text.substr(11, 5) : text.substr(11, 8));
}

// At whole multiples of the interval.
std::vector<TrajectoryLine::Tick> TicksOf(const v1::CreateTrajectory& command,
                                          const Trajectory& shown,
                                          const std::vector<TimeSpan>& parts,
                                          const std::string& object) {
  const double interval = command.tick_interval_s();
  Require(interval >= 0.0 && std::isfinite(interval), object, "the interval of its ticks", interval,
          "0 s (no ticks) and more");
  if (command.clock() != v1::CreateTrajectory::UTC &&
      command.clock() != v1::CreateTrajectory::SECONDS) {
    Reject(object,
           "its clock is " + std::to_string(int(command.clock())) + "; accepted: UTC, SECONDS");
  }
  std::vector<TrajectoryLine::Tick> ticks;
  if (interval == 0.0) {
    return ticks;
  }
  const bool utc = command.clock() == v1::CreateTrajectory::UTC;
  const TimeScales& scales = TrajectoryClock();
  // UTC as seconds counts from noon; ticks are at whole multiples from midnight.
  const auto toClock = [&](double t) {
    return utc ? scales.Convert(t, TimeScale::Tdb, TimeScale::Utc) + 0.5 * Day : t;
  };
  const auto fromClock = [&](double t) {
    return utc ? scales.Convert(t - 0.5 * Day, TimeScale::Utc, TimeScale::Tdb) : t;
  };
  for (const TimeSpan& part : parts) {
    const double first = std::ceil(toClock(part.begin) / interval);
    const double last = std::floor(toClock(part.end) / interval);
    Require(last - first + double(ticks.size()) < MostTicks, object, "the number of its ticks",
            last - first + 1.0, "up to 100000: a longer interval");
    for (double k = first; k <= last; ++k) {
      const double clock = k * interval;
      const double t = fromClock(clock);
      if (t < part.begin || t > part.end || (!ticks.empty() && t <= ticks.back().time)) {
        continue;
      }
      ticks.push_back({t, shown.At(t).position, TickText(clock, t, interval, utc)});
    }
  }
  return ticks;
}

void CreateTrajectory(const Context& context, v1::CreateTrajectory& command) {
  v1::ObjectSettings& settings = *command.mutable_object();
  const std::string name =
      settings.name().empty() ? context.GetScene().FreeObjectName("trajectory") : settings.name();
  const std::string label = "object '" + name + "'";
  if (settings.material().ByteSizeLong() > 0 || settings.has_offset() ||
      settings.has_point_size()) {
    Reject(label, "a material, offset or point size is given; accepted for trajectories: none");
  }
  TrajectorySource source = ToSource(*command.mutable_path(), label);
  const MovingFramePtr axes = ToAxes(*command.mutable_axes(), label);
  const TrajectoryPtr shown =
      axes ? std::make_shared<RelativeTrajectory>(source.path, axes) : source.path;
  const TrajectoryLook look = ToLook(command.look(), {}, label);
  const Colors colors(command, label);
  const double time = context.GetScene().Time();
  TrajectoryObject::Osculating osculating;
  std::shared_ptr<TrajectoryLine> line;
  if (command.osculating()) {
    Require(command.mu() > 0.0 && std::isfinite(command.mu()), label, "GM of the centre",
            command.mu(), "a positive number [m^3/s^2]");
    Require(!command.has_farthest() ||
                (command.farthest() > 0.0 && std::isfinite(command.farthest())),
            label, "how far its orbit is drawn", command.farthest(), "a positive number [m]");
    if (colors.Given() || command.tick_interval_s() != 0.0) {
      Reject(label, "it has colours or ticks by time; accepted for osculating orbits: none");
    }
    RequireNoTimes(look, label);
    osculating = {command.mu(), command.farthest()};
    line = std::make_shared<TrajectoryLine>(
        label, TrajectoryObject::ConicAt(label, *source.path, axes.get(), osculating,
                                         NearestTime(shown->Parts(), time)));
  } else {
    const std::vector<TimeSpan> parts = DrawnParts(command, *shown, label);
    line = std::make_shared<TrajectoryLine>(label, StripsOf(command, *shown, colors, parts, label),
                                            TicksOf(command, *shown, parts, label),
                                            [shown](double t) { return shown->At(t).position; });
  }
  line->SetLook(label, look);
  auto object =
      std::make_unique<TrajectoryObject>(label, std::move(source), axes, line, osculating);
  const std::string warning = object->SetTime(time);
  const ObjectId id = AddObject(context, settings, name, {}, false, line);
  context.scene->trajectories[id] = std::move(object);
  if (!warning.empty()) {
    context.reply.add_warning(warning);
  }
}

void SetTrajectory(const Context& context, v1::SetTrajectory& command) {
  TrajectoryObject& object = FindTrajectory(context, command.object());
  const std::string label = ObjectLabel(context.GetScene(), command.object());
  const TrajectoryLook look = ToLook(command.look(), object.Line()->Look(), label);
  if (object.IsOsculating()) {
    RequireNoTimes(look, label);
  }
  object.Line()->SetLook(label, look);
  PutLook(look, command.mutable_look());
}

void SetTrajectoryFrame(const Context& context, v1::SetTrajectoryFrame& command) {
  TrajectoryObject& object = FindTrajectory(context, command.object());
  const std::string label = ObjectLabel(context.GetScene(), command.object());
  FrameTree& frames = context.Frames();
  const FrameId frame = command.frame();
  AttitudePtr attitude = ToAttitude(command, object.Source().path, label);
  Pose place;
  Pose before;
  std::string warning;
  if (frame != NoFrame) {
    const std::string moved = "frame '" + frames.Path(frame) + "'"; // throws where there is none
    const FrameId parent = context.GetScene().Object(command.object()).frame;
    if (frame == RootFrame || frames.Parent(frame) != parent) {
      Reject(moved, "it is not a child of frame '" + frames.Path(parent) + "', in which " + label +
                        " is; accepted: one of its children");
    }
    context.scene->sky.RequireFree(frames, frame, "moved along a trajectory");
    for (const auto& [id, other] : context.scene->trajectories) {
      if (other->Follower() == frame && id != command.object()) {
        Reject(moved, "it follows " + ObjectLabel(context.GetScene(), id) +
                          "; accepted: a frame that follows no other trajectory");
      }
    }
    before = object.Follower() == frame ? object.PoseBefore() : frames.LocalPose(frame);
    TrajectoryObject trial = object;
    trial.Follow(frame, before, attitude);
    place = trial.FollowerPose(context.GetScene().Time(), warning);
  }
  if (object.Follower() != NoFrame && object.Follower() != frame) {
    frames.SetLocalPose(object.Follower(), object.PoseBefore());
  }
  object.Follow(frame, before, std::move(attitude));
  if (frame != NoFrame) {
    frames.SetLocalPose(frame, place);
  }
  if (!warning.empty()) {
    context.reply.add_warning(warning);
  }
}

void GetTrajectory(const Context& context, v1::GetTrajectory& command) {
  const TrajectoryObject& object = FindTrajectory(context, command.object());
  const std::string label = ObjectLabel(context.GetScene(), command.object());
  const Trajectory& path = command.reference() ? *object.Source().path : *object.Shown();
  std::vector<double> positions;
  std::vector<double> velocities;
  for (const double t : DoublesOf(command.time(), 1, 0, label, "time")) {
    const dspace::State state = path.At(t);
    positions.insert(positions.end(), state.position.data(), state.position.data() + 3);
    velocities.insert(velocities.end(), state.velocity.data(), state.velocity.data() + 3);
  }
  v1::TrajectoryReply* reply = context.reply.mutable_trajectory();
  PutDoubles(positions, reply->mutable_position());
  PutDoubles(velocities, reply->mutable_velocity());
  reply->set_begin_s(path.Span().begin);
  reply->set_end_s(path.Span().end);
  reply->set_center(object.Source().center);
  reply->set_frame(object.Source().frame);
  reply->set_object_name(object.Source().objectName);
  std::size_t points = 0;
  for (const auto& strip : object.Line()->Strips()) {
    points += strip.points.size();
  }
  reply->set_points(std::uint32_t(points));
  PutLook(object.Line()->Look(), reply->mutable_look());
}

void GetOrbit(const Context& context, v1::GetOrbit& command) {
  dspace::State state{ToVector(command.position()), ToVector(command.velocity())};
  std::string label = "the orbit";
  if (command.object() != 0) {
    if (command.has_position() || command.has_velocity()) {
      Reject("command get_orbit",
             "it has an object and a position or velocity; accepted: one of them");
    }
    label = ObjectLabel(context.GetScene(), command.object());
    state = FindTrajectory(context, command.object()).Source().path->At(command.time_s());
  }
  const OrbitalElements elements = ElementsOf(state, command.mu(), label);
  v1::OrbitReply* reply = context.reply.mutable_orbit();
  reply->set_semi_latus_rectum(elements.semiLatusRectum);
  reply->set_eccentricity(elements.eccentricity);
  reply->set_inclination_deg(elements.inclination_deg);
  reply->set_ascending_node_deg(elements.ascendingNode_deg);
  reply->set_periapsis_argument_deg(elements.periapsisArgument_deg);
  reply->set_true_anomaly_deg(elements.trueAnomaly_deg);
  reply->set_semi_major_axis(elements.SemiMajorAxis());
  reply->set_period_s(elements.Period());
  reply->set_periapsis_radius(elements.PeriapsisRadius());
  reply->set_apoapsis_radius(elements.ApoapsisRadius());
  reply->set_mean_anomaly_deg(elements.MeanAnomaly_deg());
}

} // namespace

void AddTrajectoryCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kCreateTrajectory, &C::mutable_create_trajectory, CreateTrajectory);
  registry.Add(C::kSetTrajectory, &C::mutable_set_trajectory, SetTrajectory);
  registry.Add(C::kSetTrajectoryFrame, &C::mutable_set_trajectory_frame, SetTrajectoryFrame);
  registry.Add(C::kGetTrajectory, &C::mutable_get_trajectory, GetTrajectory);
  registry.Add(C::kGetOrbit, &C::mutable_get_orbit, GetOrbit);
}

} // namespace dspace::session
