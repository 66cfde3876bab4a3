// Layouts: docks come back where they were, also docks that are made later, and bad ones change
// nothing.
#include <gtest/gtest.h>

#include <functional>

#include <QDockWidget>
#include <QJsonArray>
#include <QJsonObject>
#include <QLabel>
#include <QMainWindow>
#include <QSignalSpy>
#include <QTemporaryDir>
#include <QtTest>

#include <dspace/Error.h>
#include <dspace/widgets/desktop/Layouts.h>
#include <dspace/widgets/settings/SettingsFile.h>

#include "OneApplication.h"

using namespace dspace::widgets;

namespace {

class LayoutsTest : public ::testing::Test {
protected:
  QTemporaryDir folder;
  SettingsFile file{folder.filePath("settings.json")};
  QMainWindow window;
  Layouts layouts{&window, &file};

  QDockWidget* Dock(const QString& name, Qt::DockWidgetArea area) {
    auto* dock = new QDockWidget(name, &this->window);
    dock->setObjectName(name);
    dock->setWidget(new QLabel(name));
    this->window.addDockWidget(area, dock);
    return dock;
  }
  void Show() {
    this->window.resize(700, 500);
    this->window.show();
    QTest::qWait(300); // a first window may come before the window manager, and is never exposed
  }
  static dspace::Error::Kind KindOf(const std::function<void()>& f) {
    try {
      f();
    } catch (const dspace::Error& error) {
      return error.GetKind();
    }
    return dspace::Error::Kind(-1);
  }
};

} // namespace

TEST_F(LayoutsTest, PutDocksBack) {
  QDockWidget* tree = this->Dock("tree", Qt::LeftDockWidgetArea);
  QDockWidget* view = this->Dock("view 1", Qt::RightDockWidgetArea);
  QDockWidget* console = this->Dock("console", Qt::BottomDockWidgetArea);
  this->Show();
  this->window.resizeDocks({tree, view}, {180, 500}, Qt::Horizontal);
  QTest::qWait(50);
  const int width = tree->width();
  QSignalSpy changed(&this->layouts, &Layouts::changed);
  this->layouts.Save(" usual ");
  EXPECT_EQ(changed.count(), 1);
  this->window.addDockWidget(Qt::BottomDockWidgetArea, tree);
  view->setFloating(true);
  console->hide();
  this->layouts.Save("other");
  EXPECT_EQ(this->layouts.Names(), (QStringList{"other", "usual"}));
  this->layouts.Restore("usual");
  EXPECT_EQ(this->window.dockWidgetArea(tree), Qt::LeftDockWidgetArea);
  EXPECT_FALSE(view->isFloating());
  EXPECT_TRUE(console->isVisible());
  EXPECT_TRUE(QTest::qWaitFor([&] { return std::abs(tree->width() - width) < 3; }, 2000))
      << tree->width() << " for " << width;
  this->layouts.Restore("other");
  EXPECT_EQ(this->window.dockWidgetArea(tree), Qt::BottomDockWidgetArea);
  EXPECT_TRUE(view->isFloating());
  EXPECT_FALSE(console->isVisible());
  this->layouts.Remove("other");
  EXPECT_EQ(this->layouts.Names(), QStringList{"usual"});
  // They are in the file.
  SettingsFile read(this->file.Path());
  EXPECT_EQ(Layouts(&this->window, &read).Names(), QStringList{"usual"});
}

TEST_F(LayoutsTest, AskForViewsThatAreGoneAndPlaceThoseThatComeLater) {
  this->Dock("tree", Qt::LeftDockWidgetArea);
  QDockWidget* view = this->Dock("view 1", Qt::BottomDockWidgetArea);
  this->Show();
  this->layouts.Save("two");
  ASSERT_TRUE(this->layouts.SaveLast());
  delete view;
  QStringList wanted;
  QObject::connect(&this->layouts, &Layouts::viewsWanted, [&](const QStringList& names) {
    wanted = names;
    this->Dock("view 1", Qt::RightDockWidgetArea);
  });
  this->layouts.Restore("two");
  EXPECT_EQ(wanted, QStringList{"1"});
  auto* made = this->window.findChild<QDockWidget*>("view 1");
  ASSERT_TRUE(made);
  EXPECT_EQ(this->window.dockWidgetArea(made), Qt::BottomDockWidgetArea);
  delete made;
  // As at the start of a program: the view comes after the layout.
  ASSERT_TRUE(this->layouts.RestoreLast());
  auto* later = new QDockWidget("view 1", &this->window);
  later->setObjectName("view 1");
  EXPECT_TRUE(this->layouts.Place(later));
  EXPECT_EQ(this->window.dockWidgetArea(later), Qt::BottomDockWidgetArea);
  auto* strange = new QDockWidget("view 9", &this->window);
  strange->setObjectName("view 9");
  EXPECT_FALSE(this->layouts.Place(strange));
}

// As starts of a program one after the other: without the view the tree takes its room, and would
// keep it.
TEST_F(LayoutsTest, SizesStayWhenViewsComeLater) {
  QDockWidget* tree = this->Dock("tree", Qt::LeftDockWidgetArea);
  QDockWidget* view = this->Dock("view 1", Qt::RightDockWidgetArea);
  this->Show();
  this->window.resizeDocks({tree, view}, {180, 500}, Qt::Horizontal);
  QTest::qWait(50);
  const int width = tree->width();
  for (int start = 0; start < 3; ++start) {
    ASSERT_TRUE(this->layouts.SaveLast());
    delete view;
    QTest::qWait(50);
    EXPECT_GT(tree->width(), 2 * width); // it has all of the room
    ASSERT_TRUE(this->layouts.RestoreLast());
    QTest::qWait(50);
    view = new QDockWidget("view 1", &this->window);
    view->setObjectName("view 1");
    view->setWidget(new QLabel("view 1"));
    ASSERT_TRUE(this->layouts.Place(view));
    EXPECT_TRUE(QTest::qWaitFor([&] { return std::abs(tree->width() - width) < 3; }, 2000))
        << start << ": " << tree->width() << " for " << width;
  }
}

TEST_F(LayoutsTest, BadOnesChangeNothing) {
  QDockWidget* tree = this->Dock("tree", Qt::LeftDockWidgetArea);
  this->Show();
  EXPECT_FALSE(this->layouts.RestoreLast());
  EXPECT_EQ(KindOf([&] { this->layouts.Save("  "); }), dspace::Error::Kind::InvalidArgument);
  EXPECT_EQ(KindOf([&] { this->layouts.Save(QString(61, 'x')); }),
            dspace::Error::Kind::InvalidArgument);
  EXPECT_EQ(KindOf([&] { this->layouts.Restore("none"); }), dspace::Error::Kind::NotFound);
  EXPECT_EQ(KindOf([&] { this->layouts.Remove("none"); }), dspace::Error::Kind::NotFound);
  ASSERT_TRUE(
      this->file.Set("layouts", QJsonObject{{"odd", QJsonObject{{"docks", "AAAA"}}}, {"none", 3}}));
  for (const char* name : {"odd", "none"}) {
    EXPECT_EQ(KindOf([&] { this->layouts.Restore(name); }), dspace::Error::Kind::Corrupt);
    EXPECT_EQ(this->window.dockWidgetArea(tree), Qt::LeftDockWidgetArea);
    EXPECT_TRUE(tree->isVisible());
  }
}
