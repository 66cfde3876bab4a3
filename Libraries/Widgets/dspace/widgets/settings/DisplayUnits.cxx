#include <dspace/widgets/settings/DisplayUnits.h>

namespace dspace::widgets {
namespace {

constexpr double RadiansPerDegree = 0.017453292519943295;

} // namespace

double UnitChoice::LengthFactor() const {
  return this->length == Length::Kilometre ? 1e-3 : 1.0;
}

double UnitChoice::AngleFactor() const {
  return this->angle == Angle::Radian ? RadiansPerDegree : 1.0;
}

QString UnitChoice::LengthUnit() const {
  return WordOf(this->length);
}

QString UnitChoice::AngleUnit() const {
  return this->angle == Angle::Radian ? QStringLiteral("rad") : QString(QChar(0xb0));
}

int UnitChoice::LengthDecimals(int inMetres) const {
  return this->length == Length::Kilometre ? inMetres + 3 : inMetres;
}

int UnitChoice::AngleDecimals(int inDegrees) const {
  return this->angle == Angle::Radian ? inDegrees + 2 : inDegrees;
}

QString UnitChoice::WordOf(Length length) {
  return length == Length::Kilometre ? QStringLiteral("km") : QStringLiteral("m");
}

QString UnitChoice::WordOf(Angle angle) {
  return angle == Angle::Radian ? QStringLiteral("rad") : QStringLiteral("deg");
}

std::optional<UnitChoice::Length> UnitChoice::LengthOf(const QString& word) {
  for (const Length each : {Length::Metre, Length::Kilometre}) {
    if (word == WordOf(each)) {
      return each;
    }
  }
  return std::nullopt;
}

std::optional<UnitChoice::Angle> UnitChoice::AngleOf(const QString& word) {
  for (const Angle each : {Angle::Degree, Angle::Radian}) {
    if (word == WordOf(each)) {
      return each;
    }
  }
  return std::nullopt;
}

DisplayUnits& DisplayUnits::The() {
  static DisplayUnits the;
  return the;
}

void DisplayUnits::Set(const UnitChoice& choice) {
  if (choice.length == this->Choice_.length && choice.angle == this->Choice_.angle &&
      choice.bodyFixed == this->Choice_.bodyFixed && choice.inertial == this->Choice_.inertial) {
    return;
  }
  this->Choice_ = choice;
  emit this->changed();
}

} // namespace dspace::widgets
