// Repairs of URDF text: each flaw costs a warning, not the robot.
#include <dspace/import/urdf/UrdfRepair.h>

#include "UrdfTestSupport.h"

using namespace dspace;
using namespace dspace::testing;

// What is wrong with a joint or a visual costs a warning, not the robot.
TEST(UrdfRepair, FlawsAreRepaired) {
  const TempFolder folder;
  ImportOptions strict;
  strict.strict = true;
  const auto read = [&](const std::string& text, const std::string& warning) {
    const std::string path = folder.Write("robot.urdf", text);
    folder.Write("meshes/shell.stl", "solid"); // else it is what strict names
    EXPECT_THROW(ReadUrdf(path, strict), Error) << warning;
    Urdf urdf = ReadUrdf(path);
    EXPECT_TRUE(HasWarning(urdf.warnings, warning)) << warning;
    EXPECT_EQ(urdf.links.size(), 6u) << warning;
    EXPECT_EQ(urdf.joints.size(), 5u) << warning;
    return urdf;
  };
  const std::string shoulderLimit = "<limit lower=\"-1\" upper=\"2\" effort=\"1\" velocity=\"1\"/>";
  const std::string sliderLimit =
      "<limit lower=\"-0.5\" upper=\"0.25\" effort=\"1\" velocity=\"1\"/>";
  Urdf urdf = read(Changed("lower=\"-1\"", "lower=\"3\""),
                   "wrong way round are exchanged: joint 'shoulder' (3 to 2)");
  EXPECT_NEAR(Joint(urdf, "shoulder").lower, 360 / M_PI, 1e-9);
  EXPECT_NEAR(Joint(urdf, "shoulder").upper, 540 / M_PI, 1e-9);
  urdf = read(Changed(sliderLimit, ""), "joints without limits take any position: joint 'slider'");
  EXPECT_FALSE(Joint(urdf, "slider").hasLimits);
  EXPECT_EQ(Joint(urdf, "slider").type, UrdfJoint::Type::Prismatic);
  EXPECT_TRUE(Joint(urdf, "shoulder").hasLimits); // untouched
  urdf = read(Changed(shoulderLimit, ""), "joints without limits take any position: joint 'shoul");
  EXPECT_FALSE(Joint(urdf, "shoulder").hasLimits);
  urdf = ReadText(folder, Changed(" effort=\"1\"", "")); // not used: nothing to say
  EXPECT_TRUE(urdf.warnings.empty());
  EXPECT_NEAR(Joint(urdf, "shoulder").upper, 360 / M_PI, 1e-12);
  urdf = read(Changed("lower=\"-1\"", "lower=\"a\""), "limits that are no numbers");
  EXPECT_FALSE(Joint(urdf, "shoulder").hasLimits);
  urdf = read(Changed("0 3 4", "0 0 0"), "axis has no direction are taken as fixed: joint 'shoul");
  EXPECT_EQ(Joint(urdf, "shoulder").type, UrdfJoint::Type::Fixed);
  read(Changed("0 3 4", "nan 0 0"), "joint 'shoulder'");
  read(Changed("0 3 4", "0 3"), "axes that are not three numbers are taken as X");
  urdf = read(Changed("type=\"revolute\"", "type=\"bendy\""),
              "unknown type are taken as floating: joint 'shoulder' (bendy)");
  EXPECT_EQ(Joint(urdf, "shoulder").type, UrdfJoint::Type::Floating);
  urdf = read(Changed("mimic joint=\"shoulder\"", "mimic joint=\"elbow\""), "'elbow'");
  EXPECT_EQ(Joint(urdf, "slider").mimic, -1);
  EXPECT_GE(Joint(urdf, "wheel").mimic, 0);
  read(Changed("mimic joint=\"shoulder\"", "mimic joint=\"slider\""), "mimic themselves");
  read(Changed("name=\"slider\"", "name=\"shoulder\""), "get one: joint 'shoulder_2'");
  urdf = read(Changed("xyz=\"0 0 1\" rpy=\"0.1", "xyz=\"0 1e300 1\" rpy=\"0.1"), "beyond 1e18 m");
  EXPECT_EQ(Joint(urdf, "shoulder").X_PJ.position, Eigen::Vector3d::Zero());

  const auto visuals = [&](const std::string& from, const std::string& to,
                           const std::string& warning) {
    return read(Changed(from, to), warning).links[0].visuals.size();
  };
  EXPECT_EQ(visuals("size=\"2 4 6\"", "size=\"2 0 6\"", "link 'base' has 2 0 6"), 3u);
  EXPECT_EQ(visuals("radius=\"0.5\" length=\"3\"", "radius=\"0.5\" length=\"0\"", "0.5 0.5 0"), 3u);
  EXPECT_EQ(visuals("radius=\"0.25\"", "radius=\"0\"", "left out for their size"), 3u);
  EXPECT_EQ(visuals("radius=\"0.25\"", "radius=\"-1\"", "1e-9 to 1e15 metres"), 3u);
  EXPECT_EQ(visuals("radius=\"0.25\"", "radius=\"1e300\"", "1e-9 to 1e15 metres"), 3u);
  EXPECT_EQ(visuals("1 -2 3", "1 0 3", "for the scale of their mesh"), 3u);
  EXPECT_EQ(visuals("1 -2 3", "1 1e-300 3", "for the scale of their mesh"), 3u);
  EXPECT_EQ(visuals("<sphere radius=\"0.25\"/>", "<capsule radius=\"1\" length=\"2\"/>",
                    "unknown shape, or with sizes that are no numbers, are left out: link 'base' "
                    "(capsule)"),
            3u);
  EXPECT_EQ(visuals("<sphere radius=\"0.25\"/>", "", "visuals without a shape"), 3u);
  EXPECT_EQ(visuals("<material name=\"gold\"/>", "<material name=\"silver\"/>",
                    "not defined, their visuals are grey: material 'silver'"),
            4u);
  // Limits beyond any degree are none, and no flaw.
  const Urdf boundless = ReadText(
      folder, Changed("lower=\"-1\" upper=\"2\"", "lower=\"-1.79769e308\" upper=\"1.79769e308\""));
  EXPECT_FALSE(Joint(boundless, "shoulder").hasLimits);
  EXPECT_TRUE(boundless.warnings.empty());
  // What Dspace does not use cannot be wrong.
  const std::string unused = "<link name=\"upper\"><inertial><mass/></inertial><collision/></link>";
  EXPECT_TRUE(ReadText(folder, Changed("<link name=\"upper\"/>", unused)).warnings.empty());
}

TEST(UrdfRepair, TextWithoutFlawsKeepsItsMeaning) {
  GroupedWarnings warnings;
  const std::string text = "<robot name='r'><link name='a'/></robot>";
  EXPECT_NE(RepairUrdfText(text, warnings).find("<link name=\"a\""), std::string::npos);
  EXPECT_EQ(RepairUrdfText("no XML <", warnings), "no XML <");
  EXPECT_EQ(RepairUrdfText("", warnings), "");
  EXPECT_TRUE(warnings.Empty());
  const std::string twice = RepairUrdfText(
      "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
      "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
      "<joint name='j' type='fixed'><parent link='a'/><child link='c'/></joint></robot>",
      warnings);
  EXPECT_NE(twice.find("\"j_2\""), std::string::npos) << twice;
  ASSERT_EQ(warnings.Texts().size(), 1u);
  GroupedWarnings none; // what is repaired has no flaws
  RepairUrdfText(twice, none);
  EXPECT_TRUE(none.Empty());
}
