#include <dspace/widgets/window/Shell.h>

#include <QAction>
#include <QDockWidget>
#include <QInputDialog>
#include <QJsonArray>
#include <QJsonDocument>
#include <QMainWindow>
#include <QMenu>
#include <QStatusBar>

#include <dspace/Error.h>
#include <dspace/widgets/desktop/GuideWindow.h>
#include <dspace/widgets/desktop/Layouts.h>
#include <dspace/widgets/desktop/MenuKeys.h>
#include <dspace/widgets/desktop/NoticeBar.h>
#include <dspace/widgets/desktop/RecentFiles.h>
#include <dspace/widgets/desktop/TextWindow.h>
#include <dspace/widgets/script/PythonText.h>
#include <dspace/widgets/settings/PreferencesDialog.h>

namespace dspace::widgets {
Shell::Shell(QMainWindow* window, std::function<bool(const QString&)> run)
    : QObject(window), Window_(window), Run_(std::move(run)),
      Preferences_(Preferences::Read(this->File_)), Notices_(new NoticeBar(window)),
      Layouts_(new Layouts(window, &this->File_, this)) {
  window->addToolBar(Qt::BottomToolBarArea, this->Notices_);
  this->Notices_->hide();
  connect(window->statusBar(), &QStatusBar::messageChanged, this, [this](const QString& text) {
    if (!text.isEmpty()) {
      this->Notices_->Note(text);
    }
  });
  connect(this->Layouts_, &Layouts::changed, this, &Shell::FillLayouts);
  connect(this->Layouts_, &Layouts::viewsWanted, this, [this](const QStringList& names) {
    for (const QString& name : names) {
      if (!name.startsWith(QStringLiteral("viewer:"))) { // of a recording or a server
        this->Run_(QStringLiteral("app.new_view(name=%1)").arg(Quoted(name)));
      }
    }
  });
  ApplyTheme(this->Preferences_.theme);
  DisplayUnits::The().Set(this->Preferences_.units);
  if (!this->File_.Problem().isEmpty()) {
    this->Notices_->Fail(this->File_.Problem());
  }
}

Shell::~Shell() = default;

// --- Menus ---------------------------------------------------------------------------------------

void Shell::FillRecent(QMenu* menu) {
  this->Recent_ = new RecentFiles(menu, &this->File_, this->Preferences_.recentFiles, this);
  connect(this->Recent_, &RecentFiles::chosen, this, &Shell::fileChosen);
}

void Shell::FillView(QMenu* menu) {
  menu->addSeparator();
  this->LayoutMenu_ = menu->addMenu(tr("&Layouts"));
  this->FillLayouts();
  menu->addAction(tr("Pre&ferences..."), QKeySequence(Qt::CTRL | Qt::Key_Comma), this,
                  &Shell::ShowPreferences);
}

void Shell::FillLayouts() {
  if (!this->LayoutMenu_) {
    return;
  }
  this->LayoutMenu_->clear();
  this->LayoutMenu_->addAction(tr("&Save layout..."), this, [this] {
    auto* dialog = new QInputDialog(this->Window_);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setWindowTitle(tr("Save layout"));
    dialog->setLabelText(tr("Name of the layout of docks and views"));
    connect(dialog, &QInputDialog::textValueSelected, this, [this](const QString& name) {
      if (!name.trimmed().isEmpty()) {
        this->Run_(QStringLiteral("app.layouts.save(%1)").arg(Quoted(name.trimmed())));
      }
    });
    dialog->open();
  });
  const QStringList names = this->Layouts_->Names();
  auto* remove = this->LayoutMenu_->addMenu(tr("&Remove layout"));
  remove->setEnabled(!names.isEmpty());
  this->LayoutMenu_->addSeparator();
  const auto add = [this, &names](QMenu* menu, const QString& name, const char* line) {
    QString shown = name;
    shown.replace('&', QStringLiteral("&&"));
    const auto number = names.indexOf(name) + 1; // 1 to 9 are keys
    menu->addAction(
        (number < 10 ? QStringLiteral("&%1 ").arg(number) : QString()) + shown, this,
        [this, name, line] { this->Run_(QString::fromLatin1(line).arg(Quoted(name))); });
  };
  for (const QString& name : names) {
    add(this->LayoutMenu_, name, "app.layouts.restore(%1)");
    add(remove, name, "app.layouts.remove(%1)");
  }
}

void Shell::FillHelp(QMenu* menu, const QString& keys, std::function<QString()> about) {
  this->Keys_ = keys;
  this->About_ = std::move(about);
  const auto add = [&](const QString& text, const QKeySequence& key, const char* name) {
    menu->addAction(text, key, this, [this, name] { this->ShowDialog(QString::fromLatin1(name)); });
  };
  add(tr("&Guide"), QKeySequence(Qt::SHIFT | Qt::Key_F1), "guide");
  add(tr("&Keys"), QKeySequence::HelpContents, "keys");
  add(tr("&Messages"), {}, "messages");
  menu->addSeparator();
  add(tr("&About"), {}, "about");
}

void Shell::ShowDialog(const QString& name) {
  if (name == "preferences") {
    this->ShowPreferences();
  } else if (name == "guide") {
    this->ShowGuide();
  } else if (name == "keys") {
    ShowKeys(this->Window_, this->Keys_);
  } else if (name == "messages") {
    this->Notices_->ShowHistory();
  } else if (name == "about") {
    TextWindow::Open(tr("About DspaceQt"),
                     tr("DspaceQt\n3D visualization and measurement for spacecraft and rover "
                        "simulations\nLicence: BSD-3-Clause\n\n") +
                         this->About_(),
                     this->Window_);
  } else {
    throw Error(Error::Kind::InvalidArgument, "dialog",
                "it is '" + name.toStdString() +
                    "'; accepted: preferences, guide, keys, messages, about");
  }
}

void Shell::ShowDock(const QString& name) {
  QStringList names;
  for (QDockWidget* dock : this->Window_->findChildren<QDockWidget*>()) {
    names << dock->objectName();
    if (dock->objectName() == name) {
      dock->show();
      dock->raise();
      return;
    }
  }
  names.sort();
  throw Error(Error::Kind::NotFound, "dock",
              "it is '" + name.toStdString() + "'; there are: " + names.join(", ").toStdString());
}

bool Shell::ShowGuide(const QString& page) {
  const QString folder = GuideWindow::Folder();
  if (folder.isEmpty()) {
    this->Notices_->Fail(tr("The guide is not installed; accepted: share/doc/dspace beside bin"));
    return false;
  }
  auto* guide = new GuideWindow(folder + '/' + page, this->Window_);
  guide->setAttribute(Qt::WA_DeleteOnClose);
  guide->show();
  return true;
}

// --- Preferences ---------------------------------------------------------------------------------

void Shell::ShowPreferences() {
  if (this->Dialog_) {
    this->Dialog_->raise();
    return;
  }
  this->Dialog_ = new PreferencesDialog(this->Preferences_, this->Window_);
  this->Dialog_->setAttribute(Qt::WA_DeleteOnClose);
  connect(this->Dialog_, &PreferencesDialog::chosen, this, &Shell::Choose);
  this->Dialog_->show();
}

PreferencesDialog* Shell::Dialog() const {
  return this->Dialog_;
}

void Shell::Choose(const Preferences& preferences) {
  const Preferences before = this->Preferences_;
  this->Preferences_ = preferences;
  if (!preferences.Write(this->File_)) {
    this->Notices_->Fail(this->File_.Problem());
  }
  ApplyTheme(preferences.theme);
  DisplayUnits::The().Set(preferences.units);
  if (this->Recent_) {
    this->Recent_->SetMost(preferences.recentFiles);
  }
  if (preferences.samples != before.samples || preferences.navigation != before.navigation) {
    this->Apply();
  }
}

void Shell::Apply() {
  this->Run_(QStringLiteral("app.set_view_defaults(samples=%1, navigation=%2)")
                 .arg(this->Preferences_.samples)
                 .arg(Quoted(this->Preferences_.navigation)));
}

// --- Layouts -------------------------------------------------------------------------------------

bool Shell::Takes(const QJsonObject& request) {
  const QString what = request["do"].toString();
  return what == "layout" || what == "dialog" || what == "dock" || what == "theme";
}

QJsonObject Shell::Handle(const QJsonObject& request) {
  const QString what = request["what"].toString();
  const QString name = request["name"].toString();
  if (request["do"].toString() == "dialog") {
    this->ShowDialog(name);
  } else if (request["do"].toString() == "dock") {
    this->ShowDock(name);
  } else if (request["do"].toString() == "theme") {
    Preferences chosen = this->Preferences_;
    const std::optional<Theme> theme = ThemeOf(name);
    if (!theme) {
      throw Error(Error::Kind::InvalidArgument, "theme",
                  "it is '" + name.toStdString() + "'; accepted: system, dark, light");
    }
    chosen.theme = *theme;
    this->Choose(chosen);
  } else if (what == "save") {
    this->Layouts_->Save(name);
  } else if (what == "restore") {
    this->Layouts_->Restore(name);
  } else if (what == "remove") {
    this->Layouts_->Remove(name);
  } else if (what == "names") {
    return {{"names", QJsonArray::fromStringList(this->Layouts_->Names())}};
  } else {
    throw Error(Error::Kind::InvalidArgument, "layouts",
                "they are asked to \"" + what.toStdString() +
                    "\"; accepted: save, restore, remove, names");
  }
  return {};
}

void Shell::Start() {
  const Preferences standard;
  if (this->Preferences_.samples != standard.samples ||
      this->Preferences_.navigation != standard.navigation) {
    this->Apply();
  }
  if (this->Preferences_.restoreLayout) {
    const bool hidden = this->Notices_->isHidden();
    this->Layouts_->RestoreLast();
    this->Notices_->setVisible(!hidden); // it is no part of a layout
  }
}

void Shell::End() {
  this->Notices_->hide();
  this->Layouts_->SaveLast();
}

} // namespace dspace::widgets
