#include <dspace/scene/bodies/Atmosphere.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>

namespace dspace {
namespace {

struct Density {
  double rayleigh;
  double mie;
};

Density DensityAt(const Atmosphere& air, double height) {
  return {std::exp(-height / air.rayleighHeight), std::exp(-height / air.mieHeight)};
}

Eigen::Vector3d Extinction(const Atmosphere& air, const Density& column) {
  return air.rayleigh * column.rayleigh + air.mieExtinction * column.mie;
}

// To where a ray from distance r leaves the sphere of radius `top`, along the cosine mu.
double LengthTo(double top, double r, double mu) {
  return -r * mu + std::sqrt(std::max(0.0, top * top - r * r * (1.0 - mu * mu)));
}

} // namespace

void Atmosphere::Check(const std::string& object, const Eigen::Vector3d& radii) const {
  Require(this->top >= 1.0 && this->top <= 1e8, object, "the top of its atmosphere", this->top,
          "1 to 1e8 metres");
  Require(std::abs(radii.x() - radii.y()) <= 1e-9 * radii.x(), object,
          "the ratio of the equator's radii of a body with an atmosphere", radii.x() / radii.y(),
          "1");
  const auto check = [&](const char* what, const Eigen::Vector3d& values) {
    for (int i = 0; i < 3; ++i) {
      Require(values[i] >= 0.0 && values[i] <= 1.0, object, what, values[i], "0 to 1 per metre");
    }
  };
  check("the Rayleigh coefficient of its atmosphere", this->rayleigh);
  check("the scattering coefficient of its haze", this->mie);
  check("the extinction coefficient of its haze", this->mieExtinction);
  for (int i = 0; i < 3; ++i) {
    Require(this->mieExtinction[i] >= this->mie[i], object,
            "the extinction coefficient of its haze", this->mieExtinction[i],
            "at least its scattering coefficient");
  }
  for (const double height : {this->rayleighHeight, this->mieHeight}) {
    Require(height >= 1.0 && height <= 1e7, object, "a scale height of its atmosphere", height,
            "1 to 1e7 metres");
  }
  Require(std::abs(this->mieAsymmetry) <= 0.99, object, "the asymmetry of its haze",
          this->mieAsymmetry, "-0.99 to 0.99");
}

Atmosphere EarthAtmosphere() {
  Atmosphere air;
  air.rayleigh = {5.802e-6, 13.558e-6, 33.1e-6};
  air.rayleighHeight = 8e3;
  air.mie = Eigen::Vector3d::Constant(3.996e-6);
  air.mieExtinction = Eigen::Vector3d::Constant(4.44e-6);
  air.mieHeight = 1.2e3;
  air.mieAsymmetry = 0.8;
  air.top = 100e3;
  return air;
}

Atmosphere MarsAtmosphere() {
  Atmosphere air;
  const double density = 610.0 / (1.380649e-23 * 210.0); // molecules [1/m^3]
  const Eigen::Array3d wavelength(680.0, 550.0, 440.0);  // [nm]
  air.rayleigh = (density * 1.24e-30 * (532.0 / wavelength).pow(4)).matrix();
  air.rayleighHeight = 11.1e3;
  air.mieExtinction = Eigen::Vector3d::Constant(0.5 / 11.1e3);
  air.mie = air.mieExtinction.cwiseProduct(Eigen::Vector3d(0.94, 0.85, 0.72));
  air.mieHeight = 11.1e3;
  air.mieAsymmetry = 0.7;
  air.top = 100e3;
  return air;
}

Eigen::Vector3d TransmittanceToTop(const Atmosphere& air, double ground, double r, double mu,
                                   int steps) {
  if (mu < 0.0 && r * r * (1.0 - mu * mu) < ground * ground && r > ground) {
    return Eigen::Vector3d::Zero();
  }
  const double length = LengthTo(ground + air.top, r, mu);
  Density column{0.0, 0.0};
  for (int i = 0; i <= steps; ++i) {
    const double s = length * i / steps;
    const double height = std::sqrt(r * r + s * s + 2.0 * r * s * mu) - ground;
    const Density here = DensityAt(air, height);
    const double weight = length / steps * (i == 0 || i == steps ? 0.5 : 1.0);
    column.rayleigh += weight * here.rayleigh;
    column.mie += weight * here.mie;
  }
  return (-Extinction(air, column)).array().exp().matrix();
}

AirLight IntegrateAir(const Atmosphere& air, double ground, const Eigen::Vector3d& from,
                      const Eigen::Vector3d& to, const Eigen::Vector3d& sun, int steps,
                      int sunSteps) {
  AirLight light;
  const Eigen::Vector3d way = to - from;
  const double step = way.norm() / steps;
  const double cosine = way.normalized().dot(sun);
  const double g = air.mieAsymmetry;
  const double phaseR = 3.0 / (16.0 * M_PI) * (1.0 + cosine * cosine);
  const double phaseM =
      (1.0 - g * g) / (4.0 * M_PI * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
  Density column{0.0, 0.0};
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector3d x = from + way * ((i + 0.5) / steps);
    const double r = x.norm();
    if (r > ground + air.top) {
      continue;
    }
    const Density here = DensityAt(air, r - ground);
    column.rayleigh += 0.5 * step * here.rayleigh;
    column.mie += 0.5 * step * here.mie;
    const Eigen::Vector3d passed = (-Extinction(air, column)).array().exp().matrix();
    const Eigen::Vector3d lit = TransmittanceToTop(air, ground, r, x.dot(sun) / r, sunSteps);
    const Eigen::Vector3d source =
        air.rayleigh * (here.rayleigh * phaseR) + air.mie * (here.mie * phaseM);
    light.scattered += step * passed.cwiseProduct(lit).cwiseProduct(source);
    column.rayleigh += 0.5 * step * here.rayleigh;
    column.mie += 0.5 * step * here.mie;
  }
  light.transmitted = (-Extinction(air, column)).array().exp().matrix();
  return light;
}

AirTable::AirTable(const Atmosphere& air, double ground) {
  const double top = ground + air.top;
  const double most = std::sqrt(top * top - ground * ground);
  this->values.reserve(std::size_t(3 * Columns * Rows));
  for (int row = 0; row < Rows; ++row) {
    const double rho = most * row / (Rows - 1);
    const double r = std::sqrt(rho * rho + ground * ground);
    const double shortest = top - r;
    const double longest = rho + most;
    for (int column = 0; column < Columns; ++column) {
      const double d = shortest + (longest - shortest) * column / (Columns - 1);
      const double mu =
          d <= 0.0 ? 1.0 : std::clamp((most * most - rho * rho - d * d) / (2.0 * r * d), -1.0, 1.0);
      // Without the ground, which begins beside the table's last column.
      const double length = d;
      Density sum{0.0, 0.0};
      constexpr int Steps = 200;
      for (int i = 0; i <= Steps; ++i) {
        const double s = length * i / Steps;
        const double height = std::max(0.0, std::sqrt(r * r + s * s + 2.0 * r * s * mu) - ground);
        const Density here = DensityAt(air, height);
        const double weight = length / Steps * (i == 0 || i == Steps ? 0.5 : 1.0);
        sum.rayleigh += weight * here.rayleigh;
        sum.mie += weight * here.mie;
      }
      const Eigen::Vector3d passed = (-Extinction(air, sum)).array().exp().matrix();
      for (int i = 0; i < 3; ++i) {
        this->values.push_back(float(passed[i]));
      }
    }
  }
}

} // namespace dspace
