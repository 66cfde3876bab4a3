// Spacecraft clocks of SCLK kernels.
#include <cmath>

#include <TestData.h>

#include <dspace/Error.h>
#include <dspace/kernels/ClockKernel.h>
#include <dspace/kernels/LeapSecondKernel.h>

namespace {

using namespace dspace;

// Two partitions, a rate that changes, TDB as parallel time: ticks of 1/10 s.
const char* const Small = "\\begindata\n"
                          "SCLK_DATA_TYPE_77 = 1\n"
                          "SCLK01_TIME_SYSTEM_77 = 1\n"
                          "SCLK01_N_FIELDS_77 = 2\n"
                          "SCLK01_MODULI_77 = ( 1000 10 )\n"
                          "SCLK01_OFFSETS_77 = ( 0 1 )\n"
                          "SCLK01_OUTPUT_DELIM_77 = 2\n"
                          "SCLK_PARTITION_START_77 = ( 100 0 )\n"
                          "SCLK_PARTITION_END_77 = ( 600 1000 )\n"
                          "SCLK01_COEFFICIENTS_77 = ( 0 1000 1.0  500 1050 2.0 )\n";

ClockKernel SmallClock(const std::string& more = "") {
  KernelPool pool;
  pool.Add(TextKernel::Parse(Small + more, "small.tsc"));
  return ClockKernel(pool, -77, TimeScales());
}

TEST(ClockKernel, PartitionsFieldsAndRatesByHand) {
  const ClockKernel clock = SmallClock();
  EXPECT_EQ(clock.LastTick(), 1500.0); // 500 and 1000
  EXPECT_EQ(clock.TicksACount(), 10.0);
  EXPECT_EQ(clock.TdbOf(0.0), 1000.0);
  EXPECT_EQ(clock.TdbOf(255.0), 1025.5);
  EXPECT_EQ(clock.TdbOf(600.0), 1070.0); // 10 counts of 2 s
  EXPECT_EQ(clock.TicksOf(1070.0), 600.0);
  EXPECT_EQ(clock.TicksOf(1025.5), 255.0);
  // The second field counts from 1: 12:4 is 12 counts and 3 ticks.
  EXPECT_EQ(clock.TicksOfText("1/12:4"), 23.0);
  EXPECT_EQ(clock.TicksOfText("12.4"), 23.0);
  EXPECT_EQ(clock.TicksOfText("2/12:4"), 623.0);
  EXPECT_EQ(clock.TicksOfText("5:1"), 550.0); // before the first partition's start: the second
  EXPECT_EQ(clock.TextOf(23.0), "1/012:04");
  EXPECT_EQ(clock.TextOf(623.0), "2/012:04");
  EXPECT_EQ(clock.TextOf(500.0), "2/000:01");
}

TEST(ClockKernel, RejectsWhatIsOutsideAndDamagedKernels) {
  const ClockKernel clock = SmallClock();
  for (const char* bad : {"", "x", "3/1:1", "0/1:1", "/1:1", "1/12:0", "1/12:11", "1/1000:1",
                          "1/1:1:1", "1/700:1", "1//1", "1/12::3"}) {
    EXPECT_THROW(clock.TicksOfText(bad), Error) << bad;
  }
  EXPECT_THROW(clock.TdbOf(-1.0), Error);
  EXPECT_THROW(clock.TdbOf(1501.0), Error);
  EXPECT_THROW(clock.TicksOf(999.0), Error);
  EXPECT_THROW(clock.TicksOf(std::nan("")), Error);
  try {
    clock.TicksOf(5000.0);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("accepted: 1000 to 1250"), std::string::npos)
        << error.what();
  }
  for (const char* bad :
       {"SCLK_DATA_TYPE_77 = 2\n", "SCLK01_TIME_SYSTEM_77 = 3\n", "SCLK01_N_FIELDS_77 = 3\n",
        "SCLK01_MODULI_77 = ( 1000 0 )\n", "SCLK_PARTITION_END_77 = ( 50 1000 )\n",
        "SCLK01_COEFFICIENTS_77 = ( 0 1000 1 0 2000 1 )\n", "SCLK01_COEFFICIENTS_77 = ( 0 1000 )\n",
        "SCLK01_COEFFICIENTS_77 = ( 0 1000 0 )\n", "SCLK01_OUTPUT_DELIM_77 = 9\n",
        "SCLK_PARTITION_END_77 = ( 600 1000 2000 )\n"}) {
    EXPECT_THROW(SmallClock(bad), Error) << bad;
  }
  KernelPool pool;
  pool.Add(TextKernel::Parse(Small, "small.tsc"));
  EXPECT_THROW(ClockKernel(pool, -82, TimeScales()), Error);
  EXPECT_EQ(ClockKernel::Clocks(pool), std::vector<int>({-77}));
}

TEST(ClockKernel, Cassini) {
  DSPACE_REAL_DATA(folder, "ephemeris");
  KernelPool pool;
  pool.Add(TextKernel::Read(folder + "/naif0012.tls"));
  pool.Add(TextKernel::Read(folder + "/spice_test_kernels/cas00167.tsc"));
  const TimeScales scales = TimeScalesOf(pool);
  const ClockKernel clock(pool, -82, scales);
  // A row of the kernel itself: ticks and TT.
  EXPECT_NEAR(clock.TdbOf(2.7459139517500e11), scales.TdbFromTt(4.4142408718400e8), 1e-7);
  // NAIF's lessons ("In-situ Sensing Hands-On Lesson") have 140254384.183426 with cas00084.tsc, a
  // prediction for that day, which this kernel replaces by what was measured: 0.12 s away.
  EXPECT_NEAR(clock.TdbOf(clock.TicksOfText("1465674964.105")), 140254384.183426, 0.2);
  // A text and its ticks are each other's, at ten thousand times.
  for (int i = 0; i < 10000; ++i) {
    const double ticks = std::floor(2.0e11 + 7.0e6 * i);
    EXPECT_EQ(clock.TicksOfText(clock.TextOf(ticks)), ticks);
    EXPECT_NEAR(clock.TicksOf(clock.TdbOf(ticks)), ticks, 1e-3);
  }
}

} // namespace
