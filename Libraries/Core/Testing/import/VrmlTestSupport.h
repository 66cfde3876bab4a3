// What the tests of VRML share: files made by hand, and what meshes hold.
#ifndef DSPACE_VRML_TEST_SUPPORT_H
#define DSPACE_VRML_TEST_SUPPORT_H

#include <array>
#include <string>

#include <zlib.h>

#include "ImportTestSupport.h"

namespace dspace::testing {

inline const std::string Head2 = "#VRML V2.0 utf8\n";
inline const std::string Head1 = "#VRML V1.0 ascii\n";

inline Model Read(const TempFolder& folder, const std::string& text) {
  return ReadModel(folder.Write("test.wrl", text));
}

// A right triangle in the plane z = 0 as a geometry node, with more fields.
inline std::string Triangle(const std::string& fields = "") {
  return "IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } coordIndex [ 0 1 2 "
         "-1 ] " +
         fields + " }";
}

inline std::string Shape(const std::string& geometry, const std::string& appearance = "") {
  return "Shape { geometry " + geometry + " " + appearance + " }\n";
}

inline Eigen::Vector3d Position(const Mesh& mesh, std::size_t vertex) {
  return Eigen::Map<const Eigen::Vector3f>(&mesh.positions[3 * vertex]).cast<double>();
}

inline Eigen::Vector3d Normal(const Mesh& mesh, std::size_t vertex) {
  return Eigen::Map<const Eigen::Vector3f>(&mesh.normals[3 * vertex]).cast<double>();
}

inline std::array<int, 4> Color(const Mesh& mesh, std::size_t vertex) {
  const std::uint8_t* c = &mesh.colors[4 * vertex];
  return {c[0], c[1], c[2], c[3]};
}

// Volume inside a closed mesh whose faces look outward (divergence theorem).
inline double Volume(const Mesh& mesh) {
  double volume = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    volume +=
        Position(mesh, mesh.indices[i])
            .dot(Position(mesh, mesh.indices[i + 1]).cross(Position(mesh, mesh.indices[i + 2])));
  }
  return volume / 6.0;
}

// Every normal looks to the side from which its triangle runs counter-clockwise.
inline void ExpectNormalsAgree(const Mesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const std::uint32_t* t = &mesh.indices[i];
    const Eigen::Vector3d area = (Position(mesh, t[1]) - Position(mesh, t[0]))
                                     .cross(Position(mesh, t[2]) - Position(mesh, t[0]));
    for (int k = 0; k < 3; ++k) {
      EXPECT_GT(area.dot(Normal(mesh, t[k])), 0.0) << "triangle " << i / 3;
      EXPECT_NEAR(Normal(mesh, t[k]).norm(), 1.0, 1e-6);
    }
  }
}

inline const Mesh& Only(const Model& model) {
  EXPECT_EQ(model.meshes.size(), 1u);
  return model.meshes.at(0);
}

inline const Material& MaterialOf(const Model& model, std::size_t mesh = 0) {
  return model.materials.at(static_cast<std::size_t>(model.meshes.at(mesh).material));
}

inline std::string Gzip(const std::string& text) {
  z_stream stream = {};
  deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

} // namespace dspace::testing

#endif
