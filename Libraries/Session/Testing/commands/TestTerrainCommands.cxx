#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

// An ESRI grid of 5 × 5 posts, 2 m apart, z = x + 2 y by map coordinates of the posts.
std::string Slope() {
  std::string text = "ncols 5\nnrows 5\nxllcorner 100\nyllcorner 200\ncellsize 2\n";
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 5; ++column) {
      const double x = 101 + 2 * column;
      const double y = 209 - 2 * row;
      text += std::to_string(x + 2 * y) + " ";
    }
    text += "\n";
  }
  return text;
}

class TerrainCommands : public CommandTest {
protected:
  TerrainCommands() : File_("slope.asc", Slope()) {}

  v1::TerrainReply Open() {
    v1::Command command;
    command.mutable_open_terrain()->set_path(this->File_.Path());
    command.mutable_open_terrain()->mutable_map_origin()->set_x(105);
    command.mutable_open_terrain()->mutable_map_origin()->set_y(205);
    command.mutable_open_terrain()->mutable_map_origin()->set_z(500);
    const v1::Reply reply = this->Accept(command);
    EXPECT_EQ(command.open_terrain().object_id(), reply.terrain().object());
    return reply.terrain();
  }

  TemporaryFile File_;
};

TEST_F(TerrainCommands, AnswersAndIsDrawn) {
  const v1::TerrainReply terrain = this->Open();
  EXPECT_EQ(terrain.name(), "terrain");
  EXPECT_EQ(terrain.columns(), 5u);
  EXPECT_EQ(terrain.pixel_width(), 2);
  EXPECT_NEAR(terrain.minimum_height(), 101 + 2 * 201, 1e-9);
  EXPECT_NEAR(terrain.west(), -4, 1e-9);
  EXPECT_NEAR(terrain.north(), 4, 1e-9);
  v1::Command query;
  v1::QueryTerrain* ask = query.mutable_query_terrain();
  ask->set_terrain("terrain");
  ask->set_height(true);
  ask->set_normal(true);
  ask->set_slope(true);
  for (const double value : {0.5, -1.25, 50.0, 0.0}) {
    ask->add_point(value);
  }
  const v1::TerrainQueryReply scene = this->Accept(query).terrain_values();
  ASSERT_EQ(scene.height_size(), 2);
  EXPECT_NEAR(scene.height(0), 105.5 + 2 * 203.75 - 500, 1e-9);
  EXPECT_TRUE(std::isnan(scene.height(1)));
  EXPECT_NEAR(scene.normal(0), -1 / std::sqrt(6.0), 1e-12);
  EXPECT_NEAR(scene.normal(1), -2 / std::sqrt(6.0), 1e-12);
  EXPECT_NEAR(scene.slope_deg(0), std::acos(1 / std::sqrt(6.0)) * 180 / M_PI, 1e-9);
  ask->set_map(true);
  ask->set_point(0, 105.5);
  ask->set_point(1, 203.75);
  EXPECT_NEAR(this->Accept(query).terrain_values().height(0), 105.5 + 2 * 203.75, 1e-9);

  v1::Command convert;
  convert.mutable_convert_terrain()->set_terrain("terrain");
  convert.mutable_convert_terrain()->set_to_map(true);
  for (const double value : {1.0, 2.0, 3.0}) {
    convert.mutable_convert_terrain()->add_point(value);
  }
  const v1::TerrainPoints map = this->Accept(convert).terrain_points();
  EXPECT_NEAR(map.point(0), 106, 1e-9);
  EXPECT_NEAR(map.point(1), 207, 1e-9);
  EXPECT_NEAR(map.point(2), 503, 1e-9);

  const GraphicsObject& object = this->Interpreter_.FindScene("scene")->Object(terrain.object());
  EXPECT_EQ(object.nature, Nature::Physical);
  ASSERT_FALSE(object.levels.at(0).parts.empty());
  // Plain ground, as a clipmap has it: the lights shade it, and no relief is painted on.
  EXPECT_FALSE(object.levels.at(0).parts[0].material->texture);
  EXPECT_NEAR(object.levels.at(0).parts[0].material->color[0], 0.85, 1e-12);
}

TEST_F(TerrainCommands, FocusKeepsTheMeshesThatDoNotChange) {
  std::string text = "ncols 257\nnrows 257\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
  for (int i = 0; i < 257 * 257; ++i) {
    text += std::to_string((i * 7919) % 13) + " ";
  }
  const TemporaryFile rough("rough.asc", text);
  v1::Command command;
  command.mutable_open_terrain()->set_path(rough.Path());
  command.mutable_open_terrain()->set_triangle_budget(8000);
  const ObjectId id = this->Accept(command).terrain().object();
  const auto meshes = [&] {
    std::map<std::string, std::shared_ptr<const Mesh>> found;
    for (const Part& part : this->Interpreter_.FindScene("scene")->Object(id).levels[0].parts) {
      found[part.mesh->name] = part.mesh;
    }
    return found;
  };
  const auto before = meshes();
  v1::Command focus;
  focus.mutable_focus_terrain()->set_terrain("terrain");
  focus.mutable_focus_terrain()->add_point(100);
  focus.mutable_focus_terrain()->add_point(100);
  focus.mutable_focus_terrain()->set_radius(5);
  this->Accept(focus);
  std::size_t same = 0;
  const auto after = meshes();
  for (const auto& [name, mesh] : after) {
    same += before.count(name) && before.at(name) == mesh;
  }
  EXPECT_GT(same, after.size() / 2);
  EXPECT_LT(same, after.size());
  focus.mutable_focus_terrain()->set_radius(-1);
  this->Reject(focus, v1::Error::INVALID_ARGUMENT, "-1");
}

TEST_F(TerrainCommands, BadInputIsRejectedAndChangesNothing) {
  v1::Command c;
  c.mutable_open_terrain()->set_path("/nowhere/at/all.tif");
  this->Reject(c, v1::Error::NOT_FOUND, "/nowhere/at/all.tif");
  const TemporaryFile text("text.tif", "this is no raster");
  c.mutable_open_terrain()->set_path(text.Path());
  EXPECT_TRUE(this->Interpreter_.Execute(c).has_error());
  c.mutable_open_terrain()->set_path(this->File_.Path());
  c.mutable_open_terrain()->set_frame(44);
  this->Reject(c, v1::Error::NOT_FOUND, "44");
  c.mutable_open_terrain()->set_frame(0);
  c.mutable_open_terrain()->set_fragment("ornamental");
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "ornamental");
  c.mutable_open_terrain()->clear_fragment();
  c.mutable_open_terrain()->mutable_drape()->set_path("/nowhere/at/all.png");
  this->Reject(c, v1::Error::NOT_FOUND, "/nowhere/at/all.png");
  c.mutable_open_terrain()->mutable_relief()->set_sun_elevation_deg(100);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "100");
  c.mutable_open_terrain()->clear_appearance();
  c.mutable_open_terrain()->set_vertical_datum("moonoid");
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "moonoid");
  const v1::TerrainReply terrain = this->Open();
  c.Clear();
  c.mutable_remove_object()->set_object(terrain.object());
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "remove_terrain");
  c.Clear();
  c.mutable_set_object_offset()->set_object(terrain.object());
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "terrain");
  c.Clear();
  c.mutable_query_terrain()->set_terrain("terrain");
  c.mutable_query_terrain()->add_point(1);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "multiple of 2");
  c.mutable_query_terrain()->add_point(1);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "no quantity is requested");
  c.mutable_query_terrain()->set_terrain("sea");
  this->Reject(c, v1::Error::NOT_FOUND, "sea");
  c.Clear();
  c.mutable_remove_terrain()->set_terrain("terrain");
  this->Accept(c);
  this->Reject(c, v1::Error::NOT_FOUND, "terrain");
}

} // namespace
} // namespace dspace::testing
