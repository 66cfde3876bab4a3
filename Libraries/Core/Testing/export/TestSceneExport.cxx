// Exported scenes, opened by assimp: places, animation, warnings; rejected input.
#include <filesystem>
#include <fstream>
#include <map>

#include "ExportTestSupport.h"
#include "FullDisk.h"

using namespace dspace;
using namespace dspace::testing;

TEST_F(SceneExportTest, FramesPlaceObjects) {
  const FrameId base = this->S.Frames().Create(RootFrame, "base", Turned(10, -4, 2, 70, {1, 2, 3}));
  const FrameId arm = this->S.Frames().Create(base, "arm", Turned(1, 2, 3, -40, {0, 1, 1}, 2.5));
  const ObjectId box = this->Add("box", MakeBox({1, 2, 3}), arm);
  const ObjectId ball = this->Add("ball", MakeSphere(0.5), base);
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  X.translate(Eigen::Vector3d(0, 0, 4)).rotate(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX()));
  X.scale(Eigen::Vector3d(1, 3, -0.5)); // stretched and mirrored
  this->S.SetObjectOffset(ball, X);
  const ObjectId sheared = this->Add("sheared", MakeBox({1, 1, 1}), base);
  Eigen::Affine3d shear = Eigen::Affine3d::Identity();
  shear.linear() << 1, 0.7, 0, 0, 1, 0.2, 0, 0, 1;
  this->S.SetObjectOffset(sheared, shear);
  EXPECT_TRUE(this->Export().empty());

  const ExportedFile file(this->Path);
  EXPECT_STREQ(file.Node("arm").mParent->mName.C_Str(), "base");
  const Eigen::Affine3d local = ToEigen(file.Node("arm").mTransformation);
  EXPECT_TRUE(local.matrix().isApprox(this->S.Frames().LocalPose(arm).Matrix(), 1e-6));
  this->ExpectSameBox(file.Box(file.Node("box")), this->Expected(box));
  this->ExpectSameBox(file.Box(file.Node("ball")), this->Expected(ball));
  this->ExpectSameBox(file.Box(file.Node("sheared")), this->Expected(sheared));
  EXPECT_EQ(file.Mesh("box").mNumFaces, 12u);
  EXPECT_EQ(file.Mesh("ball").mNumFaces, MakeSphere(0.5).PrimitiveCount());
}

TEST_F(SceneExportTest, NormalsOfShearedFacesStayNormal) {
  const ObjectId id = this->Add("sheared", MakeSphere(1.0, 16));
  Eigen::Affine3d shear = Eigen::Affine3d::Identity();
  shear.linear() << 1, 0.7, 0, 0, 1, 0.2, 0, 0, -1; // mirrored too
  this->S.SetObjectOffset(id, shear);
  this->Export();
  const ExportedFile file(this->Path);
  const aiMesh& mesh = file.Mesh("sheared");
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const unsigned* i = mesh.mFaces[f].mIndices;
    const aiVector3D face = (mesh.mVertices[i[1]] - mesh.mVertices[i[0]]) ^
                            (mesh.mVertices[i[2]] - mesh.mVertices[i[0]]);
    if (face.Length() > 1e-4f) {
      EXPECT_GT(face * mesh.mNormals[i[0]] / face.Length(), 0.7f) << f; // outwards
    }
  }
}

TEST_F(SceneExportTest, PosesAreAnimated) {
  const FrameId base = this->S.Frames().Create(RootFrame, "base");
  const FrameId arm = this->S.Frames().Create(base, "arm", Turned(1, 0, 0, 0, {0, 0, 1}));
  this->Add("box", MakeBox({1, 1, 1}), arm);
  SceneExportOptions options;
  options.times = {100.0, 101.0, 103.5};
  options.frames = {base, arm};
  for (int t = 0; t < 3; ++t) {
    options.poses.push_back(Turned(t, 2.0 * t, 0, 0, {0, 0, 1}));   // base moves
    options.poses.push_back(Turned(1, 0, 0, 120.0 * t, {0, 0, 1})); // arm turns
    options.poses.back().rotation.coeffs() *= t == 1 ? -1.0 : 1.0;  // the same rotation
  }
  EXPECT_TRUE(this->Export(options).empty());
  const ExportedFile file(this->Path);
  ASSERT_EQ(file.Scene->mNumAnimations, 1u);
  const aiAnimation& animation = *file.Scene->mAnimations[0];
  std::map<std::string, const aiNodeAnim*> channels;
  for (unsigned i = 0; i < animation.mNumChannels; ++i) {
    channels[animation.mChannels[i]->mNodeName.C_Str()] = animation.mChannels[i];
  }
  ASSERT_EQ(channels.size(), 2u);
  const aiNodeAnim& moved = *channels.at("base");
  ASSERT_EQ(moved.mNumPositionKeys, 3u);
  EXPECT_EQ(moved.mNumRotationKeys, 1u); // at rest
  const double seconds[3] = {0.0, 1.0, 3.5};
  for (unsigned t = 0; t < 3; ++t) {
    EXPECT_NEAR(moved.mPositionKeys[t].mTime / animation.mTicksPerSecond, seconds[t], 1e-6);
    EXPECT_NEAR(moved.mPositionKeys[t].mValue.y, 2.0 * t, 1e-6);
  }
  const aiNodeAnim& turned = *channels.at("arm");
  ASSERT_EQ(turned.mNumRotationKeys, 3u);
  for (unsigned t = 0; t < 3; ++t) {
    const aiQuaternion& q = turned.mRotationKeys[t].mValue;
    const Eigen::Quaterniond expected(
        Eigen::AngleAxisd(t * 120.0 * M_PI / 180.0, Eigen::Vector3d::UnitZ()));
    EXPECT_NEAR(std::abs(expected.dot(Eigen::Quaterniond(q.w, q.x, q.y, q.z))), 1.0, 1e-6);
    if (t > 0) { // the short way
      const aiQuaternion& p = turned.mRotationKeys[t - 1].mValue;
      EXPECT_GT(p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z, 0.0f);
    }
  }
}

TEST_F(SceneExportTest, WhatIsLeftOutIsNamed) {
  this->Add("box", MakeBox({1, 1, 1}));
  this->Add("trail", Mesh());
  this->S.SetObjectVisible(this->Add("hidden", MakeBox({1, 1, 1})), false);
  GraphicsObject label;
  label.name = "label";
  label.billboard = true;
  label.nature = Nature::Ornamental;
  label.levels = {{{Part{std::make_shared<const Mesh>(MakePlane(1, 1)), nullptr}}, 0.0}};
  this->S.AddObject(label);
  GraphicsObject axes = label;
  axes.name = "axes";
  axes.billboard = false;
  this->S.AddObject(axes);
  std::vector<std::string> warnings = this->Export();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("'trail'"), std::string::npos) << warnings[0];
  {
    const ExportedFile file(this->Path);
    EXPECT_EQ(file.Scene->mRootNode->FindNode("hidden"), nullptr);
    EXPECT_EQ(file.Scene->mRootNode->FindNode("axes"), nullptr);
  }
  SceneExportOptions options;
  options.ornaments = true;
  warnings = this->Export(options);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[1].find("'label'"), std::string::npos) << warnings[1];
  EXPECT_NE(ExportedFile(this->Path).Scene->mRootNode->FindNode("axes"), nullptr);
  options.fragments = {"ornamental"};
  this->Export(options);
  EXPECT_EQ(ExportedFile(this->Path).Scene->mRootNode->FindNode("box"), nullptr);
}

TEST_F(SceneExportTest, FarObjectsAreNamed) {
  const FrameId far = this->S.Frames().Create(RootFrame, "far", Turned(1.5e11, 0, 0, 0, {0, 0, 1}));
  this->Add("near", MakeBox({1, 1, 1}));
  this->Add("probe", MakeBox({1, 1, 1}), far);
  this->Add("planet", MakeSphere(6e6), far);
  const std::vector<std::string> warnings = this->Export();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("'probe'"), std::string::npos) << warnings[0];
  EXPECT_EQ(warnings[0].find("more objects"), std::string::npos) << warnings[0];
}

TEST_F(SceneExportTest, RefusalsLeaveTheEarlierFile) {
  const FrameId base = this->S.Frames().Create(RootFrame, "base");
  this->Add("ball", MakeSphere(1.0, 64), base);
  std::ofstream(this->Path) << "earlier";
  using Kind = Error::Kind;
  this->ExpectRefused(Kind::InvalidArgument, ".gltf", this->Folder / "scene.gltf");
  this->ExpectRefused(Kind::Io, "absent", this->Folder / "absent/scene.glb");
  SceneExportOptions options;
  options.fragments = {"nothing"};
  this->ExpectRefused(Kind::NotFound, "nothing", this->Path, options);
  options = {};
  options.times = {0, 1};
  options.frames = {base};
  options.poses = {Pose()};
  this->ExpectRefused(Kind::InvalidArgument, "1 poses for 2 times", this->Path, options);
  options.poses = {Pose(), Pose()};
  options.times = {1, 1};
  this->ExpectRefused(Kind::InvalidArgument, "time", this->Path, options);
  options.times = {0, NAN};
  this->ExpectRefused(Kind::InvalidArgument, "time", this->Path, options);
  options.times = {0, 1};
  options.poses[1].scale = 0.0;
  this->ExpectRefused(Kind::InvalidArgument, "scale", this->Path, options);
  options.poses[1] = Pose();
  options.frames = {RootFrame};
  this->ExpectRefused(Kind::InvalidArgument, "root", this->Path, options);
  options.frames = {FrameId(99)};
  this->ExpectRefused(Kind::NotFound, "99", this->Path, options);
  {
    const FullDisk full(1000);
    this->ExpectRefused(Kind::Io, "scene.glb", this->Path);
  }
  std::ifstream file(this->Path);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "earlier");
  for (const auto& entry : std::filesystem::directory_iterator(this->Folder.Path())) {
    EXPECT_EQ(entry.path().filename(), "scene.glb"); // nothing beside it
  }
  file.close();
  this->Export();
  EXPECT_NE(ExportedFile(this->Path).Scene->mRootNode->FindNode("ball"), nullptr);
}
