#include <dspace/scene/bodies/BodyTable.h>

#include <algorithm>
#include <cctype>

#include <dspace/Error.h>

namespace dspace {
namespace {

using Photometric = Reflectance::Model;

KnownBody Make(const char* name, double a, double b, double c, double albedo,
               Photometric model = Photometric::Lambert) {
  KnownBody body;
  body.name = name;
  body.shape.radii = Eigen::Vector3d(a, b, c) * 1e3;
  body.geometricAlbedo = albedo;
  body.model = model;
  return body;
}

std::vector<KnownBody> MakeAll() {
  std::vector<KnownBody> all = {
      Make("sun", 695700.0, 695700.0, 695700.0, 0.0),
      Make("mercury", 2440.53, 2440.53, 2438.26, 0.142, Photometric::LunarLambert),
      Make("venus", 6051.8, 6051.8, 6051.8, 0.689),
      Make("earth", 6378.137, 6378.137, 6356.752314245, 0.434),
      Make("moon", 1737.4, 1737.4, 1737.4, 0.12, Photometric::LunarLambert),
      Make("mars", 3396.19, 3396.19, 3376.20, 0.170),
      Make("phobos", 13.0, 11.4, 9.1, 0.07, Photometric::LunarLambert),
      Make("deimos", 7.8, 6.0, 5.1, 0.08, Photometric::LunarLambert),
      Make("jupiter", 71492.0, 71492.0, 66854.0, 0.538),
      Make("io", 1829.4, 1819.4, 1815.7, 0.63),
      Make("europa", 1562.6, 1560.3, 1559.5, 0.67),
      Make("ganymede", 2631.2, 2631.2, 2631.2, 0.43),
      Make("callisto", 2410.3, 2410.3, 2410.3, 0.17),
      Make("saturn", 60268.0, 60268.0, 54364.0, 0.499),
      Make("enceladus", 256.6, 251.4, 248.3, 1.0),
      Make("titan", 2575.15, 2574.78, 2574.47, 0.2),
      Make("uranus", 25559.0, 25559.0, 24973.0, 0.488),
      Make("neptune", 24764.0, 24764.0, 24341.0, 0.442),
      Make("triton", 1352.6, 1352.6, 1352.6, 0.76),
      Make("pluto", 1188.3, 1188.3, 1188.3, 0.52),
      Make("charon", 606.0, 606.0, 606.0, 0.38),
      Make("ceres", 487.3, 487.3, 446.0, 0.09, Photometric::LunarLambert),
  };
  for (KnownBody& body : all) {
    if (body.name == "sun") {
      body.shape.sun = true;
      body.shape.eclipses = false;
    } else if (body.name == "earth") {
      body.shape.geodetic = true;
      body.shape.atmosphere = EarthAtmosphere();
    } else if (body.name == "mars") {
      body.shape.atmosphere = MarsAtmosphere();
    } else if (body.name == "saturn") {
      body.shape.rings = {{74658e3, 92000e3, 0.1, {0.55, 0.52, 0.48}},
                          {92000e3, 99000e3, 1.0, {0.80, 0.74, 0.64}},
                          {99000e3, 117580e3, 2.5, {0.88, 0.82, 0.72}},
                          {117580e3, 122170e3, 0.12, {0.60, 0.57, 0.52}},
                          {122170e3, 133420e3, 0.6, {0.78, 0.74, 0.67}},
                          {133745e3, 136775e3, 0.6, {0.78, 0.74, 0.67}}};
    }
  }
  return all;
}

} // namespace

const std::vector<KnownBody>& KnownBodies() {
  static const std::vector<KnownBody> all = MakeAll();
  return all;
}

const KnownBody& FindBody(const std::string& object, const std::string& name) {
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  std::string names;
  for (const KnownBody& body : KnownBodies()) {
    if (body.name == lower) {
      return body;
    }
    names += (names.empty() ? "" : ", ") + body.name;
  }
  throw Error(Error::Kind::NotFound, object,
              "the body '" + name + "' is unknown; known are: " + names +
                  "; any other by its radii");
}

double NormalAlbedo(double geometricAlbedo, Reflectance::Model model) {
  return geometricAlbedo *
         (model == Photometric::LommelSeeliger || model == Photometric::LunarLambert ? 1.0 : 1.5);
}

} // namespace dspace
