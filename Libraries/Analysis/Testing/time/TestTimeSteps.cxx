// Steps before an end that rounding and TDB move.
#include <gtest/gtest.h>

#include <dspace/time/TimeSteps.h>
#include <dspace/time/UtcText.h>

namespace dspace {
namespace {

TEST(TimeSteps, TheEndIsNoStep) {
  EXPECT_EQ(StepsBefore(0.0, 7200.0, 3600.0), 2);
  EXPECT_EQ(StepsBefore(0.0, 7201.0, 3600.0), 3);
  EXPECT_EQ(StepsBefore(0.0, 7199.0, 3600.0), 2);
  EXPECT_EQ(StepsBefore(0.0, 1.0, 3600.0), 1);
  EXPECT_EQ(StepsBefore(0.0, 1e-6, 3600.0), 1);
  EXPECT_EQ(StepsBefore(7e8, 7e8 + 0.3, 0.1), 3); // eps of the times is 1e-7
  EXPECT_EQ(StepsBefore(0.0, 7200.0 + 1e-5, 3600.0), 2);
  EXPECT_EQ(StepsBefore(0.0, 7200.0 - 1e-5, 3600.0), 2);
}

TEST(TimeSteps, TextsAreWholeStepsApart) {
  struct Span {
    const char *start, *end;
    std::int64_t hours;
  };
  for (const Span& span : {Span{"2022-11-08T12:00", "2022-11-08T14:00", 2},
                           Span{"2022-11-20T08:00", "2022-11-20T14:00", 6},
                           Span{"2026-01-01T00:00", "2027-01-01T00:00", 8760},
                           Span{"2024-01-03T00:00", "2024-07-04T00:00", 4392}}) {
    EXPECT_EQ(StepsBefore(TdbFromText(span.start, TimeScales()),
                          TdbFromText(span.end, TimeScales()), 3600.0),
              span.hours)
        << span.start;
  }
}

} // namespace
} // namespace dspace
