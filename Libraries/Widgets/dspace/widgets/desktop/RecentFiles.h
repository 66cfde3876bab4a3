// The menu of the files that were opened last.
#ifndef DSPACE_WIDGETS_RECENT_FILES_H
#define DSPACE_WIDGETS_RECENT_FILES_H

#include <QObject>
#include <QString>
#include <QStringList>

class QMenu;

namespace dspace::widgets {

class SettingsFile;

class RecentFiles : public QObject {
  Q_OBJECT

public:
  // Both must outlive it. `most`: as many files, the latest first.
  RecentFiles(QMenu* menu, SettingsFile* file, int most, QObject* parent = nullptr);

  void Add(const QString& path);
  void SetMost(int most);
  QStringList Paths() const;

signals:
  void chosen(const QString& path);

private:
  void Keep(const QStringList& paths);
  void Fill();

  QMenu* Menu_;
  SettingsFile* File_;
  int Most_;
};

} // namespace dspace::widgets

#endif
