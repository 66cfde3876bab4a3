#include <dspace/import/vrml/VrmlFaces.h>

#include <dspace/import/model/Polygon.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace dspace {

namespace {

// Beyond this many faces around one point, creases are not searched for: the search is quadratic.
constexpr std::size_t MaximumFacesAroundPoint = 512;

struct Face {
  std::size_t first = 0; // position of its first corner in coordIndex
  std::size_t count = 0;
  std::size_t serial = 0;      // which face of the file
  std::size_t firstCorner = 0; // corners of the file's faces before it
};

std::string Times(std::size_t n, const char* what) {
  return std::to_string(n) + " " + what;
}

// The faces of a list whose corners are all usable.
std::vector<Face> SplitFaces(const VrmlFaces& in, std::size_t minimum, const char* noun,
                             VrmlComplaints& complaints) {
  std::vector<bool> usable(in.points.size());
  for (std::size_t i = 0; i < usable.size(); ++i) {
    usable[i] = in.points[i].allFinite();
  }
  std::vector<Face> faces;
  Face face;
  bool good = true;
  std::size_t bad = 0;
  std::size_t small = 0;
  std::size_t corners = 0;
  const std::size_t n = in.coordIndex.size();
  for (std::size_t i = 0; i <= n; ++i) {
    const int index = i < n ? in.coordIndex[i] : -1;
    if (index != -1) {
      good = good && index >= 0 && static_cast<std::size_t>(index) < usable.size() &&
             usable[static_cast<std::size_t>(index)];
      ++face.count;
      continue;
    }
    if (face.count > 0) {
      bad += !good;
      small += good && face.count < minimum;
      if (good && face.count >= minimum) {
        faces.push_back(face);
      }
      corners += face.count;
      face.serial += 1;
    }
    face.first = i + 1;
    face.count = 0;
    face.firstCorner = corners;
    good = true;
  }
  if (bad > 0) {
    complaints.push_back(Times(bad, noun) + " with an index out of range of " +
                         Times(in.points.size(), "points are left out"));
  }
  if (small > 0) {
    complaints.push_back(Times(small, noun) + " with fewer than " + Times(minimum, "corners are") +
                         " left out");
  }
  return faces;
}

// Index into an attribute's values for corner `k` of a face; it may be out of their range.
template<typename Value>
long long ValueIndex(const VrmlAttribute<Value>& attribute, const VrmlFaces& in, const Face& face,
                     std::size_t k) {
  const auto indexed = [&attribute](std::size_t i) {
    return i < attribute.indices.size() ? attribute.indices[i] : -1;
  };
  switch (attribute.binding) {
  case VrmlBinding::Overall:
    return 0;
  case VrmlBinding::PerFace:
    return static_cast<long long>(face.serial);
  case VrmlBinding::PerFaceIndexed:
    return indexed(face.serial);
  case VrmlBinding::PerCorner:
    return static_cast<long long>(face.firstCorner) + static_cast<long long>(k);
  case VrmlBinding::PerCornerIndexed:
    return attribute.indices.empty() ? in.coordIndex[face.first + k] : indexed(face.first + k);
  default:
    return -1;
  }
}

// Value indices of all corners, face by face; -1 where there is none.
template<typename Value>
std::vector<int> ValueIndices(const VrmlAttribute<Value>& attribute, const VrmlFaces& in,
                              const std::vector<Face>& faces, std::size_t& missing) {
  std::vector<int> result;
  const auto count = static_cast<long long>(attribute.values.size());
  for (const Face& face : faces) {
    for (std::size_t k = 0; k < face.count; ++k) {
      const long long i = ValueIndex(attribute, in, face, k);
      const bool valid = i >= 0 && i < count;
      missing += !valid;
      result.push_back(valid ? static_cast<int>(i) : -1);
    }
  }
  return result;
}

std::vector<int> ColorIndices(const VrmlFaces& in, const std::vector<Face>& faces,
                              VrmlComplaints& complaints) {
  std::size_t missing = 0;
  if (in.colors.values.empty() || in.colors.binding == VrmlBinding::None) {
    return {};
  }
  std::vector<int> result = ValueIndices(in.colors, in, faces, missing);
  if (missing > 0) {
    complaints.push_back(Times(missing, "corners have no colour among ") +
                         Times(in.colors.values.size(), "colours and take the last"));
    std::replace(result.begin(), result.end(), -1, static_cast<int>(in.colors.values.size()) - 1);
  }
  return result;
}

// Index of a normal in the pool; `made` are those that the same point has already.
int Pooled(std::vector<Eigen::Vector3f>& pool, std::vector<int>& made,
           const Eigen::Vector3f& normal) {
  for (const int i : made) {
    if (pool[static_cast<std::size_t>(i)] == normal) {
      return i;
    }
  }
  made.push_back(static_cast<int>(pool.size()));
  pool.push_back(normal);
  return made.back();
}

// Corner normals of the faces themselves, smooth below the crease angle; appended to `pool`.
std::vector<int> GeneratedNormals(const VrmlFaces& in, const std::vector<Face>& faces,
                                  const std::vector<Eigen::Vector3d>& areas,
                                  std::vector<Eigen::Vector3f>& pool) {
  std::vector<int> result;
  std::vector<Eigen::Vector3d> units;
  const int firstFlat = static_cast<int>(pool.size());
  for (const Eigen::Vector3d& area : areas) {
    units.push_back(area.norm() > 0.0 ? Eigen::Vector3d(area.normalized())
                                      : Eigen::Vector3d(Eigen::Vector3d::UnitZ()));
    pool.push_back(units.back().cast<float>());
  }
  std::unordered_map<int, std::vector<int>> around; // point -> faces
  if (in.creaseAngle > 0.0) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (std::size_t k = 0; k < faces[f].count; ++k) {
        std::vector<int>& list = around[in.coordIndex[faces[f].first + k]];
        if (list.empty() || list.back() != static_cast<int>(f)) {
          list.push_back(static_cast<int>(f));
        }
      }
    }
  }
  std::unordered_map<int, std::vector<int>> made; // point -> normals in the pool
  // Slightly below, so that an angle of exactly the crease angle is smooth in spite of rounding.
  const double limit = std::cos(std::min(in.creaseAngle, M_PI)) - 1e-6;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < faces[f].count; ++k) {
      int normal = firstFlat + static_cast<int>(f);
      const auto found = around.find(in.coordIndex[faces[f].first + k]);
      if (found != around.end() && found->second.size() > 1 &&
          found->second.size() <= MaximumFacesAroundPoint) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (const int other : found->second) {
          if (units[static_cast<std::size_t>(other)].dot(units[f]) >= limit) {
            sum += areas[static_cast<std::size_t>(other)];
          }
        }
        if (sum.norm() > 0.0) {
          normal =
              Pooled(pool, made[in.coordIndex[faces[f].first + k]], sum.normalized().cast<float>());
        }
      }
      result.push_back(normal);
    }
  }
  return result;
}

// Texture coordinates of VRML97 6.23: S along the longest side of the bounds, T along the second.
std::vector<Eigen::Vector2f> BoundsTcoords(const std::vector<Eigen::Vector3f>& points) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : points) {
    if (p.allFinite()) {
      box.extend(p);
    }
  }
  const Eigen::Vector3f size = box.isEmpty() ? Eigen::Vector3f::Zero().eval() : box.sizes();
  std::array<int, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&size](int a, int b) { return size[a] > size[b]; });
  const float scale = size[order[0]] > 0.0f ? 1.0f / size[order[0]] : 0.0f;
  std::vector<Eigen::Vector2f> result;
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3f q = p.allFinite() ? Eigen::Vector3f((p - box.min()) * scale)
                                            : Eigen::Vector3f(Eigen::Vector3f::Zero());
    result.emplace_back(q[order[0]], q[order[1]]);
  }
  return result;
}

// Vertices of a mesh, each combination of attributes once.
class VertexPool {
public:
  VertexPool(const VrmlFaces& in, const std::vector<Eigen::Vector3f>& normals,
             const std::vector<Eigen::Vector2f>& tcoords, Mesh& mesh)
      : In_(in), Normals_(normals), Tcoords_(tcoords), Mesh_(mesh) {}

  std::uint32_t Add(int point, int color, int normal, int tcoord) {
    const Key key = {point, color, normal, tcoord};
    const auto [found, fresh] =
        this->Vertices_.emplace(key, static_cast<std::uint32_t>(this->Vertices_.size()));
    if (fresh) {
      Append(this->Mesh_.positions, this->In_.points[static_cast<std::size_t>(point)]);
      if (color >= 0) {
        const auto& c = this->In_.colors.values[static_cast<std::size_t>(color)];
        this->Mesh_.colors.insert(this->Mesh_.colors.end(), c.begin(), c.end());
      }
      if (normal >= 0) {
        Append(this->Mesh_.normals, this->Normals_[static_cast<std::size_t>(normal)]);
      }
      if (tcoord >= 0) {
        Append(this->Mesh_.tcoords, this->Tcoords_[static_cast<std::size_t>(tcoord)]);
      }
    }
    return found->second;
  }

private:
  using Key = std::array<int, 4>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::uint64_t h = 1469598103934665603ULL;
      for (const int k : key) {
        h = (h ^ static_cast<std::uint32_t>(k)) * 1099511628211ULL;
        h ^= h >> 29;
      }
      return static_cast<std::size_t>(h);
    }
  };

  template<typename Vector> static void Append(std::vector<float>& out, const Vector& v) {
    out.insert(out.end(), v.data(), v.data() + v.size());
  }

  const VrmlFaces& In_;
  const std::vector<Eigen::Vector3f>& Normals_;
  const std::vector<Eigen::Vector2f>& Tcoords_;
  Mesh& Mesh_;
  std::unordered_map<Key, std::uint32_t, Hash> Vertices_;
};

int At(const std::vector<int>& values, std::size_t i) {
  return values.empty() ? -1 : values[i];
}

} // namespace

Mesh MakeVrmlFaces(const VrmlFaces& in, VrmlComplaints& complaints) {
  const std::vector<Face> faces = SplitFaces(in, 3, "faces", complaints);
  const std::vector<int> colors = ColorIndices(in, faces, complaints);

  std::vector<std::vector<Eigen::Vector3d>> corners(faces.size());
  std::vector<Eigen::Vector3d> areas;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < faces[f].count; ++k) {
      const auto i = static_cast<std::size_t>(in.coordIndex[faces[f].first + k]);
      corners[f].push_back(in.points[i].cast<double>());
    }
    areas.push_back(PolygonNormal(corners[f]) * (in.ccw ? 1.0 : -1.0));
  }

  std::vector<Eigen::Vector3f> normals;
  std::vector<int> normalIndices;
  if (in.normals.binding != VrmlBinding::None) {
    bool usable = true;
    for (const Eigen::Vector3f& n : in.normals.values) {
      const double length = n.cast<double>().norm();
      usable = usable && length > 1e-30;
      normals.emplace_back((n.cast<double>() / (length > 1e-30 ? length : 1.0)).cast<float>());
    }
    std::size_t missing = 0;
    normalIndices = ValueIndices(in.normals, in, faces, missing);
    if (missing > 0 || !usable) {
      complaints.push_back(missing > 0
                               ? Times(missing, "corners have no normal among ") +
                                     Times(normals.size(), "normals: all are made from the faces")
                               : "a normal is null: all are made from the faces");
      normals.clear();
    }
  }
  if (normals.empty()) {
    normalIndices = GeneratedNormals(in, faces, areas, normals);
  }

  std::vector<Eigen::Vector2f> tcoords;
  std::vector<int> tcoordIndices;
  if (in.tcoords.binding != VrmlBinding::None && !in.tcoords.values.empty()) {
    std::size_t missing = 0;
    tcoordIndices = ValueIndices(in.tcoords, in, faces, missing);
    tcoords = in.tcoords.values;
    if (missing > 0) {
      complaints.push_back(Times(missing, "corners have no texture coordinate among ") +
                           Times(tcoords.size(), "and take the first"));
      std::replace(tcoordIndices.begin(), tcoordIndices.end(), -1, 0);
    }
  } else if (in.defaultTcoords) {
    VrmlAttribute<Eigen::Vector2f> byPoint;
    byPoint.binding = VrmlBinding::PerCornerIndexed;
    byPoint.values = BoundsTcoords(in.points);
    std::size_t missing = 0;
    tcoordIndices = ValueIndices(byPoint, in, faces, missing);
    tcoords = byPoint.values;
  }

  Mesh mesh;
  VertexPool pool(in, normals, tcoords, mesh);
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::uint32_t> vertices;
  std::size_t corner = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    vertices.clear();
    for (std::size_t k = 0; k < faces[f].count; ++k, ++corner) {
      vertices.push_back(pool.Add(in.coordIndex[faces[f].first + k], At(colors, corner),
                                  normalIndices[corner], At(tcoordIndices, corner)));
    }
    triangles.clear();
    TriangulatePolygon(corners[f], in.convex, triangles);
    for (const std::array<int, 3>& t : triangles) {
      for (const int i : {t[0], in.ccw ? t[1] : t[2], in.ccw ? t[2] : t[1]}) {
        mesh.indices.push_back(vertices[static_cast<std::size_t>(i)]);
      }
    }
  }
  return mesh;
}

Mesh MakeVrmlLines(const VrmlFaces& in, VrmlComplaints& complaints) {
  const std::vector<Face> lines = SplitFaces(in, 2, "polylines", complaints);
  const std::vector<int> colors = ColorIndices(in, lines, complaints);
  Mesh mesh;
  mesh.primitive = Mesh::Primitive::Lines;
  const std::vector<Eigen::Vector3f> noNormals;
  const std::vector<Eigen::Vector2f> noTcoords;
  VertexPool pool(in, noNormals, noTcoords, mesh);
  std::size_t corner = 0;
  for (const Face& line : lines) {
    std::uint32_t previous = 0;
    for (std::size_t k = 0; k < line.count; ++k, ++corner) {
      const std::uint32_t vertex =
          pool.Add(in.coordIndex[line.first + k], At(colors, corner), -1, -1);
      if (k > 0) {
        mesh.indices.insert(mesh.indices.end(), {previous, vertex});
      }
      previous = vertex;
    }
  }
  return mesh;
}

Mesh MakeVrmlPoints(const VrmlFaces& in, VrmlComplaints& complaints) {
  VrmlFaces single = in;
  single.coordIndex.clear();
  for (std::size_t i = 0; i < in.points.size(); ++i) {
    single.coordIndex.insert(single.coordIndex.end(), {static_cast<int>(i), -1});
  }
  const std::vector<Face> points = SplitFaces(single, 1, "points", complaints);
  const std::vector<int> colors = ColorIndices(single, points, complaints);
  Mesh mesh;
  mesh.primitive = Mesh::Primitive::Points;
  const std::vector<Eigen::Vector3f> noNormals;
  const std::vector<Eigen::Vector2f> noTcoords;
  VertexPool pool(single, noNormals, noTcoords, mesh);
  for (std::size_t i = 0; i < points.size(); ++i) {
    mesh.indices.push_back(pool.Add(single.coordIndex[points[i].first], At(colors, i), -1, -1));
  }
  return mesh;
}

} // namespace dspace
