#include <dspace/scene/Primitives.h>

#include <cmath>

#include <dspace/scene/MeshBuilder.h>

namespace dspace {

namespace {

constexpr double Pi = 3.14159265358979323846;

// A surface of revolution about Z, row by row from a profile that runs upwards on the outside:
// its outward side is to the right of the way it runs.
class Revolution {
public:
  Revolution(const std::string& name, int sectors) : Builder_(name), Sectors_(sectors) {}

  // Texture of a row: round the side at height v, or a disc cut out of the image.
  enum class Texture { Side, CapUp, CapDown };
  struct Ring {
    double r, z;             // r = 0: a point on the axis
    double normalR, normalZ; // unit
    double v;                // Side: height in the image; caps: r over the cap's radius
    Texture texture;
  };

  // Rows of a straight piece of the profile, with its own normal.
  void Straight(double r0, double z0, double r1, double z1, Texture texture) {
    const double length = std::hypot(r1 - r0, z1 - z0);
    const double nr = (z1 - z0) / length;
    const double nz = -(r1 - r0) / length;
    const double outer = std::max(r0, r1);
    const bool side = texture == Texture::Side;
    this->Begin({r0, z0, nr, nz, side ? 0.0 : r0 / outer, texture});
    this->Continue({r1, z1, nr, nz, side ? 1.0 : r1 / outer, texture});
  }

  void Begin(const Ring& ring) {
    this->Row_ = this->AddRow(ring);
    this->Pole_ = ring.r == 0.0;
  }

  // Joins a row to the one before.
  void Continue(const Ring& ring) {
    const std::vector<std::uint32_t> row = this->AddRow(ring);
    const bool pole = ring.r == 0.0;
    for (std::size_t j = 0; j < std::size_t(this->Sectors_); ++j) {
      if (!this->Pole_) {
        this->Builder_.Triangle(this->Row_[j], this->Row_[j + 1], row[pole ? j : j + 1]);
      }
      if (!pole) {
        this->Builder_.Triangle(this->Row_[j], row[j + 1], row[j]);
      }
    }
    this->Row_ = row;
    this->Pole_ = pole;
  }

  Mesh Take() { return this->Builder_.Take(); }

private:
  // One vertex more than sectors, the last on the first; on the axis one a sector, in its middle.
  std::vector<std::uint32_t> AddRow(const Ring& ring) {
    const bool pole = ring.r == 0.0;
    std::vector<std::uint32_t> row;
    for (int j = 0; j < this->Sectors_ + (pole ? 0 : 1); ++j) {
      const double turn = (pole ? j + 0.5 : j % this->Sectors_) / this->Sectors_;
      const double c = std::cos(2.0 * Pi * turn);
      const double s = std::sin(2.0 * Pi * turn);
      double u = (pole ? j + 0.5 : j) / this->Sectors_;
      double v = ring.v;
      if (ring.texture != Texture::Side) {
        u = 0.5 + 0.5 * ring.v * c;
        v = 0.5 + 0.5 * ring.v * (ring.texture == Texture::CapUp ? s : -s);
      }
      row.push_back(this->Builder_.Vertex({ring.r * c, ring.r * s, ring.z},
                                          {ring.normalR * c, ring.normalR * s, ring.normalZ}, u,
                                          v));
    }
    return row;
  }

  MeshBuilder Builder_;
  int Sectors_;
  std::vector<std::uint32_t> Row_;
  bool Pole_ = false;
};

using Texture = Revolution::Texture;

// Turns Z to X, X to Y, Y to Z.
void CycleAxes(std::vector<float>& xyz) {
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3) {
    const float z = xyz[i + 2];
    xyz[i + 2] = xyz[i + 1];
    xyz[i + 1] = xyz[i];
    xyz[i] = z;
  }
}

Mesh FromPoints(const std::string& name, Mesh::Primitive primitive,
                const std::vector<Eigen::Vector3d>& points, std::size_t least) {
  if (points.size() < least) {
    Reject(name, "it has " + std::to_string(points.size()) + " points; accepted: at least " +
                     std::to_string(least));
  }
  Mesh mesh;
  mesh.name = name;
  mesh.primitive = primitive;
  for (const Eigen::Vector3d& p : points) {
    if (!(p.array().abs() <= 1e15).all()) { // false for NaN too
      Reject(name, "a point is " + VectorText(p) + "; accepted: within 1e15 metres");
    }
    for (int i = 0; i < 3; ++i) {
      mesh.positions.push_back(static_cast<float>(p[i]));
    }
  }
  return mesh;
}

} // namespace

Mesh MakeBox(const Eigen::Vector3d& size) {
  for (int i = 0; i < 3; ++i) {
    RequireLength("box", "size", size[i]);
  }
  MeshBuilder builder("box");
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      // a, b and the outward normal are right-handed.
      Eigen::Vector3d a = Eigen::Vector3d::Zero();
      Eigen::Vector3d b = Eigen::Vector3d::Zero();
      Eigen::Vector3d out = Eigen::Vector3d::Zero();
      a[(axis + 1) % 3] = 0.5 * sign * size[(axis + 1) % 3];
      b[(axis + 2) % 3] = 0.5 * size[(axis + 2) % 3];
      out[axis] = 0.5 * sign * size[axis];
      builder.Face({out - a - b, out + a - b, out + a + b, out - a + b});
    }
  }
  return builder.Take();
}

Mesh MakeSphere(double radius, int resolution) {
  RequireLength("sphere", "radius", radius);
  RequireResolution("sphere", resolution);
  const int bands = std::max(2, resolution / 2);
  Revolution surface("sphere", resolution);
  for (int i = 0; i <= bands; ++i) {
    const bool pole = i == 0 || i == bands;
    const double latitude = Pi * (double(i) / bands - 0.5);
    const double c = pole ? 0.0 : std::cos(latitude);
    const double s = pole ? (i == 0 ? -1.0 : 1.0) : std::sin(latitude);
    const Revolution::Ring ring = {radius * c, radius * s, c, s, double(i) / bands, Texture::Side};
    if (i == 0) {
      surface.Begin(ring);
    } else {
      surface.Continue(ring);
    }
  }
  Mesh mesh = surface.Take();
  // Rows begin at +X, maps at -X: half a turn, so that the seam is at longitude 180.
  for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
    for (std::size_t k = 0; k < 2; ++k) {
      mesh.positions[i + k] = -mesh.positions[i + k];
      mesh.normals[i + k] = -mesh.normals[i + k];
    }
  }
  return mesh;
}

Mesh MakeCylinder(double radius, double height, int resolution) {
  RequireLength("cylinder", "radius", radius);
  RequireLength("cylinder", "height", height);
  RequireResolution("cylinder", resolution);
  const double h = 0.5 * height;
  Revolution surface("cylinder", resolution);
  surface.Straight(0, -h, radius, -h, Texture::CapDown);
  surface.Straight(radius, -h, radius, h, Texture::Side);
  surface.Straight(radius, h, 0, h, Texture::CapUp);
  return surface.Take();
}

Mesh MakeCone(double radius, double height, int resolution) {
  RequireLength("cone", "radius", radius);
  RequireLength("cone", "height", height);
  RequireResolution("cone", resolution);
  const double h = 0.5 * height;
  Revolution surface("cone", resolution);
  surface.Straight(0, -h, radius, -h, Texture::CapDown);
  surface.Straight(radius, -h, 0, h, Texture::Side);
  return surface.Take();
}

Mesh MakePlane(double width, double height) {
  RequireLength("plane", "width", width);
  RequireLength("plane", "height", height);
  const double x = 0.5 * width;
  const double y = 0.5 * height;
  MeshBuilder builder("plane");
  builder.Face({{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}});
  return builder.Take();
}

Mesh MakeDisc(double radius, int resolution) {
  RequireLength("disc", "radius", radius);
  RequireResolution("disc", resolution);
  Revolution surface("disc", resolution);
  surface.Straight(radius, 0, 0, 0, Texture::CapUp);
  return surface.Take();
}

Mesh MakeTorus(double radius, double tube, int resolution) {
  RequireLength("torus", "radius", radius);
  RequireLength("torus", "tube", tube);
  RequireResolution("torus", resolution);
  Require(tube < radius, "torus", "tube", tube, ("less than radius " + NumberText(radius)).c_str());
  const int rows = std::max(6, resolution / 4);
  Revolution surface("torus", resolution);
  for (int k = 0; k <= rows; ++k) {
    const double angle = 2.0 * Pi * (k % rows) / rows; // the last row is the first to the bit
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const Revolution::Ring ring = {radius + tube * c, tube * s,     c, s,
                                   double(k) / rows,  Texture::Side};
    if (k == 0) {
      surface.Begin(ring);
    } else {
      surface.Continue(ring);
    }
  }
  return surface.Take();
}

Mesh MakeArrow(double length, int resolution) {
  RequireLength("arrow", "length", length);
  RequireResolution("arrow", resolution);
  const double shaft = 0.02 * length;
  const double head = 0.06 * length;
  const double neck = 0.8 * length;
  Revolution surface("arrow", resolution);
  surface.Straight(0, 0, shaft, 0, Texture::CapDown);
  surface.Straight(shaft, 0, shaft, neck, Texture::Side);
  surface.Straight(shaft, neck, head, neck, Texture::CapDown);
  surface.Straight(head, neck, 0, length, Texture::Side);
  Mesh mesh = surface.Take();
  CycleAxes(mesh.positions);
  CycleAxes(mesh.normals);
  return mesh;
}

Mesh MakeLineSet(const std::vector<Eigen::Vector3d>& points, bool closed) {
  Mesh mesh = FromPoints("line set", Mesh::Primitive::Lines, points, closed ? 3 : 2);
  const auto n = static_cast<std::uint32_t>(points.size());
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    mesh.indices.insert(mesh.indices.end(), {i, i + 1});
  }
  if (closed) {
    mesh.indices.insert(mesh.indices.end(), {n - 1, 0});
  }
  return mesh;
}

Mesh MakePointSet(const std::vector<Eigen::Vector3d>& points) {
  Mesh mesh = FromPoints("point set", Mesh::Primitive::Points, points, 1);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    mesh.indices.push_back(i);
  }
  return mesh;
}

} // namespace dspace
