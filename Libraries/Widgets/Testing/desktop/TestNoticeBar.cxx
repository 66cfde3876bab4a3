// Notices: what failed stays until it is closed, and can be copied.
#include <gtest/gtest.h>

#include <QClipboard>
#include <QGuiApplication>
#include <QLabel>
#include <QMainWindow>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QToolButton>
#include <QtTest>

#include <dspace/widgets/desktop/NoticeBar.h>
#include <dspace/widgets/desktop/TextWindow.h>
#include <dspace/widgets/settings/Theme.h>

#include "OneApplication.h"

using namespace dspace::widgets;

TEST(NoticeBar, SaysWhatFailedAndCopiesIt) {
  QMainWindow window;
  auto* notices = new NoticeBar(&window);
  window.addToolBar(Qt::BottomToolBarArea, notices);
  notices->hide();
  window.resize(600, 300);
  window.show();
  ASSERT_TRUE(QTest::qWaitForWindowExposed(&window));
  EXPECT_FALSE(notices->isVisible());
  notices->Fail("file 'x.glb': it is cut", "Traceback\nfile 'x.glb': it is cut");
  EXPECT_TRUE(notices->isVisible());
  EXPECT_EQ(notices->Text(), "file 'x.glb': it is cut");
  QTest::mouseClick(notices->findChild<QToolButton*>("copy"), Qt::LeftButton);
  EXPECT_EQ(QGuiApplication::clipboard()->text(), "Traceback\nfile 'x.glb': it is cut");
  auto* label = notices->findChild<QLabel*>();
  EXPECT_TRUE(label->textInteractionFlags() & Qt::TextSelectableByMouse);
  // In both themes it stands out.
  for (const Theme theme : {Theme::Dark, Theme::Light}) {
    ApplyTheme(theme);
    QCoreApplication::processEvents();
    EXPECT_GE(ContrastOf(label->palette().color(QPalette::WindowText),
                         notices->palette().color(QPalette::Window)),
              4.5);
  }
  ApplyTheme(Theme::System);
  QTest::mouseClick(notices->findChild<QToolButton*>("details"), Qt::LeftButton);
  auto* details = window.findChild<TextWindow*>();
  ASSERT_TRUE(details);
  EXPECT_EQ(details->findChild<QPlainTextEdit*>()->toPlainText(), notices->Details());
  details->close();
  QTest::mouseClick(notices->findChild<QToolButton*>("close"), Qt::LeftButton);
  EXPECT_FALSE(notices->isVisible());
  // What was said is kept, up to a number.
  for (int i = 0; i < NoticeBar::MostKept; ++i) {
    notices->Note(QString("note %1").arg(i));
  }
  EXPECT_EQ(notices->History().count('\n') + 1, NoticeBar::MostKept);
  EXPECT_EQ(notices->History().indexOf("x.glb"), -1);
  notices->ShowHistory();
  TextWindow* history = window.findChildren<TextWindow*>().last();
  for (QPushButton* button : history->findChildren<QPushButton*>()) {
    if (button->text().contains("Copy")) {
      QTest::mouseClick(button, Qt::LeftButton);
    }
  }
  EXPECT_TRUE(QGuiApplication::clipboard()->text().endsWith("note 499"));
}
