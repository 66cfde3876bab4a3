// Meshes made at run time: closed, of the right volume, facing outwards, with the shape's normals.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/scene/Markers.h>
#include <dspace/scene/Primitives.h>

namespace {

using dspace::Error;
using dspace::Mesh;
using dspace::Part;
using dspace::Projection;
using Eigen::Vector3d;

constexpr double Pi = 3.14159265358979323846;
constexpr double NotANumber = std::numeric_limits<double>::quiet_NaN();

Vector3d At(const std::vector<float>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

double Volume(const Mesh& mesh) {
  double six = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    six += At(mesh.positions, mesh.indices[i])
               .dot(At(mesh.positions, mesh.indices[i + 1])
                        .cross(At(mesh.positions, mesh.indices[i + 2])));
  }
  return six / 6.0;
}

Eigen::AlignedBox3d Bounds(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < mesh.VertexCount(); ++i) {
    box.extend(At(mesh.positions, i));
  }
  return box;
}

// Edges by their ends' coordinates: each directed edge once and its reverse once.
void ExpectClosed(const Mesh& mesh) {
  using Point = std::array<float, 3>;
  std::map<std::pair<Point, Point>, int> edges;
  const auto point = [&](std::size_t corner) {
    const Vector3d p = At(mesh.positions, mesh.indices[corner]);
    return Point{float(p.x()) + 0.0f, float(p.y()) + 0.0f, float(p.z()) + 0.0f};
  };
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++edges[{point(i + k), point(i + (k + 1) % 3)}];
    }
  }
  for (const auto& edge : edges) {
    EXPECT_EQ(edge.second, 1) << mesh.name;
    EXPECT_EQ(edges.count({edge.first.second, edge.first.first}), 1u) << mesh.name;
    EXPECT_NE(edge.first.first, edge.first.second) << mesh.name;
  }
}

// Well formed; unit normals; no sliver; each triangle faces the way its normals do, by at least
// `leastCosine`.
void ExpectSound(const Mesh& mesh, double leastCosine) {
  EXPECT_NO_THROW(dspace::CheckMesh(mesh, "test"));
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.tcoords.size() / 2, mesh.VertexCount());
  for (const float t : mesh.tcoords) {
    EXPECT_TRUE(t >= 0.0f && t <= 1.0f) << mesh.name << " " << t;
  }
  for (std::size_t i = 0; i < mesh.VertexCount(); ++i) {
    EXPECT_NEAR(At(mesh.normals, i).norm(), 1.0, 1e-6);
  }
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vector3d a = At(mesh.positions, mesh.indices[i]);
    const Vector3d b = At(mesh.positions, mesh.indices[i + 1]);
    const Vector3d c = At(mesh.positions, mesh.indices[i + 2]);
    const Vector3d face = (b - a).cross(c - a);
    ASSERT_GT(face.norm(), 0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_GE(face.normalized().dot(At(mesh.normals, mesh.indices[i + k])), leastCosine)
          << mesh.name << " triangle " << i / 3;
    }
  }
}

// Area of the regular polygon of n corners on a circle of radius 1.
double PolygonArea(int n) {
  return 0.5 * n * std::sin(2.0 * Pi / n);
}

// Volume between two such polygons of circles r and s, h apart.
double Frustum(int n, double r, double s, double h) {
  return PolygonArea(n) * h * (r * r + r * s + s * s) / 3.0;
}

void ExpectRejected(const std::string& word, const std::function<void()>& f) {
  try {
    f();
    ADD_FAILURE() << "accepted; expected an error with '" << word << "'";
  } catch (const Error& e) {
    EXPECT_EQ(e.GetKind(), Error::Kind::InvalidArgument);
    EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
  }
}

constexpr double Relative = 1e-6; // floats

} // namespace

TEST(Primitives, Box) {
  const Mesh mesh = dspace::MakeBox({1, 2, 3});
  ExpectClosed(mesh);
  ExpectSound(mesh, 1.0 - 1e-12);
  EXPECT_DOUBLE_EQ(Volume(mesh), 6.0);
  EXPECT_EQ(mesh.PrimitiveCount(), 12u);
  EXPECT_EQ(Bounds(mesh).min(), Vector3d(-0.5, -1, -1.5));
  EXPECT_EQ(Bounds(mesh).max(), Vector3d(0.5, 1, 1.5));
}

TEST(Primitives, Sphere) {
  for (const int n : {3, 7, 32, 100}) {
    const int bands = std::max(2, n / 2);
    const Mesh mesh = dspace::MakeSphere(2.0, n);
    ExpectClosed(mesh);
    ExpectSound(mesh, n < 8 ? 0.3 : std::cos(2.0 * Pi / n));
    EXPECT_EQ(mesh.PrimitiveCount(), std::size_t(2 * n * (bands - 1)));
    double volume = 0.0;
    for (int i = 0; i < bands; ++i) {
      const double a = Pi * i / bands;
      const double b = Pi * (i + 1) / bands;
      volume += Frustum(n, 2 * std::sin(a), 2 * std::sin(b), 2 * (std::cos(a) - std::cos(b)));
    }
    EXPECT_NEAR(Volume(mesh), volume, Relative * volume);
    for (std::size_t i = 0; i < mesh.VertexCount(); ++i) {
      const Vector3d p = At(mesh.positions, i);
      EXPECT_NEAR(p.norm(), 2.0, 1e-6);
      if (std::hypot(p.x(), p.y()) > 0.0) { // at the poles the normal is upright, as the place is
        EXPECT_LT((p / 2.0 - At(mesh.normals, i)).norm(), 1e-6);
      }
      // Texture: longitude from -180, latitude from -90. The seam's two sides are both right.
      const double u = mesh.tcoords[2 * i];
      const double v = mesh.tcoords[2 * i + 1];
      EXPECT_NEAR(std::asin(p.z() / p.norm()), Pi * (v - 0.5), 1e-3);
      if (std::hypot(p.x(), p.y()) > 1e-3) {
        EXPECT_NEAR(p.y(), std::sin(2.0 * Pi * (u - 0.5)) * std::hypot(p.x(), p.y()), 1e-5);
        EXPECT_NEAR(p.x(), std::cos(2.0 * Pi * (u - 0.5)) * std::hypot(p.x(), p.y()), 1e-5);
      }
    }
  }
  EXPECT_NEAR(Volume(dspace::MakeSphere(1.0, 512)), 4.0 / 3.0 * Pi, 1e-3);
}

TEST(Primitives, Cylinder) {
  const Mesh mesh = dspace::MakeCylinder(0.5, 3.0, 12);
  ExpectClosed(mesh);
  ExpectSound(mesh, std::cos(Pi / 12) - 1e-6); // a facet is half a sector from its edges' normals
  EXPECT_NEAR(Volume(mesh), PolygonArea(12) * 0.25 * 3.0, 1e-6);
  EXPECT_LT((Bounds(mesh).max() - Vector3d(0.5, 0.5, 1.5)).norm(), 1e-6);
  EXPECT_LT((Bounds(mesh).min() + Vector3d(0.5, 0.5, 1.5)).norm(), 1e-6);
  for (std::size_t i = 0; i < mesh.VertexCount(); ++i) {
    const Vector3d p = At(mesh.positions, i);
    const Vector3d n = At(mesh.normals, i);
    if (std::abs(n.z()) < 0.5) { // the side
      EXPECT_LT((n - Vector3d(p.x(), p.y(), 0) / 0.5).norm(), 1e-6);
    } else {
      EXPECT_LT((n - Vector3d(0, 0, p.z() > 0 ? 1 : -1)).norm(), 1e-12);
    }
  }
}

TEST(Primitives, Cone) {
  const Mesh mesh = dspace::MakeCone(3.0, 4.0, 20);
  ExpectClosed(mesh);
  ExpectSound(mesh, std::cos(Pi / 20) - 1e-6);
  EXPECT_NEAR(Volume(mesh), Frustum(20, 3.0, 0.0, 4.0), 1e-4);
  EXPECT_NEAR(Bounds(mesh).min().z(), -2.0, 1e-12);
  EXPECT_NEAR(Bounds(mesh).max().z(), 2.0, 1e-12);
  for (std::size_t i = 0; i < mesh.VertexCount(); ++i) {
    const Vector3d n = At(mesh.normals, i);
    if (n.z() > -0.5) { // slope 3:4, so normals rise by 3/5
      EXPECT_NEAR(n.z(), 0.6, 1e-6);
    }
  }
}

TEST(Primitives, PlaneAndDisc) {
  const Mesh plane = dspace::MakePlane(4, 2);
  ExpectSound(plane, 1.0 - 1e-12);
  EXPECT_EQ(plane.PrimitiveCount(), 2u);
  EXPECT_EQ(At(plane.normals, 0), Vector3d(Vector3d::UnitZ()));
  EXPECT_EQ(At(plane.positions, 0), Vector3d(-2, -1, 0));
  EXPECT_EQ(plane.tcoords[0], 0.0f);
  EXPECT_EQ(plane.tcoords[1], 0.0f);
  EXPECT_EQ(At(plane.positions, 2), Vector3d(2, 1, 0));
  EXPECT_EQ(plane.tcoords[4], 1.0f);
  EXPECT_EQ(plane.tcoords[5], 1.0f);

  const Mesh disc = dspace::MakeDisc(2, 16);
  ExpectSound(disc, 1.0 - 1e-6);
  double area = 0.0;
  for (std::size_t i = 0; i < disc.indices.size(); i += 3) {
    area += 0.5 * (At(disc.positions, disc.indices[i + 1]) - At(disc.positions, disc.indices[i]))
                      .cross(At(disc.positions, disc.indices[i + 2]) -
                             At(disc.positions, disc.indices[i]))
                      .z();
  }
  EXPECT_NEAR(area, 4.0 * PolygonArea(16), 1e-5);
}

TEST(Primitives, Torus) {
  const int n = 48;
  const int rows = 12;
  const Mesh mesh = dspace::MakeTorus(2.0, 0.5, n);
  ExpectClosed(mesh);
  ExpectSound(mesh, std::cos(0.3)); // half a row, 0.262 rad, and half a sector, 0.065 rad
  double volume = 0.0;              // the tube's polygon, row by row
  for (int k = 0; k < rows; ++k) {
    const double a = 2 * Pi * k / rows;
    const double b = 2 * Pi * (k + 1) / rows;
    volume +=
        Frustum(n, 2 + 0.5 * std::cos(a), 2 + 0.5 * std::cos(b), 0.5 * (std::sin(b) - std::sin(a)));
  }
  EXPECT_NEAR(Volume(mesh), volume, Relative * volume);
  EXPECT_NEAR(Bounds(mesh).max().x(), 2.5, 1e-6);
  EXPECT_NEAR(Bounds(mesh).max().z(), 0.5, 1e-6);
}

TEST(Primitives, Arrow) {
  const Mesh mesh = dspace::MakeArrow(10.0, 16);
  ExpectClosed(mesh);
  ExpectSound(mesh, std::cos(Pi / 16) - 1e-6);
  const double volume = Frustum(16, 0.2, 0.2, 8.0) + Frustum(16, 0.6, 0.0, 2.0);
  EXPECT_NEAR(Volume(mesh), volume, Relative * volume);
  EXPECT_EQ(Bounds(mesh).min().x(), 0.0);
  EXPECT_EQ(Bounds(mesh).max().x(), 10.0);
  EXPECT_NEAR(Bounds(mesh).max().y(), 0.6, 1e-6);
}

TEST(Primitives, LinesAndPoints) {
  const std::vector<Vector3d> points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const Mesh open = dspace::MakeLineSet(points);
  EXPECT_EQ(open.primitive, Mesh::Primitive::Lines);
  EXPECT_EQ(open.indices, (std::vector<std::uint32_t>{0, 1, 1, 2}));
  EXPECT_EQ(dspace::MakeLineSet(points, true).indices,
            (std::vector<std::uint32_t>{0, 1, 1, 2, 2, 0}));
  const Mesh cloud = dspace::MakePointSet(points);
  EXPECT_EQ(cloud.primitive, Mesh::Primitive::Points);
  EXPECT_EQ(cloud.indices, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(At(cloud.positions, 2), points[2]);
}

TEST(Primitives, Rejections) {
  for (const double bad :
       {0.0, -1.0, NotANumber, std::numeric_limits<double>::infinity(), 1e16, 1e-10}) {
    ExpectRejected("box", [&] { dspace::MakeBox({1, bad, 1}); });
    ExpectRejected("sphere", [&] { dspace::MakeSphere(bad); });
    ExpectRejected("cylinder", [&] { dspace::MakeCylinder(bad, 1); });
    ExpectRejected("cylinder", [&] { dspace::MakeCylinder(1, bad); });
    ExpectRejected("cone", [&] { dspace::MakeCone(bad, 1); });
    ExpectRejected("cone", [&] { dspace::MakeCone(1, bad); });
    ExpectRejected("plane", [&] { dspace::MakePlane(bad, 1); });
    ExpectRejected("plane", [&] { dspace::MakePlane(1, bad); });
    ExpectRejected("disc", [&] { dspace::MakeDisc(bad); });
    ExpectRejected("torus", [&] { dspace::MakeTorus(bad, 1e-9); });
    ExpectRejected("torus", [&] { dspace::MakeTorus(1, bad); });
    ExpectRejected("arrow", [&] { dspace::MakeArrow(bad); });
    ExpectRejected("axes", [&] { dspace::MakeAxes(bad); });
    ExpectRejected("goal marker", [&] { dspace::MakeGoalMarker(bad); });
    ExpectRejected("tilt marker", [&] { dspace::MakeTiltMarker(bad); });
    ExpectRejected("frustum pyramid",
                   [&] { dspace::MakeFrustumPyramid(Projection(), bad, 10, 10); });
  }
  for (const int bad : {2, 0, -5, 1025}) {
    ExpectRejected("resolution", [&] { dspace::MakeSphere(1, bad); });
    ExpectRejected("resolution", [&] { dspace::MakeCylinder(1, 1, bad); });
    ExpectRejected("resolution", [&] { dspace::MakeCone(1, 1, bad); });
    ExpectRejected("resolution", [&] { dspace::MakeDisc(1, bad); });
    ExpectRejected("resolution", [&] { dspace::MakeTorus(1, 0.1, bad); });
    ExpectRejected("resolution", [&] { dspace::MakeArrow(1, bad); });
  }
  ExpectRejected("less than radius", [] { dspace::MakeTorus(1, 1); });
  ExpectRejected("1 points", [] { dspace::MakeLineSet({{0, 0, 0}}); });
  ExpectRejected("2 points", [] { dspace::MakeLineSet({{0, 0, 0}, {1, 0, 0}}, true); });
  ExpectRejected("0 points", [] { dspace::MakePointSet({}); });
  ExpectRejected("nan", [] { dspace::MakePointSet({{0, NotANumber, 0}}); });
  ExpectRejected("0 x 5", [] { dspace::MakeFrustumPyramid(Projection(), 1, 0, 5); });
  Projection bad;
  bad.nearDistance = -1;
  ExpectRejected("near", [&] { dspace::MakeFrustumPyramid(bad, 1, 5, 5); });
}

TEST(Markers, AxesPointAlongTheirAxes) {
  const std::vector<Part> parts = dspace::MakeAxes(2.0);
  ASSERT_EQ(parts.size(), 3u);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(parts[axis].mesh, parts[0].mesh);
    EXPECT_EQ(parts[axis].X_OP * Vector3d(2, 0, 0), Vector3d(2.0 * Vector3d::Unit(axis)));
    EXPECT_EQ(parts[axis].X_OP.linear().determinant(), 1.0);
    const auto& color = parts[axis].material->color;
    EXPECT_EQ(std::max_element(color.begin(), color.end()) - color.begin(), std::ptrdiff_t(axis));
    EXPECT_FALSE(parts[axis].material->lit);
  }
}

TEST(Markers, FrustumPyramidBordersThePicture) {
  Projection perspective;
  Projection flat;
  flat.kind = Projection::Kind::Orthographic;
  flat.farDistance = 100;
  Projection offAxis;
  offAxis.kind = Projection::Kind::Frustum;
  offAxis.left = 0.1;
  for (const Projection& p : {perspective, flat, offAxis}) {
    const std::vector<Part> parts = dspace::MakeFrustumPyramid(p, 3.0, 320, 200);
    ASSERT_EQ(parts.size(), 2u);
    const Mesh& lines = *parts[0].mesh;
    const Mesh& faces = *parts[1].mesh;
    EXPECT_EQ(lines.primitive, Mesh::Primitive::Lines);
    const bool pointed = p.kind != Projection::Kind::Orthographic;
    EXPECT_EQ(lines.PrimitiveCount(), pointed ? 8u : 12u);
    EXPECT_NO_THROW(dspace::CheckMesh(lines, "test"));
    ExpectClosed(faces);
    ExpectSound(faces, 1.0 - 1e-6);
    EXPECT_LT(parts[1].material->opacity, 1.0);
    EXPECT_EQ(parts[0].material->opacity, 1.0);
    const double corners[4][2] = {{-0.5, -0.5}, {319.5, -0.5}, {319.5, 199.5}, {-0.5, 199.5}};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto q = p.Project(At(lines.positions, k), 320, 200);
      EXPECT_NEAR(q.x, corners[k][0], 1e-3);
      EXPECT_NEAR(q.y, corners[k][1], 1e-3);
      EXPECT_NEAR(q.depth, 3.0, 1e-6);
    }
    const Vector3d size = Bounds(faces).sizes();
    const double area = (At(lines.positions, 1) - At(lines.positions, 0)).norm() *
                        (At(lines.positions, 3) - At(lines.positions, 0)).norm();
    EXPECT_NEAR(Volume(faces), area * 3.0 / (pointed ? 3.0 : 1.0), 1e-5 * area);
    EXPECT_NEAR(size.z(), 3.0, 1e-6);
  }
}

TEST(Markers, GoalAndTiltStandUpright) {
  const auto bounds = [](const std::vector<Part>& parts) {
    Eigen::AlignedBox3d box;
    for (const Part& part : parts) {
      EXPECT_NO_THROW(dspace::CheckMesh(*part.mesh, "test"));
      EXPECT_NO_THROW(dspace::CheckMaterial(*part.material, "test"));
      for (std::size_t i = 0; i < part.mesh->VertexCount(); ++i) {
        box.extend(part.X_OP * At(part.mesh->positions, i));
      }
    }
    return box;
  };
  const Eigen::AlignedBox3d goal = bounds(dspace::MakeGoalMarker(2.0));
  EXPECT_NEAR(goal.max().z(), 2.0, 1e-6);
  EXPECT_NEAR(goal.min().z(), -0.04, 1e-6); // half the ring's tube
  EXPECT_NEAR(goal.max().x(), 0.9, 1e-6);   // the flag
  const Eigen::AlignedBox3d tilt = bounds(dspace::MakeTiltMarker(2.0));
  EXPECT_NEAR(tilt.max().z(), 2.0, 1e-6);
  EXPECT_NEAR(tilt.max().x(), 2.1, 1e-6);
  EXPECT_NEAR(tilt.min().y(), -2.1, 1e-6);
  for (const Part& part : dspace::MakeTiltMarker(1.0)) {
    EXPECT_EQ(part.material->color, (std::array<double, 3>{1, 1, 1}));
  }
}

TEST(Markers, TiltReddens) {
  using Color = std::array<double, 3>;
  const Color green = dspace::TiltColor(0, 15, 30);
  const Color yellow = dspace::TiltColor(15, 15, 30);
  const Color red = dspace::TiltColor(30, 15, 30);
  EXPECT_GT(green[1], 0.7);
  EXPECT_LT(green[0], 0.2);
  EXPECT_GT(std::min(yellow[0], yellow[1]), 0.8);
  EXPECT_GT(red[0], 0.8);
  EXPECT_LT(red[1], 0.2);
  EXPECT_EQ(dspace::TiltColor(180, 15, 30), red);
  const Color between = dspace::TiltColor(20, 15, 30); // a third of the way
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(between[i], (2 * yellow[i] + red[i]) / 3, 1e-12);
  }
  // Never greener as it tilts.
  for (double tilt = 0; tilt < 40; tilt += 0.5) {
    const Color a = dspace::TiltColor(tilt, 15, 30);
    const Color b = dspace::TiltColor(tilt + 0.5, 15, 30);
    EXPECT_LE(b[1] - b[0], a[1] - a[0] + 1e-12);
  }
  ExpectRejected("tilt", [] { dspace::TiltColor(-1, 15, 30); });
  ExpectRejected("tilt", [] { dspace::TiltColor(NotANumber, 15, 30); });
  ExpectRejected("limit", [] { dspace::TiltColor(1, 15, 181); });
  ExpectRejected("warning", [] { dspace::TiltColor(1, 30, 30); });
  ExpectRejected("warning", [] { dspace::TiltColor(1, 0, 30); });
}
