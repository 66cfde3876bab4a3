// The power of solar panels over a span of time, and a battery that it charges.
#ifndef DSPACE_VISIBILITY_POWER_PROFILE_H
#define DSPACE_VISIBILITY_POWER_PROFILE_H

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <dspace/sky/SkyView.h>
#include <dspace/visibility/DirectionTable.h>
#include <dspace/visibility/HorizonLine.h>

namespace dspace {

// A flat panel at a place.
struct SolarPanel {
  // How it turns to the Sun. Vertical: about the vertical only, its normal level.
  enum class Tracking { None, Vertical, Full };
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ(); // unit: east, north, up; without tracking
  Tracking tracking = Tracking::None;
  double area = 1.0;       // [m^2]
  double efficiency = 1.0; // 0 to 1; the temperature of the cells does not count
  // In place of normal, tracking and area: the area projected towards each direction that the Sun
  // lights [m^2], with the shadows of what is at the place; null: none. It does not turn.
  std::shared_ptr<const DirectionTable> projected;
};

// The power [W] of a panel at an irradiance [W/m^2] from a unit direction (east, north, up). 0 for
// its back.
double PanelPower(const SolarPanel& panel, const Eigen::Vector3d& towardsSun, double irradiance);

struct Battery {
  double capacity = 0.0; // [W h] > 0
  double initial = 1.0;  // charge at the start, 0 to 1 of the capacity
  double load = 0.0;     // [W] that the panels and the battery supply
  double charging = 1.0; // part of the energy that arrives when it charges, 0 to 1
};

struct PowerSample {
  double time = 0.0; // TDB [s past J2000]
  AzimuthElevation sun;
  double lit = 0.0;    // part of the Sun's disc that is seen, 0 to 1
  double power = 0.0;  // [W] of all panels
  double charge = 0.0; // of the battery, 0 to 1; NaN without one
};

struct PowerProfile {
  std::vector<PowerSample> samples;
  double litShare = 0.0;     // mean of `lit` over the span
  double energy = 0.0;       // [J] of all panels over the span
  double longestNight = 0.0; // [s] without any of the Sun's disc, to 1e-3 s; nights cut by the
                             // span's ends count as they are
  double nightStart = 0.0;   // TDB [s past J2000] of the longest night; NaN: there is none
  double leastCharge = 0.0;  // 0 to 1; NaN without a battery
  double empty = 0.0;   // [s] in which the battery is empty and the panels do not supply the load
  double missing = 0.0; // [J] that the load lacks in that time
};

// The Sun over a place with a horizon, from `start` to `end` (the last step may be shorter). The
// power between two samples is linear. Irradiance: `solarConstant` [W/m^2] at 1 au, over the square
// of the distance, times the part of the disc above the horizon (of even radiance), times the part
// that the Earth leaves over places on the Moon, and the Moon over places on the Earth: eclipses,
// by discs of their largest radii, without the Earth's air. Nights are those of the horizon alone.
// `check` is called at each step with its time; what it throws ends the work. Throws
// Error(InvalidArgument) as FindContacts, and for values out of range.
PowerProfile ProfilePower(const Ephemeris& ephemeris, const Frames& frames, const SkyPlace& place,
                          const HorizonLine& horizon, const std::vector<SolarPanel>& panels,
                          const std::optional<Battery>& battery, double solarConstant, double start,
                          double end, double step,
                          const std::function<void(double tdb)>& check = {});

// One step of a battery from a charge [J], with the panels' power less the load linear in between.
struct BatteryStep {
  double charge = 0.0;  // [J] at the end
  double least = 0.0;   // [J] in between
  double empty = 0.0;   // [s]
  double missing = 0.0; // [J]
};
BatteryStep StepBattery(const Battery& battery, double charge, double surplusBefore,
                        double surplusAfter, double seconds);

} // namespace dspace

#endif
