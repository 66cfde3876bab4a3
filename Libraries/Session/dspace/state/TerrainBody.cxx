#include <dspace/state/TerrainBody.h>

#include <cctype>
#include <cmath>
#include <utility>

#include <dspace/Checks.h>
#include <dspace/crs/Crs.h>
#include <dspace/ephemeris/BodyNames.h>
#include <dspace/orientation/BodyConstants.h>
#include <dspace/sky/KernelSet.h>

namespace dspace::session {

std::optional<int> FindBody(const KernelSet& kernels, const Crs& crs) {
  static const std::pair<const char*, int> Bodies[] = {
      {"moon", 301},   {"mars", 499},   {"mercury", 199},   {"venus", 299},     {"earth", 399},
      {"phobos", 401}, {"deimos", 402}, {"ceres", 2000001}, {"vesta", 2000004}, {"titan", 606},
      {"europa", 502}, {"io", 501},     {"ganymede", 503},  {"callisto", 504},  {"enceladus", 602}};
  std::string word; // words of the CRS's WKT, which names the body in its datum
  for (const char c : crs.GetWkt() + " ") {
    if (std::isalpha(static_cast<unsigned char>(c))) {
      word += char(std::tolower(static_cast<unsigned char>(c)));
      continue;
    }
    for (const auto& [name, body] : Bodies) {
      if (word == name) {
        return body;
      }
    }
    word.clear();
  }
  for (const int body : {399, 301, 499, 199, 299}) {
    try {
      const double radius = BodyRadii(kernels.Pool(), body).x();
      if (std::abs(crs.GetAxes().semiMajor - radius) < 1e-4 * radius) {
        return body;
      }
    } catch (const Error&) { // a kernel has wrong radii of this body
    }
  }
  return std::nullopt;
}

int BodyOf(const KernelSet& kernels, const Crs& crs, const std::string& label) {
  const std::optional<int> body = FindBody(kernels, crs);
  if (!body) {
    Reject(label, "its CRS tells no body; accepted: the command with a body");
  }
  return *body;
}

int BodyFor(const KernelSet& kernels, const Crs& crs, const std::string& named,
            const std::string& label, const std::function<void(const std::string&)>& warn) {
  if (named.empty()) {
    return BodyOf(kernels, crs, label);
  }
  const BodyNames& names = kernels.GetEphemeris().Names();
  const int body = names.IdOf(named);
  const std::optional<int> told = FindBody(kernels, crs);
  if (told && *told != body) {
    warn(label + ": the command names body '" + named + "', and its CRS tells '" +
         names.NameOf(*told) + "'; the result is for '" + named + "'");
  }
  return body;
}

std::optional<Eigen::Matrix3d> InertialFromFixed(const KernelSet& kernels, const Crs& crs,
                                                 double tdb) {
  const std::optional<int> body = FindBody(kernels, crs);
  if (!body) {
    return std::nullopt;
  }
  try {
    const Frames& frames = kernels.GetFrames();
    return frames.Rotation(frames.Table().BodyFixed(*body).name, "J2000", tdb);
  } catch (const Error&) { // the kernels do not have it then
    return std::nullopt;
  }
}

} // namespace dspace::session
