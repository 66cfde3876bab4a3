// Checks of values, and the wording of their errors.
#ifndef DSPACE_SCENE_CHECKS_H
#define DSPACE_SCENE_CHECKS_H

#include <cmath>
#include <cstdio>
#include <string>

#include <Eigen/Core>

#include <dspace/Error.h>
#include <dspace/FrameRules.h>
#include <dspace/Utf8.h>

namespace dspace {

inline std::string NumberText(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.9g", value);
  return text;
}

inline std::string VectorText(const Eigen::Vector3d& v) {
  return "(" + NumberText(v.x()) + ", " + NumberText(v.y()) + ", " + NumberText(v.z()) + ")";
}

[[noreturn]] inline void Reject(const std::string& object, const std::string& message) {
  throw Error(Error::Kind::InvalidArgument, object, message);
}

// `accepted` completes "<what> is <value>; accepted: ...".
inline void Require(bool good, const std::string& object, const char* what, double value,
                    const char* accepted) {
  if (!good) {
    Reject(object, std::string(what) + " is " + NumberText(value) + "; accepted: " + accepted);
  }
}

inline void RequireFinite(const std::string& object, const char* what, double value) {
  Require(std::isfinite(value), object, what, value, "a finite number");
}

inline void RequireFinite(const std::string& object, const char* what, const Eigen::Vector3d& v) {
  if (!v.allFinite()) {
    Reject(object, std::string(what) + " is " + VectorText(v) + "; accepted: finite numbers");
  }
}

inline void RequirePosition(const std::string& object, const char* what, const Eigen::Vector3d& p) {
  if (!IsValidPosition(p)) {
    Reject(object, std::string(what) + " is " + VectorText(p) +
                       "; accepted: within 1e18 metres on each axis");
  }
}

// Lengths that stay well inside a float, squares too.
inline void RequireLength(const std::string& object, const char* what, double value) {
  Require(value >= 1e-9 && value <= 1e15, object, what, value, "1e-9 to 1e15 metres");
}

// In [0, 1]: colours, opacities.
inline void RequireFraction(const std::string& object, const char* what, double value) {
  Require(value >= 0.0 && value <= 1.0, object, what, value, "0 to 1");
}

// Names of objects, fragments, lights, vantages and cameras: UTF-8, not empty, no control
// characters.
inline void RequireName(const char* kind, const std::string& name) {
  std::string shown = name;
  bool good = !name.empty() && IsUtf8(name);
  for (char& c : shown) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 32 || byte == 127) {
      good = false;
      c = '?';
    }
  }
  if (!good) {
    Reject(std::string(kind) + " '" + shown + "'",
           "its name is empty, holds control characters or is not UTF-8; accepted: any other");
  }
}

} // namespace dspace

#endif
