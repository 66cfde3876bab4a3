#include <dspace/commands/objects/TrajectoryMessages.h>

#include <cstring>
#include <utility>

#include <dspace/Checks.h>
#include <dspace/messages/Convert.h>
#include <dspace/trajectories/OemFile.h>
#include <dspace/trajectories/Orbit.h>
#include <dspace/trajectories/XyzvFile.h>

namespace dspace::session {
namespace {

std::vector<Eigen::Vector3d> VectorsOf(const std::string& bytes, std::size_t count,
                                       const std::string& object, const char* what) {
  const std::vector<double> numbers = DoublesOf(bytes, 3, count, object, what);
  std::vector<Eigen::Vector3d> vectors;
  vectors.reserve(numbers.size() / 3);
  for (std::size_t i = 0; i < numbers.size(); i += 3) {
    vectors.emplace_back(numbers.data() + i);
  }
  return vectors;
}

std::vector<Eigen::Quaterniond> RotationsOf(const std::string& bytes, std::size_t count,
                                            const std::string& object) {
  const std::vector<double> numbers = DoublesOf(bytes, 4, count, object, "rotation");
  std::vector<Eigen::Quaterniond> rotations;
  rotations.reserve(count);
  for (std::size_t i = 0; i < numbers.size(); i += 4) {
    rotations.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]);
  }
  return rotations;
}

Interpolation ToInterpolation(const v1::StateInterpolation& from, bool velocities,
                              const std::string& object) {
  Interpolation by;
  by.degree = from.degree() > 0 ? ToInt(from.degree()) : 7;
  switch (from.kind()) {
  case v1::StateInterpolation::HERMITE:
    // Without velocities Hermite's polynomials are not known.
    by.kind = velocities ? Interpolation::Kind::Hermite : Interpolation::Kind::Lagrange;
    break;
  case v1::StateInterpolation::LAGRANGE:
    by.kind = Interpolation::Kind::Lagrange;
    break;
  case v1::StateInterpolation::LINEAR:
    by.kind = Interpolation::Kind::Linear;
    by.degree = 1;
    break;
  default:
    Reject(object, "the kind of interpolation is " + std::to_string(int(from.kind())) +
                       "; accepted: HERMITE, LAGRANGE, LINEAR");
  }
  return by;
}

TrajectoryPtr ToTable(const v1::StateArrays& from, const std::string& object) {
  StateTable::Content content;
  content.times = DoublesOf(from.time(), 1, 0, object, "time");
  const std::size_t n = content.times.size();
  content.positions = VectorsOf(from.position(), n, object, "position");
  if (!from.velocity().empty()) {
    content.velocities = VectorsOf(from.velocity(), n, object, "velocity");
  }
  content.interpolation =
      ToInterpolation(from.interpolation(), !content.velocities.empty(), object);
  return std::make_shared<StateTable>(object, std::move(content));
}

PointingRule::Direction ToDirection(v1::PointingRule::Direction from, const std::string& object) {
  switch (from) {
  case v1::PointingRule::NADIR:
    return PointingRule::Direction::Nadir;
  case v1::PointingRule::MOTION:
    return PointingRule::Direction::Velocity;
  case v1::PointingRule::ORBIT_NORMAL:
    return PointingRule::Direction::OrbitNormal;
  case v1::PointingRule::TOWARDS:
    return PointingRule::Direction::Sun;
  default:
    Reject(object, "a direction of its rule is " + std::to_string(int(from)) +
                       "; accepted: NADIR, MOTION, ORBIT_NORMAL, TOWARDS");
  }
}

} // namespace

const TimeScales& TrajectoryClock() {
  static const TimeScales scales;
  return scales;
}

std::vector<double> DoublesOf(const std::string& bytes, std::size_t size, std::size_t count,
                              const std::string& object, const char* what) {
  const std::size_t row = 8 * size;
  if (bytes.size() % row != 0 || (count > 0 && bytes.size() != count * row)) {
    Reject(object,
           std::string(what) + " has " + std::to_string(bytes.size()) + " bytes; accepted: " +
               (count > 0 ? std::to_string(count * row) : "multiples of " + std::to_string(row)) +
               ", float64");
  }
  std::vector<double> numbers(bytes.size() / 8);
  if (!numbers.empty()) { // little-endian, as the machine
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
  }
  return numbers;
}

void PutDoubles(const std::vector<double>& from, std::string* to) {
  to->assign(reinterpret_cast<const char*>(from.data()), 8 * from.size());
}

TrajectorySource ToSource(v1::TrajectoryPath& path, const std::string& object) {
  switch (path.kind_case()) {
  case v1::TrajectoryPath::kStates:
    return {ToTable(path.states(), object), "", "", ""};
  case v1::TrajectoryPath::kOem: {
    const OemFile file(path.oem(), TrajectoryClock());
    return {file.GetTrajectory(), file.Blocks().front().center, file.Frame(), file.ObjectName()};
  }
  case v1::TrajectoryPath::kXyzv: {
    const XyzvFile file(path.xyzv());
    return {file.GetTrajectory(), file.Center(), file.Frame(), file.Target()};
  }
  case v1::TrajectoryPath::kConic: {
    const v1::ConicState& conic = path.conic();
    return {std::make_shared<Conic>(
                object, dspace::State{ToVector(conic.position()), ToVector(conic.velocity())},
                conic.time_s(), conic.mu()),
            "", "", ""};
  }
  default:
    Reject(object, "its path is missing; accepted: states, an OEM, an xyzv file, a conic");
  }
}

MovingFramePtr ToAxes(v1::TrajectoryAxes& axes, const std::string& object) {
  using Kind = v1::TrajectoryAxes;
  const std::string name = object + ", its axes";
  const TrajectoryPtr origin =
      axes.has_origin() ? ToSource(*axes.mutable_origin(), name + "' origin").path : nullptr;
  if (axes.kind() != Kind::ROTATING && (axes.has_other() || axes.share() != 0.0)) {
    Reject(name, "they have another body or a share; accepted for ROTATING axes only");
  }
  switch (axes.kind()) {
  case Kind::REFERENCE:
    return origin ? std::make_shared<LocalFrame>(name, origin, LocalFrame::Axes::Reference)
                  : nullptr;
  case Kind::ROTATING: {
    const TrajectoryPtr other =
        axes.has_other() ? ToSource(*axes.mutable_other(), name + "' other body").path : nullptr;
    return std::make_shared<TwoBodyFrame>(name, origin, other, axes.share());
  }
  case Kind::LVLH:
    return std::make_shared<LocalFrame>(name, origin, LocalFrame::Axes::Lvlh);
  case Kind::RTN:
    return std::make_shared<LocalFrame>(name, origin, LocalFrame::Axes::Rtn);
  case Kind::VELOCITY:
    return std::make_shared<LocalFrame>(name, origin, LocalFrame::Axes::Velocity);
  case Kind::TABLE: {
    std::vector<double> times = DoublesOf(axes.time(), 1, 0, name, "time");
    std::vector<Eigen::Quaterniond> rotations = RotationsOf(axes.rotation(), times.size(), name);
    const auto table =
        std::make_shared<TableAttitude>(name, std::move(times), std::move(rotations));
    return std::make_shared<TurningFrame>(
        name, origin, [table](double t) { return table->At(t).toRotationMatrix(); }, table->Span());
  }
  default:
    Reject(name, "their kind is " + std::to_string(int(axes.kind())) +
                     "; accepted: REFERENCE, ROTATING, LVLH, RTN, VELOCITY, TABLE");
  }
}

AttitudePtr ToAttitude(v1::SetTrajectoryFrame& command, const TrajectoryPtr& craft,
                       const std::string& object) {
  const bool table = !command.time().empty() || !command.rotation().empty();
  if (table && command.has_rule()) {
    Reject(object, "it has a rule and a table of rotations; accepted: one of them");
  }
  if (table) {
    std::vector<double> times = DoublesOf(command.time(), 1, 0, object, "time");
    std::vector<Eigen::Quaterniond> rotations =
        RotationsOf(command.rotation(), times.size(), object);
    return std::make_shared<TableAttitude>(object, std::move(times), std::move(rotations));
  }
  if (!command.has_rule()) {
    return nullptr;
  }
  v1::PointingRule& from = *command.mutable_rule();
  PointingRule rule;
  rule.axis = ToVector(from.axis());
  rule.direction = ToDirection(from.direction(), object);
  rule.secondaryAxis = ToVector(from.second_axis());
  rule.secondaryDirection = ToDirection(from.second_direction(), object);
  RuleAttitude::SunDirection towards;
  if (from.has_towards()) {
    const TrajectoryPtr target =
        ToSource(*from.mutable_towards(), object + ", what it points to").path;
    towards = [target](double time_s, const Eigen::Vector3d& p_F) -> Eigen::Vector3d {
      return target->At(time_s).position - p_F;
    };
  }
  return std::make_shared<RuleAttitude>(object, craft, rule, std::move(towards));
}

} // namespace dspace::session
