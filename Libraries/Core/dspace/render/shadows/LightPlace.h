// Where something is along the light.
#ifndef DSPACE_RENDER_SHADOWS_LIGHT_PLACE_H
#define DSPACE_RENDER_SHADOWS_LIGHT_PLACE_H

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace dspace {

// Where something is, in view axes [m]: within `radius` of the hull of points (none: anywhere), and
// above or below a plane. Planes: a unit normal, upwards, and the distance that n . p + d is 0 at.
struct LightHull {
  std::vector<Eigen::Vector3d> points;
  double radius = 0.0;
  std::optional<Eigen::Vector4d> floor;
  std::optional<Eigen::Vector4d> ceiling;
  // Boxes in axes of its own that hold it (CasterParts.h), and how those stand in the view; null or
  // none: unknown.
  const std::vector<Eigen::AlignedBox3f>* parts = nullptr;
  Eigen::Matrix<double, 3, 4> X_VM = Eigen::Matrix<double, 3, 4>::Identity();
};

// A hull in the axes U, V and S of the light (CascadeFit.h). All maps of a fit have the same axes:
// it is turned once for all of them. The hull's parts must outlive it. Not for several threads.
class LightPlace {
public:
  // Along U, V and S [m], and how S of its planes goes with U and V.
  struct Extent {
    static constexpr int Most = 8; // points with sides; a polygon has no more sides than points
    Eigen::AlignedBox3d box;
    std::optional<Eigen::Vector3d> floor; // S = x + y U + z V
    std::optional<Eigen::Vector3d> ceiling;
    std::array<Eigen::Vector3d, Most> sides; // outside where x U + y V > z for any of these
    int sideCount = 0;                       // the first of `sides` that count
  };
  // How far before the camera its nearest and its farthest point may be [m].
  struct Depths {
    double nearest = 1e300;
    double farthest = -1e300;
  };
  struct Part {
    Eigen::AlignedBox3d box; // along U, V and S [m]
    Depths depths;
  };

  // `axes`: rows U, V, S, from view axes.
  LightPlace(const Eigen::Matrix3d& axes, const LightHull& hull);

  bool Anywhere() const { return this->Anywhere_; }
  const Extent& Whole() const { return this->Whole_; }
  Depths GetDepths() const { return this->Depths_; }
  bool HasParts() const { return this->Boxes_ && !this->Boxes_->empty(); }
  const std::vector<Part>& Parts() const; // made when they are first asked for

private:
  Eigen::Matrix3d Axes_;
  const std::vector<Eigen::AlignedBox3f>* Boxes_;
  Eigen::Matrix<double, 3, 4> X_VM_;
  bool Anywhere_;
  Extent Whole_;
  Depths Depths_;
  mutable std::vector<Part> Parts_;
};

} // namespace dspace

#endif
