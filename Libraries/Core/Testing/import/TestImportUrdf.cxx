// URDF: hand-made robots with known answers, bad ones, and Perseverance.
#include <dspace/FrameRules.h>

#include <cmath>
#include <map>
#include <random>

#include "TestData.h"
#include "UrdfTestSupport.h"

using namespace dspace;
using namespace dspace::testing;

namespace {

void ExpectBad(const TempFolder& folder, const std::string& part, const std::string& text) {
  ExpectError(Error::Kind::Corrupt, part, [&] { ReadText(folder, text); });
}

} // namespace

TEST(ImportUrdf, LinksJointsAndVisuals) {
  const TempFolder folder;
  const std::string shell = folder.Write("meshes/shell.stl", "solid");
  const Urdf urdf = ReadText(folder, Arm);
  EXPECT_EQ(urdf.name, "arm");
  ASSERT_EQ(urdf.links.size(), 6u);
  ASSERT_EQ(urdf.joints.size(), 5u);
  EXPECT_EQ(urdf.links[0].name, "base");
  EXPECT_EQ(urdf.links[0].parentJoint, -1);
  for (std::size_t i = 1; i < urdf.links.size(); ++i) {
    const UrdfJoint& joint = urdf.joints[std::size_t(urdf.links[i].parentJoint)];
    EXPECT_EQ(joint.childLink, static_cast<int>(i));
    EXPECT_LT(joint.parentLink, static_cast<int>(i)); // parents first
  }
  const UrdfJoint& shoulder = Joint(urdf, "shoulder");
  EXPECT_EQ(shoulder.type, UrdfJoint::Type::Revolute);
  EXPECT_LT((shoulder.axis - Eigen::Vector3d(0, 0.6, 0.8)).norm(), 1e-12);
  EXPECT_TRUE(shoulder.hasLimits);
  EXPECT_NEAR(shoulder.lower, -180 / M_PI, 1e-12);
  EXPECT_NEAR(shoulder.upper, 360 / M_PI, 1e-12);
  const UrdfJoint& slider = Joint(urdf, "slider");
  EXPECT_EQ(slider.upper, 0.25);
  EXPECT_EQ(urdf.joints[std::size_t(slider.mimic)].name, "shoulder");
  // 2 m a radian is 2 pi / 180 m a degree; the offset is metres.
  EXPECT_NEAR(slider.mimicMultiplier, 2 * M_PI / 180, 1e-12);
  EXPECT_EQ(slider.mimicOffset, 0.5);
  const UrdfJoint& wheel = Joint(urdf, "wheel");
  EXPECT_EQ(wheel.type, UrdfJoint::Type::Continuous);
  EXPECT_FALSE(wheel.hasLimits);
  EXPECT_EQ(wheel.axis, Eigen::Vector3d(1, 0, 0)); // URDF's default
  EXPECT_EQ(wheel.mimicMultiplier, -1.0);
  EXPECT_NEAR(wheel.mimicOffset, 18 / M_PI, 1e-12);
  EXPECT_EQ(Joint(urdf, "loose").type, UrdfJoint::Type::Floating);
  EXPECT_EQ(Joint(urdf, "flat").type, UrdfJoint::Type::Planar);

  const std::vector<UrdfVisual>& visuals = urdf.links[0].visuals;
  ASSERT_EQ(visuals.size(), 4u);
  EXPECT_EQ(visuals[0].shape, UrdfVisual::Shape::Box);
  EXPECT_EQ(visuals[0].size, Eigen::Vector3d(2, 4, 6));
  EXPECT_LT((visuals[0].X_LV.Apply({1, 0, 0}) - Eigen::Vector3d(1, 3, 3)).norm(), 1e-12);
  ASSERT_TRUE(visuals[0].hasMaterial); // of the robot
  EXPECT_NEAR(visuals[0].material.color[1], 0.8, 1e-6);
  EXPECT_NEAR(visuals[0].material.opacity, 0.5, 1e-6);
  EXPECT_EQ(visuals[1].size, Eigen::Vector3d(0.5, 0.5, 3));
  ASSERT_TRUE(visuals[1].hasMaterial); // of the visual
  EXPECT_NEAR(visuals[1].material.color[2], 0.3, 1e-6);
  EXPECT_EQ(visuals[2].size, Eigen::Vector3d(0.25, 0.25, 0.25));
  EXPECT_FALSE(visuals[2].hasMaterial);
  EXPECT_EQ(visuals[3].meshPath, shell);
  EXPECT_FALSE(visuals[3].missing);
  EXPECT_EQ(visuals[3].size, Eigen::Vector3d(1, -2, 3));
}

TEST(ImportUrdf, ChildInParentAgainstEigen) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-3, 3);
  const auto vector = [&] {
    return Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
  };
  for (int i = 0; i < 100; ++i) {
    UrdfJoint joint;
    joint.X_PJ.position = vector();
    joint.X_PJ.rotation = Eigen::AngleAxisd(uniform(random), vector().normalized());
    joint.axis = vector().normalized();
    const double position = 40 * uniform(random);
    const Eigen::Affine3d X_PJ =
        Eigen::Translation3d(joint.X_PJ.position) * Eigen::Affine3d(joint.X_PJ.rotation);
    for (const auto type : {UrdfJoint::Type::Revolute, UrdfJoint::Type::Continuous,
                            UrdfJoint::Type::Prismatic, UrdfJoint::Type::Fixed}) {
      joint.type = type;
      Eigen::Affine3d expected = X_PJ;
      if (type == UrdfJoint::Type::Prismatic) {
        expected.translate(position * joint.axis);
      } else if (type != UrdfJoint::Type::Fixed) {
        expected.rotate(Eigen::AngleAxisd(position * M_PI / 180, joint.axis));
      }
      EXPECT_LT((joint.ChildInParent(position).Matrix() - expected.matrix()).norm(), 1e-11);
    }
  }
}

TEST(ImportUrdf, MeshesAreFoundAndMissed) {
  const TempFolder folder;
  const Urdf gone = ReadText(folder, Arm);
  EXPECT_TRUE(gone.links[0].visuals[3].missing);
  EXPECT_TRUE(HasWarning(gone.warnings, "meshes/shell.stl"));
  EXPECT_TRUE(HasWarning(gone.warnings, "link 'base'"));
  ImportOptions strict;
  strict.strict = true;
  ExpectError(Error::Kind::NotFound, "shell.stl", [&] { ReadUrdf(folder / "robot.urdf", strict); });
  // package:// from the folder of the package itself, and from a folder of packages.
  const std::string mesh = folder.Write("packs/arm_pkg/meshes/a b.stl", "solid");
  const auto read = [&](const std::string& name) {
    return ReadUrdf(
               folder.Write("packs/arm_pkg/urdf/robot.urdf", Changed("meshes/shell.stl", name)))
        .links[0]
        .visuals[3];
  };
  EXPECT_EQ(read("package://arm_pkg/meshes/a b.stl").meshPath, mesh);
  EXPECT_EQ(read("../meshes/a b.stl").meshPath, mesh);
  EXPECT_EQ(read("file://" + mesh).meshPath, mesh);
  EXPECT_TRUE(read("package://other/meshes/a b.stl").missing);
  EXPECT_TRUE(read("http://example.com/a.stl").missing);
}

TEST(ImportUrdf, BadGraphsAreTypedErrors) {
  const TempFolder folder;
  const auto joint = [](const std::string& name, const std::string& parent,
                        const std::string& child) {
    return "<joint name='" + name + "' type='fixed'><parent link='" + parent + "'/><child link='" +
           child + "'/></joint>";
  };
  const std::string links = "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>";
  ExpectBad(folder, "link 'c' has two parents",
            links + joint("1", "a", "b") + joint("2", "a", "c") + joint("3", "b", "c") +
                "</robot>");
  ExpectBad(folder, "part of a loop",
            links + joint("1", "b", "c") + joint("2", "c", "b") + "</robot>");
  ExpectBad(folder, "oot", // no root at all
            links + joint("1", "a", "b") + joint("2", "b", "c") + joint("3", "c", "a") +
                "</robot>");
  ExpectBad(folder, "part of a loop",
            links + joint("1", "a", "b") + joint("2", "c", "c") + "</robot>");
  ExpectBad(folder, "Two root links", links + "</robot>");
  // Links that joints name are there, and once.
  const Urdf arm = ReadText(folder, "<robot name='r'><link name='a'/><link name='a'/>" +
                                        joint("1", "body", "a") + "</robot>");
  ASSERT_EQ(arm.links.size(), 2u);
  EXPECT_EQ(arm.links[0].name, "body");
  EXPECT_TRUE(HasWarning(arm.warnings, "empty ones are made: joint '1' (body)"));
  EXPECT_TRUE(HasWarning(arm.warnings, "defined twice, the first is taken: link 'a'"));
  ExpectBad(folder, "", "<robot name='r'></robot>");
  std::string chain = "<robot name='r'><link name='l0'/>";
  for (int i = 1; i <= 1001; ++i) {
    chain += "<link name='l" + std::to_string(i) + "'/>" +
             joint("j" + std::to_string(i), "l" + std::to_string(i - 1), "l" + std::to_string(i));
  }
  ExpectBad(folder, "deeper than 1000", chain + "</robot>");
}

TEST(ImportUrdf, NamesThatFramesCannotHaveAreMapped) {
  const TempFolder folder;
  const std::string text =
      "<robot name='r2'><link name='/r2/robot_base'/><link name='_r2_robot_base'/><link name='..'/>"
      "<link name='" +
      std::string(300, 'n') +
      "'/><link name='fine'/>"
      "<joint name='r2/a' type='fixed'><parent link='/r2/robot_base'/><child "
      "link='_r2_robot_base'/></joint>"
      "<joint name='b' type='fixed'><parent link='/r2/robot_base'/><child link='..'/></joint>"
      "<joint name='c' type='fixed'><parent link='..'/><child link='" +
      std::string(300, 'n') +
      "'/></joint>"
      "<joint name='d' type='fixed'><parent link='..'/><child link='fine'/></joint></robot>";
  const std::string path = folder.Write("r2.urdf", text);
  const Urdf urdf = ReadUrdf(path);
  std::map<std::string, std::string> mapped;
  for (const UrdfLink& link : urdf.links) {
    EXPECT_TRUE(IsValidFrameName(link.name)) << link.name;
    mapped[link.originalName] = link.name;
  }
  EXPECT_EQ(mapped["/r2/robot_base"], "_r2_robot_base_2"); // the other one has that name already
  EXPECT_EQ(mapped["_r2_robot_base"], "_r2_robot_base");
  EXPECT_EQ(mapped[".."], "_");
  EXPECT_EQ(mapped["fine"], "fine");
  EXPECT_EQ(mapped.size(), 5u);
  // Joints are no frames.
  EXPECT_EQ(urdf.links[std::size_t(Joint(urdf, "r2/a").childLink)].name, "_r2_robot_base");
  ASSERT_EQ(urdf.warnings.size(), 1u); // once
  EXPECT_TRUE(HasWarning(urdf.warnings, "'/r2/robot_base' is '_r2_robot_base_2'"));
  ImportOptions strict;
  strict.strict = true;
  ExpectError(Error::Kind::Corrupt, "'/r2/robot_base'", [&] { ReadUrdf(path, strict); });
}

TEST(ImportUrdf, BadTextIsTyped) {
  const TempFolder folder;
  ExpectError(Error::Kind::NotFound, "none.urdf", [&] { ReadUrdf(folder / "none.urdf"); });
  ExpectError(Error::Kind::Io, "not a regular file", [&] { ReadUrdf(folder / ""); });
  ExpectBad(folder, "is empty", "");
  ExpectBad(folder, "not a valid URDF", "hello");
  ExpectBad(folder, "not a valid URDF", "<sdf/>");
  ExpectBad(folder, "zero bytes", std::string("<robot name='r'>\0</robot>", 25));
  std::string deep = "<robot name='r'>";
  for (int i = 0; i < 200000; ++i) {
    deep += "<a>";
  }
  ExpectBad(folder, "nested 200001 deep", deep);
  // The same behind what looks like the start of a comment to a careless scanner.
  std::string hidden = "<?x > ";
  for (int i = 0; i < 200000; ++i) {
    hidden += "<a b='>'>";
  }
  ExpectBad(folder, "deep", hidden);
  const std::string arm = Arm;
  for (std::size_t n = 0; n < arm.size(); n += 13) {
    EXPECT_THROW(ReadText(folder, arm.substr(0, n)), Error) << n;
  }
}

TEST(ImportUrdf, Perseverance) {
  DSPACE_REAL_DATA(path, "models/m2020_rover/m2020.urdf");
  const Urdf urdf = ReadUrdf(path);
  EXPECT_EQ(urdf.links.size(), 115u);
  EXPECT_EQ(urdf.joints.size(), 114u);
  std::map<UrdfJoint::Type, int> types;
  for (const UrdfJoint& joint : urdf.joints) {
    ++types[joint.type];
    EXPECT_NEAR(joint.axis.norm(), 1, 1e-12) << joint.name;
  }
  EXPECT_EQ(types[UrdfJoint::Type::Revolute], 26);
  EXPECT_EQ(types[UrdfJoint::Type::Prismatic], 3);
  EXPECT_EQ(types[UrdfJoint::Type::Floating], 2);
  EXPECT_EQ(types[UrdfJoint::Type::Fixed], 83);
  EXPECT_EQ(urdf.links[0].name, "ground");
  std::map<std::string, int> read;
  for (const UrdfLink& link : urdf.links) {
    for (const UrdfVisual& visual : link.visuals) {
      ASSERT_EQ(visual.shape, UrdfVisual::Shape::Mesh);
      EXPECT_FALSE(visual.missing) << visual.meshPath;
      try {
        read["parts"] += ReadModel(visual.meshPath).TriangleCount() > 0;
      } catch (const Error& e) {
        ++read[std::string(e.what()).find("CHASSIS.bin") != std::string::npos  ? "CHASSIS"
               : std::string(e.what()).find("Turret.bin") != std::string::npos ? "Turret"
                                                                               : e.what()];
      }
    }
  }
  EXPECT_EQ(read.size(), 3u);
  EXPECT_EQ(read["CHASSIS"], 1);
  EXPECT_EQ(read["Turret"], 1);
  EXPECT_GT(read["parts"], 20);
  // At rest the six wheels stand around the body: 1.1 m to either side, 2.3 m front to rear.
  double wheels = 0;
  for (std::size_t i = 0; i < urdf.links.size(); ++i) {
    if (urdf.links[i].visuals.empty() ||
        urdf.links[i].visuals[0].meshPath.find("Wheel_") == std::string::npos) {
      continue;
    }
    Pose X_RL; // link in the root
    for (int l = static_cast<int>(i); urdf.links[std::size_t(l)].parentJoint >= 0;) {
      const UrdfJoint& joint = urdf.joints[std::size_t(urdf.links[std::size_t(l)].parentJoint)];
      X_RL = joint.ChildInParent(0) * X_RL;
      l = joint.parentLink;
    }
    EXPECT_NEAR(std::abs(X_RL.position.y()), 1.1, 0.15) << urdf.links[i].name;
    EXPECT_LT(std::abs(X_RL.position.x()), 1.4) << urdf.links[i].name;
    ++wheels;
  }
  EXPECT_EQ(wheels, 6);
}
