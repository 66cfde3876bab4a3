// Days as texts.
#ifndef DSPACE_ANALYSIS_DAY_TEXT_H
#define DSPACE_ANALYSIS_DAY_TEXT_H

#include <string>

namespace dspace {

// "2017-01-01" of a Modified Julian Date.
std::string DayText(int mjd);

} // namespace dspace

#endif
