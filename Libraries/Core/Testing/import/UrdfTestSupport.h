// What the tests of URDF share: an arm with joints of all types, to be changed word by word.
#ifndef DSPACE_CORE_TESTING_URDF_TEST_SUPPORT_H
#define DSPACE_CORE_TESTING_URDF_TEST_SUPPORT_H

#include <dspace/import/urdf/Urdf.h>

#include "ImportTestSupport.h"

namespace dspace::testing {

inline const char* const Arm = R"(<?xml version="1.0"?>
<robot name="arm">
  <material name="gold"><color rgba="1 0.8 0 0.5"/></material>
  <link name="base">
    <visual name="plate"><origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/>
      <geometry><box size="2 4 6"/></geometry><material name="gold"/></visual>
    <visual><geometry><cylinder radius="0.5" length="3"/></geometry>
      <material name="own"><color rgba="0.1 0.2 0.3 1"/></material></visual>
    <visual><geometry><sphere radius="0.25"/></geometry></visual>
    <visual name="shell"><geometry><mesh filename="meshes/shell.stl" scale="1 -2 3"/></geometry>
    </visual>
  </link>
  <link name="upper"/><link name="slide"/><link name="spin"/><link name="free"/><link name="lead"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 1" rpy="0.1 0.2 0.3"/><axis xyz="0 3 4"/>
    <limit lower="-1" upper="2" effort="1" velocity="1"/></joint>
  <joint name="slider" type="prismatic"><parent link="upper"/><child link="slide"/>
    <axis xyz="0 0 2"/><limit lower="-0.5" upper="0.25" effort="1" velocity="1"/>
    <mimic joint="shoulder" multiplier="2" offset="0.5"/></joint>
  <joint name="wheel" type="continuous"><parent link="upper"/><child link="spin"/>
    <mimic joint="shoulder" multiplier="-1" offset="0.1"/></joint>
  <joint name="loose" type="floating"><parent link="slide"/><child link="free"/></joint>
  <joint name="flat" type="planar"><parent link="slide"/><child link="lead"/><axis xyz="0 0 1"/>
  </joint>
</robot>)";

inline const UrdfJoint& Joint(const Urdf& urdf, const std::string& name) {
  for (const UrdfJoint& joint : urdf.joints) {
    if (joint.name == name) {
      return joint;
    }
  }
  throw std::runtime_error("no joint " + name);
}

inline Urdf ReadText(const TempFolder& folder, const std::string& text) {
  return ReadUrdf(folder.Write("robot.urdf", text));
}

inline std::string Changed(const std::string& from, const std::string& to) {
  std::string text = Arm;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

} // namespace dspace::testing

#endif
