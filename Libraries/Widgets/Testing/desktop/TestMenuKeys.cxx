// Every entry of a menu has a letter of its own; the table of keys is that of the menus.
#include <gtest/gtest.h>

#include <QDialog>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QTextBrowser>
#include <QtTest>

#include <dspace/widgets/desktop/MenuKeys.h>

#include "OneApplication.h"

using namespace dspace::widgets;

TEST(MenuKeys, FindsEntriesWithoutLettersAndCompletesThem) {
  QMainWindow window;
  QMenu* file = window.menuBar()->addMenu("&File");
  file->addAction("&Open");
  file->addAction("Overlay");
  file->addSeparator();
  file->addAction("Print && &Post");
  QMenu* more = file->addMenu("More");
  more->addAction("&Same");
  more->addAction("&Simple");
  EXPECT_EQ(MnemonicFaults(window.menuBar()),
            (QStringList{"File > Overlay: no letter", "File > More: no letter",
                         "File > More > Simple: its letter s is another's, too"}));
  CompleteMnemonics(window.menuBar());
  EXPECT_EQ(file->actions().at(1)->text(), "O&verlay");
  EXPECT_EQ(more->title(), "&More");
  EXPECT_EQ(MnemonicFaults(window.menuBar()).size(), 1); // what was given stays
}

TEST(MenuKeys, ShowsTheKeysOfTheMenus) {
  QMainWindow window;
  QMenu* file = window.menuBar()->addMenu("&File");
  file->addAction("&Open...")->setShortcut(QKeySequence("Ctrl+O"));
  file->addAction("&Other");
  const QString html = KeysOfMenus(window.menuBar());
  EXPECT_NE(html.indexOf("<b>Ctrl+O</b></td><td>File &gt; Open<"), -1) << html.toStdString();
  EXPECT_EQ(html.indexOf("Other"), -1);
  ShowKeys(&window, "<table><tr><td>Wheel</td></tr></table>");
  auto* dialog = window.findChild<QDialog*>("keys");
  ASSERT_TRUE(dialog);
  const QString text = dialog->findChild<QTextBrowser*>()->toPlainText();
  EXPECT_NE(text.indexOf("Wheel"), -1);
  EXPECT_NE(text.indexOf("Ctrl+O"), -1);
  QTest::keyClick(dialog, Qt::Key_Escape);
  EXPECT_TRUE(QTest::qWaitFor([&] { return !window.findChild<QDialog*>("keys"); }, 2000));
}
