// Questions of the simulation are answered in the Messages dock.
#include "WindowFixture.h"

#include <QDockWidget>
#include <QPushButton>

#include <dspace/widgets/console/ConsoleWidget.h>
#include <dspace/widgets/operator/MessageWidget.h>

using dspace::widgets::MessageWidget;

using MessagesInWindow = WindowFixture;

namespace {

// A simulation in another process, which asks and logs the answer.
const char* const AskingSimulation = R"(
import os, subprocess, sys
asking = subprocess.Popen([sys.executable, "-c", '''
import dspace, sys
with dspace.connect(sys.argv[1], name="asker") as session:
    place = session.scene("place")
    place.add_viewport((320, 200), place.add_camera(eye=(0, -14, 3), target=(0, 0, 0)), name="main")
    session.on_event(lambda event: place.log_event("goal", event.dragged.goal), "dragged")
    answer = place.ask("go", "Deploy?", choices=["yes", "no"]).wait(60)
    place.log_event("answer", answer)
    while not session.process_events(60):
        pass
    sys.stdin.read()
''', link.address], env={**os.environ, "PYTHONPATH": sys.path[0]}, stdin=subprocess.PIPE)
)";

} // namespace

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

TEST_F(MessagesInWindow, TheSimulationOfAServerHearsTheAnswerAndTheGoal) {
  auto* messages = window->findChild<MessageWidget*>();
  ASSERT_TRUE(Run("link = app.listen()")) << errors.toStdString();
  ASSERT_TRUE(Wait([] { return Value("link.state") == "connected"; })) << errors.toStdString();
  ASSERT_TRUE(Run(AskingSimulation)) << errors.toStdString();
  const auto no = [&] { return messages->findChild<QPushButton*>("answer no"); };
  ASSERT_TRUE(Wait([&] { return no() && no()->isVisible(); }));
  QTest::mouseClick(no(), Qt::LeftButton);
  const auto last = [&](const QString& text) {
    return messages->Count() > 0 && messages->Row(messages->Count() - 1).endsWith(text);
  };
  EXPECT_TRUE(Wait([&] { return last("answer\t\tno"); })) << errors.toStdString();
  EXPECT_TRUE(Wait([&] { return !no(); }));
  EXPECT_TRUE(Run("app.send_goal((3, 0, 0), 'base')")) << errors.toStdString();
  EXPECT_TRUE(Wait([&] { return last("goal\t\tbase"); })) << errors.toStdString();
  // Without a simulation nobody hears it, which is said at once.
  ASSERT_TRUE(Run("asking.stdin.close(); asking.wait(20)"));
  ASSERT_TRUE(Wait([] { return Value("link.simulation") == "None"; }));
  EXPECT_FALSE(Run("app.send_goal((3, 0, 0))"));
  EXPECT_TRUE(errors.contains("no driver")) << errors.toStdString();
  EXPECT_TRUE(Run("link.close()")) << errors.toStdString();
  QTest::qWait(0);
}
