// Colour layers through commands: the interpreter's choices are recorded, and a rejected command
// changes nothing.
#include <cmath>
#include <filesystem>
#include <functional>
#include <vector>

#include <dspace/ledger/Ledger.h>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

namespace fs = std::filesystem;

std::string Grid(const char* values) {
  std::string text = "ncols 5\nnrows 5\nxllcorner 100\nyllcorner 200\ncellsize 2\n";
  for (int row = 0; row < 5; ++row) {
    text += std::string(values) + "\n";
  }
  return text;
}

class TerrainLayers : public CommandTest {
protected:
  TerrainLayers()
      : Ground_("layered.asc", Grid("0 0 0 0 0")), Values_("values.asc", Grid("-3 1 2 5 9")),
        Image_("painted.ppm", "P6\n2 1\n255\n" + std::string("\xff\0\0\0\xff\0", 6)),
        Shapes_("shapes.geojson",
                R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},
                "geometry":{"type":"Point","coordinates":[105, 205]}}]})") {}

  void OpenGround(v1::OpenTerrain::Mode mode = v1::OpenTerrain::CLIPMAP) {
    v1::Command command;
    command.mutable_open_terrain()->set_path(this->Ground_.Path());
    command.mutable_open_terrain()->set_mode(mode);
    this->Accept(command);
  }

  static v1::Command Noise(const std::string& name = {}) {
    v1::Command command;
    command.mutable_add_terrain_layer()->set_terrain("terrain");
    command.mutable_add_terrain_layer()->set_name(name);
    command.mutable_add_terrain_layer()->mutable_noise();
    return command;
  }

  v1::TerrainLayerReply Add(v1::Command command) { return this->Accept(command).terrain_layer(); }

  v1::Reply Change(const std::string& name,
                   const std::function<void(v1::ChangeTerrainLayer&)>& fill) {
    v1::Command command;
    command.mutable_change_terrain_layer()->set_terrain("terrain");
    command.mutable_change_terrain_layer()->set_name(name);
    fill(*command.mutable_change_terrain_layer());
    return this->Interpreter_.Execute(command);
  }

  static v1::TerrainLayerList LayersOf(session::Interpreter& interpreter) {
    v1::Command command;
    command.mutable_list_terrain_layers()->set_terrain("terrain");
    return interpreter.Execute(command).terrain_layers();
  }

  // Bottom first: "image 2, noise".
  std::string Names() {
    std::string names;
    const v1::TerrainLayerList list = LayersOf(this->Interpreter_);
    for (const v1::TerrainLayerReply& layer : list.layer()) {
      names += (names.empty() ? "" : ", ") + layer.name();
    }
    return names;
  }

  void RejectLayer(const v1::Command& command, v1::Error::Kind kind, const std::string& text) {
    const std::string before = LayersOf(this->Interpreter_).DebugString();
    this->Reject(command, kind, text);
    EXPECT_EQ(LayersOf(this->Interpreter_).DebugString(), before);
  }

  TemporaryFile Ground_;
  TemporaryFile Values_;
  TemporaryFile Image_;
  TemporaryFile Shapes_;
};

TEST_F(TerrainLayers, AreNamedOrderedChangedAndRemoved) {
  this->OpenGround();
  EXPECT_EQ(this->Names(), "");
  const v1::TerrainLayerReply first = this->Add(Noise());
  EXPECT_EQ(first.name(), "noise");
  EXPECT_EQ(first.kind(), v1::TerrainLayerReply::NOISE);
  EXPECT_EQ(first.opacity(), 1.0);
  EXPECT_TRUE(first.visible());
  EXPECT_EQ(first.path(), "");
  EXPECT_EQ(this->Add(Noise()).position(), 1u);
  v1::Command low = Noise("low");
  low.mutable_add_terrain_layer()->set_position(0);
  low.mutable_add_terrain_layer()->set_opacity(0.25);
  low.mutable_add_terrain_layer()->set_hidden(true);
  const v1::TerrainLayerReply added = this->Add(low);
  EXPECT_EQ(added.position(), 0u);
  EXPECT_EQ(added.opacity(), 0.25);
  EXPECT_FALSE(added.visible());
  EXPECT_EQ(this->Names(), "low, noise, noise 2");

  const v1::TerrainLayerReply moved =
      this->Change("low", [](auto& c) { c.set_position(2); }).terrain_layer();
  EXPECT_EQ(moved.position(), 2u);
  EXPECT_EQ(moved.opacity(), 0.25); // what is absent stays
  EXPECT_FALSE(moved.visible());
  EXPECT_EQ(this->Names(), "noise, noise 2, low");
  EXPECT_EQ(this->Change("low", [](auto& c) { c.set_opacity(0); }).terrain_layer().opacity(), 0);
  EXPECT_TRUE(this->Change("low", [](auto& c) { c.set_visible(true); }).terrain_layer().visible());

  v1::Command remove;
  remove.mutable_remove_terrain_layer()->set_terrain("terrain");
  remove.mutable_remove_terrain_layer()->set_name("noise");
  this->Accept(remove);
  EXPECT_EQ(this->Names(), "noise 2, low");
  this->RejectLayer(remove, v1::Error::NOT_FOUND, "there are: 'noise 2', 'low'");
  EXPECT_EQ(this->Add(Noise()).name(), "noise"); // free again
}

TEST_F(TerrainLayers, TellWhatALegendNeeds) {
  this->OpenGround();
  v1::Command command;
  command.mutable_add_terrain_layer()->set_terrain("terrain");
  v1::AddTerrainLayer::FalseColor* color =
      command.mutable_add_terrain_layer()->mutable_false_color();
  color->set_path(this->Values_.Path());
  v1::TerrainLayerReply layer = this->Add(command);
  EXPECT_EQ(layer.name(), "false color");
  EXPECT_EQ(layer.kind(), v1::TerrainLayerReply::FALSE_COLOR);
  EXPECT_EQ(layer.low(), -3);
  EXPECT_EQ(layer.high(), 9);
  EXPECT_GE(layer.color_size(), 3);
  EXPECT_NEAR(layer.pixel_size(), 2, 1e-9);
  color->set_low(1);
  color->set_high(1.5);
  color->add_color()->set_b(0.5);
  color->add_color()->set_r(0.75);
  layer = this->Add(command);
  EXPECT_EQ(layer.name(), "false color 2");
  EXPECT_EQ(layer.low(), 1);
  EXPECT_EQ(layer.high(), 1.5);
  ASSERT_EQ(layer.color_size(), 2);
  EXPECT_EQ(layer.color(0).b(), 0.5);
  EXPECT_EQ(layer.color(1).r(), 0.75);
}

TEST_F(TerrainLayers, ARecordingCarriesNamesAndAbsolutePaths) {
  const fs::path folder = fs::path(this->Image_.Path()).parent_path();
  const fs::path before = fs::current_path();
  fs::current_path(folder); // relative paths are of here, the recording replays elsewhere
  std::vector<std::string> recorded;
  v1::Command scene;
  scene.mutable_create_scene();
  recorded.push_back(scene.SerializeAsString());
  const auto token =
      this->Interpreter_.AddListener([&](const v1::Command& command, const v1::Reply&) {
        recorded.push_back(command.SerializeAsString());
      });
  this->OpenGround();
  const std::string image = fs::path(this->Image_.Path()).filename();
  v1::Command command;
  v1::AddTerrainLayer* add = command.mutable_add_terrain_layer();
  add->set_terrain("terrain");
  add->mutable_image()->set_path(image);
  const v1::Reply reply = this->Accept(command);
  EXPECT_EQ(add->name(), "image");
  EXPECT_EQ(add->image().path(), (folder / image).string());
  EXPECT_EQ(reply.terrain_layer().path(), (folder / image).string());
  ASSERT_GE(reply.warning_size(), 1); // it is stretched
  EXPECT_NE(reply.warning(0).find("georeference"), std::string::npos) << reply.warning(0);
  add->Clear();
  add->set_terrain("terrain");
  add->mutable_shapes()->set_path(fs::path(this->Shapes_.Path()).filename());
  this->Accept(command);
  add->clear_name();
  add->mutable_false_color()->set_path(fs::path(this->Values_.Path()).filename());
  add->set_position(0);
  this->Accept(command);
  this->Change("shapes", [](auto& c) { c.set_opacity(0.5); });
  v1::Command noise = Noise();
  this->Accept(noise);
  fs::current_path(before);
  this->Interpreter_.RemoveListener(token);
  EXPECT_EQ(this->Names(), "false color, image, shapes, noise");

  session::Interpreter other;
  for (const std::string& bytes : recorded) {
    v1::Command replayed;
    ASSERT_TRUE(replayed.ParseFromString(bytes));
    const v1::Reply answer = other.Execute(replayed);
    EXPECT_FALSE(answer.has_error()) << answer.error().message();
  }
  EXPECT_EQ(LayersOf(other).DebugString(), LayersOf(this->Interpreter_).DebugString());
}

TEST_F(TerrainLayers, BadInputIsRejectedAndChangesNothing) {
  this->OpenGround();
  this->Add(Noise("one"));
  this->RejectLayer(Noise("one"), v1::Error::ALREADY_EXISTS, "'one'");
  this->RejectLayer(Noise("a\nb"), v1::Error::INVALID_ARGUMENT, "control");
  v1::Command c = Noise();
  c.mutable_add_terrain_layer()->set_opacity(1.5);
  this->RejectLayer(c, v1::Error::INVALID_ARGUMENT, "1.5");
  c.mutable_add_terrain_layer()->set_opacity(NAN);
  this->RejectLayer(c, v1::Error::INVALID_ARGUMENT, "0 to 1");
  c = Noise();
  c.mutable_add_terrain_layer()->set_position(2);
  this->RejectLayer(c, v1::Error::INVALID_ARGUMENT, "2");
  c = Noise();
  c.mutable_add_terrain_layer()->mutable_noise()->set_wavelength(-1);
  this->RejectLayer(c, v1::Error::INVALID_ARGUMENT, "-1");
  c = Noise();
  c.mutable_add_terrain_layer()->mutable_noise()->set_octaves(17);
  this->RejectLayer(c, v1::Error::INVALID_ARGUMENT, "17");
  c = Noise();
  c.mutable_add_terrain_layer()->mutable_noise()->set_contrast(2);
  this->RejectLayer(c, v1::Error::INVALID_ARGUMENT, "2");
  c = Noise();
  c.mutable_add_terrain_layer()->clear_kind();
  this->RejectLayer(c, v1::Error::INVALID_ARGUMENT, "no kind");
  c.mutable_add_terrain_layer()->mutable_image()->set_path("/nowhere/at/all.png");
  this->RejectLayer(c, v1::Error::NOT_FOUND, "/nowhere/at/all.png");
  c.mutable_add_terrain_layer()->mutable_image()->set_path(this->Image_.Path());
  for (const double value : {1.0, 2.0, 3.0}) {
    c.mutable_add_terrain_layer()->mutable_image()->add_extent(value);
  }
  this->RejectLayer(c, v1::Error::INVALID_ARGUMENT, "3 numbers");
  c.mutable_add_terrain_layer()->mutable_false_color()->set_path(this->Values_.Path());
  c.mutable_add_terrain_layer()->mutable_false_color()->set_band(2);
  this->RejectLayer(c, v1::Error::INVALID_ARGUMENT, "2");
  c.mutable_add_terrain_layer()->mutable_false_color()->set_band(1);
  c.mutable_add_terrain_layer()->mutable_false_color()->add_color()->set_r(2);
  this->RejectLayer(c, v1::Error::INVALID_ARGUMENT, "2");
  c.mutable_add_terrain_layer()->mutable_shapes()->set_path("/nowhere/at/all.json");
  this->RejectLayer(c, v1::Error::NOT_FOUND, "/nowhere/at/all.json");
  c = Noise();
  c.mutable_add_terrain_layer()->set_terrain("nowhere");
  this->RejectLayer(c, v1::Error::NOT_FOUND, "nowhere");

  const std::string before = LayersOf(this->Interpreter_).DebugString();
  EXPECT_EQ(this->Change("one", [](auto& c) { c.set_opacity(-1); }).error().kind(),
            v1::Error::INVALID_ARGUMENT);
  EXPECT_EQ(this->Change("one",
                         [](auto& c) {
                           c.set_opacity(0.5);
                           c.set_position(1);
                         })
                .error()
                .kind(),
            v1::Error::INVALID_ARGUMENT);
  EXPECT_EQ(this->Change("two", [](auto&) {}).error().kind(), v1::Error::NOT_FOUND);
  EXPECT_EQ(LayersOf(this->Interpreter_).DebugString(), before);
}

TEST_F(TerrainLayers, ThoseOfColoursAreOfClipmaps) {
  this->OpenGround(v1::OpenTerrain::TRIANGLES);
  this->Reject(Noise(), v1::Error::UNSUPPORTED, "clipmap");
  EXPECT_EQ(this->Change("noise", [](auto&) {}).error().kind(), v1::Error::NOT_FOUND);
}

TEST_F(TerrainLayers, AreAtMost64) {
  this->OpenGround();
  for (int i = 0; i < 64; ++i) {
    this->Add(Noise());
  }
  this->RejectLayer(Noise(), v1::Error::INVALID_ARGUMENT, "64");
}

TEST_F(TerrainLayers, ALedgerRebuildsThem) {
  session::Ledger ledger;
  this->Interpreter_.AddListener([&ledger](const v1::Command& command, const v1::Reply& reply) {
    ledger.Add(command, reply);
  });
  v1::Command anew; // from nothing on, as a ledger needs it
  anew.mutable_remove_scene();
  this->Accept(anew);
  anew.mutable_create_scene();
  this->Accept(anew);
  v1::Command open;
  open.mutable_open_terrain()->set_path(this->Ground_.Path());
  open.mutable_open_terrain()->set_mode(v1::OpenTerrain::CLIPMAP);
  open.mutable_open_terrain()->set_fill_holes(5.0);
  open.mutable_open_terrain()->mutable_drape()->set_path(this->Image_.Path());
  this->Accept(open);
  const auto same = [&](const char* when) {
    session::Interpreter second;
    for (v1::Command command : ledger.Commands()) {
      const v1::Reply reply = second.Execute(command);
      ASSERT_FALSE(reply.has_error()) << when << ": " << reply.error().message();
    }
    EXPECT_EQ(LayersOf(second).DebugString(), LayersOf(this->Interpreter_).DebugString()) << when;
  };
  same("opened");
  this->Add(Noise("a"));
  this->Add(Noise("b"));
  same("with more");
  EXPECT_FALSE(this->Change("filled", [](auto& c) { c.set_opacity(0.7); }).has_error());
  same("changed");
  EXPECT_FALSE(this->Change("filled", [](auto& c) { c.set_position(0); }).has_error());
  EXPECT_FALSE(this->Change("drape", [](auto& c) { c.set_visible(false); }).has_error());
  EXPECT_FALSE(this->Change("a", [](auto& c) { c.set_position(3); }).has_error());
  same("moved");
  v1::Command remove;
  remove.mutable_remove_terrain_layer()->set_terrain("terrain");
  remove.mutable_remove_terrain_layer()->set_name("drape");
  this->Accept(remove);
  same("removed");
}

} // namespace
} // namespace dspace::testing
