// What a lens does: which pixel shows a point, and which ray a pixel sees.
#ifndef DSPACE_CAMERA_LENS_MODEL_H
#define DSPACE_CAMERA_LENS_MODEL_H

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace dspace {

// Numbers of a lens by name, as in files of camera models. Pixels unless a name says otherwise;
// names of angles end in `_deg`.
using LensValues = std::map<std::string, std::vector<double>>;

// The line of sight of a pixel in the camera's axes C: X right, Y down, Z forward.
struct LensRay {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();     // the entrance pupil [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ(); // unit, away from the camera
};

// Where a lens maps directions one to one.
struct LensField {
  // Every direction within this angle of the axis has a pixel of its own [deg]. The lens may see
  // more on some sides.
  double limit_deg = 180.0;
  // What ends the field: "" (nothing: all directions), "the plane of the lens", "a fold" (farther
  // out the image would turn back), "the end of the model", "parallel rays", "a row that moves".
  std::string end;
};

// Maps points in the camera's axes C to pixels and back. Pixel (0, 0) is the centre of the top-left
// pixel, x to the right, y down. Immutable; several threads may use it. Directions beyond a fold
// have no pixel, and pixels that no direction has within the field have no ray.
class LensModel {
public:
  using Jacobian = Eigen::Matrix<double, 2, 3>;

  virtual ~LensModel() = default;
  virtual const char* Type() const = 0; // the word in files: "pinhole", "cahvor", ...
  // The pixel of the point p_C [m], and its derivative by the point [pixel / m]. False where the
  // lens does not see it; the results are then undefined.
  virtual bool Project(const Eigen::Vector3d& p_C, Eigen::Vector2d& pixel,
                       Jacobian* jacobian = nullptr) const = 0;
  // The ray of a pixel; false where there is none.
  virtual bool Unproject(const Eigen::Vector2d& pixel, LensRay& ray) const = 0;
  virtual LensField Field() const = 0;
  // Whether the entrance pupil depends on the pixel.
  virtual bool MovesPupil() const { return false; }
  // Its numbers, from which MakeLens makes an equal lens.
  virtual LensValues Values() const = 0;
  // The lens for an image that is larger by the factors in x and y, of the same field of view.
  virtual std::shared_ptr<const LensModel> Scaled(double x, double y) const = 0;

protected:
  LensModel() = default;
  LensModel(const LensModel&) = default;
  LensModel& operator=(const LensModel&) = delete;
};

using LensPtr = std::shared_ptr<const LensModel>;

// The lens of a type and its numbers. `label` names the model in errors. Throws
// Error(Unsupported) for an unknown type, Error(InvalidArgument) naming `label`, the number and
// what is accepted. The types, with the numbers that may be left out (zero) in brackets:
// - pinhole: focal (2), center (2)
// - brown: focal, center, [radial (1 to 6: k1 to k6)], [tangential (2)], [prism (2 or 4)],
//   [tilt_deg (2)]
// - kannala_brandt: focal, center, [radial (1 to 4)]; equidistant: focal, center
// - ucm: focal, center, alpha; eucm: also beta; double_sphere: focal, center, xi, alpha
// - owen: focal_length (1, millimetres), matrix (4: kx, kxy, kyx, ky, pixels per millimetre),
//   center, [radial (1 to 2)], [tangential (2: y, x)], [pinwheel (1 to 2)]
// - usgs: focal_length, matrix, center, [radial (1 to 3)]
// - line_scan: as usgs, and row (1), line (n, 2 to 1024), positions (3 n), rotations (4 n)
// - orthographic: scale (2, pixels per metre), center
// - cahv: A, H, V (3 each); cahvor: also O, R; cahvore: also E, linearity (1)
LensPtr MakeLens(const std::string& type, const LensValues& values, const std::string& label);

// The types that MakeLens accepts, separated by ", ".
const std::string& LensTypes();

// A position in an image that is larger by a factor. Pixel centres are at integers.
inline double ScaledPosition(double position, double factor) {
  return (position + 0.5) * factor - 0.5;
}

} // namespace dspace

#endif
