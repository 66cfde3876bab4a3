// Values of Coin's fields as Eigen's and the standard library's types. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML_FIELDS_H
#define DSPACE_IMPORT_VRML_FIELDS_H

#include <Inventor/fields/SoMFColor.h>
#include <Inventor/fields/SoMFInt32.h>
#include <Inventor/fields/SoMFString.h>
#include <Inventor/fields/SoMFVec2f.h>
#include <Inventor/fields/SoMFVec3f.h>
#include <Inventor/fields/SoSFColor.h>
#include <Inventor/fields/SoSFImage.h>
#include <Inventor/fields/SoSFRotation.h>
#include <Inventor/fields/SoSFVec2f.h>
#include <Inventor/fields/SoSFVec3f.h>

#include <dspace/import/model/Model.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace dspace {

Eigen::Vector3d ToEigen(const SbVec3f& v);
Eigen::Vector2d ToEigen(const SbVec2f& v);
// Identity for an axis of length zero.
Eigen::Quaterniond ToEigen(const SbRotation& r);
std::array<double, 3> ToColor(const SbColor& c); // clamped to [0, 1]
std::array<std::uint8_t, 4> ToBytes(const SbColor& c, double opacity = 1.0);

std::vector<Eigen::Vector3f> ToVector(const SoMFVec3f& field);
std::vector<Eigen::Vector2f> ToVector(const SoMFVec2f& field);
std::vector<std::array<std::uint8_t, 4>> ToVector(const SoMFColor& field);
std::vector<int> ToVector(const SoMFInt32& field);
std::vector<std::string> ToVector(const SoMFString& field);

// Top row first; null when it has no pixels.
std::shared_ptr<const Image> ToImage(const SoSFImage& field, const std::string& name);

// T * C * R * SR * S * -SR * -C, as VRML97 6.52 and VRML 1.0 define Transform.
Eigen::Affine3d VrmlTransform(const SbVec3f& translation, const SbVec3f& center,
                              const SbRotation& rotation, const SbVec3f& scale,
                              const SbRotation& scaleOrientation);

// Roughness of a highlight as wide as that of Phong's exponent 128 * shininess.
double RoughnessOf(double shininess);

} // namespace dspace

#endif
