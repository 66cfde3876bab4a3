#include <dspace/widgets/settings/Preferences.h>

#include <tuple>

#include <QJsonObject>

#include <dspace/widgets/settings/SettingsFile.h>

namespace dspace::widgets {
namespace {

const QString Key = QStringLiteral("preferences");

// A whole number of a range, or the default.
int Whole(const QJsonValue& value, int low, int high, int otherwise) {
  const int number = value.toInt(low - 1);
  return number < low || number > high ? otherwise : number;
}

auto Tied(const Preferences& p) {
  return std::tie(p.theme, p.samples, p.navigation, p.units.length, p.units.angle,
                  p.units.bodyFixed, p.units.inertial, p.recentFiles, p.restoreLayout);
}

} // namespace

QStringList Preferences::Navigations() {
  return {QStringLiteral("orbit"), QStringLiteral("walk"), QStringLiteral("map")};
}

Preferences Preferences::Read(const SettingsFile& file) {
  const QJsonObject given = file.Get(Key).toObject();
  Preferences read;
  read.theme = ThemeOf(given["theme"].toString()).value_or(read.theme);
  read.samples = Whole(given["samples"], 1, MostSamples, read.samples);
  if (Navigations().contains(given["navigation"].toString())) {
    read.navigation = given["navigation"].toString();
  }
  read.units.length = UnitChoice::LengthOf(given["length"].toString()).value_or(read.units.length);
  read.units.angle = UnitChoice::AngleOf(given["angle"].toString()).value_or(read.units.angle);
  read.units.bodyFixed = given["bodyFixed"].toBool(read.units.bodyFixed);
  read.units.inertial = given["inertial"].toBool(read.units.inertial);
  read.recentFiles = Whole(given["recentFiles"], 0, MostRecentFiles, read.recentFiles);
  read.restoreLayout = given["restoreLayout"].toBool(read.restoreLayout);
  return read;
}

bool Preferences::Write(SettingsFile& file) const {
  return file.Set(Key, QJsonObject{{"theme", WordOf(this->theme)},
                                   {"samples", this->samples},
                                   {"navigation", this->navigation},
                                   {"length", UnitChoice::WordOf(this->units.length)},
                                   {"angle", UnitChoice::WordOf(this->units.angle)},
                                   {"bodyFixed", this->units.bodyFixed},
                                   {"inertial", this->units.inertial},
                                   {"recentFiles", this->recentFiles},
                                   {"restoreLayout", this->restoreLayout}});
}

bool Preferences::operator==(const Preferences& other) const {
  return Tied(*this) == Tied(other);
}

} // namespace dspace::widgets
