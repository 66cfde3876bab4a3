#include <dspace/widgets/timeline/TimeTexts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include <dspace/overlay/RoundNumbers.h>

namespace dspace::widgets {
namespace {

constexpr std::int64_t Day_ms = 86400000;
constexpr double Day = 86400.0;
constexpr double FarthestTime = 10000.0 * 365.25 * Day;
constexpr std::int64_t TtMinusTai_ms = 32184;
constexpr std::int64_t J2000Day = 10957; // 2000-01-01 in days after 1970-01-01

// Since the beginning of `day` (days after 1970-01-01, UTC), TAI - UTC is `offset` [s].
struct LeapSecond {
  std::int64_t day;
  std::int64_t offset;
};
constexpr std::array<LeapSecond, 28> LeapSeconds = {
    {{730, 10},   {912, 11},   {1096, 12},  {1461, 13},  {1826, 14},  {2191, 15},  {2557, 16},
     {2922, 17},  {3287, 18},  {3652, 19},  {4199, 20},  {4564, 21},  {4929, 22},  {5660, 23},
     {6574, 24},  {7305, 25},  {7670, 26},  {8217, 27},  {8582, 28},  {8947, 29},  {9496, 30},
     {10043, 31}, {10592, 32}, {13149, 33}, {14245, 34}, {15522, 35}, {16617, 36}, {17167, 37}}};

double TdbMinusTt(double tdb_s) {
  const double T = tdb_s / (36525.0 * Day);
  return 0.001657 * std::sin(628.3076 * T + 6.2401) + 0.000022 * std::sin(575.3385 * T + 4.2970) +
         0.000014 * std::sin(1256.6152 * T + 6.1969) + 0.000005 * std::sin(606.9777 * T + 4.0212) +
         0.000005 * std::sin(52.9691 * T + 0.4444) + 0.000002 * std::sin(21.3299 * T + 5.5431) +
         0.000010 * T * std::sin(628.3076 * T + 4.2490);
}

std::int64_t FloorDivide(std::int64_t a, std::int64_t b) {
  return a / b - (a % b < 0 ? 1 : 0);
}

// Of the proleptic Gregorian calendar; `day` is counted from 1970-01-01 (Hinnant, "chrono-
// Compatible Low-Level Date Algorithms", civil_from_days).
void DateOf(std::int64_t day, int& year, int& month, int& dayOfMonth) {
  const std::int64_t z = day + 719468;
  const std::int64_t era = FloorDivide(z, 146097);
  const std::int64_t doe = z - era * 146097;
  const std::int64_t yoe = (doe - doe / 1460 + doe / 36524 - doe / 146096) / 365;
  const std::int64_t doy = doe - (365 * yoe + yoe / 4 - yoe / 100);
  const std::int64_t mp = (5 * doy + 2) / 153;
  dayOfMonth = int(doy - (153 * mp + 2) / 5 + 1);
  month = int(mp < 10 ? mp + 3 : mp - 9);
  year = int(yoe + era * 400 + (month <= 2 ? 1 : 0));
}

// `ms` of the day; a leap second is behind the last one.
std::string DateText(std::int64_t day, std::int64_t ms, const char* scale) {
  int year = 0, month = 0, dayOfMonth = 0;
  DateOf(day, year, month, dayOfMonth);
  const std::int64_t minutes = ms >= Day_ms ? 1439 : ms / 60000;
  const std::int64_t rest = ms - 60000 * minutes;
  char text[64];
  std::snprintf(text, sizeof(text), "%04d-%02d-%02d %02d:%02d:%02d.%03d %s", year, month,
                dayOfMonth, int(minutes / 60), int(minutes % 60), int(rest / 1000),
                int(rest % 1000), scale);
  return text;
}

} // namespace

std::string UtcText(double tdb_s) {
  if (!(std::abs(tdb_s) <= FarthestTime)) {
    return "";
  }
  // Milliseconds after 1970-01-01 00:00:00 of TT, then of TAI.
  const std::int64_t tt_ms =
      std::llround((tdb_s - TdbMinusTt(tdb_s)) * 1000.0) + J2000Day * Day_ms + Day_ms / 2;
  const std::int64_t tai_ms = tt_ms - TtMinusTai_ms;
  for (auto leap = LeapSeconds.rbegin(); leap != LeapSeconds.rend(); ++leap) {
    const std::int64_t begin_ms = leap->day * Day_ms + 1000 * leap->offset;
    if (tai_ms >= begin_ms) {
      const std::int64_t utc_ms = tai_ms - 1000 * leap->offset;
      const std::int64_t day = FloorDivide(utc_ms, Day_ms);
      return DateText(day, utc_ms - day * Day_ms, "UTC");
    }
    // In the second before it, which the first of them does not have.
    if (tai_ms >= begin_ms - 1000 && leap + 1 != LeapSeconds.rend()) {
      return DateText(leap->day - 1, tai_ms - (begin_ms - 1000) + Day_ms, "UTC");
    }
  }
  const std::int64_t day = FloorDivide(tt_ms, Day_ms);
  return DateText(day, tt_ms - day * Day_ms, "TT");
}

std::string ElapsedText(double seconds) {
  if (!(std::abs(seconds) <= 1e15)) {
    return "";
  }
  const std::int64_t ms = std::llround(seconds * 1000.0);
  const std::int64_t size = ms < 0 ? -ms : ms;
  const std::int64_t rest = size % Day_ms;
  char text[64];
  std::snprintf(text, sizeof(text), "%02d:%02d:%02d.%03d", int(rest / 3600000),
                int(rest / 60000 % 60), int(rest / 1000 % 60), int(rest % 1000));
  const std::string days = size >= Day_ms ? std::to_string(size / Day_ms) + " d " : std::string();
  return (ms < 0 ? "T- " : "T+ ") + days + text;
}

std::string TickText(double seconds, double step_s) {
  if (step_s < 60.0 && std::abs(seconds) < 60.0) {
    return RoundText(seconds, step_s);
  }
  const std::string sign = seconds < 0.0 ? "-" : "";
  if (step_s >= Day) {
    return sign + RoundText(std::abs(seconds) / Day, step_s / Day) + " d";
  }
  // The nearest multiple, with its whole seconds and the decimals that the step needs.
  const double size = std::abs(std::round(seconds / step_s) * step_s);
  auto whole = std::int64_t(std::floor(size + 1e-6));
  std::string fraction;
  if (step_s < 1.0) {
    fraction = RoundText(std::max(size - double(whole), 0.0), step_s).substr(1); // without the 0
  }
  const std::int64_t days = whole / std::int64_t(Day);
  whole %= std::int64_t(Day);
  char text[64];
  if (days > 0) {
    std::snprintf(text, sizeof(text), "%d d %02d:%02d", int(days), int(whole / 3600),
                  int(whole / 60 % 60));
  } else if (whole >= 3600) {
    std::snprintf(text, sizeof(text), "%d:%02d", int(whole / 3600), int(whole / 60 % 60));
  } else {
    std::snprintf(text, sizeof(text), "%d", int(whole / 60));
  }
  std::string all = text;
  if (days == 0 || step_s < 60.0) {
    std::snprintf(text, sizeof(text), ":%02d", int(whole % 60));
    all += text;
  }
  return sign + all + fraction;
}

double TimeStep(double low_s, double high_s, int count) {
  const double step = RoundStep(low_s, high_s, count, false);
  if (step <= 50.0) {
    return step;
  }
  for (const double round :
       {60.0, 120.0, 300.0, 600.0, 900.0, 1800.0, 3600.0, 7200.0, 10800.0, 21600.0, 43200.0, Day}) {
    if (std::floor(high_s / round) - std::ceil(low_s / round) + 1.0 <= count) {
      return round;
    }
  }
  return Day * std::max(1.0, RoundStep(low_s / Day, high_s / Day, count, false));
}

} // namespace dspace::widgets
