// Models as bytes: what is written comes back, and what is not a model is an error, never a read
// beyond the end.
#include "FuzzMutator.h"
#include "ImportTestSupport.h"

#include <dspace/import/worker/Bytes.h>
#include <dspace/import/worker/ModelBytes.h>
#include <dspace/import/worker/UrdfBytes.h>

namespace dspace {
namespace {

using testing::ExpectError;

Model Everything() {
  auto image = std::make_shared<Image>();
  image->name = "a.png";
  image->width = 2;
  image->height = 1;
  image->channels = 3;
  image->pixels = {1, 2, 3, 4, 5, 6};
  Model model;
  model.path = "a.glb";
  model.materials.resize(2);
  model.materials[0].name = "paint";
  model.materials[0].color = {0.1, 0.2, 0.3};
  model.materials[0].opacity = 0.5;
  model.materials[0].metallic = 0.25;
  model.materials[0].roughness = 0.75;
  model.materials[0].emissive = {0.4, 0.5, 0.6};
  model.materials[0].texture = image;
  model.materials[0].normalTexture = image;
  model.materials[0].normalScale = 2.0;
  model.materials[0].repeatTexture = false;
  model.materials[0].lit = false;
  model.materials[0].doubleSided = false;
  model.materials[1].texture = image;
  model.meshes.resize(2);
  model.meshes[0].name = "wing";
  model.meshes[0].positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  model.meshes[0].normals = {0, 0, 1, 0, 0, 1, 0, 0, 1};
  model.meshes[0].tcoords = {0, 0, 1, 0, 0, 1};
  model.meshes[0].colors = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  model.meshes[0].indices = {0, 1, 2};
  model.meshes[0].material = 1;
  model.meshes[0].solid = true;
  model.meshes[1].primitive = Mesh::Primitive::Lines;
  model.meshes[1].positions = {0, 0, 0, 1, 0, 0};
  model.meshes[1].indices = {0, 1};
  model.nodes.resize(2);
  model.nodes[0].name = "base";
  model.nodes[1].parent = 0;
  model.nodes[1].local = Eigen::Translation3d(1, 2, 3) * Eigen::Scaling(2.0);
  model.nodes[1].meshes = {0, 1};
  model.nodes[1].range = DistanceRange{{1, 2, 3}, 4.0, 5.0};
  model.lights.resize(1);
  model.lights[0].name = "lamp";
  model.lights[0].kind = ModelLight::Kind::Spot;
  model.lights[0].node = 1;
  model.lights[0].color = {0.5, 0.25, 0.125};
  model.lights[0].intensity = 3.0;
  model.lights[0].cone_deg = 20.0;
  model.animations.resize(1);
  model.animations[0].name = "deploy";
  model.animations[0].channels.resize(1);
  model.animations[0].channels[0].node = 1;
  model.animations[0].channels[0].property = ModelChannel::Property::Rotation;
  model.animations[0].channels[0].interpolation = ModelChannel::Interpolation::Step;
  model.animations[0].channels[0].time_s = {0.0, 1.0};
  model.animations[0].channels[0].value = {0, 0, 0, 1, 1, 0, 0, 0};
  model.warnings = {"first", "second"};
  model.leftOut = {"2 cameras"};
  return model;
}

std::string BytesOf(const Model& model) {
  ByteWriter into;
  WriteModel(model, into);
  return into.Text();
}

Model Read(const std::string& bytes) {
  // A copy of exactly this size, so that the address sanitizer sees each byte beyond.
  const std::vector<char> exact(bytes.begin(), bytes.end());
  ByteReader from(exact.data(), exact.size(), "file 'a.glb'");
  Model model = ReadModelBytes(from, "a.glb");
  from.End();
  return model;
}

TEST(ModelBytes, ComeBack) {
  const Model before = Everything();
  const Model after = Read(BytesOf(before));
  EXPECT_EQ(after.path, before.path);
  ASSERT_EQ(after.materials.size(), 2u);
  const Material& paint = after.materials[0];
  EXPECT_EQ(paint.name, "paint");
  EXPECT_EQ(paint.color, before.materials[0].color);
  EXPECT_EQ(paint.opacity, 0.5);
  EXPECT_EQ(paint.metallic, 0.25);
  EXPECT_EQ(paint.roughness, 0.75);
  EXPECT_EQ(paint.emissive, before.materials[0].emissive);
  EXPECT_EQ(paint.normalScale, 2.0);
  EXPECT_FALSE(paint.repeatTexture || paint.lit || paint.doubleSided);
  EXPECT_TRUE(after.materials[1].repeatTexture && after.materials[1].lit &&
              after.materials[1].doubleSided);
  ASSERT_TRUE(paint.texture);
  EXPECT_EQ(paint.texture, paint.normalTexture); // shared, as before
  EXPECT_EQ(paint.texture, after.materials[1].texture);
  EXPECT_EQ(after.materials[1].normalTexture, nullptr);
  EXPECT_EQ(paint.texture->name, "a.png");
  EXPECT_EQ(paint.texture->width, 2);
  EXPECT_EQ(paint.texture->height, 1);
  EXPECT_EQ(paint.texture->channels, 3);
  EXPECT_EQ(paint.texture->pixels, (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6}));
  ASSERT_EQ(after.meshes.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(after.meshes[i].name, before.meshes[i].name);
    EXPECT_EQ(after.meshes[i].primitive, before.meshes[i].primitive);
    EXPECT_EQ(after.meshes[i].positions, before.meshes[i].positions);
    EXPECT_EQ(after.meshes[i].normals, before.meshes[i].normals);
    EXPECT_EQ(after.meshes[i].tcoords, before.meshes[i].tcoords);
    EXPECT_EQ(after.meshes[i].colors, before.meshes[i].colors);
    EXPECT_EQ(after.meshes[i].indices, before.meshes[i].indices);
    EXPECT_EQ(after.meshes[i].material, before.meshes[i].material);
    EXPECT_EQ(after.meshes[i].solid, before.meshes[i].solid);
  }
  ASSERT_EQ(after.nodes.size(), 2u);
  EXPECT_EQ(after.nodes[0].name, "base");
  EXPECT_EQ(after.nodes[0].parent, -1);
  EXPECT_FALSE(after.nodes[0].range);
  EXPECT_EQ(after.nodes[1].parent, 0);
  EXPECT_EQ(after.nodes[1].local.matrix(), before.nodes[1].local.matrix());
  EXPECT_EQ(after.nodes[1].meshes, (std::vector<int>{0, 1}));
  ASSERT_TRUE(after.nodes[1].range);
  EXPECT_EQ(after.nodes[1].range->center, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(after.nodes[1].range->from, 4.0);
  EXPECT_EQ(after.nodes[1].range->to, 5.0);
  ASSERT_EQ(after.lights.size(), 1u);
  EXPECT_EQ(after.lights[0].name, "lamp");
  EXPECT_EQ(after.lights[0].kind, ModelLight::Kind::Spot);
  EXPECT_EQ(after.lights[0].node, 1);
  EXPECT_EQ(after.lights[0].color, before.lights[0].color);
  EXPECT_EQ(after.lights[0].intensity, 3.0);
  EXPECT_EQ(after.lights[0].cone_deg, 20.0);
  ASSERT_EQ(after.animations.size(), 1u);
  EXPECT_EQ(after.animations[0].name, "deploy");
  ASSERT_EQ(after.animations[0].channels.size(), 1u);
  const ModelChannel& channel = after.animations[0].channels[0];
  EXPECT_EQ(channel.node, 1);
  EXPECT_EQ(channel.property, ModelChannel::Property::Rotation);
  EXPECT_EQ(channel.interpolation, ModelChannel::Interpolation::Step);
  EXPECT_EQ(channel.time_s, (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(channel.value, before.animations[0].channels[0].value);
  EXPECT_EQ(after.warnings, before.warnings);
  EXPECT_EQ(after.leftOut, before.leftOut);
}

TEST(ModelBytes, AreRejectedAtEveryShorterLength) {
  const std::string bytes = BytesOf(Everything());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ExpectError(Error::Kind::Corrupt, "the process that reads it gave no valid result",
                [&] { Read(bytes.substr(0, size)); });
  }
  ExpectError(Error::Kind::Corrupt, "it goes on after its end", [&] { Read(bytes + '\0'); });
}

TEST(ModelBytes, AreRejectedWhenACountIsHuge) {
  ByteWriter into;
  into.Number<std::uint64_t>(std::uint64_t(1) << 61); // images
  ExpectError(Error::Kind::Corrupt, "it states more than it holds", [&] { Read(into.Text()); });
}

void ExpectRejected(const std::string& part, void (*damage)(Model& model)) {
  Model model = Everything();
  damage(model);
  ExpectError(Error::Kind::Corrupt, part, [&] { Read(BytesOf(model)); });
}

TEST(ModelBytes, AreCheckedForWhatAModelMustBe) {
  ExpectRejected("index 3", [](Model& model) { model.meshes[0].indices[0] = 3; });
  ExpectRejected("material 2", [](Model& model) { model.meshes[0].material = 2; });
  ExpectRejected("not an earlier node", [](Model& model) { model.nodes[0].parent = 1; });
  ExpectRejected("mesh 2", [](Model& model) { model.nodes[0].meshes = {2}; });
  ExpectRejected("not affine", [](Model& model) { model.nodes[0].local(3, 0) = 1.0; });
  ExpectRejected("names a node", [](Model& model) { model.lights[0].node = 2; });
  ExpectRejected("of a light is not finite",
                 [](Model& model) { model.lights[0].intensity = std::nan(""); });
  ExpectRejected("names a node", [](Model& model) { model.animations[0].channels[0].node = -1; });
  ExpectRejected("keys of a channel",
                 [](Model& model) { model.animations[0].channels[0].value.pop_back(); });
  ExpectRejected("keys of a channel", [](Model& model) {
    model.animations[0].channels[0].time_s = {1.0, 0.0};
  });
  ExpectRejected("scale of normals",
                 [](Model& model) { model.materials[0].normalScale = std::nan(""); });
  ExpectRejected("pixels of an image", [](Model& model) {
    auto image = std::make_shared<Image>(*model.materials[0].texture);
    image->width = 100;
    model.materials[0].normalTexture = image;
  });
}

// Damaged bytes give a model that passes CheckModel, or an Error of this kind.
TEST(ModelBytes, SurviveDamage) {
  const std::string bytes = BytesOf(Everything());
  int models = 0;
  int errors = 0;
  for (std::uint64_t number = 0; number < 20000; ++number) {
    testing::FuzzMutator mutator(number);
    try {
      CheckModel(Read(mutator.Mutate(bytes)));
      ++models;
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::Corrupt) << error.what();
      ++errors;
    }
  }
  EXPECT_GT(models, 100);
  EXPECT_GT(errors, 1000);
}

// --- Robots
// ---------------------------------------------------------------------------------------

std::string RobotBytes(const Urdf& urdf) {
  ByteWriter into;
  WriteUrdf(urdf, into);
  return into.Text();
}

Urdf ReadRobot(const std::string& bytes) {
  const std::vector<char> exact(bytes.begin(), bytes.end());
  ByteReader from(exact.data(), exact.size(), "file 'a.urdf'");
  Urdf urdf = ReadUrdfBytes(from, "a.urdf");
  from.End();
  return urdf;
}

Urdf Arm() {
  return ReadUrdf(std::string(DSPACE_SEEDS) + "/arm.urdf");
}

void ExpectRobotRejected(const std::string& part, void (*damage)(Urdf& urdf)) {
  Urdf urdf = Arm();
  damage(urdf);
  ExpectError(Error::Kind::Corrupt, part, [&] { ReadRobot(RobotBytes(urdf)); });
}

TEST(ModelBytes, OfARobotComeBackOrAreRejected) {
  const std::string bytes = RobotBytes(Arm());
  EXPECT_EQ(RobotBytes(ReadRobot(bytes)), bytes);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ExpectError(Error::Kind::Corrupt, "the process that reads it gave no valid result",
                [&] { ReadRobot(bytes.substr(0, size)); });
  }
  ExpectRobotRejected("no tree", [](Urdf& urdf) { urdf.links[0].parentJoint = 0; });
  ExpectRobotRejected("no tree", [](Urdf& urdf) { urdf.links[1].parentJoint = -1; });
  ExpectRobotRejected("no tree", [](Urdf& urdf) { urdf.joints.pop_back(); });
  ExpectRobotRejected("not there", [](Urdf& urdf) { urdf.joints[0].parentLink = 1000; });
  ExpectRobotRejected("not there", [](Urdf& urdf) { urdf.joints[0].mimic = -2; });
  ExpectRobotRejected("not finite", [](Urdf& urdf) { urdf.joints[0].lower = std::nan(""); });
  ExpectRobotRejected("a pose", [](Urdf& urdf) { urdf.joints[0].X_PJ.scale = 0.0; });
  ExpectRobotRejected("a name that frames cannot have",
                      [](Urdf& urdf) { urdf.links[1].name = "a/b"; });
}

TEST(ModelBytes, OfARobotSurviveDamage) {
  const std::string bytes = RobotBytes(Arm());
  int robots = 0;
  int errors = 0;
  for (std::uint64_t number = 0; number < 5000; ++number) {
    testing::FuzzMutator mutator(number);
    try {
      ReadRobot(mutator.Mutate(bytes));
      ++robots;
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::Corrupt) << error.what();
      ++errors;
    }
  }
  EXPECT_GT(robots, 50);
  EXPECT_GT(errors, 500);
}

} // namespace
} // namespace dspace
