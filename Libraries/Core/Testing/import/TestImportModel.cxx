// The model itself, its normals, and which reader a file gets.
#include <dspace/import/model/Model.h>
#include <dspace/import/model/Normals.h>

#include <cmath>
#include <limits>

#include "ImportTestSupport.h"

using namespace dspace;
using namespace dspace::testing;

namespace {

// A cube from -1 to 1 with eight shared vertices, outward triangles.
Mesh Cube() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.insert(mesh.positions.end(),
                          {i & 1 ? 1.f : -1.f, i & 2 ? 1.f : -1.f, i & 4 ? 1.f : -1.f});
  }
  mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                  2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return mesh;
}

Eigen::Vector3d At(const std::vector<float>& array, std::size_t vertex) {
  return {array[3 * vertex], array[3 * vertex + 1], array[3 * vertex + 2]};
}

Model CubeModel() {
  Model model;
  model.path = "cube";
  model.meshes.push_back(Cube());
  model.materials.emplace_back();
  model.meshes[0].material = 0;
  ModelNode root;
  root.local =
      Eigen::Translation3d(10, 0, 0) * Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  ModelNode child;
  child.parent = 0;
  child.local = Eigen::Translation3d(5, 0, 0) * Eigen::Scaling(1.0, 2.0, 3.0);
  child.meshes = {0};
  root.meshes = {0};
  model.nodes = {root, child};
  return model;
}

} // namespace

TEST(ImportModel, BoundsAndCountsFollowTheNodes) {
  const Model model = CubeModel();
  EXPECT_EQ(model.TriangleCount(), 24u);
  // The child stands 5 along the root's X, which is the file's Y; its Y, 2 long, is the file's -X.
  const Eigen::Affine3d X_FC = model.NodeToModel(1);
  EXPECT_LT((X_FC * Eigen::Vector3d::Zero() - Eigen::Vector3d(10, 5, 0)).norm(), 1e-12);
  EXPECT_LT((X_FC * Eigen::Vector3d(0, 1, 0) - Eigen::Vector3d(8, 5, 0)).norm(), 1e-12);
  const Eigen::AlignedBox3d box = model.Bounds();
  EXPECT_LT((box.min() - Eigen::Vector3d(8, -1, -3)).norm(), 1e-12);
  EXPECT_LT((box.max() - Eigen::Vector3d(12, 6, 3)).norm(), 1e-12);
  EXPECT_TRUE(Model().Bounds().isEmpty());
  ExpectError(Error::Kind::InvalidArgument, "node 2", [&] { model.NodeToModel(2); });
}

TEST(ImportModel, CheckNamesWhatIsWrong) {
  const auto expect = [](const std::string& part, void (*damage)(Model&)) {
    Model model = CubeModel();
    damage(model);
    ExpectError(Error::Kind::Corrupt, part, [&] { CheckModel(model); });
  };
  EXPECT_NO_THROW(CheckModel(CubeModel()));
  expect("index 8 (number 3)", [](Model& m) { m.meshes[0].indices[3] = 8; });
  expect("positions",
         [](Model& m) { m.meshes[0].positions[4] = std::numeric_limits<float>::quiet_NaN(); });
  expect("positions", [](Model& m) { m.meshes[0].positions.push_back(0); });
  expect("normals", [](Model& m) { m.meshes[0].normals = {0, 0, 1}; });
  expect("tcoords",
         [](Model& m) { m.meshes[0].tcoords.assign(16, std::numeric_limits<float>::infinity()); });
  expect("colours", [](Model& m) { m.meshes[0].colors.resize(3); });
  expect("material 1 of 1", [](Model& m) { m.meshes[0].material = 1; });
  expect("multiple of 3", [](Model& m) { m.meshes[0].indices.pop_back(); });
  expect("parent 1", [](Model& m) { m.nodes[1].parent = 1; });
  expect("mesh 7 of 1", [](Model& m) { m.nodes[1].meshes = {7}; });
  expect("transform", [](Model& m) { m.nodes[0].local.translation().x() = NAN; });
  expect("opacity is 2", [](Model& m) { m.materials[0].opacity = 2; });
  expect("texture", [](Model& m) {
    auto image = std::make_shared<Image>();
    image->width = image->height = image->channels = 3;
    m.materials[0].texture = image;
  });
}

TEST(ImportModel, NormalsBreakAtCreases) {
  Mesh cube = Cube();
  ComputeNormals(cube, 30.0);
  ASSERT_EQ(cube.VertexCount(), 24u); // three at each corner
  ASSERT_EQ(cube.normals.size(), cube.positions.size());
  for (std::size_t f = 0; f < cube.indices.size(); f += 3) {
    const Eigen::Vector3d a = At(cube.positions, cube.indices[f]);
    const Eigen::Vector3d face = (At(cube.positions, cube.indices[f + 1]) - a)
                                     .cross(At(cube.positions, cube.indices[f + 2]) - a)
                                     .normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LT((At(cube.normals, cube.indices[f + k]) - face).norm(), 1e-6);
    }
  }
  // Smooth across 90 degrees: by symmetry the corner's normal is its own direction.
  Mesh smooth = Cube();
  ComputeNormals(smooth, 100.0);
  ASSERT_EQ(smooth.VertexCount(), 8u);
  for (std::size_t v = 0; v < 8; ++v) {
    EXPECT_LT((At(smooth.normals, v) - At(smooth.positions, v).normalized()).norm(), 1e-6);
  }
}

TEST(ImportModel, NormalsOfASphereAreRadial) {
  // Each quad has vertices of its own, as after a texture seam: they must be smoothed all the same.
  Mesh sphere;
  const int n = 48, m = 24;
  const auto point = [&](int i, int j) {
    const double u = 2 * M_PI * i / n, v = M_PI * j / m;
    return Eigen::Vector3f(float(std::sin(v) * std::cos(u)), float(std::sin(v) * std::sin(u)),
                           float(std::cos(v)));
  };
  for (int j = 1; j < m - 1; ++j) {
    for (int i = 0; i < n; ++i) {
      const auto base = static_cast<std::uint32_t>(sphere.VertexCount());
      for (const Eigen::Vector3f& p :
           {point(i, j), point(i, j + 1), point((i + 1) % n, j + 1), point((i + 1) % n, j)}) {
        sphere.positions.insert(sphere.positions.end(), {p.x(), p.y(), p.z()});
      }
      for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) {
        sphere.indices.push_back(base + k);
      }
    }
  }
  const std::size_t before = sphere.VertexCount();
  ComputeNormals(sphere, 30.0);
  EXPECT_EQ(sphere.VertexCount(), before);
  for (std::size_t v = 0; v < before; ++v) {
    const Eigen::Vector3d p = At(sphere.positions, v);
    if (std::abs(p.z()) < 0.9) { // the open ends lean
      EXPECT_GT(At(sphere.normals, v).dot(p), std::cos(1.0 * M_PI / 180));
    }
  }
}

TEST(ImportModel, NormalsKeepWhatIsThereAndStandDegenerates) {
  Mesh mesh = Cube();
  mesh.normals.assign(24, 0.5f);
  ComputeNormals(mesh);
  EXPECT_EQ(mesh.normals, std::vector<float>(24, 0.5f));
  Mesh flat;
  flat.positions = {0, 0, 0, 1, 0, 0, 2, 0, 0, 5, 5, 5};
  flat.indices = {0, 1, 2, 0, 0, 0};
  ComputeNormals(flat);
  ASSERT_EQ(flat.normals.size(), flat.positions.size());
  for (std::size_t v = 0; v < flat.VertexCount(); ++v) {
    EXPECT_NEAR(At(flat.normals, v).norm(), 1.0, 1e-6);
  }
  ExpectError(Error::Kind::InvalidArgument, "crease angle", [] {
    Mesh cube = Cube();
    ComputeNormals(cube, NAN);
  });
}

TEST(ImportModel, NormalsTakeLinearTimeAroundOneVertex) {
  Mesh fan; // 200,000 triangles at one vertex: quadratic work would not end within the test's limit
  const std::uint32_t n = 200000;
  fan.positions = {0, 0, 0};
  for (std::uint32_t i = 0; i < n; ++i) {
    const double a = 2 * M_PI * i / n;
    fan.positions.insert(fan.positions.end(), {float(std::cos(a)), float(std::sin(a)), 0.f});
    fan.indices.insert(fan.indices.end(), {0u, 1 + i, 1 + (i + 1) % n});
  }
  ComputeNormals(fan);
  EXPECT_EQ(fan.VertexCount(), n + 1u);
  EXPECT_NEAR(fan.normals[2], 1.0, 1e-6);
}

TEST(ImportReader, WrongFilesAreTypedErrors) {
  const TempFolder folder;
  ExpectReadError(Error::Kind::NotFound, "nothing.gltf", folder / "nothing.gltf");
  ExpectReadError(Error::Kind::Io, "not a regular file", folder / "");
  ExpectReadError(Error::Kind::Io, "not a regular file", "/dev/zero");
  for (const std::string type : {"gltf", "glb", "obj", "stl", "ply", "wrl"}) {
    ExpectReadError(Error::Kind::Corrupt, "is empty", folder.Write("empty." + type, ""));
  }
  ExpectReadError(Error::Kind::Unsupported, "accepted are", folder.Write("a.xyz", "hello world"));
  ExpectReadError(Error::Kind::Unsupported, "URDF", folder.Write("a.urdf", "<robot name='r'/>"));
  ExpectReadError(Error::Kind::Corrupt, "not glTF",
                  folder.Write("png.gltf", DecodeBase64(FourColorsPng)));
  ExpectReadError(Error::Kind::Corrupt, "no faces",
                  folder.Write("png.obj", DecodeBase64(FourColorsPng)));
}
