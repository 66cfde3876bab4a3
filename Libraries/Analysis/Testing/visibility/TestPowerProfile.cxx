// Panels and batteries: closed forms.
#include <cmath>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/visibility/PowerProfile.h>

namespace {

using namespace dspace;

TEST(PowerProfile, PanelsSeeTheCosine) {
  const Eigen::Vector3d sun(0.6, 0.0, 0.8);
  SolarPanel panel;
  panel.area = 2.0;
  panel.efficiency = 0.3;
  EXPECT_NEAR(PanelPower(panel, sun, 1000.0), 0.8 * 600.0, 1e-9);
  panel.normal = -Eigen::Vector3d::UnitX();
  EXPECT_EQ(PanelPower(panel, sun, 1000.0), 0.0);
  panel.tracking = SolarPanel::Tracking::Vertical;
  EXPECT_NEAR(PanelPower(panel, sun, 1000.0), 0.6 * 600.0, 1e-9);
  panel.tracking = SolarPanel::Tracking::Full;
  EXPECT_NEAR(PanelPower(panel, sun, 1000.0), 600.0, 1e-9);
}

// 100 W h: 360,000 J.
TEST(PowerProfile, BatteryFillsDrainsAndRunsEmpty) {
  Battery battery;
  battery.capacity = 100.0;
  battery.charging = 0.9;
  // Charges with losses, and stops when it is full.
  EXPECT_NEAR(StepBattery(battery, 1000.0, 10.0, 10.0, 100.0).charge, 1900.0, 1e-9);
  EXPECT_NEAR(StepBattery(battery, 359990.0, 10.0, 10.0, 100.0).charge, 360000.0, 1e-9);
  // Drains without.
  const BatteryStep drained = StepBattery(battery, 1000.0, -4.0, -6.0, 100.0);
  EXPECT_NEAR(drained.charge, 500.0, 1e-9);
  EXPECT_NEAR(drained.least, 500.0, 1e-9);
  EXPECT_EQ(drained.empty, 0.0);
  // A surplus that falls from 0 to -20 W in 100 s has drained 0.1 t^2 J: 250 J after 50 s.
  const BatteryStep spent = StepBattery(battery, 250.0, 0.0, -20.0, 100.0);
  EXPECT_EQ(spent.charge, 0.0);
  EXPECT_NEAR(spent.empty, 50.0, 1e-9);
  EXPECT_NEAR(spent.missing, 750.0, 1e-9);
  // From -10 W up to 10 W in 100 s: 250 J out, of which 100 J were there, then 225 J in.
  const BatteryStep turned = StepBattery(battery, 100.0, -10.0, 10.0, 100.0);
  EXPECT_NEAR(turned.charge, 225.0, 1e-9);
  EXPECT_EQ(turned.least, 0.0);
  EXPECT_NEAR(turned.missing, 150.0, 1e-9);
  // 10 t - 0.1 t^2 = 100.
  EXPECT_NEAR(turned.empty, 50.0 - (50.0 - std::sqrt(2500.0 - 1000.0)), 1e-9);
  // An empty one stays empty.
  EXPECT_NEAR(StepBattery(battery, 0.0, -5.0, -5.0, 10.0).empty, 10.0, 1e-12);
}

} // namespace
