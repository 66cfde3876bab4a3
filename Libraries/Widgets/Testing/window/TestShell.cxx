// What the window has of every desktop application: preferences, layouts, notices, recent files,
// help.
#include "WindowFixture.h"

#include <algorithm>
#include <vector>

#include <QAbstractButton>
#include <QAction>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QDockWidget>
#include <QFile>
#include <QMenu>
#include <QMenuBar>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QTextBlock>
#include <QTextBrowser>
#include <QToolButton>

#include "OneApplication.h"
#include "vtkDspaceViewport.h"

#include <dspace/widgets/desktop/GuideWindow.h>
#include <dspace/widgets/desktop/Layouts.h>
#include <dspace/widgets/desktop/MenuKeys.h>
#include <dspace/widgets/desktop/NoticeBar.h>
#include <dspace/widgets/desktop/RecentFiles.h>
#include <dspace/widgets/desktop/TextWindow.h>
#include <dspace/widgets/settings/PreferencesDialog.h>
#include <dspace/widgets/settings/Theme.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/Shell.h>

using namespace dspace::widgets;

namespace {

class ShellTest : public WindowFixture {
protected:
  static void SetUpTestSuite() {
    QStandardPaths::setTestModeEnabled(true);
    QFile::remove(SettingsFile::DefaultPath());
    WindowFixture::SetUpTestSuite();
  }
  static QAction* Action(const QString& text) {
    for (QAction* action : window->findChildren<QAction*>()) {
      if (action->text().remove('&') == text) {
        return action;
      }
    }
    return nullptr;
  }
};

} // namespace

TEST_F(ShellTest, EveryEntryOfTheMenusIsReachedByLetters) {
  EXPECT_EQ(MnemonicFaults(window->menuBar()), QStringList());
  window->activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(window));
  QTest::keyClick(window, Qt::Key_F, Qt::AltModifier);
  QWidget* menu = nullptr;
  ASSERT_TRUE(Wait([&] { return (menu = QApplication::activePopupWidget()) != nullptr; }, 3000));
  QTest::keyClick(menu, Qt::Key_Escape);
}

TEST_F(ShellTest, WhatCannotBeOpenedLeavesEverythingAndCanBeCopied) {
  const QString path = folder->filePath("cut.glb");
  QFile file(path);
  ASSERT_TRUE(file.open(QIODevice::WriteOnly));
  file.write("glTF nothing");
  file.close();
  const std::string objects = Value("len(scene.objects)");
  EXPECT_FALSE(window->Open(path));
  const NoticeBar* notices = window->Desktop()->Notices();
  EXPECT_TRUE(notices->isVisible());
  EXPECT_NE(notices->Text().indexOf("cut.glb"), -1) << notices->Text().toStdString();
  EXPECT_NE(notices->Details().indexOf("Traceback"), -1);
  EXPECT_EQ(Value("len(scene.objects)"), objects);
  EXPECT_FALSE(window->Desktop()->Recent()->Paths().contains(path));
  QTest::mouseClick(notices->findChild<QToolButton*>("close"), Qt::LeftButton);
}

TEST_F(ShellTest, PreferencesHoldAtOnceAndInTheFile) {
  Action("Preferences...")->trigger();
  PreferencesDialog* dialog = window->Desktop()->Dialog();
  ASSERT_TRUE(dialog);
  const auto boxes = dialog->findChildren<QComboBox*>();
  boxes.at(0)->setCurrentIndex(1); // dark
  boxes.at(1)->setCurrentIndex(2); // map
  dialog->findChildren<QSpinBox*>().at(0)->setValue(3);
  QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok),
                    Qt::LeftButton);
  EXPECT_TRUE(IsDark(QApplication::palette()));
  EXPECT_EQ(Preferences::Read(SettingsFile()).samples, 3);
  ASSERT_TRUE(Run("made = app.new_view()")) << errors.toStdString();
  EXPECT_EQ(Value("(made.samples, made.navigation)"), "(3, 'map')");
  ASSERT_TRUE(Run("app.close_view(made)"));
  window->Desktop()->Choose(Preferences());
  EXPECT_FALSE(Run("app.set_view_defaults(samples=9)"));
  EXPECT_NE(errors.indexOf("1 to 8"), -1);
  EXPECT_FALSE(Run("app.set_view_defaults(navigation='fly')"));
}

TEST_F(ShellTest, LayoutsAreLinesOfPythonAndMakeViewsThatAreGone) {
  ASSERT_TRUE(Run("one = app.new_view(); two = app.new_view(name='second')"));
  ASSERT_TRUE(Settled());
  auto* dock = window->findChild<QDockWidget*>("view second");
  ASSERT_TRUE(dock);
  dock->setFloating(true);
  ASSERT_TRUE(Run("app.layouts.save('pair')")) << errors.toStdString();
  EXPECT_EQ(Value("app.layouts.names"), "['pair']");
  ASSERT_TRUE(Run("app.close_view(two)"));
  QMenu* layouts = Action("Layouts")->menu();
  ASSERT_TRUE(layouts);
  EXPECT_EQ(layouts->actions().last()->text(), "&1 pair");
  EXPECT_EQ(MnemonicFaults(window->menuBar()), QStringList());
  layouts->actions().last()->trigger();
  dock = window->findChild<QDockWidget*>("view second");
  ASSERT_TRUE(dock) << errors.toStdString();
  EXPECT_TRUE(dock->isFloating());
  EXPECT_EQ(Value("'second' in app.views"), "True");
  ASSERT_TRUE(Settled());
  EXPECT_FALSE(Run("app.layouts.restore('nothing')"));
  EXPECT_NE(errors.indexOf("there are: pair"), -1) << errors.toStdString();
  ASSERT_TRUE(Run("app.layouts.remove('pair')\n"
                  "for view in list(app.views.values()): app.close_view(view)"));
}

TEST_F(ShellTest, TheLastLayoutComesBackWithItsViews) {
  ASSERT_TRUE(Run("one = app.new_view(); two = app.new_view(name='lower')"));
  ASSERT_TRUE(Settled());
  auto* dock = window->findChild<QDockWidget*>("view lower");
  window->addDockWidget(Qt::BottomDockWidgetArea, dock);
  window->findChild<QDockWidget*>("scene")->hide();
  window->Desktop()->End();
  window->findChild<QDockWidget*>("scene")->show();
  ASSERT_TRUE(Run("app.close_view(two)"));
  window->Desktop()->Start(); // as at the next start, before the views are there
  EXPECT_FALSE(window->findChild<QDockWidget*>("scene")->isVisible());
  ASSERT_TRUE(Run("two = app.new_view(name='lower')")) << errors.toStdString();
  dock = window->findChild<QDockWidget*>("view lower");
  EXPECT_EQ(window->dockWidgetArea(dock), Qt::BottomDockWidgetArea);
  window->findChild<QDockWidget*>("scene")->show();
  ASSERT_TRUE(Run("for view in list(app.views.values()): app.close_view(view)"));
}

TEST_F(ShellTest, RecentFilesAreOpenedFromTheMenu) {
  const QString path = folder->filePath("noted & kept.py");
  QFile file(path);
  ASSERT_TRUE(file.open(QIODevice::WriteOnly));
  file.write("opened = globals().get('opened', 0) + 1\n");
  file.close();
  ASSERT_TRUE(window->Open(path)) << errors.toStdString();
  ASSERT_EQ(window->Desktop()->Recent()->Paths().value(0), path);
  for (QAction* action : window->findChildren<QAction*>()) {
    if (action->text().endsWith("noted && kept.py")) {
      EXPECT_TRUE(action->text().startsWith("&1 "));
      action->trigger();
      break;
    }
  }
  EXPECT_EQ(Value("opened"), "2");
  Preferences none = window->Desktop()->Chosen();
  none.recentFiles = 0;
  window->Desktop()->Choose(none);
  EXPECT_EQ(window->Desktop()->Recent()->Paths(), QStringList());
  window->Desktop()->Choose(Preferences());
}

TEST_F(ShellTest, HelpHasTheGuideTheKeysAndWhatAReportNeeds) {
  Action("About")->trigger();
  const auto about = window->findChildren<TextWindow*>();
  ASSERT_FALSE(about.isEmpty());
  const QString text = about.last()->findChild<QPlainTextEdit*>()->toPlainText();
  for (const char* word :
       {"Dspace: ", "Qt: 6.", "VTK: 9.", "OpenGL vendor: ", "OpenGL version: 4."}) {
    EXPECT_NE(text.indexOf(word), -1) << word << " in " << text.toStdString();
  }
  EXPECT_EQ(text.indexOf("not known"), -1) << text.toStdString();
  about.last()->close();
  Action("Guide")->trigger();
  auto* guide = window->findChild<GuideWindow*>();
  ASSERT_TRUE(guide);
  EXPECT_NE(guide->Browser()->toPlainText().indexOf("DspaceQt"), -1);
  // The pictures of the page are there, no wider than it.
  int pictures = 0;
  for (QTextBlock block = guide->Browser()->document()->begin(); block.isValid();
       block = block.next()) {
    for (auto it = block.begin(); !it.atEnd(); ++it) {
      const QTextImageFormat image = it.fragment().charFormat().toImageFormat();
      if (image.isValid()) {
        const auto loaded =
            guide->Browser()->loadResource(QTextDocument::ImageResource, QUrl(image.name()));
        EXPECT_FALSE(loaded.value<QImage>().isNull()) << image.name().toStdString();
        EXPECT_LE(loaded.value<QImage>().width(), 780);
        ++pictures;
      }
    }
  }
  EXPECT_GT(pictures, 2);
  guide->close();
}

TEST_F(ShellTest, EveryControlIsReachedByTabAndHasATip) {
  ASSERT_TRUE(Run("one = app.new_view(); drawn = app.plot()")) << errors.toStdString();
  ASSERT_TRUE(Settled());
  int seen = 0;
  for (const QAbstractButton* button : window->findChildren<QAbstractButton*>()) {
    const QString name = button->objectName();
    const bool ofQt = name.startsWith("qt_") || button->parent()->inherits("QTabBar") ||
                      button->parent()->inherits("QLineEdit") ||
                      QString(button->metaObject()->className()).contains("Private") ||
                      button->inherits("QDockWidgetTitleButton") || button->inherits("CloseButton");
    if (ofQt || !button->isVisible()) {
      continue;
    }
    ++seen;
    const std::string about =
        (name + " '" + button->text() + "' of " + button->parent()->metaObject()->className())
            .toStdString();
    EXPECT_FALSE(button->toolTip().isEmpty()) << about;
    // The prompt's own arrow does what Return does.
    EXPECT_TRUE((button->focusPolicy() & Qt::TabFocus) != 0 || button->text() == ">>>") << about;
  }
  EXPECT_GT(seen, 10);
  ASSERT_TRUE(Run("for view in list(app.views.values()): app.close_view(view)"));
}

TEST_F(ShellTest, AllDocksFollowTheTheme) {
  ASSERT_TRUE(Run("drawn = app.plot()")) << errors.toStdString();
  const auto lightness = [](const QWidget* widget) { // of most of its pixels
    const QImage image = const_cast<QWidget*>(widget)->grab().toImage().scaled(40, 40);
    std::vector<int> values;
    for (int i = 0; i < 1600; ++i) {
      values.push_back(image.pixelColor(i % 40, i / 40).lightness());
    }
    std::nth_element(values.begin(), values.begin() + 800, values.end());
    return values[800];
  };
  for (const char* theme : {"dark", "light", "dark"}) {
    ASSERT_TRUE(Run(QString("app.set_theme('%1')").arg(theme))) << errors.toStdString();
    QTest::qWait(100);
    int docks = 0;
    for (QDockWidget* dock : window->findChildren<QDockWidget*>()) {
      dock->raise();
      QTest::qWait(20);
      if (!dock->isVisible() || dock->widget()->visibleRegion().isEmpty()) {
        continue;
      }
      ++docks;
      EXPECT_EQ(lightness(dock->widget()) < 128, QString(theme) == "dark")
          << dock->objectName().toStdString() << ' ' << theme;
    }
    EXPECT_GE(docks, 4);
  }
  EXPECT_FALSE(Run("app.set_theme('pink')"));
  EXPECT_NE(errors.indexOf("system, dark, light"), -1);
  ASSERT_TRUE(Run("app.set_theme('system')"));
}
