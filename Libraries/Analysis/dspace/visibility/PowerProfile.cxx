#include <dspace/visibility/PowerProfile.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <dspace/Checks.h>
#include <dspace/ephemeris/BodyNames.h>
#include <dspace/ephemeris/Fallbacks.h>
#include <dspace/sky/SkyEclipse.h>
#include <dspace/time/TimeSteps.h>
#include <dspace/visibility/Contacts.h>

namespace dspace {
namespace {

constexpr double JoulesPerWattHour = 3600.0;

void Check(const std::vector<SolarPanel>& panels, const std::optional<Battery>& battery) {
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const std::string label = "panel " + std::to_string(i);
    const SolarPanel& panel = panels[i];
    Require(panel.area > 0.0 && panel.area <= 1e9, label, "its area", panel.area,
            "above 0 to 1e9 m^2");
    RequireFraction(label, "its efficiency", panel.efficiency);
    if (panel.tracking == SolarPanel::Tracking::None &&
        !(std::abs(panel.normal.norm() - 1.0) < 1e-6)) {
      Reject(label, "its normal is " + VectorText(panel.normal) +
                        "; accepted: a unit vector (east, north, up)");
    }
  }
  if (battery) {
    Require(battery->capacity > 0.0 && battery->capacity <= 1e12, "battery", "its capacity",
            battery->capacity, "above 0 to 1e12 W h");
    RequireFraction("battery", "its charge at the start", battery->initial);
    RequireFraction("battery", "its charging efficiency", battery->charging);
    Require(battery->load >= 0.0 && battery->load <= 1e12, "battery", "the load", battery->load,
            "0 to 1e12 W");
  }
}

// A piece of a step in which the surplus does not change its sign: `energy` is its integral,
// `before` and `after` the surplus at its ends.
void Advance(const Battery& battery, BatteryStep& state, double before, double after,
             double seconds) {
  const double energy = 0.5 * (before + after) * seconds;
  if (energy >= 0.0) {
    state.charge =
        std::min(state.charge + battery.charging * energy, battery.capacity * JoulesPerWattHour);
    return;
  }
  if (state.charge + energy >= 0.0) {
    state.charge += energy;
  } else {
    // The time at which the charge is spent: before t + (after - before) t^2 / (2 seconds) =
    // -charge.
    const double a = 0.5 * (after - before) / seconds;
    const double root = std::sqrt(std::max(0.0, before * before - 4.0 * a * state.charge));
    const double spent = state.charge <= 0.0 ? 0.0 : 2.0 * state.charge / (-before + root);
    state.empty += std::max(0.0, seconds - spent);
    state.missing += -energy - state.charge;
    state.charge = 0.0;
  }
  state.least = std::min(state.least, state.charge);
}

} // namespace

double PanelPower(const SolarPanel& panel, const Eigen::Vector3d& towardsSun, double irradiance) {
  if (panel.projected) {
    return irradiance * panel.efficiency * panel.projected->At(ToAzimuthElevation(towardsSun));
  }
  double cosine = 0.0;
  switch (panel.tracking) {
  case SolarPanel::Tracking::None:
    cosine = panel.normal.dot(towardsSun);
    break;
  case SolarPanel::Tracking::Vertical:
    cosine = std::hypot(towardsSun.x(), towardsSun.y());
    break;
  case SolarPanel::Tracking::Full:
    cosine = 1.0;
    break;
  }
  return std::max(0.0, cosine) * irradiance * panel.area * panel.efficiency;
}

BatteryStep StepBattery(const Battery& battery, double charge, double surplusBefore,
                        double surplusAfter, double seconds) {
  BatteryStep state;
  state.charge = charge;
  state.least = charge;
  if (surplusBefore * surplusAfter < 0.0) {
    const double first = seconds * surplusBefore / (surplusBefore - surplusAfter);
    Advance(battery, state, surplusBefore, 0.0, first);
    Advance(battery, state, 0.0, surplusAfter, seconds - first);
  } else {
    Advance(battery, state, surplusBefore, surplusAfter, seconds);
  }
  return state;
}

PowerProfile ProfilePower(const Ephemeris& ephemeris, const Frames& frames, const SkyPlace& place,
                          const HorizonLine& horizon, const std::vector<SolarPanel>& panels,
                          const std::optional<Battery>& battery, double solarConstant, double start,
                          double end, double step, const std::function<void(double tdb)>& check) {
  Check(panels, battery);
  Require(solarConstant >= 0.0 && solarConstant <= 1e9, "power profile", "the irradiance at 1 au",
          solarConstant, "0 to 1e9 W/m^2");
  RequireSpan(start, end, step);
  PowerProfile profile;
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto look = [&](double tdb) {
    if (check) {
      check(tdb);
    }
    FallbackScope::Begin(tdb);
    return Look(ephemeris, frames, place, BodySun, tdb);
  };
  const auto sighted = [&](const SkyBody& sun) {
    return Sighted{
        sun.direction, sun.range,
        horizon.TopOver(sun.direction, std::min(sun.radius_deg, HorizonLine::MostRadius))};
  };
  const auto sample = [&](double tdb, const SkyBody& sun) {
    PowerSample out;
    out.time = tdb;
    out.sun = sun.direction;
    out.lit = horizon.LitFraction(sun.direction, std::min(sun.radius_deg, HorizonLine::MostRadius));
    if (out.lit > 0.0) {
      out.lit *= SunLeftOver(ephemeris, frames, place, sun, tdb);
    }
    const double distance = sun.range / AstronomicalUnit;
    const double irradiance = out.lit * solarConstant / (distance * distance);
    for (const SolarPanel& panel : panels) {
      out.power += PanelPower(panel, sun.eastNorthUp, irradiance);
    }
    out.charge = none;
    return out;
  };
  const std::int64_t count = StepsBefore(start, end, step);
  profile.samples.reserve(std::size_t(count) + 1);
  std::vector<Sighted> seen;
  for (std::int64_t i = 0; i <= count; ++i) {
    const double tdb = i == count ? end : start + double(i) * step;
    const SkyBody sun = look(tdb);
    profile.samples.push_back(sample(tdb, sun));
    seen.push_back(sighted(sun));
  }
  // The search for nights begins with the same times.
  const std::vector<Contact> days = FindContacts(
      [&](double tdb) {
        const auto i = std::size_t(std::llround((tdb - start) / step));
        return i < seen.size() && profile.samples[i].time == tdb ? seen[i] : sighted(look(tdb));
      },
      start, end, step);
  profile.nightStart = none;
  double dark = start;
  const auto night = [&](double until) {
    if (until - dark > profile.longestNight) {
      profile.longestNight = until - dark;
      profile.nightStart = dark;
    }
  };
  for (const Contact& day : days) {
    night(day.rise);
    dark = day.set;
  }
  if (days.empty() || !days.back().untilAfter) {
    night(end);
  }
  double charge = battery ? battery->initial * battery->capacity * JoulesPerWattHour : none;
  double least = charge;
  for (std::size_t i = 0; i < profile.samples.size(); ++i) {
    PowerSample& after = profile.samples[i];
    if (i > 0) {
      const PowerSample& before = profile.samples[i - 1];
      const double seconds = after.time - before.time;
      profile.litShare += 0.5 * (before.lit + after.lit) * seconds;
      profile.energy += 0.5 * (before.power + after.power) * seconds;
      if (battery) {
        const BatteryStep stepped = StepBattery(*battery, charge, before.power - battery->load,
                                                after.power - battery->load, seconds);
        charge = stepped.charge;
        least = std::min(least, stepped.least);
        profile.empty += stepped.empty;
        profile.missing += stepped.missing;
      }
    }
    if (battery) {
      after.charge = charge / (battery->capacity * JoulesPerWattHour);
    }
  }
  profile.litShare /= end - start;
  profile.leastCharge = battery ? least / (battery->capacity * JoulesPerWattHour) : none;
  return profile;
}

} // namespace dspace
