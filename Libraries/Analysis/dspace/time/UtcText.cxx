#include <dspace/time/UtcText.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string_view>

#include <erfa.h>

#include <dspace/Checks.h>
#include <dspace/time/Days.h>

namespace dspace {
namespace {

// Reads a text from left to right.
class TimeParser {
public:
  TimeParser(const std::string& text, const TimeScales& scales) : Text_(text), Scales_(scales) {}

  double Tdb() {
    this->Rest_ = this->Trimmed();
    if (this->Rest_.rfind("JD", 0) == 0) {
      return this->JulianDate();
    }
    const int mjd = this->Date();
    double seconds = 0.0;
    const bool hasTime = !this->Rest_.empty() && (this->Rest_[0] == 'T' || this->Rest_[0] == ' ') &&
                         this->Rest_.size() > 1 && this->IsDigit(1);
    if (hasTime) {
      this->Rest_.remove_prefix(1);
      seconds = this->TimeOfDay();
    }
    const Suffix suffix = this->ReadSuffix();
    return this->Combine(mjd, seconds, suffix);
  }

private:
  struct Suffix {
    TimeScale scale = TimeScale::Utc;
    bool stated = false;
    int offset_min = 0;
  };

  [[noreturn]] void Fail(const std::string& what) const {
    Reject("time '" + this->Text_ + "'",
           what + "; accepted: YYYY-MM-DD or YYYY-DDD, with Thh:mm[:ss[.fff]] and Z, +hh:mm, UTC, "
                  "TAI, TT, TDB or UT1 behind it, or 'JD DAYS TDB'");
  }

  std::string_view Trimmed() const {
    std::string_view text = this->Text_;
    while (!text.empty() && text.front() == ' ') {
      text.remove_prefix(1);
    }
    while (!text.empty() && text.back() == ' ') {
      text.remove_suffix(1);
    }
    return text;
  }

  bool IsDigit(std::size_t at) const {
    return at < this->Rest_.size() && this->Rest_[at] >= '0' && this->Rest_[at] <= '9';
  }

  int Digits(std::size_t count, const char* what) {
    int value = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!this->IsDigit(i)) {
        this->Fail(std::string("its ") + what + " is not " + std::to_string(count) + " digits");
      }
      value = value * 10 + (this->Rest_[i] - '0');
    }
    this->Rest_.remove_prefix(count);
    return value;
  }

  bool Take(char c) {
    if (this->Rest_.empty() || this->Rest_[0] != c) {
      return false;
    }
    this->Rest_.remove_prefix(1);
    return true;
  }

  int Date() {
    const int year = this->Digits(4, "year");
    if (year < 1) {
      this->Fail("its year is 0");
    }
    if (!this->Take('-')) {
      this->Fail("no '-' follows its year");
    }
    double zero = 0.0, mjd = 0.0;
    if (this->IsDigit(2)) { // a day of the year
      const int day = this->Digits(3, "day of the year");
      eraCal2jd(year, 1, 1, &zero, &mjd);
      double next = 0.0;
      eraCal2jd(year + 1, 1, 1, &zero, &next);
      if (day < 1 || day > next - mjd) {
        this->Fail("its day of the year is " + std::to_string(day) + " of " +
                   NumberText(next - mjd));
      }
      return int(mjd) + day - 1;
    }
    const int month = this->Digits(2, "month");
    if (!this->Take('-')) {
      this->Fail("no '-' follows its month");
    }
    const int day = this->Digits(2, "day");
    if (month < 1 || month > 12) {
      this->Fail("its month is " + std::to_string(month));
    }
    if (eraCal2jd(year, month, day, &zero, &mjd) != 0) {
      this->Fail("its month has no day " + std::to_string(day));
    }
    return int(mjd);
  }

  double TimeOfDay() {
    const int hour = this->Digits(2, "hour");
    if (!this->Take(':')) {
      this->Fail("no ':' follows its hour");
    }
    const int minute = this->Digits(2, "minute");
    double second = 0.0;
    if (this->Take(':')) {
      std::size_t length = 2;
      if (!this->IsDigit(0) || !this->IsDigit(1)) {
        this->Fail("its second is not two digits");
      }
      if (length < this->Rest_.size() && this->Rest_[length] == '.') {
        ++length;
        while (this->IsDigit(length)) {
          ++length;
        }
      }
      std::from_chars(this->Rest_.data(), this->Rest_.data() + length, second);
      this->Rest_.remove_prefix(length);
    }
    const bool endOfDay = hour == 24 && minute == 0 && second == 0.0;
    if ((hour > 23 && !endOfDay) || minute > 59 || second >= 61.0) {
      this->Fail("its hour, minute or second is beyond 23, 59 or 59 (60 in a leap second)");
    }
    this->Leaping_ = second >= 60.0;
    return hour * 3600.0 + minute * 60.0 + second;
  }

  Suffix ReadSuffix() {
    Suffix suffix;
    if (this->Rest_.empty()) {
      return suffix;
    }
    suffix.stated = true;
    if (this->Rest_ == "Z") {
      return suffix;
    }
    if (this->Rest_[0] == '+' || this->Rest_[0] == '-') {
      const int sign = this->Rest_[0] == '+' ? 1 : -1;
      this->Rest_.remove_prefix(1);
      const int hours = this->Digits(2, "offset in hours");
      this->Take(':');
      const int minutes = this->Rest_.empty() ? 0 : this->Digits(2, "offset in minutes");
      if (hours > 23 || minutes > 59 || !this->Rest_.empty()) {
        this->Fail("its offset from UTC is not within 23:59");
      }
      suffix.offset_min = sign * (hours * 60 + minutes);
      return suffix;
    }
    while (this->Take(' ')) {
    }
    for (const TimeScale scale :
         {TimeScale::Utc, TimeScale::Tai, TimeScale::Tt, TimeScale::Tdb, TimeScale::Ut1}) {
      if (this->Rest_ == TimeScaleName(scale)) {
        suffix.scale = scale;
        return suffix;
      }
    }
    this->Fail("'" + std::string(this->Rest_) + "' behind it is no time scale");
  }

  double JulianDate() {
    this->Rest_.remove_prefix(2);
    while (this->Take(' ')) {
    }
    // The whole days and their fraction apart: a double of the sum resolves 40 us only.
    double days = 0.0, fraction = 0.0;
    std::size_t whole = 0;
    while (this->IsDigit(whole)) {
      ++whole;
    }
    if (whole == 0 || whole > 8) {
      this->Fail("its Julian date is not a number of days");
    }
    std::from_chars(this->Rest_.data(), this->Rest_.data() + whole, days);
    this->Rest_.remove_prefix(whole);
    if (this->Take('.')) {
      const std::string digits =
          "0." + std::string(this->Rest_.substr(0, this->Rest_.find_first_not_of("0123456789")));
      std::from_chars(digits.data(), digits.data() + digits.size(), fraction);
      this->Rest_.remove_prefix(digits.size() - 2);
    }
    const Suffix suffix = this->ReadSuffix();
    if (!suffix.stated || suffix.offset_min != 0) {
      this->Fail("no time scale follows its Julian date");
    }
    // Midday of the day JD is MJD JD - 2400001 + 0.5.
    const double half = fraction + 0.5;
    const int mjd = int(days) - 2400001 + (half >= 1.0 ? 1 : 0);
    if (mjd < -678575 || mjd > 2973483) {
      this->Fail("its year is beyond 1 to 9999");
    }
    const double ofDay = half >= 1.0 ? half - 1.0 : half;
    return this->Combine(mjd, ofDay * DaySeconds, suffix);
  }

  double Combine(int mjd, double seconds, const Suffix& suffix) const {
    if (this->Leaping_) {
      // Local midnight may be any hour of UTC, but the second is always the last of a day of UTC.
      const double utc = seconds - suffix.offset_min * 60.0;
      const int day = mjd + int(std::floor((utc - 1.0) / DaySeconds));
      const bool real = suffix.scale == TimeScale::Utc &&
                        this->Scales_.GetLeapSeconds().SecondsOfDay(day) == 86401 &&
                        utc - (day - mjd) * DaySeconds >= DaySeconds;
      if (!real) {
        this->Fail("it is in second 60, and there is no leap second");
      }
      return this->FromUtc({day, utc - (day - mjd) * DaySeconds});
    }
    if (suffix.scale == TimeScale::Utc) {
      const double utc = seconds - suffix.offset_min * 60.0;
      const double days = std::floor(utc / DaySeconds);
      return this->FromUtc({mjd + int(days), utc - days * DaySeconds});
    }
    const double whole = (mjd - J2000Mjd) * DaySeconds - 0.5 * DaySeconds + seconds;
    return this->Scales_.Convert(whole, suffix.scale, TimeScale::Tdb);
  }

  double FromUtc(const TimeScales::UtcDay& utc) const {
    return this->Scales_.Convert(this->Scales_.TaiFromUtc(utc), TimeScale::Tai, TimeScale::Tdb);
  }

  const std::string& Text_;
  const TimeScales& Scales_;
  std::string_view Rest_;
  bool Leaping_ = false;
};

} // namespace

double TdbFromText(const std::string& text, const TimeScales& scales) {
  return TimeParser(text, scales).Tdb();
}

std::string TimeText(double tdb, TimeScale scale, const TimeScales& scales, int decimals) {
  Require(decimals >= 0 && decimals <= 9, "time", "the number of decimals", decimals, "0 to 9");
  TimeScales::UtcDay day{};
  double length = DaySeconds;
  if (scale == TimeScale::Utc) {
    day = scales.UtcFromTai(scales.Convert(tdb, TimeScale::Tdb, TimeScale::Tai));
    length = scales.GetLeapSeconds().SecondsOfDay(day.mjd);
  } else {
    const double seconds = scales.Convert(tdb, TimeScale::Tdb, scale);
    day.mjd = J2000Mjd + int(std::floor((seconds + 0.5 * DaySeconds) / DaySeconds));
    day.seconds = seconds - ((day.mjd - J2000Mjd) * DaySeconds - 0.5 * DaySeconds);
  }
  const auto unit = std::int64_t(std::llround(std::pow(10.0, decimals)));
  std::int64_t count = std::llround(day.seconds * double(unit));
  if (count >= std::int64_t(length) * unit) {
    count =
        day.seconds >= length ? std::int64_t(length) * unit - 1 : 0; // 1971 ends with 0.1 s more
    day.mjd += count == 0 ? 1 : 0;
  }
  int year = 0, month = 0, date = 0;
  double fraction = 0.0;
  if (eraJd2cal(MjdZero, day.mjd, &year, &month, &date, &fraction) != 0 || year < 1 ||
      year > 9999) {
    Reject("time", NumberText(tdb) + " s past J2000 TDB; accepted: the years 1 to 9999");
  }
  const std::int64_t second = count / unit;
  const bool leap = second >= 86400;
  const std::int64_t inDay = leap ? 86399 : second;
  char text[96] = "";
  std::snprintf(text, sizeof(text), "%04d-%02d-%02dT%02d:%02d:%02d", year, month, date,
                int(inDay / 3600), int(inDay / 60 % 60),
                int(inDay % 60) + (leap ? int(second - 86399) : 0));
  std::string out = text;
  if (decimals > 0) {
    const std::string digits = std::to_string(count % unit);
    out += "." + std::string(std::size_t(decimals) - digits.size(), '0') + digits;
  }
  return out;
}

std::string UtcText(double tdb, const TimeScales& scales, int decimals) {
  return TimeText(tdb, TimeScale::Utc, scales, decimals);
}

std::string TimeLabel(double tdb, const TimeScales& scales) {
  constexpr double Utc1960 = -1262260800.0;            // 1960-01-01 12:00
  if (tdb >= -63113860800.0 && tdb < 252455572800.0) { // the years 1 to 9999
    const bool utc = tdb > Utc1960;
    return TimeText(tdb, utc ? TimeScale::Utc : TimeScale::Tdb, scales) + (utc ? " UTC" : " TDB");
  }
  return NumberText(tdb) + " s past J2000 TDB";
}

} // namespace dspace
