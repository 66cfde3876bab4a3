// Questions of the simulation are answered in the Messages dock.
#include "WindowFixture.h"

#include <QDockWidget>
#include <QPushButton>

#include <dspace/widgets/console/ConsoleWidget.h>
#include <dspace/widgets/operator/MessageWidget.h>

using dspace::widgets::MessageWidget;

using MessagesInWindow = WindowFixture;

TEST_F(MessagesInWindow, AQuestionRaisesItsDockAndIsAnswered) {
  ASSERT_TRUE(QTest::qWaitForWindowExposed(window));
  auto* messages = window->findChild<MessageWidget*>();
  ASSERT_TRUE(messages);
  window->findChild<QDockWidget*>("messages")->hide();
  ASSERT_TRUE(Run("scene.log_event('fault', 'wheel 3 is stuck', severity='alarm')\n"
                  "question = scene.ask('drive', 'Go on?', ['Yes', 'No'])\n"))
      << errors.toStdString();
  EXPECT_TRUE(Wait([&] { return messages->isVisible(); })); // the dock has come back
  ASSERT_EQ(messages->Count(), 1);
  EXPECT_TRUE(messages->Row(0).endsWith("wheel 3 is stuck"));
  auto* yes = messages->findChild<QPushButton*>("answer Yes");
  ASSERT_TRUE(yes);
  QTest::mouseClick(yes, Qt::LeftButton);
  EXPECT_EQ(Value("question.answer"), "Yes") << errors.toStdString();
  EXPECT_TRUE(Wait([&] { return !messages->findChild<QPushButton*>("answer Yes"); }));
  EXPECT_EQ(window->Console()->Script().trimmed().section('\n', -1).toStdString(),
            "app.answer(\"drive\", \"Yes\")");
}
