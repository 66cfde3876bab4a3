// Samples as a table of text.
#ifndef DSPACE_WIDGETS_SAMPLE_CSV_H
#define DSPACE_WIDGETS_SAMPLE_CSV_H

#include <functional>
#include <string>
#include <vector>

#include <dspace/widgets/telemetry/SampleSeries.h>

namespace dspace::widgets {

// A column of the table.
struct CsvColumn {
  std::string title; // UTF-8, any characters
  SampleSeries samples;
};

// Writes a file as RFC 4180 has it: UTF-8, a line of titles, fields separated by commas, lines by
// CR LF. The first column, "time [s]", has each time at which there is a sample, `from` to `to`; a
// field is empty where its column has no sample, and "nan" for one that is NaN. Numbers have the
// least number of digits that give the same number when they are read.
// The file appears as a whole, or not at all (AtomicFile, whose errors it throws). `cancelled` is
// asked every few thousand lines; when it returns true nothing is written, and false returned.
bool WriteCsv(const std::string& path, const std::vector<CsvColumn>& columns, double from,
              double to, const std::function<bool()>& cancelled = {});

} // namespace dspace::widgets

#endif
