// An atmosphere that scatters sunlight once: coefficients, and the reference in double precision
// that the shader follows (Shaders/Atmosphere.glsl).
#ifndef DSPACE_SCENE_ATMOSPHERE_H
#define DSPACE_SCENE_ATMOSPHERE_H

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace dspace {

// Air and haze about a body, each thinning with height as exp(-height / its scale height). Height
// is that above the ellipsoid whose shells are similar to it: on an oblate body heights at the
// poles count as larger by the flattening (0.3 % on the Earth). Radiance of a ray: the integral of
// T(eye, x) T(x, Sun) (beta_R P_R + beta_M P_M) E over its points x, T = exp(-optical depth); light
// that was scattered twice, or reflected by the ground, is left out.
struct Atmosphere {
  double top = 100e3; // [m] above the ellipsoid, 1 to 1e8
  // Rayleigh: P_R = 3 (1 + cos^2) / (16 pi). [1/m] at height 0 for red, green and blue
  Eigen::Vector3d rayleigh = Eigen::Vector3d::Zero();
  double rayleighHeight = 8e3; // scale height [m]
  // Haze or dust: P_M of L. Henyey, J. Greenstein, ApJ 93 (1941) 70.
  Eigen::Vector3d mie = Eigen::Vector3d::Zero();           // scattering [1/m]
  Eigen::Vector3d mieExtinction = Eigen::Vector3d::Zero(); // [1/m], at least the scattering
  double mieHeight = 1.2e3;                                // scale height [m]
  double mieAsymmetry = 0.8;                               // g, -0.99 to 0.99

  // Throws Error(InvalidArgument) naming `object` and the value.
  void Check(const std::string& object, const Eigen::Vector3d& radii) const;
};

// Air of the Earth: Rayleigh 5.802, 13.558, 33.1 per 1000 km with 8 km; haze 3.996 (scattering) and
// 4.44 (extinction) per 1000 km with 1.2 km, g 0.8 (E. Bruneton, F. Neyret, "Precomputed
// Atmospheric Scattering", EGSR 2008; S. Hillaire, "A Scalable and Production Ready Sky and
// Atmosphere Rendering Technique", EGSR 2020). Without ozone.
Atmosphere EarthAtmosphere();

// Air of Mars on a day of little dust: optical depth 0.5 of dust with 11.1 km, single-scattering
// albedo 0.94, 0.85, 0.72 and g 0.7 (after M. Tomasko et al., JGR 104 (1999) 8987, rounded), and
// the Rayleigh scattering of CO2 at 610 Pa and 210 K (cross-section 1.24e-30 m^2 at 532 nm: M.
// Sneep, W. Ubachs, JQSRT 92 (2005) 293; by the fourth power of the wavelength to 680, 550 and 440
// nm).
Atmosphere MarsAtmosphere();

// Sunlight that reaches a place: exp(-optical depth) from a distance `r` [m] from the centre
// towards a direction whose cosine with the vertical is `mu`, on a sphere of radius `ground` [m]; 0
// where the ground is in the way. In `steps` steps by the trapezoidal rule.
Eigen::Vector3d TransmittanceToTop(const Atmosphere& air, double ground, double r, double mu,
                                   int steps = 500);

// The light of a ray and what it leaves of what is behind it.
struct AirLight {
  Eigen::Vector3d scattered = Eigen::Vector3d::Zero();   // radiance, against the Sun's irradiance 1
  Eigen::Vector3d transmitted = Eigen::Vector3d::Ones(); // 0 to 1
};

// By numerical integration of the equations above on a sphere of radius `ground`: from `from` to
// `to` [m from the centre], with the Sun in a unit direction, in `steps` steps by the midpoint
// rule.
AirLight IntegrateAir(const Atmosphere& air, double ground, const Eigen::Vector3d& from,
                      const Eigen::Vector3d& to, const Eigen::Vector3d& sun, int steps = 2000,
                      int sunSteps = 500);

// What the shader reads: TransmittanceToTop() over a table of `Columns` x `Rows`. Rows: height, as
// the distance to the horizon of height 0, against that of the top. Columns: the length of the way
// to the top, from the shortest to that along the horizon (Bruneton and Neyret, 2008).
struct AirTable {
  static constexpr int Columns = 128;
  static constexpr int Rows = 64;
  std::vector<float> values; // three a cell, in rows

  AirTable(const Atmosphere& air, double ground);
};

} // namespace dspace

#endif
