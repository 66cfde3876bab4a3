// Contacts and power over a span of time.
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <dspace/Checks.h>
#include <dspace/commands/objects/TrajectoryMessages.h>
#include <dspace/commands/sky/SkyPlaces.h>
#include <dspace/commands/sky/SkyTools.h>
#include <dspace/ephemeris/Fallbacks.h>
#include <dspace/messages/Convert.h>
#include <dspace/messages/Deadline.h>
#include <dspace/scene/Light.h>
#include <dspace/state/Works.h>
#include <dspace/visibility/Contacts.h>
#include <dspace/visibility/PowerProfile.h>

namespace dspace::session {
namespace {

constexpr int MostTargets = 1000;
constexpr int MostPanels = 10000;

HorizonLine LineOf(const v1::HorizonMask& mask) {
  if (mask.elevation_deg().empty()) {
    return HorizonLine();
  }
  return HorizonLine({mask.elevation_deg().begin(), mask.elevation_deg().end()}, mask.first_deg());
}

// A point on a path about a body.
dspace::ContactTarget CraftOf(const std::shared_ptr<const KernelSet>& kernels,
                              v1::ContactTarget& asked, const std::string& label) {
  const TrajectorySource source = ToSource(*asked.mutable_path(), label);
  const std::string& center = asked.body().empty() ? source.center : asked.body();
  if (center.empty()) {
    Reject(label, "neither it nor its path names the body that the path is about; accepted: a "
                  "body's name or NAIF id");
  }
  const std::string& axes = !asked.axes().empty()   ? asked.axes()
                            : !source.frame.empty() ? source.frame
                                                    : "J2000";
  dspace::CelestialPlace place;
  place.body = kernels->GetEphemeris().Names().IdOf(center);
  place.axes = kernels->GetFrames().Table().Get(axes).name;
  dspace::ContactTarget target;
  target.body = place.body;
  target.point = [place, path = source.path, label, kernels](double tdb) {
    Pose X;
    X.position = PositionAt(*path, tdb, label);
    return SkyPlaceOf(*kernels, place, X);
  };
  return target;
}

dspace::ContactTarget TargetOf(const Context& context, v1::ContactTarget& asked,
                               const std::string& label) {
  const SkyMotions& sky = context.scene->sky;
  if (asked.moving_case() != v1::ContactTarget::MOVING_NOT_SET &&
      (asked.has_station() || asked.upper() || asked.station_mask_deg() != 0.0)) {
    Reject(label, "it moves along a path or with a frame, and has a station, its mask or an upper "
                  "limb; accepted: those of bodies");
  }
  if (!asked.has_path() && !asked.axes().empty()) {
    Reject(label, "it has axes '" + asked.axes() + "' and no path; accepted: axes of a path");
  }
  if (asked.has_path()) {
    return CraftOf(sky.kernels, asked, label);
  }
  dspace::ContactTarget target;
  if (asked.has_at()) {
    if (!asked.body().empty()) {
      Reject(label, "it has a frame and the body '" + asked.body() + "'; accepted: one of them");
    }
    target.point = TimedPlaceOnFrame(context, asked.at()).at;
    return target;
  }
  target.body = sky.kernels->GetEphemeris().Names().IdOf(asked.body());
  if (asked.has_station()) {
    v1::CelestialPlace place;
    place.set_body(asked.body());
    *place.mutable_site() = asked.station();
    target.point = [station = SkyPlaceOf(*sky.kernels, sky.PlaceOf(place), Pose())](double) {
      return station;
    };
    target.stationMask_deg = asked.station_mask_deg();
  }
  return target;
}

template<class Message>
void RunWork(const Context& context, const Message& command, const Deadline& deadline,
             Works::Compute compute) {
  context.state.works->Run(
      context.reply,
      {command.has_wait_s() ? std::optional<double>(command.wait_s()) : std::nullopt, deadline,
       context.scene->sky.kernels},
      std::move(compute));
}

template<class Message> Deadline DeadlineOf(const Message& command, const std::string& name) {
  return {command.has_deadline_s() ? std::optional<double>(command.deadline_s()) : std::nullopt,
          name, "fewer steps"};
}

void TrackSky(const Context& context, v1::TrackSky& command) {
  const std::string name = "command track_sky";
  const std::shared_ptr<const KernelSet> kernels = context.scene->sky.kernels;
  const TimedPlace place = TimedPlaceUnderSky(context, command.place(), name);
  const dspace::ContactTarget target =
      TargetOf(context, *command.mutable_target(), name + ", its target");
  if (command.time_s_size() > MostSteps) {
    Reject(name, std::to_string(command.time_s_size()) + " times; accepted: 1 to 2,000,000");
  }
  if (command.time_s().empty()) {
    command.add_time_s(context.GetScene().Time());
  }
  const std::vector<double> times(command.time_s().begin(), command.time_s().end());
  const Deadline none({}, name, "");
  RunWork(context, command, none, [=](v1::Reply& reply, const Works::Proceed& proceed) {
    v1::SkyTrackReply track;
    const HorizonLine level;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double tdb = times[i];
      proceed(double(i) / double(times.size()));
      FallbackScope::Begin(tdb);
      const Sighted seen = LookOver(kernels->GetEphemeris(), kernels->GetFrames(), place.at(tdb),
                                    level, target, tdb);
      track.add_azimuth_deg(seen.direction.azimuth_deg);
      track.add_elevation_deg(seen.direction.elevation_deg);
      track.add_range(seen.range);
      track.add_time_s(tdb);
    }
    reply.mutable_sky_track()->Swap(&track);
  });
}

void Put(double time, const Sighted& seen, v1::ContactsReply::Moment* moment) {
  moment->set_time_s(time);
  moment->set_azimuth_deg(seen.direction.azimuth_deg);
  moment->set_elevation_deg(seen.direction.elevation_deg);
  moment->set_range(seen.range);
}

void SearchContacts(const Context& context, v1::FindContacts& command) {
  const std::string name = "command find_contacts";
  const std::shared_ptr<const KernelSet> kernels = context.scene->sky.kernels;
  const TimedPlace place = TimedPlaceUnderSky(context, command.place(), name);
  if (command.target_size() < 1 || command.target_size() > MostTargets) {
    Reject(name, std::to_string(command.target_size()) + " targets; accepted: 1 to 1,000");
  }
  constexpr double Standard = 60.0; // [s]
  const double step = command.step_s() == 0.0 ? Standard : command.step_s();
  const HorizonLine horizon = LineOf(command.mask());
  const double start = command.start_s();
  const double end = command.end_s();
  RequireSpan(start, end, step);
  struct Target {
    dspace::ContactTarget target;
    bool upper = false;
  };
  std::vector<Target> targets;
  for (int i = 0; i < command.target_size(); ++i) {
    targets.push_back(
        {TargetOf(context, *command.mutable_target(i), name + ", target " + std::to_string(i)),
         command.target(i).upper()});
  }
  const Deadline deadline = DeadlineOf(command, name);
  RunWork(context, command, deadline, [=](v1::Reply& reply, const Works::Proceed& proceed) {
    v1::ContactsReply contacts;
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const auto look = [&](double tdb) {
        proceed((double(i) + (tdb - start) / (end - start)) / double(targets.size()));
        FallbackScope::Begin(tdb);
        return LookOver(kernels->GetEphemeris(), kernels->GetFrames(), place.at(tdb), horizon,
                        targets[i].target, tdb, targets[i].upper);
      };
      for (const Contact& found : FindContacts(look, start, end, step)) {
        v1::ContactsReply::Contact* contact = contacts.add_contact();
        contact->set_target(std::uint32_t(i));
        Put(found.rise, found.atRise, contact->mutable_rise());
        Put(found.set, found.atSet, contact->mutable_set());
        Put(found.peak, found.atPeak, contact->mutable_peak());
        contact->set_since_before(found.sinceBefore);
        contact->set_until_after(found.untilAfter);
      }
    }
    reply.mutable_contacts()->Swap(&contacts);
  });
}

SolarPanel PanelOf(const v1::ProfilePower::Panel& asked, const std::string& label) {
  SolarPanel panel;
  panel.efficiency = asked.has_efficiency() ? asked.efficiency() : 1.0;
  if (asked.has_projected()) {
    if (asked.has_normal() || asked.area() != 0.0 ||
        asked.tracking() != v1::ProfilePower::Panel::FIXED) {
      Reject(label, "it has projected areas, and a normal, an area or a tracking; accepted: one or "
                    "the other");
    }
    const v1::ProfilePower::ProjectedAreas& areas = asked.projected();
    panel.projected = std::make_shared<DirectionTable>(
        std::vector<double>(areas.area().begin(), areas.area().end()), areas.azimuths(),
        areas.lowest_deg(), areas.highest_deg());
    return panel;
  }
  switch (asked.tracking()) {
  case v1::ProfilePower::Panel::FIXED:
    break;
  case v1::ProfilePower::Panel::VERTICAL:
    panel.tracking = SolarPanel::Tracking::Vertical;
    break;
  case v1::ProfilePower::Panel::FULL:
    panel.tracking = SolarPanel::Tracking::Full;
    break;
  default:
    Reject(label, "its tracking is " + std::to_string(int(asked.tracking())) +
                      "; accepted: FIXED, VERTICAL, FULL");
  }
  if (asked.has_normal()) {
    panel.normal = ToVector(asked.normal());
  }
  panel.area = asked.area();
  return panel;
}

void Put(const PowerProfile& profile, bool battery, v1::PowerProfileReply& reply) {
  for (const PowerSample& sample : profile.samples) {
    reply.add_time_s(sample.time);
    reply.add_sun_azimuth_deg(sample.sun.azimuth_deg);
    reply.add_sun_elevation_deg(sample.sun.elevation_deg);
    reply.add_lit(sample.lit);
    reply.add_power(sample.power);
    if (battery) {
      reply.add_charge(sample.charge);
    }
  }
  reply.set_lit_share(profile.litShare);
  reply.set_energy(profile.energy);
  reply.set_longest_night_s(profile.longestNight);
  reply.set_night_start_s(profile.nightStart);
  reply.set_least_charge(profile.leastCharge);
  reply.set_empty_s(profile.empty);
  reply.set_missing(profile.missing);
}

void ProfilePowerOf(const Context& context, v1::ProfilePower& command) {
  const std::string name = "command profile_power";
  const std::shared_ptr<const KernelSet> kernels = context.scene->sky.kernels;
  const TimedPlace timed = TimedPlaceUnderSky(context, command.place(), name);
  if (timed.moves) {
    Reject(name, "its place moves along a trajectory; accepted: a place that rests on its body");
  }
  const dspace::SkyPlace place = timed.at(command.start_s());
  if (command.panel_size() > MostPanels) {
    Reject(name, std::to_string(command.panel_size()) + " panels; accepted: at most 10,000");
  }
  std::vector<SolarPanel> panels;
  for (int i = 0; i < command.panel_size(); ++i) {
    panels.push_back(PanelOf(command.panel(i), "panel " + std::to_string(i)));
  }
  std::optional<Battery> battery;
  if (command.has_battery()) {
    const v1::ProfilePower::Battery& asked = command.battery();
    battery.emplace();
    battery->capacity = asked.capacity_wh();
    battery->load = asked.load();
    battery->initial = asked.has_charge() ? asked.charge() : 1.0;
    battery->charging = asked.has_charging() ? asked.charging() : 1.0;
  }
  constexpr double Standard = 3600.0; // [s]
  const double start = command.start_s();
  const double end = command.end_s();
  const double step = command.step_s() == 0.0 ? Standard : command.step_s();
  const HorizonLine horizon = LineOf(command.mask());
  const Deadline deadline = DeadlineOf(command, name);
  RunWork(context, command, deadline, [=](v1::Reply& reply, const Works::Proceed& proceed) {
    const PowerProfile profile =
        ProfilePower(kernels->GetEphemeris(), kernels->GetFrames(), place, horizon, panels, battery,
                     SolarConstant, start, end, step,
                     [&](double tdb) { proceed((tdb - start) / (end - start)); });
    Put(profile, battery.has_value(), *reply.mutable_power_profile());
  });
}

} // namespace

void AddVisibilityRequests(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kTrackSky, &C::mutable_track_sky, TrackSky);
  registry.Add(C::kFindContacts, &C::mutable_find_contacts, SearchContacts);
  registry.Add(C::kProfilePower, &C::mutable_profile_power, ProfilePowerOf);
}

} // namespace dspace::session
