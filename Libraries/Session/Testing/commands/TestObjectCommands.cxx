#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

class ObjectCommands : public CommandTest {
protected:
  v1::ObjectInfo Describe(ObjectId id) {
    v1::Command command;
    command.mutable_describe_object()->set_object(id);
    return this->Accept(command).object_info();
  }
};

const char* const Triangle = "v 0 0 0\nv 0 2 0\nv 0 0 4\nf 1 2 3\n";

TEST_F(ObjectCommands, ImportScalesAndTurnsAsToldAndSharesMeshes) {
  const TemporaryFile file("triangle.obj", Triangle);
  v1::Command command;
  v1::ImportObject* import = command.mutable_import_object();
  import->add_level()->set_path(file.Path());
  import->set_scale(10);
  import->set_up(v1::UP_Y);
  const ObjectId first = this->Accept(command).object().object();
  EXPECT_EQ(import->object().id(), first); // as recorded
  EXPECT_EQ(import->object().name(), "triangle");
  v1::Command again;
  again.mutable_import_object()->add_level()->set_path(file.Path());
  const ObjectId second = this->Accept(again).object().object();
  EXPECT_EQ(this->Describe(second).name(), "triangle 2");

  const auto& objects = this->Interpreter_.FindScene("scene")->Objects();
  const Part& part = objects.at(first).levels.at(0).parts.at(0);
  EXPECT_EQ(part.mesh, objects.at(second).levels.at(0).parts.at(0).mesh);
  // The file's Y is up: its point (0, 2, 0) lies 20 m along Z.
  EXPECT_TRUE((part.X_OP * Eigen::Vector3d(0, 2, 0)).isApprox(Eigen::Vector3d(0, 0, 20), 1e-12));
  EXPECT_TRUE((part.X_OP * Eigen::Vector3d(0, 0, 4)).isApprox(Eigen::Vector3d(0, -40, 0), 1e-12));
  EXPECT_EQ(this->Describe(first).triangles(), 1u);
}

TEST_F(ObjectCommands, AFileThatChangedIsReadAnew) {
  const TemporaryFile file("changes.obj", "");
  const std::string& path = file.Path();
  session::ModelCache cache;
  std::ofstream(path) << Triangle;
  const auto first = cache.LoadModel(path, {});
  EXPECT_EQ(cache.LoadModel(path, {}), first);
  std::ofstream(path) << Triangle << "f 3 2 1\n";
  EXPECT_EQ(cache.LoadModel(path, {})->TriangleCount(), 2u);
}

TEST_F(ObjectCommands, UnnamedObjectsTakeTheLowestFreeNumber) {
  const auto made = [this](FrameId frame = 0) {
    return this->Describe(this->AddBox("", frame)).name();
  };
  for (const char* name : {"box", "box 2", "box 3", "box 4"}) {
    EXPECT_EQ(made(), name);
  }
  this->AddBox("box 6");
  EXPECT_EQ(made(), "box 5");
  EXPECT_EQ(made(), "box 7");
  const auto remove = [this](const char* name) {
    v1::Command command;
    command.mutable_remove_object()->set_object(
        this->Interpreter_.FindScene("scene")->FindObject(name));
    this->Accept(command);
  };
  remove("box 3");
  remove("box");
  EXPECT_EQ(made(), "box");
  EXPECT_EQ(made(), "box 3");
  v1::Command bad; // takes no name
  for (auto set : {&v1::Vector3::set_x, &v1::Vector3::set_y, &v1::Vector3::set_z}) {
    (bad.mutable_create_primitive()->mutable_box()->mutable_size()->*set)(1.0);
  }
  bad.mutable_create_primitive()->mutable_object()->set_fragment("none");
  this->Reject(bad, Kind::NOT_FOUND, "'none'");
  const FrameId frame = this->AddFrame("frame");
  EXPECT_EQ(made(frame), "box 8");
  EXPECT_EQ(made(), "box 9");
  v1::Command gone; // and its objects
  gone.mutable_remove_frame()->set_frame(frame);
  this->Accept(gone);
  EXPECT_EQ(made(), "box 8");
  EXPECT_EQ(made(), "box 10");
}

TEST_F(ObjectCommands, EveryPrimitiveIsMade) {
  const auto make = [this](auto fill) {
    v1::Command command;
    fill(command.mutable_create_primitive());
    return this->Accept(command).object().name();
  };
  using P = v1::CreatePrimitive;
  EXPECT_EQ(make([](P* p) { p->mutable_sphere()->set_radius(1); }), "sphere");
  EXPECT_EQ(make([](P* p) {
              p->mutable_cylinder()->set_radius(1);
              p->mutable_cylinder()->set_height(1);
            }),
            "cylinder");
  EXPECT_EQ(make([](P* p) {
              p->mutable_cone()->set_radius(1);
              p->mutable_cone()->set_height(1);
            }),
            "cone");
  EXPECT_EQ(make([](P* p) {
              p->mutable_plane()->set_width(1);
              p->mutable_plane()->set_height(1);
            }),
            "plane");
  EXPECT_EQ(make([](P* p) { p->mutable_disc()->set_radius(1); }), "disc");
  EXPECT_EQ(make([](P* p) {
              p->mutable_torus()->set_radius(1);
              p->mutable_torus()->set_tube(0.1);
            }),
            "torus");
  EXPECT_EQ(make([](P* p) { p->mutable_arrow()->set_length(1); }), "arrow");
  EXPECT_EQ(make([](P* p) { p->mutable_axes()->set_length(1); }), "axes");
  EXPECT_EQ(make([](P* p) {
              for (int i = 0; i < 12; ++i) {
                p->mutable_lines()->add_point(i * i);
              }
              p->mutable_lines()->add_count(2);
              p->mutable_lines()->add_count(2);
            }),
            "lines");
  EXPECT_EQ(make([](P* p) {
              for (int i = 0; i < 3; ++i) {
                p->mutable_points()->add_point(i);
              }
            }),
            "points");
  EXPECT_EQ(make([](P* p) {
              p->mutable_frustum()->set_length(2);
              p->mutable_frustum()->set_width(640);
              p->mutable_frustum()->set_height(480);
            }),
            "frustum");
  EXPECT_EQ(make([](P* p) { p->mutable_goal()->set_height(1); }), "goal");
  EXPECT_EQ(make([](P* p) { p->mutable_tilt()->set_radius(1); }), "tilt");
  EXPECT_EQ(make([](P* p) { p->mutable_sphere()->set_radius(1); }), "sphere 2");
}

TEST_F(ObjectCommands, MaterialChangesAreLaidOverEachOther) {
  const ObjectId box = this->AddBox("box");
  v1::Command command;
  v1::SetMaterial* set = command.mutable_set_material();
  set->set_object(box);
  set->mutable_material()->mutable_color()->set_r(1);
  this->Accept(command);
  set->mutable_material()->Clear();
  set->mutable_material()->set_opacity(0.5);
  this->Accept(command);
  EXPECT_EQ(this->Describe(box).material().color().r(), 1);
  EXPECT_EQ(this->Describe(box).material().opacity(), 0.5);
  set->set_replace(true);
  this->Accept(command);
  EXPECT_FALSE(this->Describe(box).material().has_color());
  set->mutable_material()->set_opacity(1.5);
  this->Reject(command, v1::Error::INVALID_ARGUMENT, "1.5");
  set->mutable_material()->set_opacity(1);
  set->mutable_material()->set_texture("/nowhere/at/all.png");
  this->Reject(command, v1::Error::NOT_FOUND, "/nowhere/at/all.png");
}

TEST_F(ObjectCommands, TiltMarkersTurnRed) {
  v1::Command command;
  command.mutable_create_primitive()->mutable_tilt()->set_radius(1);
  const ObjectId id = this->Accept(command).object().object();
  const v1::Color upright = this->Describe(id).material().color();
  EXPECT_GT(upright.g(), upright.r());
  v1::Command tilt;
  tilt.mutable_set_tilt()->set_object(id);
  tilt.mutable_set_tilt()->set_tilt_deg(40);
  this->Accept(tilt);
  EXPECT_GT(this->Describe(id).material().color().r(), this->Describe(id).material().color().g());
  tilt.mutable_set_tilt()->set_tilt_deg(-1);
  this->Reject(tilt, v1::Error::INVALID_ARGUMENT, "-1");
  tilt.mutable_set_tilt()->set_tilt_deg(40);
  tilt.mutable_set_tilt()->set_object(this->AddBox());
  this->Reject(tilt, v1::Error::INVALID_ARGUMENT, "not a tilt marker");
}

TEST_F(ObjectCommands, TrailsGrowAndAreCleared) {
  v1::Command create;
  create.mutable_create_trail()->set_capacity(3);
  const ObjectId id = this->Accept(create).object().object();
  v1::Command append;
  append.mutable_append_trail()->set_object(id);
  for (const double value : {0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 8.0, 0.0, 0.0, 8.0, 6.0, 0.0}) {
    append.mutable_append_trail()->add_point(value);
  }
  this->Accept(append);
  // The first point has left the ring: (4, 0) to (8, 0) to (8, 6).
  const v1::ObjectInfo info = this->Describe(id);
  EXPECT_NEAR(info.bounds_center().x(), 6, 1e-6);
  EXPECT_NEAR(info.bounds_center().y(), 3, 1e-6);
  append.mutable_append_trail()->set_point(10, NAN);
  this->Reject(append, v1::Error::INVALID_ARGUMENT, "trail");
  v1::Command clear;
  clear.mutable_clear_trail()->set_object(id);
  this->Accept(clear);
  EXPECT_EQ(this->Describe(id).bounds_radius(), 0);
  append.mutable_append_trail()->set_object(this->AddBox());
  this->Reject(append, v1::Error::INVALID_ARGUMENT, "not a trail");
}

TEST_F(ObjectCommands, BadInputIsRejectedAndChangesNothing) {
  const ObjectId box = this->AddBox("box");
  v1::Command c;
  c.mutable_import_object()->add_level()->set_path("/nowhere/at/all.glb");
  this->Reject(c, v1::Error::NOT_FOUND, "/nowhere/at/all.glb");
  c.mutable_import_object()->clear_level();
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "names no file");
  const TemporaryFile empty("empty.obj", "");
  c.mutable_import_object()->add_level()->set_path(empty.Path());
  this->Reject(c, v1::Error::CORRUPT, "empty.obj");
  const TemporaryFile good("good.obj", Triangle);
  c.mutable_import_object()->mutable_level(0)->set_path(good.Path());
  c.mutable_import_object()->set_scale(0);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "scale");
  c.mutable_import_object()->clear_scale();
  c.mutable_import_object()->mutable_object()->set_name("box");
  this->Reject(c, v1::Error::ALREADY_EXISTS, "box");
  c.mutable_import_object()->mutable_object()->set_name("other");
  c.mutable_import_object()->mutable_object()->set_frame(77);
  this->Reject(c, v1::Error::NOT_FOUND, "77");
  c.Clear();
  c.mutable_create_primitive()->mutable_sphere()->set_radius(-1);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "-1");
  c.mutable_create_primitive()->mutable_torus()->set_radius(1);
  c.mutable_create_primitive()->mutable_torus()->set_tube(2);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "2");
  c.mutable_create_primitive()->mutable_lines()->add_point(1);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "multiple of 3");
  c.mutable_create_primitive()->clear_shape();
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "its shape is missing");
  c.Clear();
  c.mutable_set_object_offset()->set_object(box);
  c.mutable_set_object_offset()->mutable_offset()->mutable_scale()->set_x(1);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "scale");
  c.Clear();
  c.mutable_move_to_fragment()->set_object(box);
  c.mutable_move_to_fragment()->set_fragment("ornamental");
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "ornamental");
  c.Clear();
  c.mutable_remove_object()->set_object(1234);
  this->Reject(c, v1::Error::NOT_FOUND, "1234");
}

TEST_F(ObjectCommands, AStrangeSizeIsPointedOut) {
  const TemporaryFile file("large.obj", "v 0 0 0\nv 0 2000 0\nv 0 0 4\nf 1 2 3\n");
  v1::Command command;
  command.mutable_import_object()->add_level()->set_path(file.Path());
  const v1::Reply reply = this->Accept(command);
  ASSERT_EQ(reply.warning_size(), 1);
  EXPECT_NE(reply.warning(0).find("2000 m across"), std::string::npos) << reply.warning(0);
}

} // namespace
} // namespace dspace::testing
