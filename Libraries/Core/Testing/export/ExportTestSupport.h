// What the tests of exported scenes share: a scene to be exported, and the file as assimp reads it.
#ifndef DSPACE_EXPORT_TEST_SUPPORT_H
#define DSPACE_EXPORT_TEST_SUPPORT_H

#include <dspace/export/SceneExport.h>

#include <cmath>

#include <assimp/GltfMaterial.h>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/scene/Primitives.h>

#include "TemporaryFolder.h"

namespace dspace::testing {

inline double Linear(double s) { // IEC 61966-2-1
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

inline Eigen::Vector3d YUp(const Eigen::Vector3d& p) {
  return {p.x(), p.z(), -p.y()};
}

inline Eigen::Affine3d ToEigen(const aiMatrix4x4& m) {
  Eigen::Affine3d out;
  out.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1,
      m.d2, m.d3, m.d4;
  return out;
}

// A file as assimp reads it.
class ExportedFile {
public:
  explicit ExportedFile(const std::string& path) : Scene(Importer_.ReadFile(path, 0)) {
    EXPECT_NE(this->Scene, nullptr) << Importer_.GetErrorString();
  }

  const aiNode& Node(const std::string& name) const {
    const aiNode* node = this->Scene->mRootNode->FindNode(name.c_str());
    if (!node) {
      throw std::runtime_error("no node '" + name + "'");
    }
    return *node;
  }

  Eigen::Affine3d World(const aiNode& node) const {
    Eigen::Affine3d X = ToEigen(node.mTransformation);
    for (const aiNode* parent = node.mParent; parent; parent = parent->mParent) {
      X = ToEigen(parent->mTransformation) * X;
    }
    return X;
  }

  // Of the node and all below it, in the file's world.
  Eigen::AlignedBox3d Box(const aiNode& node) const {
    Eigen::AlignedBox3d box;
    const Eigen::Affine3d X = this->World(node);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const aiMesh& mesh = *this->Scene->mMeshes[node.mMeshes[i]];
      for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
        const aiVector3D& p = mesh.mVertices[v];
        box.extend(X * Eigen::Vector3d(p.x, p.y, p.z));
      }
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
      box.extend(this->Box(*node.mChildren[i]));
    }
    return box;
  }

  const aiMesh& Mesh(const std::string& node) const {
    return *this->Scene->mMeshes[this->Node(node).mMeshes[0]];
  }

  const aiMaterial& Material(const std::string& node) const {
    return *this->Scene->mMaterials[this->Mesh(node).mMaterialIndex];
  }

private:
  Assimp::Importer Importer_;

public:
  const aiScene* Scene;
};

class SceneExportTest : public ::testing::Test {
protected:
  ObjectId Add(const std::string& name, Mesh mesh, FrameId frame = RootFrame,
               const Material& material = {}) {
    GraphicsObject object;
    object.name = name;
    object.frame = frame;
    Part part;
    part.mesh = std::make_shared<const Mesh>(std::move(mesh));
    part.material = std::make_shared<const Material>(material);
    object.levels = {{{part}, 0.0}};
    return this->S.AddObject(std::move(object));
  }

  std::vector<std::string> Export(const SceneExportOptions& options = {}) {
    return ExportScene(this->S, this->Path, options);
  }

  void ExpectRefused(Error::Kind kind, const std::string& word, const std::string& path,
                     const SceneExportOptions& options = {}) {
    try {
      ExportScene(this->S, path, options);
      ADD_FAILURE() << "accepted: " << word;
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), kind) << error.what();
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }

  // The corners of the object's box in the scene, turned to Y up.
  Eigen::AlignedBox3d Expected(ObjectId id) const {
    const GraphicsObject& object = this->S.Object(id);
    const Pose X_RF = this->S.Frames().WorldPose(object.frame);
    Eigen::AlignedBox3d box;
    for (const Part& part : object.levels[0].parts) {
      for (std::size_t i = 0; i < part.mesh->positions.size(); i += 3) {
        const Eigen::Vector3d p = Eigen::Vector3f(&part.mesh->positions[i]).cast<double>();
        box.extend(YUp(X_RF.Apply(object.X_FO * (part.X_OP * p))));
      }
    }
    return box;
  }

  void ExpectSameBox(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
    EXPECT_LT((a.min() - b.min()).norm(), 1e-5) << a.min() << "\n" << b.min();
    EXPECT_LT((a.max() - b.max()).norm(), 1e-5) << a.max() << "\n" << b.max();
  }

  TemporaryFolder Folder;
  std::string Path = Folder / "scene.glb";
  Scene S{"test"};
};

inline Pose Turned(double x, double y, double z, double angle_deg, const Eigen::Vector3d& axis,
                   double scale = 1.0) {
  Pose pose;
  pose.position = {x, y, z};
  pose.rotation = Eigen::AngleAxisd(angle_deg * M_PI / 180.0, axis.normalized());
  pose.scale = scale;
  return pose;
}

} // namespace dspace::testing

#endif
