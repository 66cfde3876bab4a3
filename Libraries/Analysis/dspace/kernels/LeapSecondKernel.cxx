#include <dspace/kernels/LeapSecondKernel.h>

#include <cmath>
#include <vector>

#include <dspace/Checks.h>

namespace dspace {

bool HasLeapSeconds(const KernelPool& pool) {
  return pool.Has("DELTET/DELTA_AT");
}

TimeScales TimeScalesOf(const KernelPool& pool) {
  const char* const name = "DELTET/DELTA_AT";
  const std::vector<double>& table = pool.Numbers(name);
  const KernelVariable& variable = *pool.Find(name);
  const auto fail = [&](const std::string& what) {
    throw Error(Error::Kind::Corrupt,
                "text kernel '" + variable.file + "', line " + std::to_string(variable.line),
                std::string(name) + " " + what);
  };
  if (table.size() < 2 || table.size() % 2 != 0) {
    fail("has " + std::to_string(table.size()) + " values; accepted: pairs of seconds and a date");
  }
  constexpr int MjdOf2000Noon = 51544; // 2000-01-01, whose 12h is second 0
  std::vector<LeapSeconds::Step> steps;
  for (std::size_t i = 0; i + 1 < table.size(); i += 2) {
    const double day = (table[i + 1] + 43200.0) / 86400.0;
    if (day != std::floor(day) || std::abs(day) > 4e6) {
      fail("has the date " + NumberText(table[i + 1]) +
           " s past J2000; accepted: the beginning of a day");
    }
    steps.push_back({MjdOf2000Noon + int(day), table[i]});
  }
  TimeScales::DeltaEt deltaEt;
  deltaEt.ttMinusTai = pool.Number("DELTET/DELTA_T_A");
  deltaEt.k = pool.Number("DELTET/K");
  deltaEt.eb = pool.Number("DELTET/EB");
  const std::vector<double>& m = pool.Numbers("DELTET/M", 2);
  deltaEt.m0 = m[0];
  deltaEt.m1 = m[1];
  try {
    return TimeScales(LeapSeconds::FromSteps(std::move(steps), "'" + variable.file + "'"), deltaEt);
  } catch (const Error& error) {
    fail(std::string("is no table of leap seconds: ") + error.what());
    throw;
  }
}

} // namespace dspace
