#include <dspace/time/EarthOrientation.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <erfa.h>

#include <dspace/Checks.h>
#include <dspace/FilesRead.h>
#include <dspace/time/Days.h>

namespace dspace {
namespace {

constexpr double Arcsecond = M_PI / 648000.0;
constexpr std::size_t HeadBytes = 16384;
constexpr std::size_t MostBytes = 64u << 20;

struct Line {
  EarthOrientation::Row row;
  bool predicted = false;
};

// The number in columns `first` to `last` (from 1); none: blank or something else.
std::optional<double> Column(const std::string& line, std::size_t first, std::size_t last) {
  if (line.size() < last) {
    return std::nullopt;
  }
  std::istringstream text(line.substr(first - 1, last - first + 1));
  double value = 0.0;
  std::string rest;
  if (!(text >> value) || text >> rest || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

bool IsDate(int year, int month, int day, double mjd) {
  double zero = 0.0, found = 0.0;
  return eraCal2jd(year, month, day, &zero, &found) == 0 && found == mjd;
}

bool IsPlausible(const EarthOrientation::Row& row) {
  return std::abs(row.ut1MinusUtc) <= 1e4 && row.pole.cwiseAbs().maxCoeff() <= 10.0 * Arcsecond;
}

// A row of finals2000A; none: it is not one, or has no values yet.
std::optional<Line> FinalsLine(const std::string& line) {
  const auto year = Column(line, 1, 2);
  const auto month = Column(line, 3, 4);
  const auto day = Column(line, 5, 6);
  const auto mjd = Column(line, 8, 15);
  const auto x = Column(line, 19, 27);
  const auto y = Column(line, 38, 46);
  const auto ut1 = Column(line, 59, 68);
  if (!year || !month || !day || !mjd || !x || !y || !ut1) {
    return std::nullopt;
  }
  Line out{{*mjd, *ut1, Arcsecond * Eigen::Vector2d(*x, *y)}, line[57] == 'P'};
  const int century = *mjd < J2000Mjd ? 1900 : 2000;
  if (!IsDate(century + int(*year), int(*month), int(*day), *mjd) ||
      (line[57] != 'I' && line[57] != 'P') || !IsPlausible(out.row)) {
    return std::nullopt;
  }
  return out;
}

// A row of EOP C04; none: it is not one.
std::optional<Line> C04Line(const std::string& line) {
  std::istringstream text(line);
  std::vector<double> numbers;
  for (double value = 0.0; numbers.size() < 8 && text >> value;) {
    numbers.push_back(value);
  }
  if (numbers.size() < 8) {
    return std::nullopt;
  }
  // Year, month, day, in the series 20 the hour, MJD, x, y, UT1 - UTC.
  for (const std::size_t at : {std::size_t(3), std::size_t(4)}) {
    Line out{{numbers[at], numbers[at + 3],
              Arcsecond * Eigen::Vector2d(numbers[at + 1], numbers[at + 2])},
             false};
    if (std::abs(numbers[0]) < 1e4 && std::abs(numbers[1]) < 100.0 && std::abs(numbers[2]) < 100 &&
        (at == 3 || numbers[3] == 0.0) &&
        IsDate(int(numbers[0]), int(numbers[1]), int(numbers[2]), numbers[at]) &&
        IsPlausible(out.row)) {
      return out;
    }
  }
  return std::nullopt;
}

std::optional<Line> AnyLine(const std::string& line) {
  const std::optional<Line> finals = FinalsLine(line);
  return finals ? finals : C04Line(line);
}

bool IsBlank(const std::string& line) {
  return line.find_first_not_of(" \t\r") == std::string::npos;
}

// A day of finals2000A that has no values yet: the file goes on for a year.
bool IsEmptyDay(const std::string& line) {
  return Column(line, 8, 15) &&
         (line.size() < 68 || line.find_first_not_of(' ', 57) == std::string::npos ||
          IsBlank(line.substr(58, 10)));
}

} // namespace

bool EarthOrientation::Recognizes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(HeadBytes, '\0');
  file.read(head.data(), std::streamsize(head.size()));
  head.resize(std::size_t(file.gcount()));
  if (head.find('\0') != std::string::npos) {
    return false;
  }
  std::istringstream lines(head);
  for (std::string line; std::getline(lines, line);) {
    if (AnyLine(line)) {
      return true;
    }
  }
  return false;
}

EarthOrientation EarthOrientation::Read(const std::string& path) {
  NoteFileRead(path);
  std::ifstream file(path, std::ios::binary);
  std::string text;
  if (file) {
    file.seekg(0, std::ios::end);
    const std::streamoff length = file.tellg();
    if (length > std::streamoff(MostBytes)) {
      throw Error(Error::Kind::Resource, "Earth orientation '" + path + "'",
                  "the file has " + std::to_string(length) + " bytes; accepted: up to 64 MiB");
    }
    file.seekg(0);
    text.resize(std::size_t(std::max<std::streamoff>(length, 0)));
    file.read(text.data(), std::streamsize(text.size()));
  }
  if (!file) {
    throw Error(Error::Kind::Io, "Earth orientation '" + path + "'", "the file cannot be read");
  }
  return Parse(text, path);
}

EarthOrientation EarthOrientation::Parse(const std::string& text, const std::string& name) {
  EarthOrientation out;
  out.Name_ = name;
  std::istringstream lines(text);
  int number = 0;
  bool ended = false;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::optional<Line> read = AnyLine(line);
    const auto fail = [&](const std::string& what) {
      throw Error(Error::Kind::Corrupt,
                  "Earth orientation '" + name + "', line " + std::to_string(number),
                  what + "; accepted: rows of a day each of the IERS's finals2000A or EOP C04");
    };
    if (!read) {
      const bool header = out.Rows_.empty() || IsBlank(line) || line[0] == '#';
      ended = ended || (!out.Rows_.empty() && IsEmptyDay(line));
      if (!header && !ended) {
        fail("it is no such row");
      }
      continue;
    }
    if (ended || (!out.Rows_.empty() && read->row.mjd != out.LastMjd() + 1.0)) {
      fail("its day is MJD " + NumberText(read->row.mjd) + ", after MJD " +
           NumberText(out.LastMjd()));
    }
    if (read->predicted && !out.FirstPredicted_) {
      out.FirstPredicted_ = read->row.mjd;
    }
    out.Rows_.push_back(read->row);
  }
  if (out.Rows_.size() < 2) {
    throw Error(Error::Kind::Corrupt, "Earth orientation '" + name + "'",
                "it has " + std::to_string(out.Rows_.size()) +
                    " rows; accepted: at least two days of the IERS's finals2000A or EOP C04");
  }
  return out;
}

Eigen::Vector2d EarthOrientation::PoleAt(double mjd) const {
  if (!this->Covers(mjd)) {
    Reject("Earth orientation '" + this->Name_ + "'",
           "a day (MJD) is " + NumberText(mjd) + "; accepted: " + NumberText(this->FirstMjd()) +
               " to " + NumberText(this->LastMjd()));
  }
  const std::size_t row =
      std::min(std::size_t(mjd - this->FirstMjd()), this->Rows_.size() - 2); // they are a day apart
  const double part = mjd - this->Rows_[row].mjd;
  return (1.0 - part) * this->Rows_[row].pole + part * this->Rows_[row + 1].pole;
}

} // namespace dspace
