// What the window of DspaceQt has of every desktop application: preferences, layouts, notices,
// recent files, help.
#ifndef DSPACE_WIDGETS_SHELL_H
#define DSPACE_WIDGETS_SHELL_H

#include <functional>
#include <memory>

#include <QJsonObject>
#include <QObject>
#include <QPointer>

#include <dspace/widgets/settings/Preferences.h>
#include <dspace/widgets/settings/SettingsFile.h>

class QDockWidget;
class QMainWindow;
class QMenu;

namespace dspace::widgets {

class Layouts;
class NoticeBar;
class PreferencesDialog;
class RecentFiles;

class Shell : public QObject {
  Q_OBJECT

public:
  // `run` runs a line of Python that the prompt shows. Settings that are damaged give a notice.
  Shell(QMainWindow* window, std::function<bool(const QString&)> run);
  ~Shell() override;

  // Entries of the menus. `about`: the text of About; `keys`: a table of HTML (MenuKeys.h).
  void FillRecent(QMenu* menu);
  void FillView(QMenu* menu);
  void FillHelp(QMenu* menu, const QString& keys, std::function<QString()> about);

  const Preferences& Chosen() const { return this->Preferences_; }
  // Applies and saves.
  void Choose(const Preferences& preferences);
  NoticeBar* Notices() const { return this->Notices_; }
  Layouts* GetLayouts() const { return this->Layouts_; }
  RecentFiles* Recent() const { return this->Recent_; }
  void ShowPreferences();
  // The dialog, while it is open.
  PreferencesDialog* Dialog() const;
  // A page of the guide, such as Application.md; false: it is not installed, which a notice says.
  bool ShowGuide(const QString& page = QStringLiteral("Application.md"));

  // What Python asks (dspace.application.layouts), as JSON:
  //   {"do": "layout", "what": "save", "restore" or "remove", "name": ...}, {..., "what": "names"}
  //   {"do": "dialog", "name": "preferences", "guide", "keys", "messages" or "about"}
  //   {"do": "theme", "name": "system", "dark" or "light"}
  // Throws what Layouts throws, Error(InvalidArgument) for another word.
  static bool Takes(const QJsonObject& request);
  QJsonObject Handle(const QJsonObject& request);

  // Once the window is shown: the layout of the last time, if the user wants it.
  void Start();
  // Before the window closes: keeps its layout.
  void End();

signals:
  void fileChosen(const QString& path);

private:
  void Apply();
  void FillLayouts();
  void ShowDialog(const QString& name);
  // Shows a dock and brings it to the front. Throws Error(NotFound) if there is none of the name.
  void ShowDock(const QString& name);

  QMainWindow* Window_;
  std::function<bool(const QString&)> Run_;
  SettingsFile File_;
  Preferences Preferences_;
  NoticeBar* Notices_ = nullptr;
  Layouts* Layouts_ = nullptr;
  RecentFiles* Recent_ = nullptr;
  QMenu* LayoutMenu_ = nullptr;
  QPointer<PreferencesDialog> Dialog_;
  QString Keys_;
  std::function<QString()> About_;
};

} // namespace dspace::widgets

#endif
