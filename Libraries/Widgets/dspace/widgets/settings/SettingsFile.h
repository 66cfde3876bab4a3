// Settings in a file that a crash, a full disk or a stray byte cannot turn into a program that does
// not start.
#ifndef DSPACE_WIDGETS_SETTINGS_FILE_H
#define DSPACE_WIDGETS_SETTINGS_FILE_H

#include <QJsonObject>
#include <QJsonValue>
#include <QString>

namespace dspace::widgets {

// Values of JSON by name, in a file of JSON with the SHA-256 digest of its values. A file that is
// cut, damaged, too large or of a later version counts as empty: every setting then has its
// default, and Problem() says why. Nothing here throws.
class SettingsFile {
public:
  // Reads the file; one that does not exist is empty and no problem.
  explicit SettingsFile(const QString& path = DefaultPath());

  QJsonValue Get(const QString& name) const; // undefined: it is not set
  // Writes at once: the file is replaced as a whole, and settings that another program wrote since
  // stay. An undefined value removes the setting. A damaged file is kept beside, with the ending
  // ".damaged". False: it cannot be written (Problem() says why); the value still holds in this
  // process.
  bool Set(const QString& name, const QJsonValue& value);

  // Why the file could not be read or written; empty: it could.
  const QString& Problem() const { return this->Problem_; }
  const QString& Path() const { return this->Path_; }

  // DspaceQt's: settings.json in the folder of the application's configuration.
  static QString DefaultPath();

private:
  // False: Problem_ says why.
  bool Read(QJsonObject& values);

  QString Path_;
  QJsonObject Values_;
  QString Problem_;
  bool Damaged_ = false;
};

} // namespace dspace::widgets

#endif
