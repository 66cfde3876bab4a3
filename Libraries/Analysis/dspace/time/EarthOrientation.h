// UT1 and the Earth's pole as the IERS measures and predicts them.
#ifndef DSPACE_ANALYSIS_EARTH_ORIENTATION_H
#define DSPACE_ANALYSIS_EARTH_ORIENTATION_H

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace dspace {

// A daily table of UT1 - UTC and polar motion, from a file of the IERS:
// - finals2000A (".all", ".data", ".daily"): Bulletin A's values, of which the last year is a
//   prediction. Format: IERS, "readme.finals2000A".
// - EOP C04 ("eopc04...", of the series 14 and 20): final values. Format: its own header.
// Celestial pole offsets and the length of the day are not read.
class EarthOrientation {
public:
  struct Row {
    double mjd = 0.0;                               // of UTC
    double ut1MinusUtc = 0.0;                       // [s]
    Eigen::Vector2d pole = Eigen::Vector2d::Zero(); // x towards Greenwich, y to 90 W [rad]
  };

  // Whether a file's first lines have such a row.
  static bool Recognizes(const std::string& path);
  // Throws Error(NotFound, Io) for a file that cannot be read, and Error(Corrupt), naming the line,
  // for a row that cannot be read or whose day does not follow the day before.
  static EarthOrientation Read(const std::string& path);
  // The same from text in memory; `name` stands for the file in errors.
  static EarthOrientation Parse(const std::string& text, const std::string& name);

  const std::string& Name() const { return this->Name_; }
  const std::vector<Row>& Rows() const { return this->Rows_; } // at least two, a day apart
  double FirstMjd() const { return this->Rows_.front().mjd; }
  double LastMjd() const { return this->Rows_.back().mjd; }
  // The first day that is a prediction; absent: none is.
  std::optional<double> FirstPredicted() const { return this->FirstPredicted_; }
  bool Covers(double mjd) const { return mjd >= this->FirstMjd() && mjd <= this->LastMjd(); }
  // Polar motion [rad], linear between the days. Throws Error(InvalidArgument) where it does not
  // cover the day.
  Eigen::Vector2d PoleAt(double mjd) const;

private:
  EarthOrientation() = default;
  std::string Name_;
  std::vector<Row> Rows_;
  std::optional<double> FirstPredicted_;
};

} // namespace dspace

#endif
