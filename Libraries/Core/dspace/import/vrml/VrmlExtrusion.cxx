#include <dspace/import/vrml/VrmlExtrusion.h>

#include <algorithm>
#include <cmath>

namespace dspace {

namespace {

constexpr std::size_t MaximumPoints = 10000000;

using Vectors = std::vector<Eigen::Vector3d>;

bool IsNull(const Eigen::Vector3d& v) {
  return v.norm() < 1e-12;
}

// Spine-aligned axes of the cross-section's planes: their columns are X, Y and Z.
class SpineFrames {
public:
  SpineFrames(const Vectors& spine, bool closed) : Spine_(spine), Closed_(closed) {
    this->MakeY();
    this->MakeZ();
  }

  Eigen::Matrix3d Get(std::size_t i) const {
    Eigen::Matrix3d m;
    m.col(1) = this->Y_[i];
    m.col(2) = this->Z_[i];
    m.col(0) = this->Y_[i].cross(this->Z_[i]);
    return m;
  }

private:
  // The neighbours of point i, around the end of a closed spine.
  const Eigen::Vector3d& Before(std::size_t i) const {
    return this->Spine_[i > 0 ? i - 1 : this->Spine_.size() - 2];
  }
  const Eigen::Vector3d& After(std::size_t i) const {
    return this->Spine_[i + 1 < this->Spine_.size() ? i + 1 : 1];
  }
  bool AtEnd(std::size_t i) const {
    return !this->Closed_ && (i == 0 || i + 1 == this->Spine_.size());
  }

  void MakeY() {
    const std::size_t n = this->Spine_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector3d& a = this->AtEnd(i) && i == 0 ? this->Spine_[0] : this->Before(i);
      const Eigen::Vector3d& b = this->AtEnd(i) && i > 0 ? this->Spine_[i] : this->After(i);
      this->Y_.push_back(b - a);
    }
    Fill(this->Y_, Eigen::Vector3d::UnitY());
  }

  void MakeZ() {
    const std::size_t n = this->Spine_.size();
    for (std::size_t i = 0; i < n; ++i) {
      Eigen::Vector3d z = Eigen::Vector3d::Zero();
      if (!this->AtEnd(i)) {
        z = (this->After(i) - this->Spine_[i]).cross(this->Before(i) - this->Spine_[i]);
        const double lengths =
            (this->After(i) - this->Spine_[i]).norm() * (this->Before(i) - this->Spine_[i]).norm();
        // Straight within rounding counts as straight: there the previous axis is kept.
        if (z.norm() < 1e-9 * lengths) {
          z.setZero();
        }
      }
      this->Z_.push_back(z);
    }
    // A wholly straight spine: the axes that turn +Y onto it.
    const Eigen::Vector3d straight =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitY(), this->Y_[0]) *
        Eigen::Vector3d::UnitZ();
    Fill(this->Z_, straight);
    for (std::size_t i = 0; i < n; ++i) {
      if (i > 0 && this->Z_[i].dot(this->Z_[i - 1]) < 0.0) {
        this->Z_[i] = -this->Z_[i];
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      Eigen::Vector3d z = this->Z_[i] - this->Z_[i].dot(this->Y_[i]) * this->Y_[i];
      this->Z_[i] = IsNull(z) ? Eigen::Vector3d(this->Y_[i].unitOrthogonal())
                              : Eigen::Vector3d(z.normalized());
    }
  }

  // Normalises; a null vector takes the previous one, those before the first the first.
  static void Fill(Vectors& vectors, const Eigen::Vector3d& none) {
    const auto first =
        std::find_if(vectors.begin(), vectors.end(), [](const auto& v) { return !IsNull(v); });
    Eigen::Vector3d last = first == vectors.end() ? none : Eigen::Vector3d(first->normalized());
    for (Eigen::Vector3d& v : vectors) {
      v = IsNull(v) ? last : Eigen::Vector3d(v.normalized());
      last = v;
    }
  }

  const Vectors& Spine_;
  bool Closed_;
  Vectors Y_;
  Vectors Z_;
};

// A cap: the cross-section at one end of the spine, as points of its own so that its edge is sharp.
void AddCap(VrmlFaces& faces, const VrmlExtrusion& in, std::size_t ring, bool begin) {
  const std::size_t n = in.crossSection.size();
  const bool closed = in.crossSection.front() == in.crossSection.back();
  const std::size_t count = closed ? n - 1 : n;
  if (count < 3) {
    return;
  }
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : in.crossSection) {
    box.extend(p);
  }
  const double size = std::max(box.sizes().maxCoeff(), 1e-30);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t j = begin ? count - 1 - k : k;
    const Eigen::Vector2d t = (in.crossSection[j] - box.min()) / size;
    faces.coordIndex.push_back(static_cast<int>(faces.points.size()));
    const Eigen::Vector3f p = faces.points[ring * n + j];
    faces.points.push_back(p);
    faces.tcoords.values.emplace_back(static_cast<float>(t.x()), static_cast<float>(t.y()));
  }
  faces.coordIndex.push_back(-1);
}

} // namespace

bool MakeVrmlExtrusion(const VrmlExtrusion& in, VrmlFaces& faces, VrmlComplaints& complaints) {
  const std::size_t n = in.crossSection.size();
  const std::size_t m = in.spine.size();
  if (n < 2 || m < 2 || n > MaximumPoints / m) {
    complaints.push_back("an Extrusion of " + std::to_string(m) + " spine points and " +
                         std::to_string(n) + " cross-section points is left out");
    return false;
  }
  const bool closed = in.spine.front() == in.spine.back() && m > 2;
  const bool ring = in.crossSection.front() == in.crossSection.back() && n > 2;
  const SpineFrames frames(in.spine, closed);
  for (std::size_t i = 0; i < m; ++i) {
    const Eigen::Vector2d scale =
        in.scale.empty() ? Eigen::Vector2d(1, 1) : in.scale[std::min(i, in.scale.size() - 1)];
    const Eigen::Quaterniond turn = in.orientation.empty()
                                        ? Eigen::Quaterniond::Identity()
                                        : in.orientation[std::min(i, in.orientation.size() - 1)];
    const Eigen::Matrix3d frame = frames.Get(i) * turn.toRotationMatrix();
    for (std::size_t j = 0; j < n; ++j) {
      const Eigen::Vector3d p(in.crossSection[j].x() * scale.x(), 0.0,
                              in.crossSection[j].y() * scale.y());
      faces.points.push_back((in.spine[i] + frame * p).cast<float>());
      faces.tcoords.values.emplace_back(static_cast<float>(j) / static_cast<float>(n - 1),
                                        static_cast<float>(i) / static_cast<float>(m - 1));
    }
  }
  for (std::size_t i = 0; i + 1 < m; ++i) {
    for (std::size_t j = 0; j + 1 < n; ++j) {
      // The seams of closed shapes share points, so that normals are smooth across them; texture
      // coordinates keep the open count through their own indices.
      const std::size_t i1 = closed && i + 2 == m ? 0 : i + 1;
      const std::size_t j1 = ring && j + 2 == n ? 0 : j + 1;
      const auto point = [n](std::size_t a, std::size_t b) { return static_cast<int>(a * n + b); };
      faces.coordIndex.insert(faces.coordIndex.end(),
                              {point(i, j), point(i, j1), point(i1, j1), point(i1, j), -1});
      faces.tcoords.indices.insert(
          faces.tcoords.indices.end(),
          {point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j), -1});
    }
  }
  const std::size_t sides = faces.coordIndex.size();
  if (in.beginCap) {
    AddCap(faces, in, 0, true);
  }
  if (in.endCap) {
    AddCap(faces, in, m - 1, false);
  }
  faces.tcoords.indices.insert(faces.tcoords.indices.end(),
                               faces.coordIndex.begin() + static_cast<std::ptrdiff_t>(sides),
                               faces.coordIndex.end());
  faces.tcoords.binding = VrmlBinding::PerCornerIndexed;
  return true;
}

} // namespace dspace
