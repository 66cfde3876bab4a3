// Playback of commands whose files another thread reads.
#include <algorithm>
#include <fstream>

#include <dspace/recording/Playback.h>
#include <dspace/recording/RecordingWriter.h>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

using session::Interpreter;
using session::Ledger;
using session::RecordingReader;

class PlaybackAhead : public CommandTest {
protected:
  const TemporaryFolder Folder_;
  const std::string Path_ = this->Folder_ / "playback.dspace";
};

// While the files of a command are read elsewhere, a movement waits for them in slices: no command
// is lost or executed twice, another aim takes over what is being read if it needs the same, and at
// most two are read at a time.
TEST_F(PlaybackAhead, WaitsForFilesThatAreReadElsewhere) {
  constexpr int Models = 6;
  {
    Interpreter interpreter;
    Ledger ledger(&interpreter.GetState());
    session::RecordingOptions options;
    options.snapshotCommands = 1000;
    session::RecordingWriter writer(this->Path_, ledger, 0.0, options);
    interpreter.AddListener([&](const v1::Command& command, const v1::Reply& reply) {
      ledger.Add(command, reply);
      EXPECT_EQ(writer.Add(command, reply, ledger), "");
    });
    v1::Command scene;
    scene.mutable_create_scene();
    ASSERT_FALSE(interpreter.Execute(scene).has_error());
    for (int i = 0; i < Models; ++i) {
      v1::Command time;
      time.mutable_set_time()->set_time_s(i);
      ASSERT_FALSE(interpreter.Execute(time).has_error());
      const std::string path = this->Folder_ / ("m" + std::to_string(i) + ".stl");
      std::ofstream(path) << "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                             "vertex 0 "
                          << i + 1 << " 0\nendloop\nendfacet\nendsolid a\n";
      v1::Command model;
      model.mutable_import_object()->add_level()->set_path(path);
      const v1::Reply reply = interpreter.Execute(model);
      ASSERT_FALSE(reply.has_error()) << reply.error().message();
    }
  }
  RecordingReader reader(this->Path_);
  Interpreter shown;
  session::Playback playback(reader, shown);
  bool released = false;
  int begun = 0;
  int executed = 0;
  int reading = 0;
  int mostReading = 0;
  session::PlaybackGuests guests;
  guests.readAhead = [&](const v1::Command& command,
                         const FilesGuard::Check&) -> std::optional<session::CommandAhead> {
    if (!command.has_import_object()) {
      return {};
    }
    ++begun;
    mostReading = std::max(mostReading, ++reading);
    const auto done = std::make_shared<bool>(false);
    return session::CommandAhead{[&, done](double) {
                                   reading -= released && !*done;
                                   *done = *done || released;
                                   return *done;
                                 },
                                 [&, command] {
                                   ++executed;
                                   v1::Command read = command;
                                   return shown.Execute(read);
                                 }};
  };
  playback.SetGuests(guests);
  const auto objects = [&] { return int(shown.FindScene("scene")->Objects().size()); };
  const auto wait = [&] { // for what is not released
    for (int i = 0; i < 5; ++i) {
      EXPECT_FALSE(playback.Continue(0.0));
    }
  };
  playback.Aim(Models);
  wait();
  EXPECT_EQ(begun, 1);
  EXPECT_EQ(executed, 0);
  EXPECT_EQ(playback.Index(), 0u);
  playback.Aim(2); // on the same way
  wait();
  EXPECT_EQ(begun, 1);
  released = true;
  while (!playback.Continue(0.0)) {
  }
  EXPECT_EQ(playback.Index(), 2u);
  EXPECT_EQ(objects(), 2);
  EXPECT_EQ(executed, 2);
  released = false;
  playback.Aim(Models);
  wait();
  EXPECT_EQ(begun, 3);
  playback.Aim(1); // back to the start, by another way
  wait();
  EXPECT_EQ(begun, 4);
  playback.Aim(Models); // the same way again
  wait();
  EXPECT_EQ(begun, 4);
  EXPECT_EQ(mostReading, 2);
  released = true;
  while (!playback.Continue(0.0)) {
  }
  EXPECT_EQ(playback.Index(), std::size_t(Models));
  EXPECT_EQ(objects(), Models);
  EXPECT_EQ(executed, 2 + Models);
  playback.Step(-3); // waits
  EXPECT_EQ(objects(), Models - 3);
}

} // namespace
} // namespace dspace::testing
