// What a user of DspaceQt chooses once: theme, new views, units, recent files.
#ifndef DSPACE_WIDGETS_PREFERENCES_H
#define DSPACE_WIDGETS_PREFERENCES_H

#include <QString>
#include <QStringList>

#include <dspace/widgets/settings/DisplayUnits.h>
#include <dspace/widgets/settings/Theme.h>

namespace dspace::widgets {

class SettingsFile;

struct Preferences {
  static constexpr int MostSamples = 8;
  static constexpr int MostRecentFiles = 30;

  Theme theme = Theme::System;
  int samples = 2;              // a pixel along each side, of new views; 1 to MostSamples
  QString navigation = "orbit"; // of new views; one of Navigations()
  UnitChoice units;             // of numbers in docks, and coordinates
  int recentFiles = 10;         // in the menu; 0 to MostRecentFiles
  bool restoreLayout = true;    // at start

  static QStringList Navigations(); // orbit, walk, map

  // A value that the file has not, or that is not accepted, is the default's.
  static Preferences Read(const SettingsFile& file);
  // False: the file could not be written.
  bool Write(SettingsFile& file) const;
  bool operator==(const Preferences& other) const;
  bool operator!=(const Preferences& other) const { return !(*this == other); }
};

} // namespace dspace::widgets

#endif
