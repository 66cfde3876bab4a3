// The units in which docks show lengths and angles, and which coordinates. Python, files and the
// wire keep metres and degrees.
#ifndef DSPACE_WIDGETS_DISPLAY_UNITS_H
#define DSPACE_WIDGETS_DISPLAY_UNITS_H

#include <optional>

#include <QObject>
#include <QString>

namespace dspace::widgets {

struct UnitChoice {
  enum class Length { Metre, Kilometre };
  enum class Angle { Degree, Radian };
  Length length = Length::Metre;
  Angle angle = Angle::Degree;
  // Of the point under the pointer, on terrain of a known body, from the body's centre: in axes
  // that turn with it, and in those of J2000.
  bool bodyFixed = false;
  bool inertial = false;

  // From metres and from degrees to what is shown.
  double LengthFactor() const;
  double AngleFactor() const;
  // "m" and "km"; "°" and "rad".
  QString LengthUnit() const;
  QString AngleUnit() const;
  // How many decimals show what `inMetres` (`inDegrees`) decimals show of metres (degrees).
  int LengthDecimals(int inMetres) const;
  int AngleDecimals(int inDegrees) const;

  // As settings have them: "m", "km"; "deg", "rad".
  static QString WordOf(Length length);
  static QString WordOf(Angle angle);
  static std::optional<Length> LengthOf(const QString& word);
  static std::optional<Angle> AngleOf(const QString& word);
};

// The choice of the program.
class DisplayUnits : public QObject {
  Q_OBJECT

public:
  static DisplayUnits& The();
  const UnitChoice& Get() const { return this->Choice_; }
  void Set(const UnitChoice& choice);

signals:
  void changed();

private:
  DisplayUnits() = default;
  UnitChoice Choice_;
};

} // namespace dspace::widgets

#endif
