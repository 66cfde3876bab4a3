// Rasters in degrees with patches on them, for tests.
#ifndef DSPACE_TEST_GROUPS_H
#define DSPACE_TEST_GROUPS_H

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <dspace/groups/GroupPosts.h>
#include <dspace/posts/RasterPosts.h>

#include "Patches.h"
#include "RasterFile.h"

namespace dspace::testing {

// A raster in degrees, on which patches lie.
struct Base {
  int width = 0;
  int height = 0;
  double step = 1.0; // [deg]
  double west = 0.0;
  double north = 90.0;
  bool globe = false; // goes around, with poles
  std::string datum = "sphere";
  std::function<double(double lon, double lat)> formula;

  std::string Write(const std::string& path) const {
    RasterFile file;
    file.width = this->width;
    file.height = this->height;
    file.crs = "+proj=longlat +R=1737400 +no_defs";
    file.verticalDatum = this->datum;
    file.unit = "m";
    file.geotransform =
        std::array<double, 6>{this->west, this->step, 0, this->north, 0, -this->step};
    file.value = [this](int c, int r, int) {
      return this->formula(this->west + (c + 0.5) * this->step,
                           this->north - (r + 0.5) * this->step);
    };
    return file.Write(path);
  }
};

struct Group {
  std::shared_ptr<const RasterPosts> base;
  std::shared_ptr<const GroupPosts> posts;
  double parts = 1.0; // posts a pixel of the base
  Base raster;

  Group(const Base& from, const std::string& path, const std::vector<TerrainPatch>& patches,
        int least = 0)
      : raster(from) {
    const auto source = std::make_shared<const ElevationSource>(path);
    OpenPatches opened(source->Info(), patches);
    RasterPostsOptions options;
    options.subdivisions = std::max(opened.Subdivisions(), least);
    options.periodic = from.globe;
    options.poles = from.globe;
    options.coarsest = 8;
    this->base = std::make_shared<const RasterPosts>(source, options);
    this->parts = std::ldexp(1.0, options.subdivisions);
    Eigen::Affine2d postToPixel = Eigen::Affine2d::Identity();
    postToPixel.linear() /= this->parts;
    postToPixel.translation() << 0.5, from.globe ? 0.0 : 0.5;
    this->posts = std::make_shared<const GroupPosts>(
        this->base, source->Info().pixelToMap * postToPixel, from.globe, std::move(opened));
  }
  // Of a level-0 place.
  Eigen::Vector2d LonLat(double c, double r) const {
    return {this->raster.west + (c / this->parts + 0.5) * this->raster.step,
            this->raster.north -
                (r / this->parts + (this->raster.globe ? 0.0 : 0.5)) * this->raster.step};
  }
  Eigen::Vector2d Place(const Eigen::Vector2d& lonLat) const {
    return {
        ((lonLat.x() - this->raster.west) / this->raster.step - 0.5) * this->parts,
        ((this->raster.north - lonLat.y()) / this->raster.step - (this->raster.globe ? 0.0 : 0.5)) *
            this->parts};
  }
  // The surface between posts of level 0.
  double HeightAt(const Eigen::Vector2d& lonLat) const {
    const Eigen::Vector2d p = this->Place(lonLat);
    const auto c = std::int64_t(std::floor(p.x()));
    const auto r = std::int64_t(std::floor(p.y()));
    std::array<float, 4> h = {};
    this->posts->Read({0, c, r, 2, 2}, h.data());
    const double u = p.x() - double(c);
    const double v = p.y() - double(r);
    return (1.0 - std::max(u, v)) * h[0] + std::min(u, v) * h[3] +
           std::abs(u - v) * (v > u ? h[2] : h[1]);
  }
};

inline double Plain(double lon, double lat) {
  return 700.0 * std::sin(lon * Deg * 9.0) * std::cos(lat * Deg * 7.0);
}

inline Base Region() { // lon 20 to 30, lat 72 to 78
  Base base;
  base.width = 200;
  base.height = 120;
  base.step = 0.05;
  base.west = 20.0;
  base.north = 78.0;
  base.formula = Plain;
  return base;
}

inline Base WholeMoon() {
  Base base;
  base.width = 192;
  base.height = 96;
  base.step = 360.0 / 192.0;
  base.west = -180.0;
  base.globe = true;
  base.formula = Plain;
  return base;
}

inline PatchFile Polar() {
  PatchFile patch;
  patch.projection = PolarStereographic(10.0);
  patch.middle = {25.2, 75.1};
  patch.width = 301;
  patch.height = 260;
  patch.size = 110.0;
  patch.margin = 3500.0;
  patch.formula = [](const Eigen::Vector2d& m) {
    return 900.0 + 60.0 * std::sin(m.x() / 900.0) * std::cos(m.y() / 700.0) + 0.01 * m.x();
  };
  return patch;
}

inline PatchFile Cylindrical() {
  PatchFile patch;
  patch.projection = EquidistantCylindrical(24.0, 60.0);
  patch.middle = {25.6, 75.3};
  patch.width = 240;
  patch.height = 310;
  patch.size = 61.0;
  patch.margin = 1700.0;
  patch.formula = [](const Eigen::Vector2d& m) {
    return -300.0 + 20.0 * std::cos(m.x() / 500.0 + m.y() / 1300.0);
  };
  return patch;
}

// With a round hole and a hole of one pixel. Its heights refer to a sphere 40 m below the base's.
inline PatchFile PolarWithHoles() {
  PatchFile patch = Polar();
  patch.added = -40.0;
  patch.hole = [](int c, int r) {
    return (c - 90) * (c - 90) + (r - 130) * (r - 130) < 500 || (c == 200 && r == 100);
  };
  return patch;
}

inline PatchFile AcrossTheDateLine(double lon) {
  PatchFile patch = Cylindrical();
  patch.projection = EquidistantCylindrical(180.0, 0.0);
  patch.middle = {lon, 20.0};
  patch.size = 1200.0;
  patch.margin = 40000.0;
  return patch;
}

inline PatchFile OnThePole() {
  PatchFile patch = Polar();
  patch.middle = {10.0, 89.0};
  patch.size = 500.0;
  patch.margin = 20000.0;
  return patch;
}

} // namespace dspace::testing

#endif
