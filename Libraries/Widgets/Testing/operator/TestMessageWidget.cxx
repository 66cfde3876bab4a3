// Messages with their filters, and questions that are answered by buttons and texts.
#include <dspace/widgets/operator/MessageWidget.h>

#include <QComboBox>
#include <QLineEdit>
#include <QPushButton>
#include <QSignalSpy>
#include <QTreeWidget>
#include <QtTest>
#include <gtest/gtest.h>

#include "OneApplication.h"

#include <dspace/state/MessageLog.h>

using dspace::session::MessageLog;
using dspace::widgets::MessageWidget;

namespace {

class MessageWidgetTest : public ::testing::Test {
protected:
  void SetUp() override {
    this->widget.SetSource([this] {
      return MessageWidget::Shown{this->present ? &this->log : nullptr, this->scene,
                                  this->canAnswer};
    });
    this->widget.resize(500, 400);
    this->widget.show();
  }
  void Log(double time_s, dspace::v1::Severity severity, const std::string& kind,
           const std::string& text) {
    dspace::v1::LogEvent event;
    event.set_time_s(time_s);
    event.set_severity(severity);
    event.set_kind(kind);
    event.set_text(text);
    this->log.Log(event, 0.0);
  }
  void Ask(const std::string& name, const std::vector<std::string>& choices) {
    dspace::v1::AskOperator question;
    question.set_name(name);
    question.set_text("Go on?");
    for (const std::string& choice : choices) {
      question.add_choice(choice);
    }
    this->log.Ask(question, 0.0);
  }
  void Close(const std::string& name) {
    dspace::v1::CloseQuestion close;
    close.set_name(name);
    this->log.Close(close);
  }
  QWidget* Panel(const QString& name) {
    auto* panel = this->widget.findChild<QWidget*>("question " + name);
    return panel && !panel->isHidden() ? panel : nullptr;
  }

  MessageLog log;
  bool present = true;
  std::uint64_t scene = 1;
  bool canAnswer = true;
  MessageWidget widget;
};

} // namespace

TEST_F(MessageWidgetTest, ShowsEventsAndFiltersThem) {
  this->Log(12.5, dspace::v1::INFO, "staging", "first stage\nis gone");
  this->Log(13.0, dspace::v1::ALARM, "fault", "wheel 3 is stuck");
  EXPECT_TRUE(QTest::qWaitFor([&] { return this->widget.Count() == 2; }, 5000)); // by itself
  EXPECT_EQ(this->widget.Row(0).toStdString(), "12.500\tinfo\tstaging\t\tfirst stage is gone");
  EXPECT_EQ(this->widget.Row(1).toStdString(), "13.000\talarm\tfault\t\twheel 3 is stuck");
  auto* severity = this->widget.findChild<QComboBox*>("severity");
  severity->setCurrentIndex(2);
  ASSERT_EQ(this->widget.Count(), 1);
  EXPECT_TRUE(this->widget.Row(0).contains("wheel 3"));
  severity->setCurrentIndex(0);
  auto* filter = this->widget.findChild<QLineEdit*>("filter");
  QTest::keyClicks(filter, "STAGE");
  ASSERT_EQ(this->widget.Count(), 1);
  EXPECT_TRUE(this->widget.Row(0).contains("first stage"));
  filter->clear();
  EXPECT_EQ(this->widget.Count(), 2);
  // Another scene, and none.
  this->present = false;
  this->scene = 2;
  this->widget.Refresh();
  EXPECT_EQ(this->widget.Count(), 0);
}

TEST_F(MessageWidgetTest, KeepsTheNewestRows) {
  for (int i = 0; i < MessageWidget::MostRows + 50; ++i) {
    this->Log(i, dspace::v1::INFO, "note", "n" + std::to_string(i));
  }
  this->widget.Refresh();
  ASSERT_EQ(this->widget.Count(), MessageWidget::MostRows);
  EXPECT_TRUE(this->widget.Row(0).endsWith("\tn50"));
  EXPECT_TRUE(this->widget.Row(MessageWidget::MostRows - 1).endsWith("\tn1049"));
}

TEST_F(MessageWidgetTest, QuestionsComeAreAnsweredOnceAndGo) {
  QSignalSpy asked(&this->widget, &MessageWidget::asked);
  QSignalSpy answered(&this->widget, &MessageWidget::answered);
  this->Ask("drive", {"Yes & go", "No"});
  this->Ask("name", {});
  this->widget.Refresh();
  this->widget.Refresh(); // no second panel
  ASSERT_EQ(asked.size(), 2);
  EXPECT_EQ(asked[0][0].toString(), "drive");
  ASSERT_TRUE(this->Panel("drive") && this->Panel("name"));
  auto* yes = this->Panel("drive")->findChild<QPushButton*>("answer Yes & go");
  ASSERT_TRUE(yes);
  QTest::mouseClick(yes, Qt::LeftButton);
  ASSERT_EQ(answered.size(), 1);
  EXPECT_EQ(answered[0][0].toString(), "drive");
  EXPECT_EQ(answered[0][1].toString(), "Yes & go");
  EXPECT_FALSE(yes->isEnabled());
  QTest::mouseClick(yes, Qt::LeftButton); // a second click sends nothing
  EXPECT_EQ(answered.size(), 1);
  auto* line = this->Panel("name")->findChild<QLineEdit*>("answer");
  QTest::keyClicks(line, "Sojourner");
  QTest::keyClick(line, Qt::Key_Return);
  ASSERT_EQ(answered.size(), 2);
  EXPECT_EQ(answered[1][1].toString(), "Sojourner");
  this->Close("drive");
  this->widget.Refresh();
  EXPECT_FALSE(this->Panel("drive"));
  EXPECT_TRUE(this->Panel("name"));
}

TEST_F(MessageWidgetTest, ARecordingsQuestionIsNotAnswered) {
  this->canAnswer = false;
  this->Ask("drive", {"Yes"});
  this->widget.Refresh();
  ASSERT_TRUE(this->Panel("drive"));
  EXPECT_FALSE(this->Panel("drive")->findChild<QPushButton*>("answer Yes")->isEnabled());
}

TEST_F(MessageWidgetTest, AnAnswerThatWasNotSentIsGivenAgain) {
  QSignalSpy answered(&this->widget, &MessageWidget::answered);
  this->Ask("drive", {"Yes"});
  this->widget.Refresh();
  auto* yes = this->Panel("drive")->findChild<QPushButton*>("answer Yes");
  QTest::mouseClick(yes, Qt::LeftButton);
  EXPECT_FALSE(yes->isEnabled());
  this->widget.TakeAnswerAgain("another"); // nothing happens
  EXPECT_FALSE(yes->isEnabled());
  this->widget.TakeAnswerAgain("drive");
  EXPECT_TRUE(yes->isEnabled());
  QTest::mouseClick(yes, Qt::LeftButton);
  EXPECT_EQ(answered.size(), 2);
  EXPECT_FALSE(yes->isEnabled());
  EXPECT_TRUE(QTest::qWaitFor([&] { return yes->isEnabled(); }, 10000)); // the question stays open
}
