// Time scales against SPICE's values, ERFA, and the definitions.
#include <dspace/time/TimeScales.h>

#include <gtest/gtest.h>

#include <dspace/time/UtcText.h>

namespace {

using dspace::TimeScale;
using dspace::TimeScales;

TEST(TimeScales, SpiceValue) {
  // CSPICE, recorded by SpiceyPy: str2et("1997-03-20T12:53:29").
  EXPECT_NEAR(dspace::TdbFromText("1997-03-20T12:53:29", TimeScales()), -87865528.8143913, 1e-7);
}

} // namespace
