#include <dspace/widgets/telemetry/SampleCsv.h>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>

#include <dspace/AtomicFile.h>

namespace dspace::widgets {
namespace {

constexpr std::size_t BufferBytes = 1u << 16;

std::string Field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  }
  return quoted + '"';
}

void AddNumber(std::string& line, double value) {
  if (std::isnan(value)) {
    line += "nan";
    return;
  }
  char text[32];
  line.append(text, std::to_chars(text, text + sizeof(text), value).ptr);
}

} // namespace

bool WriteCsv(const std::string& path, const std::vector<CsvColumn>& columns, double from,
              double to, const std::function<bool()>& cancelled) {
  AtomicFile file(path);
  std::string text = "time [s]";
  std::vector<std::size_t> next;
  std::vector<std::size_t> end;
  for (const CsvColumn& column : columns) {
    text += "," + Field(column.title);
    next.push_back(column.samples.Lower(from));
    end.push_back(column.samples.Upper(to));
  }
  text += "\r\n";
  for (;;) {
    double time = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (next[i] < end[i]) {
        time = std::min(time, columns[i].samples.Time(next[i]));
      }
    }
    if (std::isinf(time)) {
      break;
    }
    AddNumber(text, time);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      text += ',';
      if (next[i] < end[i] && columns[i].samples.Time(next[i]) == time) {
        AddNumber(text, columns[i].samples.Value(next[i]++));
      }
    }
    text += "\r\n";
    if (text.size() > BufferBytes) {
      if (cancelled && cancelled()) {
        return false;
      }
      file.Write(text.data(), text.size());
      text.clear();
    }
  }
  file.Write(text.data(), text.size());
  file.Commit();
  return true;
}

} // namespace dspace::widgets
