#include <dspace/time/DayText.h>

#include <cstdio>

#include <erfa.h>

#include <dspace/time/Days.h>

namespace dspace {

std::string DayText(int mjd) {
  int year = 0, month = 0, day = 0;
  double fraction = 0.0;
  eraJd2cal(MjdZero, mjd, &year, &month, &day, &fraction);
  char text[32];
  std::snprintf(text, sizeof(text), "%04d-%02d-%02d", year, month, day);
  return text;
}

} // namespace dspace
