// The timeline shows a source's clock, turns the user's events into requests, plays recordings, and
// keeps marks in a side file.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <memory>
#include <sstream>

#include <QApplication>
#include <QDate>
#include <QFile>
#include <QHelpEvent>
#include <QInputDialog>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLabel>
#include <QLocale>
#include <QMenu>
#include <QPlainTextEdit>
#include <QTemporaryDir>
#include <QToolButton>
#include <QToolTip>
#include <QWheelEvent>
#include <QtTest>

#include "FullDisk.h"
#include "MissingPackage.h"

#include "vtkDspaceSession.h"
#include "vtkNew.h"

#include <dspace/Error.h>
#include <dspace/interpreter/Interpreter.h>
#include <dspace/recording/Playback.h>
#include <dspace/widgets/timeline/PlayClock.h>
#include <dspace/widgets/timeline/PlaybackTimeSource.h>
#include <dspace/widgets/timeline/RateMeter.h>
#include <dspace/widgets/timeline/SceneTimeSource.h>
#include <dspace/widgets/timeline/ScrubBar.h>
#include <dspace/widgets/timeline/TimeTexts.h>
#include <dspace/widgets/timeline/TimelineMarks.h>
#include <dspace/widgets/timeline/TimelineWidget.h>

using namespace dspace::widgets; // NOLINT(google-build-using-namespace)

namespace {

// A source that does what it is asked, and keeps account.
class PlainSource : public TimeSource {
public:
  State state;
  std::vector<TimelineEvent> events;
  std::vector<TimeRange> gaps;
  std::vector<std::string> asked;
  std::string fails; // what Advance() throws

  PlainSource() {
    state.time_s = 100.0;
    state.range = TimeRange{100.0, 200.0};
    state.canPlay = state.canSeek = state.grows = true;
  }
  State GetState() const override { return state; }
  const std::vector<TimelineEvent>& Events() const override { return events; }
  const std::vector<TimeRange>& Gaps() const override { return gaps; }
  void Advance(double) override {
    if (!fails.empty()) {
      throw dspace::Error(dspace::Error::Kind::Corrupt, "recording", fails);
    }
  }
  void Play(bool playing) override { Note("play", state.playing = playing); }
  void Seek(double time_s) override { Note("seek", state.time_s = time_s); }
  void Step(int steps) override { Note("step", steps); }
  void SetSpeed(double speed) override { Note("speed", state.speed = speed); }
  void SetLoop(const std::optional<TimeRange>& loop) override {
    state.loop = loop;
    Note("loop", loop ? loop->Length() : 0.0);
  }
  void Follow(bool following) override { Note("follow", state.following = following); }

private:
  void Note(const char* what, double value) {
    std::ostringstream text;
    text << what << " " << value;
    asked.push_back(text.str());
  }
};

void Show(TimelineWidget& widget, int width = 900) {
  widget.resize(width, widget.sizeHint().height());
  widget.show();
  ASSERT_TRUE(QTest::qWaitForWindowExposed(&widget));
}
void Click(TimelineWidget& widget, const char* button) {
  auto* found = widget.findChild<QToolButton*>(button);
  ASSERT_NE(found, nullptr) << button;
  QTest::mouseClick(found, Qt::LeftButton);
}
QString Text(const TimelineWidget& widget, const char* label) {
  const auto* found = widget.findChild<QLabel*>(label);
  return found ? found->text() : QString("no such label");
}
QPoint At(const ScrubBar& bar, double time_s, int y = 22) {
  return {int(std::lround(bar.PlaceOf(time_s))), y};
}
// A movement with the left button down.
void Drag(QWidget& widget, const QPoint& to) {
  QMouseEvent move(QEvent::MouseMove, QPointF(to), widget.mapToGlobal(QPointF(to)), Qt::NoButton,
                   Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(&widget, &move);
}

// TT seconds past J2000 at 0 h of a day whose UTC is `behind` TAI [s].
double TtOf(const QDate& day, int behind) {
  return double(day.toJulianDay() - 2451545) * 86400.0 - 43200.0 + behind + 32.184;
}

// A recording of 21 steps from 1000 s to 1010 s in which a frame moves at 2 m/s, with two events.
class Recorded {
public:
  Recorded() {
    vtkNew<vtkDspaceSession> session;
    EXPECT_EQ(session->Record(this->Path(), 0.01), "");
    const auto run = [&](const dspace::v1::Command& command) {
      dspace::v1::Reply reply;
      reply.ParseFromString(session->Execute(command.SerializeAsString()));
      EXPECT_FALSE(reply.has_error()) << reply.error().message();
    };
    dspace::v1::Command command;
    command.set_scene("run");
    command.mutable_create_scene();
    run(command);
    command.mutable_create_frame()->set_name("rover");
    command.mutable_create_frame()->set_id(7);
    run(command);
    for (int i = 0; i <= 20; ++i) {
      command.mutable_set_time()->set_time_s(1000.0 + 0.5 * i);
      run(command);
      command.mutable_set_poses()->add_frame(7);
      for (const double value : {double(i), 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) {
        command.mutable_set_poses()->add_pose(value);
      }
      run(command);
      if (i == 4 || i == 12) {
        auto& event = *command.mutable_log_event();
        event.set_kind(i == 4 ? "ignition" : "fault");
        event.set_text(i == 4 ? "engine <on>" : "valve 3 is stuck");
        event.set_severity(i == 4 ? dspace::v1::INFO : dspace::v1::ALARM);
        run(command);
      }
    }
    EXPECT_EQ(session->StopRecording(), "");
  }
  std::string Path() const { return this->Folder_.filePath("run.dspace").toStdString(); }

private:
  QTemporaryDir Folder_;
};

struct Played {
  Recorded recorded;
  dspace::session::RecordingReader reader{recorded.Path()};
  dspace::session::Interpreter interpreter;
  dspace::session::Playback playback{reader, interpreter};

  double X() const { return interpreter.FindScene("run")->Frames().LocalPose(7).position.x(); }
};

} // namespace

TEST(TimeTextsTest, UtcHasTheLeapSecondsOfTheSystemsTable) {
  EXPECT_EQ(UtcText(0.0), "2000-01-01 11:58:55.816 UTC"); // epoch J2000
  std::ifstream table("/usr/share/zoneinfo/leapseconds");
  if (!table) {
    DSPACE_MISSING_PACKAGE("tzdata");
  }
  int behind = 10; // TAI - UTC on 1972-01-01
  std::string line;
  while (std::getline(table, line)) {
    std::istringstream words(line);
    std::string word, month, time;
    int year = 0, day = 0;
    words >> word >> year >> month >> day >> time;
    if (word != "Leap") {
      continue;
    }
    const QDate date = QLocale::c().toDate(
        QString("%1 %2 %3").arg(year).arg(QString::fromStdString(month)).arg(day), "yyyy MMM d");
    ASSERT_TRUE(date.isValid()) << line;
    const double leap = TtOf(date.addDays(1), behind);
    const std::string last = date.toString(Qt::ISODate).toStdString();
    EXPECT_EQ(UtcText(leap - 1.0), last + " 23:59:59.000 UTC");
    EXPECT_EQ(UtcText(leap), last + " 23:59:60.000 UTC");
    EXPECT_EQ(UtcText(leap + 1.0),
              date.addDays(1).toString(Qt::ISODate).toStdString() + " 00:00:00.000 UTC");
    ++behind;
  }
  EXPECT_GE(behind, 37);
}

TEST(TimeTextsTest, TdbIsAheadInAprilAndBehindInOctober) {
  // By 1.7 ms (Astronomical Almanac).
  EXPECT_EQ(UtcText(TtOf({2010, 4, 4}, 34)), "2010-04-03 23:59:59.998 UTC");
  EXPECT_EQ(UtcText(TtOf({2010, 10, 4}, 34)), "2010-10-04 00:00:00.002 UTC");
  EXPECT_EQ(UtcText(TtOf({1969, 7, 20}, -32)).substr(0, 10), "1969-07-20");
  EXPECT_EQ(UtcText(-1e9).substr(24), "TT");
  EXPECT_EQ(UtcText(1e300), "");
  EXPECT_EQ(UtcText(std::numeric_limits<double>::quiet_NaN()), "");
}

TEST(TimeTextsTest, ElapsedTimesAndTicks) {
  EXPECT_EQ(ElapsedText(3723.4564), "T+ 01:02:03.456");
  EXPECT_EQ(ElapsedText(-1.0), "T- 00:00:01.000");
  EXPECT_EQ(ElapsedText(2 * 86400.0 + 59.9999), "T+ 2 d 00:01:00.000");
  EXPECT_EQ(TickText(0.25, 0.05), "0.25");
  EXPECT_EQ(TickText(750.0, 30.0), "12:30");
  EXPECT_EQ(TickText(60.5, 0.5), "1:00.5");
  EXPECT_EQ(TickText(3600.0, 600.0), "1:00:00");
  EXPECT_EQ(TickText(3 * 86400.0 + 43200.0, 21600.0), "3 d 12:00");
  EXPECT_EQ(TickText(3 * 86400.0, 86400.0), "3 d");
  EXPECT_DOUBLE_EQ(TimeStep(0.0, 10.0, 6), 2.0);
  EXPECT_DOUBLE_EQ(TimeStep(0.0, 3600.0, 8), 600.0);
  EXPECT_DOUBLE_EQ(TimeStep(0.0, 86400.0, 6), 21600.0);
  EXPECT_DOUBLE_EQ(TimeStep(0.0, 30 * 86400.0, 8), 5 * 86400.0);
}

TEST(RateMeterTest, MeasuresTheLastSecond) {
  RateMeter meter;
  EXPECT_FALSE(meter.Rate());
  for (int i = 0; i <= 30; ++i) {
    meter.Add(0.1 * i, i < 15 ? 100.0 : 100.0 + 0.3 * (i - 14));
  }
  ASSERT_TRUE(meter.Rate());
  EXPECT_NEAR(*meter.Rate(), 3.0, 1e-9);
  meter.Reset();
  EXPECT_FALSE(meter.Rate());
}

TEST(PlayClockTest, PlaysLoopsAndEnds) {
  PlayClock clock;
  clock.SetRange({10.0, 20.0}, false);
  EXPECT_DOUBLE_EQ(clock.Advance(0.0), 10.0);
  clock.SetSpeed(4.0);
  clock.Play(true);
  EXPECT_DOUBLE_EQ(clock.Advance(0.25), 11.0);
  EXPECT_DOUBLE_EQ(clock.Advance(100.0), 13.0); // a stall counts half a second
  clock.SetLoop(TimeRange{12.0, 14.0});
  EXPECT_DOUBLE_EQ(clock.Advance(100.5), 13.0); // 15.0 is 1 s over the end
  clock.SetSpeed(-4.0);
  EXPECT_DOUBLE_EQ(clock.Advance(101.0), 13.0); // 11.0 is 1 s before the beginning
  clock.Seek(18.0);
  EXPECT_DOUBLE_EQ(clock.Advance(101.1), 14.0); // from outside it begins at its end
  clock.SetLoop({});
  for (int i = 0; i < 4; ++i) {
    clock.Advance(102.0 + i);
  }
  EXPECT_DOUBLE_EQ(clock.Time(), 10.0);
  EXPECT_FALSE(clock.Playing());
  clock.Play(true); // backwards from the beginning: from the end
  EXPECT_DOUBLE_EQ(clock.Time(), 20.0);
  EXPECT_THROW(clock.SetSpeed(0.0), dspace::Error);
  EXPECT_THROW(clock.SetLoop(TimeRange{3.0, 3.0}), dspace::Error);
  clock.SetRange({10.0, 20.0}, true);
  clock.Follow(true);
  clock.SetRange({10.0, 25.0}, true);
  EXPECT_DOUBLE_EQ(clock.Advance(110.0), 25.0);
  clock.Seek(12.0);
  EXPECT_FALSE(clock.Following());
}

TEST(TimelineWidgetTest, ButtonsAndKeysAsk) {
  auto source = std::make_shared<PlainSource>();
  TimelineWidget widget;
  widget.SetSource(source);
  Show(widget);
  Click(widget, "Play");
  Click(widget, "Play"); // pauses
  Click(widget, "Step");
  Click(widget, "Step back");
  Click(widget, "Faster");
  Click(widget, "Faster");
  Click(widget, "Slower");
  Click(widget, "Reverse");
  Click(widget, "Loop");
  Click(widget, "Live");
  EXPECT_EQ(source->asked,
            (std::vector<std::string>{"play 1", "play 0", "step 1", "step -1", "speed 2", "speed 4",
                                      "speed 2", "speed -2", "loop 100", "follow 1"}));
  EXPECT_EQ(Text(widget, "speed"), QString("\u2212\u00d7 2"));
  source->asked.clear();
  QTest::keyClick(&widget, Qt::Key_Space);
  QTest::keyClick(&widget, Qt::Key_Right);
  QTest::keyClick(&widget, Qt::Key_Left);
  QTest::keyClick(&widget, Qt::Key_End);
  source->state.time_s = 150.0;
  widget.Refresh();
  QTest::keyClick(&widget, Qt::Key_BracketLeft);
  EXPECT_EQ(source->asked,
            (std::vector<std::string>{"play 1", "step 1", "step -1", "seek 200", "loop 50"}));
}

TEST(TimelineWidgetTest, ShowsTheClockAndTheRealTimeFactor) {
  auto source = std::make_shared<PlainSource>();
  source->state.range = TimeRange{536500800.0, 536600000.0};
  source->state.time_s = 536500869.184;
  TimelineWidget widget;
  EXPECT_EQ(Text(widget, "utc"), "no clock");
  widget.SetSource(source);
  EXPECT_EQ(Text(widget, "utc"), "2017-01-01 00:00:00.000 UTC");
  EXPECT_EQ(Text(widget, "elapsed"), "T+ 00:01:09.184");
  EXPECT_EQ(Text(widget, "j2000"), "536500869.184 s past J2000");
  for (int i = 0; i <= 20; ++i) {
    source->state.time_s = 536501000.0 + 2.5 * i;
    widget.Refresh(1e9 + 0.1 * i); // later than the system's clock
  }
  ASSERT_TRUE(widget.Rate());
  EXPECT_NEAR(*widget.Rate(), 25.0, 1e-6);
  EXPECT_TRUE(Text(widget, "rate").startsWith("25.00")) << Text(widget, "rate").toStdString();
  source->state.j2000 = false;
  widget.Refresh();
  EXPECT_EQ(Text(widget, "utc"), "no UTC");
}

TEST(TimelineWidgetTest, TheBarScrubsSnapsZoomsAndLoops) {
  auto source = std::make_shared<PlainSource>();
  source->events = {{137.5, TimelineEvent::Severity::Warning, "fault", "valve <3> is stuck"}};
  source->gaps = {{180.0, 190.0}};
  TimelineWidget widget;
  widget.SetSource(source);
  Show(widget);
  ScrubBar& bar = *widget.Bar();
  const double pixel = 100.0 / (bar.PlaceOf(200.0) - bar.PlaceOf(100.0));
  QTest::mousePress(&bar, Qt::LeftButton, {}, At(bar, 120.0));
  EXPECT_NEAR(source->state.time_s, 120.0, pixel);
  Drag(bar, At(bar, 160.0));
  EXPECT_NEAR(source->state.time_s, 160.0, pixel);
  Drag(bar, {bar.width() + 500, 22}); // beyond the end
  EXPECT_DOUBLE_EQ(source->state.time_s, 200.0);
  QTest::mouseRelease(&bar, Qt::LeftButton, {}, At(bar, 160.0));
  QTest::mouseClick(&bar, Qt::LeftButton, {}, At(bar, 137.5, 8) + QPoint(3, 0));
  EXPECT_DOUBLE_EQ(source->state.time_s, 137.5); // the event's time
  EXPECT_EQ(bar.TextAt(At(bar, 137.5, 8)), "T+ 00:00:37.500  fault: valve <3> is stuck");
  EXPECT_TRUE(bar.TextAt(At(bar, 185.0)).contains("Lost"));

  QTest::mousePress(&bar, Qt::LeftButton, Qt::ShiftModifier, At(bar, 110.0));
  Drag(bar, At(bar, 130.0));
  QTest::mouseRelease(&bar, Qt::LeftButton, Qt::ShiftModifier, At(bar, 130.0));
  ASSERT_TRUE(source->state.loop);
  EXPECT_NEAR(source->state.loop->begin, 110.0, pixel);
  EXPECT_NEAR(source->state.loop->end, 130.0, pixel);
  QTest::mousePress(&bar, Qt::LeftButton, {}, At(bar, 130.0)); // its end is dragged
  Drag(bar, At(bar, 150.0));
  QTest::mouseRelease(&bar, Qt::LeftButton, {}, At(bar, 150.0));
  EXPECT_NEAR(source->state.loop->begin, 110.0, pixel);
  EXPECT_NEAR(source->state.loop->end, 150.0, pixel);

  const double under = bar.TimeAt(300);
  QWheelEvent wheel(QPointF(300, 22), bar.mapToGlobal(QPointF(300, 22)), QPoint(), QPoint(0, 480),
                    Qt::NoButton, Qt::NoModifier, Qt::NoScrollPhase, false);
  QApplication::sendEvent(&bar, &wheel);
  EXPECT_NEAR(bar.View().Length(), 100.0 * std::pow(0.8, 4), 1e-9);
  EXPECT_NEAR(bar.TimeAt(300), under, 1e-9);
}

TEST(TimelineWidgetTest, OnlyThePresentTimeIsDrawnAnew) {
  auto source = std::make_shared<PlainSource>();
  for (int i = 0; i < 10000; ++i) {
    source->events.push_back({100.0 + 0.01 * i, TimelineEvent::Severity::Info, "note", "n"});
  }
  TimelineWidget widget;
  widget.SetSource(source);
  Show(widget);
  QTest::qWait(100);
  const int drawings = widget.Bar()->Drawings();
  for (int i = 0; i < 20; ++i) {
    source->state.time_s = 100.0 + i;
    widget.Refresh();
    widget.Bar()->repaint();
  }
  EXPECT_EQ(widget.Bar()->Drawings(), drawings);
  EXPECT_TRUE(widget.Bar()->TextAt(At(*widget.Bar(), 150.0, 8)).contains(" more"));
}

TEST(TimelineWidgetTest, AFailingSourceIsToldOnce) {
  auto source = std::make_shared<PlainSource>();
  TimelineWidget widget;
  QSignalSpy failed(&widget, &TimelineWidget::failed);
  source->fails = "command 7 is damaged";
  widget.SetSource(source);
  Show(widget);
  QTest::qWait(200);
  ASSERT_EQ(failed.count(), 1);
  EXPECT_EQ(failed.at(0).at(0).toString(), "recording: command 7 is damaged");
}

TEST(TimelineWidgetTest, ALiveSceneShowsItsClockAndEvents) {
  vtkNew<vtkDspaceSession> session;
  const auto run = [&](dspace::v1::Command command) {
    command.set_scene("run");
    dspace::v1::Reply reply;
    reply.ParseFromString(session->Execute(command.SerializeAsString()));
    EXPECT_FALSE(reply.has_error()) << reply.error().message();
  };
  dspace::v1::Command command;
  command.mutable_create_scene();
  run(command);
  command.mutable_set_time()->set_time_s(50.0);
  run(command);
  const std::shared_ptr<SceneTimeSource> source = MakeTimeSource(session, "run", false);
  TimelineWidget widget;
  widget.SetSource(source);
  Show(widget);
  EXPECT_FALSE(widget.findChild<QToolButton*>("Play")->isEnabled());
  command.mutable_set_time()->set_time_s(62.5);
  run(command);
  command.mutable_log_event()->set_kind("staging");
  run(command);
  ASSERT_TRUE(QTest::qWaitFor([&] { return Text(widget, "elapsed") == "T+ 00:00:12.500"; }, 2000));
  ASSERT_EQ(source->Events().size(), 1u);
  EXPECT_EQ(source->Events()[0].kind, "staging");
  EXPECT_DOUBLE_EQ(source->Events()[0].time_s, 62.5);
  QSignalSpy failed(&widget, &TimelineWidget::failed);
  QTest::keyClick(&widget, Qt::Key_Left); // asks nothing of it
  QTest::mouseClick(widget.Bar(), Qt::LeftButton, {}, At(*widget.Bar(), 55.0));
  EXPECT_EQ(failed.count(), 0);
  EXPECT_THROW(source->Seek(55.0), dspace::Error);
}

TEST(TimelineWidgetTest, PlaysARecording) {
  Played played;
  auto source = std::make_shared<PlaybackTimeSource>(played.playback, played.reader);
  EXPECT_EQ(*source->GetState().range, (TimeRange{1000.0, 1010.0}));
  ASSERT_EQ(source->Events().size(), 2u);
  EXPECT_EQ(source->Events()[1].text, "valve 3 is stuck");
  EXPECT_EQ(source->Events()[1].severity, TimelineEvent::Severity::Alarm);
  source->Advance(0.0);
  source->Play(true);
  for (int i = 1; i <= 30; ++i) {
    source->Advance(0.1 * i);
  }
  EXPECT_DOUBLE_EQ(source->GetState().time_s, 1003.0);
  EXPECT_DOUBLE_EQ(played.X(), 6.0);
  source->Seek(1009.9);
  EXPECT_DOUBLE_EQ(played.X(), 6.0); // not before Advance()
  source->Seek(1007.6);
  source->Advance(3.0);
  EXPECT_DOUBLE_EQ(played.X(), 15.0); // the step at 1007.5 s
  source->Step(-2);
  source->Advance(3.1);
  EXPECT_DOUBLE_EQ(played.X(), 13.0);
  EXPECT_FALSE(source->GetState().playing);
  source->Step(-50);
  source->Advance(3.15);
  EXPECT_DOUBLE_EQ(source->GetState().time_s, 1000.0); // not what was built before
  source->Seek(1006.0);
  source->SetSpeed(-10.0);
  source->Play(true);
  for (int i = 0; i < 20; ++i) {
    source->Advance(3.2 + 0.1 * i);
  }
  EXPECT_DOUBLE_EQ(played.X(), 0.0);
  EXPECT_FALSE(source->GetState().playing);

  TimelineWidget widget;
  widget.SetSource(source);
  Show(widget);
  QTest::mouseClick(widget.Bar(), Qt::LeftButton, {}, At(*widget.Bar(), 1006.0, 8));
  EXPECT_DOUBLE_EQ(played.X(), 12.0); // the event's step
  QTest::keyClick(&widget, Qt::Key_Right);
  EXPECT_DOUBLE_EQ(played.X(), 13.0);
}

TEST(TimelineWidgetTest, FollowsARecordingThatGrows) {
  QTemporaryDir folder;
  const std::string path = folder.filePath("live.dspace").toStdString();
  vtkNew<vtkDspaceSession> session;
  ASSERT_EQ(session->Record(path, 0.01), "");
  const auto step = [&](double time_s) {
    dspace::v1::Command command;
    command.set_scene("run");
    command.mutable_set_time()->set_time_s(time_s);
    session->Execute(command.SerializeAsString());
    ASSERT_EQ(session->FlushRecording(), "");
  };
  dspace::v1::Command command;
  command.set_scene("run");
  command.mutable_create_scene();
  session->Execute(command.SerializeAsString());
  step(1.0);
  step(2.0);
  dspace::session::RecordingReader reader(path);
  dspace::session::Interpreter interpreter;
  dspace::session::Playback playback(reader, interpreter);
  PlaybackTimeSource source(playback, reader, true);
  source.Follow(true);
  source.Advance(1.0);
  const double before = source.GetState().range->end;
  step(3.0);
  step(4.0);
  source.Advance(2.0);
  EXPECT_GT(source.GetState().range->end, before);
  EXPECT_DOUBLE_EQ(source.GetState().time_s, source.GetState().range->end);
  EXPECT_TRUE(source.GetState().following);
}

TEST(TimelineMarksTest, KeepMarksOfOthersAndFieldsOfOthers) {
  QTemporaryDir folder;
  const std::string path = MarksPath(folder.filePath("run.dspace").toStdString());
  EXPECT_EQ(QString::fromStdString(path), folder.filePath("run.dspace.marks.json"));
  EXPECT_TRUE(LoadMarks(path).empty());
  PutMark(path, {"a", 1.0 / 3.0, "line 1\nline 2 \u00e9"});
  PutMark(path, {"b", 0.25, ""}); // as another process does
  auto marks = LoadMarks(path);
  ASSERT_EQ(marks.size(), 2u);
  EXPECT_EQ(marks[0].id, "b");
  EXPECT_EQ(marks[1].time_s, 1.0 / 3.0); // to the bit
  EXPECT_EQ(marks[1].note, "line 1\nline 2 \u00e9");
  // A field that this version does not know stays.
  QFile file(QString::fromStdString(path));
  ASSERT_TRUE(file.open(QIODevice::ReadWrite));
  QByteArray bytes = file.readAll();
  bytes.replace("\"id\": \"a\"", "\"color\": \"red\", \"id\": \"a\"");
  file.resize(0);
  file.seek(0);
  file.write(bytes);
  file.close();
  PutMark(path, {"a", 0.5, "new"});
  EXPECT_EQ(EraseMark(path, "b").size(), 1u);
  ASSERT_TRUE(file.open(QIODevice::ReadOnly));
  EXPECT_TRUE(file.readAll().contains("\"red\""));
  file.close();
  EXPECT_THROW(PutMark(path, {"", 1.0, ""}), dspace::Error);
  EXPECT_THROW(PutMark(path, {"c", std::nan(""), ""}), dspace::Error);
  {
    const dspace::testing::FullDisk full(16);
    EXPECT_THROW(PutMark(path, {"c", 1.0, "lost"}), dspace::Error);
  }
  EXPECT_EQ(LoadMarks(path).size(), 1u);
}

TEST(TimelineMarksTest, ADamagedFileStaysAsItIs) {
  QTemporaryDir folder;
  const std::string path = folder.filePath("a.marks.json").toStdString();
  for (const char* text :
       {"", "{", "[1]", "{\"format\": \"other\", \"version\": 1, \"marks\": []}",
        "{\"format\": \"dspace marks\", \"version\": 2, \"marks\": []}",
        "{\"format\": \"dspace marks\", \"version\": 1, \"marks\": [{\"id\": \"a\"}]}"}) {
    std::ofstream(path, std::ios::trunc) << text;
    EXPECT_THROW(LoadMarks(path), dspace::Error) << text;
    EXPECT_THROW(PutMark(path, {"b", 1.0, ""}), dspace::Error) << text;
    std::stringstream left;
    left << std::ifstream(path).rdbuf();
    EXPECT_EQ(left.str(), text);
  }
}

TEST(TimelineWidgetTest, MarksAreKeptInTheSideFile) {
  QTemporaryDir folder;
  const std::string path = folder.filePath("run.dspace.marks.json").toStdString();
  PutMark(path, {"first", 120.0, "look here"});
  auto source = std::make_shared<PlainSource>();
  {
    TimelineWidget widget;
    widget.SetSource(source);
    widget.SetMarksFile(path);
    Show(widget);
    ASSERT_TRUE(QTest::qWaitFor([&] { return widget.Marks().size() == 1; }, 3000));
    ScrubBar& bar = *widget.Bar();
    EXPECT_EQ(bar.TextAt(At(bar, 120.0, 8)), "T+ 00:00:20.000  Mark: look here");
    source->state.time_s = 150.0;
    widget.Refresh();
    QTest::keyClick(&widget, Qt::Key_M);
    auto* dialog = widget.findChild<QInputDialog*>();
    ASSERT_NE(dialog, nullptr);
    QTest::keyClicks(dialog->findChild<QPlainTextEdit*>(), "dust devil");
    dialog->accept();
    ASSERT_TRUE(QTest::qWaitFor([&] { return widget.Marks().size() == 2; }, 3000));
    EXPECT_EQ(widget.Marks()[1].note, "dust devil");
    EXPECT_DOUBLE_EQ(widget.Marks()[1].time_s, 150.0);
    QTest::mouseDClick(&bar, Qt::LeftButton, {}, At(bar, 120.0, 8));
    dialog = nullptr;
    ASSERT_TRUE(QTest::qWaitFor(
        [&] {
          for (auto* open : widget.findChildren<QInputDialog*>()) {
            dialog = open->isVisible() ? open : dialog;
          }
          return dialog != nullptr;
        },
        3000));
    dialog->setTextValue("look there");
    dialog->accept();
    ASSERT_TRUE(QTest::qWaitFor([&] { return widget.Marks()[0].note == "look there"; }, 3000));
    widget.EraseMark(widget.Marks()[1].id); // written before the widget ends
  }
  const auto marks = LoadMarks(path);
  ASSERT_EQ(marks.size(), 1u);
  EXPECT_EQ(marks[0].note, "look there");
  // A file that cannot be read is told, and stays.
  std::ofstream(path, std::ios::trunc) << "{";
  TimelineWidget widget;
  QSignalSpy failed(&widget, &TimelineWidget::failed);
  widget.SetMarksFile(path);
  ASSERT_TRUE(QTest::qWaitFor([&] { return failed.count() == 1; }, 3000));
  widget.PutMark({"x", 1.0, ""});
  QTest::qWait(100);
  EXPECT_TRUE(widget.Marks().empty());
}

TEST(TimelineWidgetTest, ViewersOfALiveSceneCountFromTheSameTime) {
  vtkNew<vtkDspaceSession> session;
  const auto run = [&](dspace::v1::Command command) {
    command.set_scene("run");
    dspace::v1::Reply reply;
    reply.ParseFromString(session->Execute(command.SerializeAsString()));
    EXPECT_FALSE(reply.has_error()) << reply.error().message();
  };
  dspace::v1::Command command;
  command.mutable_create_scene();
  run(command);
  const auto early = MakeTimeSource(session, "run"); // before the first time is set
  EXPECT_EQ(early->GetState().range->begin, early->GetState().time_s);
  for (const double time_s : {5e8, 5e8 + 10.0}) {
    command.mutable_set_time()->set_time_s(time_s);
    run(command);
    early->Advance(0.0);
  }
  const auto late = MakeTimeSource(session, "run");
  EXPECT_EQ(*early->GetState().range, (TimeRange{5e8, 5e8 + 10.0}));
  EXPECT_EQ(*late->GetState().range, (TimeRange{5e8, 5e8 + 10.0}));
}

TEST(TimelineWidgetTest, ANarrowOneHasTheElapsedTimeAndTheFactor) {
  TimelineWidget widget;
  Show(widget);
  widget.resize(1000, 120);
  ASSERT_TRUE(QTest::qWaitFor([&] { return widget.findChild<QLabel*>("utc")->isVisible(); }, 5000));
  widget.resize(widget.minimumSizeHint().width(), 120);
  ASSERT_TRUE(
      QTest::qWaitFor([&] { return !widget.findChild<QLabel*>("utc")->isVisible(); }, 5000));
  EXPECT_LT(widget.width(), 600);
  for (const char* shown : {"elapsed", "rate"}) {
    const auto* label = widget.findChild<QLabel*>(shown);
    EXPECT_TRUE(label->isVisible());
    EXPECT_TRUE(QTest::qWaitFor([&] { return label->geometry().right() <= widget.width(); }, 5000));
  }
}
