// Objects, fragments, lights, levels of detail, text tables: what is accepted, and that a rejection
// leaves no trace.
#include "SceneTestSupport.h"

#include <cmath>

#include <dspace/overlay/Overlay.h>

using namespace dspace;

TEST_F(SceneTest, AnObjectGoesIntoTheFragmentOfItsNature) {
  const ObjectId axes = this->S.AddObject(Object("axes", Nature::Ornamental));
  EXPECT_EQ(this->S.Object(this->Body).fragment, "physical");
  EXPECT_EQ(this->S.Object(axes).fragment, "ornamental");
  EXPECT_EQ(this->S.Fragments().Get("physical").objects, std::vector<ObjectId>{this->Body});
  EXPECT_EQ(this->S.Fragments().Get("ornamental").objects, std::vector<ObjectId>{axes});
  EXPECT_EQ(this->S.Fragments().Names(), (std::vector<std::string>{"physical", "ornamental"}));
  EXPECT_EQ(this->S.FindObject("axes"), axes);
  EXPECT_EQ(this->S.FindObject("nothing"), 0u);
  EXPECT_NE(this->S.Object(axes).levels[0].parts[0].material, nullptr);
}

TEST_F(SceneTest, IdsAreNeverReused) {
  const ObjectId a = this->S.AddObject(Object("a"));
  this->S.RemoveObject(a);
  EXPECT_EQ(this->S.FindObject("a"), 0u);
  EXPECT_GT(this->S.AddObject(Object("a")), a);
  GraphicsObject again = Object("b");
  again.id = a;
  ExpectRejected(this->S, Exists, "in use", [&] { this->S.AddObject(again); });
  again.id = 1000;
  EXPECT_EQ(this->S.AddObject(again), 1000u);
  EXPECT_EQ(this->S.AddObject(Object("c")), 1001u);
  again.name = "d";
  again.id = 0x80000000u;
  ExpectRejected(this->S, Invalid, "2147483648", [&] { this->S.AddObject(again); });
}

TEST_F(SceneTest, RejectsBadObjects) {
  const auto rejected = [&](Error::Kind kind, const std::string& word,
                            const std::function<void(GraphicsObject&)>& spoil) {
    GraphicsObject object = Object("new");
    spoil(object);
    ExpectRejected(this->S, kind, word, [&] { this->S.AddObject(object); });
  };
  rejected(Exists, "body", [](GraphicsObject& o) { o.name = "body"; });
  rejected(Invalid, "name", [](GraphicsObject& o) { o.name = ""; });
  rejected(Invalid, "name", [](GraphicsObject& o) { o.name = "a\nb"; });
  rejected(NotFound, "77", [](GraphicsObject& o) { o.frame = 77; });
  rejected(NotFound, "wheels", [](GraphicsObject& o) { o.fragment = "wheels"; });
  rejected(Invalid, "ornamental", [](GraphicsObject& o) { o.fragment = "ornamental"; });
  rejected(Invalid, "offset", [](GraphicsObject& o) { o.X_FO(0, 3) = NaN; });
  rejected(Invalid, "offset", [](GraphicsObject& o) { o.X_FO.linear().row(1).setZero(); });
  rejected(Invalid, "its offset is (1e+300, 0, 0)",
           [](GraphicsObject& o) { o.X_FO(0, 3) = 1e300; });
  rejected(Invalid, "scale of its offset is 1e-300; accepted: 1e-12 to 1e12",
           [](GraphicsObject& o) { o.X_FO.linear() *= 1e-300; });
  rejected(Invalid, "scale of its offset is 1e+300",
           [](GraphicsObject& o) { o.X_FO.linear() *= 1e300; });
  rejected(Invalid, "corner of its bounds",
           [](GraphicsObject& o) { o.levels.at(0).parts.at(0).X_OP.linear() *= 1e19; });
  rejected(Invalid, "line width", [](GraphicsObject& o) { o.lineWidth = 0; });
  rejected(Invalid, "point size", [](GraphicsObject& o) { o.pointSize = NaN; });
  rejected(Invalid, "opacity", [](GraphicsObject& o) { o.material.opacity = 1.5; });
  rejected(Invalid, "colour", [](GraphicsObject& o) { o.material.color = {{0, NaN, 0}}; });
  rejected(Invalid, "minimumPixels",
           [](GraphicsObject& o) { o.levels.push_back(o.levels[0]); }); // both 0
  rejected(Invalid, "minimumPixels", [](GraphicsObject& o) { o.levels[0].minimumPixels = -1; });
  rejected(Invalid, "no mesh", [](GraphicsObject& o) { o.levels[0].parts[0].mesh.reset(); });
  rejected(Invalid, "not finite", [](GraphicsObject& o) { o.levels[0].parts[0].X_OP(2, 3) = NaN; });
  rejected(Invalid, "metallic", [](GraphicsObject& o) {
    auto material = std::make_shared<Material>();
    material->metallic = -0.1;
    o.levels[0].parts[0].material = material;
  });
  rejected(Invalid, "texture", [](GraphicsObject& o) {
    auto image = std::make_shared<Image>();
    image->width = image->height = 2;
    image->channels = 3;
    image->pixels.resize(11);
    o.material.texture = image;
  });
  const auto badMesh = [&](const std::string& word, const std::function<void(Mesh&)>& spoil) {
    rejected(Invalid, word, [&](GraphicsObject& o) {
      auto mesh = Triangle();
      spoil(*mesh);
      o.levels[0].parts[0].mesh = mesh;
    });
  };
  badMesh("index 3", [](Mesh& m) { m.indices[1] = 3; });
  badMesh("multiple of 3", [](Mesh& m) { m.indices.pop_back(); });
  badMesh("positions", [](Mesh& m) { m.positions.pop_back(); });
  badMesh("positions", [](Mesh& m) { m.positions[4] = float(NaN); });
  badMesh("normals", [](Mesh& m) { m.normals = {0, 0, 1}; });
  badMesh("texture coord", [](Mesh& m) { m.tcoords = {0, 1}; });
  badMesh("colours", [](Mesh& m) { m.colors = {1, 2, 3}; });
}

TEST_F(SceneTest, AMeshThatIsGoneVouchesForNone) {
  // A good mesh is remembered only while it lives: a bad one at its address is looked at.
  Mesh storage = *Triangle();
  const auto lend = [&] { return std::shared_ptr<const Mesh>(&storage, [](const Mesh*) {}); };
  GraphicsObject object = Object("brief");
  object.levels[0].parts[0].mesh = lend();
  this->S.RemoveObject(this->S.AddObject(object));
  object.levels.clear(); // the last to hold it
  storage.indices[0] = 9;
  object = Object("bad");
  object.levels[0].parts[0].mesh = lend();
  ExpectRejected(this->S, Invalid, "index 9", [&] { this->S.AddObject(object); });
}

// Terrain with contours in a fragment of their own.
class Painted : public CustomGeometry {
public:
  BoundingSphere Bounds() const override { return {}; }
  std::uint64_t Revision() const override { return 1; }
  std::vector<Member> Members() const override { return this->members; }

  std::vector<Member> members = {{"contours", {Nature::Ornamental, "map"}}, {"the ramp", {}}};
};

TEST_F(SceneTest, AFragmentHoldsPartsOfObjects) {
  this->S.CreateFragment("map", Nature::Ornamental);
  const auto painted = std::make_shared<Painted>();
  GraphicsObject ground;
  ground.name = "ground";
  ground.custom = painted;
  this->S.AddObject(ground);
  EXPECT_EQ(this->S.MembersOf("map"), std::vector<std::string>{"contours of object 'ground'"});
  EXPECT_EQ(this->S.MembersOf("ornamental"),
            std::vector<std::string>{"the ramp of object 'ground'"});
  EXPECT_TRUE(this->S.MembersOf("physical").empty());
  ExpectRejected(this->S, Invalid, "contours of object 'ground'",
                 [&] { this->S.RemoveFragment("map"); });
  ExpectRejected(this->S, Invalid, "always", [&] { this->S.RemoveFragment("ornamental"); });
  painted->members.clear();
  this->S.RemoveFragment("map");
  EXPECT_FALSE(this->S.Fragments().Contains("map"));
}

TEST_F(SceneTest, AMembershipIsOfAFragmentOfItsNature) {
  this->S.CreateFragment("map", Nature::Ornamental);
  const SceneFragmentManager& fragments = this->S.Fragments();
  EXPECT_EQ(fragments.Member("contours", Nature::Ornamental, "").fragment, "ornamental");
  EXPECT_EQ(fragments.Member("contours", Nature::Physical, "").fragment, "physical");
  EXPECT_EQ(fragments.Member("contours", Nature::Ornamental, "map").fragment, "map");
  ExpectRejected(this->S, Invalid, "it is physical and fragment 'map' ornamental",
                 [&] { fragments.Member("ground", Nature::Physical, "map"); });
  ExpectRejected(this->S, NotFound, "nowhere",
                 [&] { fragments.Member("ground", Nature::Physical, "nowhere"); });
}

TEST_F(SceneTest, FragmentsKeepTheirNature) {
  this->S.CreateFragment("wheels", Nature::Physical);
  this->S.CreateFragment("labels", Nature::Ornamental);
  this->S.MoveToFragment(this->Body, "wheels");
  EXPECT_EQ(this->S.Object(this->Body).fragment, "wheels");
  EXPECT_TRUE(this->S.Fragments().Get("physical").objects.empty());
  EXPECT_EQ(this->S.Fragments().Get("wheels").objects, std::vector<ObjectId>{this->Body});
  ExpectRejected(this->S, Invalid, "ornamental",
                 [&] { this->S.MoveToFragment(this->Body, "labels"); });
  ExpectRejected(this->S, NotFound, "nowhere",
                 [&] { this->S.MoveToFragment(this->Body, "nowhere"); });
  ExpectRejected(this->S, Exists, "wheels",
                 [&] { this->S.CreateFragment("wheels", Nature::Physical); });
  ExpectRejected(this->S, Invalid, "name", [&] { this->S.CreateFragment("", Nature::Physical); });
  ExpectRejected(this->S, Invalid, "1 objects", [&] { this->S.RemoveFragment("wheels"); });
  ExpectRejected(this->S, Invalid, "always", [&] { this->S.RemoveFragment("physical"); });
  ExpectRejected(this->S, NotFound, "x", [&] { this->S.RemoveFragment("x"); });
  this->S.SetFragmentVisible("wheels", false);
  EXPECT_FALSE(this->S.Fragments().Get("wheels").visible);
  this->S.MoveToFragment(this->Body, "physical");
  this->S.RemoveFragment("wheels");
  EXPECT_FALSE(this->S.Fragments().Contains("wheels"));
  ExpectRejected(this->S, NotFound, "wheels", [&] { this->S.SetFragmentVisible("wheels", true); });
}

TEST_F(SceneTest, RejectsBadLights) {
  this->S.SetLight(Lamp("sun", this->Rover));
  const auto rejected = [&](Error::Kind kind, const std::string& word,
                            const std::function<void(Light&)>& spoil) {
    Light light = Lamp("sun", this->Rover);
    spoil(light);
    ExpectRejected(this->S, kind, word, [&] { this->S.SetLight(light); });
  };
  rejected(Invalid, "name", [](Light& l) { l.name = ""; });
  rejected(NotFound, "frame 99", [](Light& l) { l.frame = 99; });
  rejected(Invalid, "direction", [](Light& l) { l.direction.setZero(); });
  rejected(Invalid, "direction", [](Light& l) { l.direction *= 1e300; });
  rejected(Invalid, "direction", [](Light& l) { l.direction *= 1e-300; });
  rejected(Invalid, "intensity is 1e+300; accepted: 0 to 1e12",
           [](Light& l) { l.intensity = 1e300; });
  rejected(Invalid, "position", [](Light& l) { l.position.y() = 1e300; });
  rejected(Invalid, "direction", [](Light& l) { l.direction.x() = NaN; });
  rejected(Invalid, "position", [](Light& l) { l.position.x() = NaN; });
  rejected(Invalid, "cone", [](Light& l) { l.cone_deg = 90; });
  rejected(Invalid, "intensity", [](Light& l) { l.intensity = -1; });
  rejected(Invalid, "colour", [](Light& l) { l.color[2] = 1.01; });
  rejected(Invalid, "attenuation", [](Light& l) { l.attenuation = {0, 0, 0}; });
  rejected(Invalid, "attenuation", [](Light& l) { l.attenuation[1] = -1; });
  ExpectRejected(this->S, NotFound, "moon", [&] { this->S.RemoveLight("moon"); });
  Light brighter = Lamp("sun", this->Mast);
  brighter.intensity = 3;
  this->S.SetLight(brighter);
  ASSERT_EQ(this->S.Fragments().Lights().size(), 1u);
  EXPECT_EQ(this->S.Fragments().Lights()[0].intensity, 3.0);
  this->S.RemoveLight("sun");
  EXPECT_TRUE(this->S.Fragments().Lights().empty());
}

TEST_F(SceneTest, RevisionsTellWhatChanged) {
  const auto changes = [&](const std::function<void()>& f) {
    const auto revision = this->S.Revision();
    const auto content = this->S.ContentRevision();
    f();
    return std::make_pair(this->S.Revision() != revision, this->S.ContentRevision() != content);
  };
  const auto None = std::make_pair(false, false);
  const auto View = std::make_pair(true, false);
  const auto Content = std::make_pair(true, true);
  EXPECT_EQ(changes([&] { this->S.SetObjectVisible(this->Body, false); }), Content);
  EXPECT_EQ(changes([&] { this->S.SetObjectVisible(this->Body, false); }), None);
  MaterialOverride red;
  red.color = {{1, 0, 0}};
  EXPECT_EQ(changes([&] { this->S.SetObjectMaterial(this->Body, red); }), Content);
  EXPECT_EQ(changes([&] { this->S.SetObjectMaterial(this->Body, red); }), None);
  const Eigen::Affine3d moved(Eigen::Translation3d(1, 0, 0));
  EXPECT_EQ(changes([&] { this->S.SetObjectOffset(this->Body, moved); }), Content);
  EXPECT_EQ(changes([&] { this->S.SetObjectOffset(this->Body, moved); }), None);
  EXPECT_EQ(changes([&] { this->S.AttachObject(this->Body, this->Mast); }), Content);
  EXPECT_EQ(changes([&] { this->S.AttachObject(this->Body, this->Mast); }), None);
  EXPECT_EQ(changes([&] { this->S.MoveToFragment(this->Body, "physical"); }), None);
  EXPECT_EQ(changes([&] { this->S.SetFragmentVisible("physical", true); }), None);
  EXPECT_EQ(changes([&] { this->S.SetObjectLevels(this->Body, {}); }), Content);
  EXPECT_EQ(changes([&] { this->S.SetLight(Lamp("sun", 1)); }), Content);
  EXPECT_EQ(changes([&] { this->S.SetTime(5.0); }), View);
  EXPECT_EQ(changes([&] { this->S.SetTime(5.0); }), None);
  EXPECT_EQ(changes([&] { this->S.SetCamera("main", Fixed("b", 1)); }), View);
  EXPECT_EQ(changes([&] { this->S.SetActiveCamera("main", "b"); }), View);
  EXPECT_EQ(changes([&] { this->S.SetActiveCamera("main", "b"); }), None);
  Pose X;
  X.position = {1, 2, 3};
  EXPECT_EQ(changes([&] { this->S.Frames().SetLocalPose(this->Rover, X); }), View);
  EXPECT_EQ(changes([&] { this->S.RemoveFrame(this->Mast); }), Content);
}

TEST_F(SceneTest, RejectsBadChangesOfObjects) {
  MaterialOverride bad;
  bad.roughness = NaN;
  ExpectRejected(this->S, Invalid, "roughness",
                 [&] { this->S.SetObjectMaterial(this->Body, bad); });
  Eigen::Affine3d flat = Eigen::Affine3d::Identity();
  flat.linear().setZero();
  ExpectRejected(this->S, Invalid, "body", [&] { this->S.SetObjectOffset(this->Body, flat); });
  ExpectRejected(this->S, NotFound, "99", [&] { this->S.AttachObject(this->Body, 99); });
  ExpectRejected(this->S, NotFound, "99", [&] { this->S.RemoveObject(99); });
  ExpectRejected(this->S, NotFound, "99", [&] { this->S.SetObjectVisible(99, true); });
  DetailLevel empty;
  empty.parts.resize(1);
  ExpectRejected(this->S, Invalid, "no mesh",
                 [&] { this->S.SetObjectLevels(this->Body, {empty}); });
  ExpectRejected(this->S, Invalid, "time", [&] { this->S.SetTime(NaN); });
  EXPECT_THROW(Scene(""), Error);
}

TEST(Levels, FinestThatIsLargeEnough) {
  std::vector<DetailLevel> levels(3);
  levels[0].minimumPixels = 100;
  levels[1].minimumPixels = 10;
  levels[2].minimumPixels = 2;
  EXPECT_EQ(LevelFor(levels, 100), 0);
  EXPECT_EQ(LevelFor(levels, 99.9), 1);
  EXPECT_EQ(LevelFor(levels, 2), 2);
  EXPECT_EQ(LevelFor(levels, 1), -1);
  EXPECT_EQ(LevelFor({}, 1), -1);
}

TEST(Levels, BoundsByHand) {
  DetailLevel level;
  EXPECT_EQ(BoundsOf(level).radius, 0.0);
  // The triangle spans (0,0)-(2,2); at the second part's place (10,0)-(14,4).
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  level.parts.push_back({Triangle(), nullptr, X});
  const BoundingSphere one = BoundsOf(level);
  EXPECT_EQ(one.center, Eigen::Vector3d(1, 1, 0));
  EXPECT_DOUBLE_EQ(one.radius, std::sqrt(2.0));
  X.translation().x() = 10;
  X.linear() *= 2;
  level.parts.push_back({Triangle(), nullptr, X});
  const BoundingSphere both = BoundsOf(level);
  EXPECT_EQ(both.center, Eigen::Vector3d(7, 2, 0));
  EXPECT_DOUBLE_EQ(both.radius, std::hypot(7, 2)); // to (0,0); (14,0) is as far
}

TEST(Parts, OfAModelShareItsMeshes) {
  auto model = std::make_shared<Model>();
  model->path = "m.obj";
  model->meshes = {*Triangle(), *Triangle()};
  model->meshes[1].material = 0;
  model->materials.resize(1);
  model->materials[0].name = "paint";
  model->nodes.resize(2);
  model->nodes[0].local = Eigen::Translation3d(1, 0, 0) * Eigen::Scaling(1.0, 2.0, 1.0);
  model->nodes[0].meshes = {1};
  model->nodes[1].parent = 0;
  model->nodes[1].local = Eigen::Translation3d(0, 5, 0);
  model->nodes[1].meshes = {0, 1};
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitZ()));
  const auto parts = PartsOf(model, 10.0, quarter);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].mesh.get(), &model->meshes[1]);
  EXPECT_EQ(parts[2].mesh, parts[0].mesh);
  EXPECT_EQ(parts[1].mesh.get(), &model->meshes[0]);
  EXPECT_EQ(parts[0].material->name, "paint");
  ASSERT_NE(parts[1].material, nullptr);
  // (1, 1, 0): + (0, 5, 0), then y doubled, x + 1: (2, 12, 0); turned and tenfold: (-120, 20, 0).
  EXPECT_LT((parts[1].X_OP * Eigen::Vector3d(1, 1, 0) - Eigen::Vector3d(-120, 20, 0)).norm(),
            1e-12);
  const std::weak_ptr<Model> watch = model;
  model.reset();
  EXPECT_FALSE(watch.expired()); // the parts keep it
  EXPECT_THROW(PartsOf(nullptr), Error);
  EXPECT_THROW(PartsOf(watch.lock(), 0.0), Error);
  EXPECT_THROW(PartsOf(watch.lock(), 1.0, Eigen::Quaterniond(2, 0, 0, 0)), Error);
}

TEST(TextTable, Rejections) {
  TextTable table;
  EXPECT_THROW(table.Check(), Error); // no name
  table.name = "readings";
  EXPECT_NO_THROW(table.Check());
  table.fontSize = 3;
  EXPECT_THROW(table.Check(), Error);
  table.fontSize = 12;
  table.margin = -1;
  EXPECT_THROW(table.Check(), Error);
  table.margin = 0;
  table.backgroundColor[3] = 1.5;
  EXPECT_THROW(table.Check(), Error);
}
