#include <dspace/FrameRules.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <dspace/Error.h>
#include <dspace/Utf8.h>

namespace dspace {

namespace {

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

// For messages: control characters made visible, and of a long name only the beginning.
std::string Quoted(const std::string& name) {
  constexpr std::size_t Shown = 60;
  std::size_t end = name.size() > MaximumFrameName ? Shown : name.size();
  while (end < name.size() && (static_cast<unsigned char>(name[end]) & 0xC0) == 0x80) {
    --end; // not within a letter of UTF-8
  }
  std::string text = "'";
  for (const char c : name.substr(0, end)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 32 || byte == 127) {
      char code[8];
      std::snprintf(code, sizeof code, "\\x%02x", byte);
      text += code;
    } else {
      text += c;
    }
  }
  return text + (end < name.size() ? "...', " + std::to_string(name.size()) + " bytes long," : "'");
}

} // namespace

bool IsValidFrameName(const std::string& name) {
  return !name.empty() && name.size() <= MaximumFrameName && name != "." && name != ".." &&
         IsUtf8(name) && std::none_of(name.begin(), name.end(), [](char c) {
           const auto byte = static_cast<unsigned char>(c);
           return c == '/' || byte < 32 || byte == 127;
         });
}

std::string MappedFrameName(const std::string& name) {
  std::string mapped = Utf8Beginning(ToUtf8(name), MaximumFrameName - 16); // room for a number
  for (char& c : mapped) {
    const auto byte = static_cast<unsigned char>(c);
    c = c == '/' || byte < 32 || byte == 127 ? '_' : c;
  }
  return mapped.empty() || mapped == "." || mapped == ".." ? "_" : mapped;
}

void RejectFrameName(const std::string& object, const std::string& name) {
  throw Error(
      Error::Kind::InvalidArgument, object,
      "the name " + Quoted(name) + " is not accepted: it must have 1 to " +
          std::to_string(MaximumFrameName) +
          " bytes of UTF-8, be neither '.' nor '..', and hold no '/' and no control characters");
}

bool IsValidPosition(const Eigen::Vector3d& p) {
  return (p.array().abs() <= MaximumCoordinate).all(); // false for NaN
}

bool IsValidPose(const Pose& X) {
  return IsValidPosition(X.position) && X.scale >= MinimumScale && X.scale <= MaximumScale &&
         std::abs(X.rotation.norm() - 1.0) <= UnitQuaternionTolerance; // false for NaN
}

void RejectPose(const std::string& object, const Pose& X) {
  std::string why;
  const Eigen::Quaterniond& q = X.rotation;
  if (!IsValidPosition(X.position)) {
    why = "position (" + Number(X.position.x()) + ", " + Number(X.position.y()) + ", " +
          Number(X.position.z()) + ") must be finite and within 1e18 m on each axis";
  } else if (!(X.scale >= MinimumScale && X.scale <= MaximumScale)) {
    why = "scale " + Number(X.scale) + " must be from 1e-12 to 1e12";
  } else {
    why = "quaternion (w " + Number(q.w()) + ", x " + Number(q.x()) + ", y " + Number(q.y()) +
          ", z " + Number(q.z()) + ") has norm " + Number(q.norm()) +
          "; it must be unit within 1e-6";
  }
  throw Error(Error::Kind::InvalidArgument, object, why);
}

Pose NormalisedPose(const Pose& X) {
  const double squared = X.rotation.squaredNorm();
  Pose result = X;
  if (std::abs(squared - 1.0) > 8.0 * std::numeric_limits<double>::epsilon()) {
    result.rotation.coeffs() /= std::sqrt(squared);
  }
  return result;
}

Pose PoseFromRow(const double* row) {
  return {{row[0], row[1], row[2]}, {row[3], row[4], row[5], row[6]}, row[7]};
}

} // namespace dspace
