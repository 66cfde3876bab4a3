// Wheel tracks in snapshots: the ruts that the terrain has, in the memory that it keeps them in.
#include <cmath>
#include <filesystem>
#include <random>

#include <malloc.h>

#include <dspace/ledger/Ledger.h>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

namespace fs = std::filesystem;

class TrackLedger : public CommandTest {
protected:
  TrackLedger()
      : TrackLedger("ncols 5\nnrows 5\nxllcorner 100\nyllcorner 200\ncellsize 2\n"
                    "0 1 2 1 0\n0 1 2 1 0\n0 1 3 1 0\n0 1 2 1 0\n0 1 2 1 0\n",
                    v1::OpenTerrain::CLIPMAP, 6) {} // 3 cm

  TrackLedger(const std::string& ground, v1::OpenTerrain::Mode mode, unsigned subdivisions)
      : Ground_("tracked.asc", ground), Ledger_(&this->Interpreter_.GetState()) {
    this->Interpreter_.AddListener([this](const v1::Command& command, const v1::Reply& reply) {
      this->Ledger_.Add(command, reply);
      this->Last_ = command;
    });
    v1::Command anew; // from nothing on, as a ledger needs it
    anew.mutable_remove_scene();
    this->Accept(anew);
    anew.mutable_create_scene();
    this->Accept(anew);
    v1::Command open;
    open.mutable_open_terrain()->set_path(this->Ground_.Path());
    open.mutable_open_terrain()->set_mode(mode);
    open.mutable_open_terrain()->set_subdivisions(subdivisions);
    this->Accept(open);
  }

  static v1::Command Roll(const std::string& wheel, double x, double y, double sinkage) {
    v1::Command command;
    v1::TrackWheels* roll = command.mutable_track_wheels();
    roll->set_terrain("terrain");
    roll->set_width(0.2);
    roll->set_rim_width(0.05);
    roll->set_rim_height(0.02);
    roll->set_tread_pitch(0.1);
    roll->set_tread_depth(0.01);
    roll->add_wheel()->set_name(wheel);
    for (const double v : {x, y, 30.0, sinkage, double(NAN)}) {
      roll->mutable_wheel(0)->add_contact(v);
    }
    return command;
  }

  // Some centimetres a contact, of two wheels that cross.
  void Wander(session::Interpreter& interpreter, int steps, double phase) {
    for (int i = 0; i < steps; ++i) {
      const double s = phase + 0.02 * i;
      v1::Command left = Roll("left", 2.0 * std::sin(s), 2.0 * std::cos(1.3 * s), 0.05);
      v1::Command right =
          Roll("right", 2.0 * std::sin(0.7 * s), std::cos(s), 0.03 + 0.001 * (i % 9));
      ASSERT_FALSE(interpreter.Execute(left).has_error());
      ASSERT_FALSE(interpreter.Execute(right).has_error());
    }
  }

  // Every number that can be asked at thousands of places.
  static std::string Answers(session::Interpreter& interpreter) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> place(-3.5, 3.5);
    v1::Command query;
    v1::QueryTerrain* ask = query.mutable_query_terrain();
    ask->set_terrain("terrain");
    ask->set_height(true);
    ask->set_normal(true);
    ask->set_slope(true);
    v1::Command rays;
    rays.mutable_intersect_terrain()->set_terrain("terrain");
    for (int i = 0; i < 5000; ++i) {
      const double x = place(random);
      const double y = place(random);
      ask->add_point(x);
      ask->add_point(y);
      if (i < 500) {
        for (const double v : {x, y, 10.0, 0.1, 0.2, -1.0}) {
          rays.mutable_intersect_terrain()->add_ray(v);
        }
      }
    }
    v1::Command describe;
    describe.mutable_describe_terrain()->set_terrain("terrain");
    v1::TerrainReply said = interpreter.Execute(describe).terrain();
    said.clear_tile_loads(); // depends on what was asked
    said.clear_tile_bytes();
    said.clear_tiles_built();
    const v1::Reply heights = interpreter.Execute(query);
    EXPECT_EQ(heights.terrain_values().height_size(), 5000);
    const v1::Reply hits = interpreter.Execute(rays);
    EXPECT_FALSE(hits.has_error()) << hits.error().message();
    return heights.SerializeAsString() + hits.SerializeAsString() + said.SerializeAsString();
  }

  void Rebuild(session::Interpreter& into) {
    for (v1::Command command : this->Ledger_.Commands()) {
      const v1::Reply reply = into.Execute(command);
      ASSERT_FALSE(reply.has_error()) << reply.error().message();
    }
  }

  TemporaryFile Ground_;
  session::Ledger Ledger_;
  v1::Command Last_;
};

// Triangles between posts 5 cm apart.
class TriangleTrackLedger : public TrackLedger {
protected:
  TriangleTrackLedger() : TrackLedger(Hills(), v1::OpenTerrain::TRIANGLES, 0) {}

  static std::string Hills() {
    constexpr int Side = 161;
    std::string text = "ncols 161\nnrows 161\nxllcorner 100\nyllcorner 200\ncellsize 0.05\n";
    for (int r = 0; r < Side; ++r) {
      for (int c = 0; c < Side; ++c) {
        text +=
            std::to_string(std::sin(0.07 * c) * std::cos(0.05 * r)) + (c + 1 < Side ? " " : "\n");
      }
    }
    return text;
  }

  // All that is drawn of the terrain.
  static std::string Drawn(session::Interpreter& interpreter) {
    const session::SceneState& scene = interpreter.GetState().scenes.at("scene");
    GraphicsObject object;
    scene.terrains.at("terrain")->Draw(object);
    const GraphicsObject& shown =
        scene.scene->Object(scene.terrains.at("terrain")->Object()); // as the scene has it
    std::string bytes;
    const auto add = [&bytes](const auto& values) {
      bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof values[0]);
    };
    EXPECT_EQ(object.levels.at(0).parts.size(), shown.levels.at(0).parts.size());
    for (std::size_t i = 0; i < object.levels[0].parts.size(); ++i) {
      const Part& part = object.levels[0].parts[i];
      EXPECT_EQ(part.mesh, shown.levels[0].parts.at(i).mesh) << i;
      add(part.mesh->positions);
      add(part.mesh->normals);
      add(part.mesh->colors);
      add(part.mesh->indices);
    }
    return bytes;
  }
};

TEST_F(TriangleTrackLedger, RebuildsTheRutsToTheByteAndTheyGoOnAlike) {
  const std::string bare = Answers(this->Interpreter_);
  const std::string plain = Drawn(this->Interpreter_);
  this->Wander(this->Interpreter_, 200, 0.0);
  session::Interpreter second;
  this->Rebuild(second);
  EXPECT_NE(Answers(this->Interpreter_), bare);
  EXPECT_NE(Drawn(this->Interpreter_), plain);
  EXPECT_TRUE(Answers(second) == Answers(this->Interpreter_));
  EXPECT_TRUE(Drawn(second) == Drawn(this->Interpreter_));
  this->Wander(this->Interpreter_, 50, 4.0);
  this->Wander(second, 50, 4.0);
  EXPECT_TRUE(Answers(second) == Answers(this->Interpreter_));
  EXPECT_TRUE(Drawn(second) == Drawn(this->Interpreter_));
  v1::Command clear;
  clear.mutable_clear_tracks()->set_terrain("terrain");
  this->Accept(clear);
  session::Interpreter third;
  this->Rebuild(third);
  EXPECT_TRUE(Answers(third) == bare);
  EXPECT_TRUE(Answers(this->Interpreter_) == bare);
  EXPECT_TRUE(Drawn(third) == plain);
  EXPECT_TRUE(Drawn(this->Interpreter_) == plain);
}

TEST_F(TrackLedger, RebuildsTheRutsToTheByteAndTheyGoOnAlike) {
  const std::string bare = Answers(this->Interpreter_);
  this->Wander(this->Interpreter_, 400, 0.0);
  session::Interpreter second;
  this->Rebuild(second);
  EXPECT_NE(Answers(this->Interpreter_), bare);
  EXPECT_TRUE(Answers(second) == Answers(this->Interpreter_));
  this->Wander(this->Interpreter_, 100, 8.0);
  this->Wander(second, 100, 8.0);
  EXPECT_TRUE(Answers(second) == Answers(this->Interpreter_));
  v1::Command clear;
  clear.mutable_clear_tracks()->set_terrain("terrain");
  this->Accept(clear);
  session::Interpreter third;
  this->Rebuild(third);
  EXPECT_TRUE(Answers(third) == bare);
}

TEST_F(TrackLedger, OneThatStandsCostsNothing) {
  v1::Command command = Roll("wheel", 0.0, 0.0, 0.05);
  this->Accept(command);
  constexpr int Contacts = 100000;
  const std::size_t before = mallinfo2().uordblks;
  for (int i = 0; i < Contacts; ++i) {
    command.mutable_track_wheels()->mutable_wheel(0)->set_contact(0, 1e-5 * (i % 2));
    this->Ledger_.Add(command, {});
  }
  const std::size_t after = mallinfo2().uordblks;
  EXPECT_LT(double(after) - double(before), 100e3); // as commands they have some 30 MB
  for (int i = 0; i < 1000; ++i) {
    command.mutable_track_wheels()->mutable_wheel(0)->set_contact(0, 1e-5 * (i % 2));
    this->Accept(command);
  }
  std::size_t bytes = 0;
  for (const v1::Command& each : this->Ledger_.Commands()) {
    bytes += each.has_restore_tracks() ? each.ByteSizeLong() : 0;
  }
  EXPECT_GT(bytes, 0u);
  EXPECT_LT(bytes, 300u);
}

TEST_F(TrackLedger, ALoadedFileMayChangeOrGo) {
  const std::string path = this->Ground_.Path() + ".geojson";
  this->Wander(this->Interpreter_, 50, 0.0);
  v1::Command save;
  save.mutable_save_tracks()->set_terrain("terrain");
  save.mutable_save_tracks()->set_path(path);
  this->Accept(save);
  v1::Command clear;
  clear.mutable_clear_tracks()->set_terrain("terrain");
  this->Accept(clear);
  v1::Command load;
  load.mutable_load_tracks()->set_terrain("terrain");
  load.mutable_load_tracks()->set_path(path);
  this->Accept(load);
  const v1::Command heard = this->Last_; // as recordings and viewers have it
  session::Interpreter viewer;           // that follows command by command
  this->Rebuild(viewer);
  const std::string loaded = Answers(this->Interpreter_);
  this->Accept(clear);
  this->Accept(save); // nothing is in the file any more
  for (v1::Command command : {clear, heard}) {
    this->Accept(command);
    ASSERT_FALSE(viewer.Execute(command).has_error());
  }
  EXPECT_TRUE(Answers(this->Interpreter_) == loaded);
  EXPECT_TRUE(Answers(viewer) == loaded);
  this->Wander(this->Interpreter_, 50, 1.0);
  this->Wander(viewer, 50, 1.0);
  this->Accept(save); // more than there was
  session::Interpreter second;
  this->Rebuild(second);
  fs::remove(path);
  session::Interpreter third;
  this->Rebuild(third);
  const std::string answers = Answers(this->Interpreter_);
  EXPECT_TRUE(Answers(viewer) == answers);
  EXPECT_TRUE(Answers(second) == answers);
  EXPECT_TRUE(Answers(third) == answers);
}

TEST_F(TrackLedger, ManyContactsComeInPieces) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-0.5, 0.5);
  for (int wheel = 0; wheel < 7; ++wheel) {
    v1::Command command = Roll("wheel " + std::to_string(wheel), 0.0, 0.0, 0.05);
    for (int i = 0; i < 10000; ++i) { // none on a line with others
      for (const double v : {place(random), place(random), double(NAN), 0.05, double(NAN)}) {
        command.mutable_track_wheels()->mutable_wheel(0)->add_contact(v);
      }
    }
    this->Accept(command);
  }
  std::size_t contacts = 0;
  int pieces = 0;
  for (const v1::Command& command : this->Ledger_.Commands()) {
    EXPECT_LT(command.ByteSizeLong(), std::size_t(1) << 20);
    for (const auto& stroke : command.restore_tracks().stroke()) {
      contacts += std::size_t(stroke.rolled_size()) - stroke.skipped();
    }
    pieces += command.has_restore_tracks() ? 1 : 0;
  }
  EXPECT_EQ(pieces, 3);
  session::Interpreter second;
  this->Rebuild(second);
  v1::Command describe;
  describe.mutable_describe_terrain()->set_terrain("terrain");
  EXPECT_EQ(this->Interpreter_.Execute(describe).terrain().track_contacts(), contacts);
  EXPECT_GT(contacts, 69000u);
  EXPECT_EQ(second.Execute(describe).terrain().track_bytes(),
            this->Interpreter_.Execute(describe).terrain().track_bytes());
  EXPECT_EQ(second.Execute(describe).terrain().track_length(),
            this->Interpreter_.Execute(describe).terrain().track_length());
}

TEST_F(TrackLedger, WhatDoesNotFitTogetherIsRejected) {
  v1::Command restore;
  restore.mutable_restore_tracks()->set_terrain("terrain");
  v1::RestoreTracks::Stroke* stroke = restore.mutable_restore_tracks()->add_stroke();
  stroke->set_name("wheel");
  stroke->set_width(0.2);
  stroke->add_rolled(0.0);
  this->Reject(restore, v1::Error::INVALID_ARGUMENT, "0 coordinates");
  stroke->add_place(0.0);
  stroke->add_place(0.0);
  stroke->add_heading(0.0f);
  stroke->add_sinkage(0.1f);
  stroke->set_skipped(2);
  this->Reject(restore, v1::Error::INVALID_ARGUMENT, "says that 2");
  stroke->set_skipped(1);
  this->Reject(restore, v1::Error::INVALID_ARGUMENT, "no contact");
  stroke->set_skipped(0);
  stroke->set_sinkage(0, 2.0f);
  this->Reject(restore, v1::Error::INVALID_ARGUMENT, "sinkage");
  stroke->set_sinkage(0, 0.1f);
  this->Accept(restore);
  // A ledger that hears of tracks and has no terrain to ask does not leave them out.
  session::Ledger blind;
  for (const v1::Command& command : this->Ledger_.Commands()) {
    blind.Add(command, {});
  }
  EXPECT_THROW(blind.Commands(), Error);
}

} // namespace
} // namespace dspace::testing
