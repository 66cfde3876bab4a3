// Terrain groups by other means, for tests: projections in closed form, weights by brute force.
#ifndef DSPACE_TEST_PATCHES_H
#define DSPACE_TEST_PATCHES_H

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <dspace/groups/GroupPosts.h>
#include <dspace/posts/RasterPosts.h>
#include <dspace/surface/GridTerrain.h>

#include "RasterFile.h"

namespace dspace::testing {

constexpr double MoonRadius = 1737400.0;
constexpr double Deg = M_PI / 180.0;

struct Projection {
  std::string text;                                                    // for PROJ
  std::function<Eigen::Vector2d(const Eigen::Vector2d& lonLat)> toMap; // [deg] to [m]
  std::function<Eigen::Vector2d(const Eigen::Vector2d& map)> toLonLat;
  std::function<Eigen::Vector2d(double latitude)> scale; // map metres a metre of ground, along x, y
};

// Snyder, Map Projections: A Working Manual, 1987, (21-1), (21-2), (21-11) on a sphere.
inline Projection PolarStereographic(double lon0, bool south = false) {
  const double side = south ? -1.0 : 1.0;
  Projection p;
  p.text = "+proj=stere +lat_0=" + std::to_string(90.0 * side) + " +lon_0=" + std::to_string(lon0) +
           " +R=1737400 +no_defs";
  p.toMap = [lon0, side](const Eigen::Vector2d& q) {
    const double rho = 2.0 * MoonRadius * std::tan((45.0 - 0.5 * side * q.y()) * Deg);
    const double l = (q.x() - lon0) * Deg;
    return Eigen::Vector2d(rho * std::sin(l), -side * rho * std::cos(l));
  };
  p.toLonLat = [lon0, side](const Eigen::Vector2d& m) {
    return Eigen::Vector2d(lon0 + std::atan2(m.x(), -side * m.y()) / Deg,
                           side * (90.0 - 2.0 * std::atan(m.norm() / (2.0 * MoonRadius)) / Deg));
  };
  p.scale = [side](double latitude) {
    return Eigen::Vector2d(
        Eigen::Vector2d::Constant(2.0 / (1.0 + std::sin(side * latitude * Deg))));
  };
  return p;
}

inline Projection EquidistantCylindrical(double lon0, double latTs) {
  Projection p;
  p.text = "+proj=eqc +lat_ts=" + std::to_string(latTs) + " +lon_0=" + std::to_string(lon0) +
           " +R=1737400 +no_defs";
  const double a = MoonRadius * Deg;
  const double c = std::cos(latTs * Deg);
  p.toMap = [lon0, a, c](const Eigen::Vector2d& q) {
    const double l = q.x() - lon0;
    return Eigen::Vector2d(a * c * (l - 360.0 * std::round(l / 360.0)), a * q.y());
  };
  p.toLonLat = [lon0, a, c](const Eigen::Vector2d& m) {
    return Eigen::Vector2d(lon0 + m.x() / (a * c), m.y() / a);
  };
  p.scale = [c](double latitude) { return Eigen::Vector2d(c / std::cos(latitude * Deg), 1.0); };
  return p;
}

// A patch of width x height square pixels of `size` [map m] about a place, and its heights.
struct PatchFile {
  Projection projection;
  Eigen::Vector2d middle; // lon, lat [deg]
  int width = 0;
  int height = 0;
  double size = 1.0;
  double margin = 1.0; // [m]
  double added = 0.0;  // to its heights, to be above the base's datum
  std::function<double(const Eigen::Vector2d& map)> formula;
  std::function<bool(int, int)> hole = [](int, int) { return false; };

  Eigen::Vector2d Corner() const {
    const Eigen::Vector2d m = this->projection.toMap(this->middle);
    return {m.x() - 0.5 * this->width * this->size, m.y() + 0.5 * this->height * this->size};
  }
  // From its corner.
  Eigen::Vector2d PixelOf(const Eigen::Vector2d& lonLat) const {
    const Eigen::Vector2d d = this->projection.toMap(lonLat) - this->Corner();
    return {d.x() / this->size, -d.y() / this->size};
  }
  Eigen::Vector2d LonLatOf(const Eigen::Vector2d& pixel) const {
    return this->projection.toLonLat(this->Corner() +
                                     this->size * Eigen::Vector2d(pixel.x(), -pixel.y()));
  }
  double FormulaAt(const Eigen::Vector2d& lonLat) const {
    return this->formula(this->projection.toMap(lonLat)) + this->added;
  }
  TerrainPatch Write(const std::string& path) const {
    RasterFile file;
    file.width = this->width;
    file.height = this->height;
    file.noData = -99999.0;
    file.crs = this->projection.text;
    file.unit = "m";
    file.verticalDatum = "sphere:" + std::to_string(MoonRadius + this->added);
    const Eigen::Vector2d corner = this->Corner();
    file.geotransform =
        std::array<double, 6>{corner.x(), this->size, 0, corner.y(), 0, -this->size};
    file.value = [&](int c, int r, int) {
      return this->hole(c, r)
                 ? -99999.0
                 : this->formula(corner + this->size * Eigen::Vector2d(c + 0.5, -r - 0.5));
    };
    TerrainPatch patch;
    patch.path = file.Write(path);
    patch.margin = this->margin;
    return patch;
  }
};

// A patch by other code: every distance looked at, every mean summed.
class PatchByHand {
public:
  PatchByHand(const PatchFile& file, const TerrainPatch& patch)
      : File_(file), Grid_(GridTerrain::Load(patch.path, {patch.elevation, {}, 0.0})),
        Means_(std::make_shared<ElevationSource>(patch.path, patch.elevation), [] {
          RasterPostsOptions options;
          options.coarsest = 2;
          return options;
        }()) {
    const Eigen::Vector2d metres =
        Eigen::Vector2d::Constant(file.size).cwiseQuotient(file.projection.scale(file.middle.y()));
    std::vector<Eigen::Vector2d> holes;
    for (int r = 0; r < file.height; ++r) {
      for (int c = 0; c < file.width; ++c) {
        if (file.hole(c, r)) {
          holes.emplace_back(c * metres.x(), r * metres.y());
        }
      }
    }
    for (int r = 0; r < file.height; ++r) {
      for (int c = 0; c < file.width; ++c) {
        double d = std::min(std::min(c + 1, file.width - c) * metres.x(),
                            std::min(r + 1, file.height - r) * metres.y());
        for (const Eigen::Vector2d& hole : holes) {
          d = std::min(d, (hole - Eigen::Vector2d(c * metres.x(), r * metres.y())).norm());
        }
        const double s = std::clamp((d - 3.0 * metres.maxCoeff()) / file.margin, 0.0, 1.0);
        this->Weights_.push_back(s * s * (3.0 - 2.0 * s));
      }
    }
  }

  // Mean of the weights of cell (i, j) of 2^level pixels a side.
  double Cell(int i, int j, int level) const {
    double sum = 0.0;
    for (int r = j << level; r < std::min((j + 1) << level, this->File_.height); ++r) {
      for (int c = i << level; c < std::min((i + 1) << level, this->File_.width); ++c) {
        sum += i < 0 || j < 0 ? 0.0 : this->Weights_[std::size_t(r) * this->File_.width + c];
      }
    }
    return std::ldexp(sum, -2 * level);
  }
  double Weight(const Eigen::Vector2d& pixel, int level) const {
    const double x = std::ldexp(pixel.x(), -level) - 0.5;
    const double y = std::ldexp(pixel.y(), -level) - 0.5;
    const int most = 1 + (std::max(this->File_.width, this->File_.height) >> level);
    if (!(x > -1.0 && y > -1.0 && x < most && y < most)) {
      return 0.0;
    }
    const int i = int(std::floor(x));
    const int j = int(std::floor(y));
    const double u = x - i;
    const double v = y - j;
    const auto cell = [&](int a, int b) { return a < 0 || b < 0 ? 0.0 : this->Cell(a, b, level); };
    return (1 - u) * (1 - v) * cell(i, j) + u * (1 - v) * cell(i + 1, j) +
           (1 - u) * v * cell(i, j + 1) + u * v * cell(i + 1, j + 1);
  }
  // How many of its pixels lie between posts `step` degrees apart: the most of some places.
  double PixelsBetween(double step) const {
    double most = 0.0;
    for (int j = 0; j <= 8; ++j) {
      for (int i = 0; i <= 8; ++i) {
        const Eigen::Vector2d p =
            this->File_.LonLatOf({this->File_.width * i / 8.0, this->File_.height * j / 8.0});
        for (const int axis : {0, 1}) {
          const Eigen::Vector2d q = p + 1e-5 * Eigen::Vector2d::Unit(axis);
          most = std::max(most,
                          (this->File_.PixelOf(q) - this->File_.PixelOf(p)).norm() / 1e-5 * step);
        }
      }
    }
    return most;
  }
  // The group there, given what lies under it. `level`: of the patch's own.
  double Over(double under, const Eigen::Vector2d& lonLat, int level) const {
    const Eigen::Vector2d pixel = this->File_.PixelOf(lonLat);
    const double weight = this->Weight(pixel, level);
    if (!(weight > 0.0)) {
      return under;
    }
    const double height = this->Height(pixel, level) + this->File_.added;
    return std::isnan(height)  ? under
           : std::isnan(under) ? height
                               : under + weight * (height - under);
  }

private:
  double Height(const Eigen::Vector2d& pixel, int level) const {
    if (level == 0) {
      const HeightGrid::Facet facet =
          this->Grid_->Grid().FacetAt(pixel - Eigen::Vector2d::Constant(0.5));
      return facet.valid ? facet.height : std::numeric_limits<double>::quiet_NaN();
    }
    const PostLattice& lattice = this->Means_.GetLattice();
    level = std::min(level, lattice.levels - 1);
    const int columns = int(lattice.ColumnsAt(level));
    const int rows = int(lattice.RowsAt(level));
    std::vector<float>& all = this->Levels_[level];
    if (all.empty()) {
      all.resize(std::size_t(columns) * rows);
      this->Means_.Read({level, 0, 0, columns, rows}, all.data());
    }
    // Cell and place in it along an axis, the last one being shorter.
    const auto find = [&](double at, int posts, int pixels, double& share) {
      at = std::clamp(at, 0.0, pixels - 1.0);
      int k = 0;
      const auto place = [&](int i) { return std::min<double>(i * (1 << level), pixels - 1); };
      while (k < posts - 2 && place(k + 1) <= at) {
        ++k;
      }
      share = (at - place(k)) / (place(k + 1) - place(k));
      return k;
    };
    double u = 0.0;
    double v = 0.0;
    const int c = find(pixel.x() - 0.5, columns, this->File_.width, u);
    const int r = find(pixel.y() - 0.5, rows, this->File_.height, v);
    const auto post = [&](int i, int j) { return double(all[std::size_t(j) * columns + i]); };
    const double a = post(c, r);
    const double d = post(c + 1, r + 1);
    const double corner = v > u ? post(c, r + 1) : post(c + 1, r);
    const double flat = (1.0 - std::max(u, v)) * a + std::min(u, v) * d + std::abs(u - v) * corner;
    if (!std::isnan(flat)) {
      return flat;
    }
    double sum = 0.0;
    double weight = 0.0;
    for (const int j : {0, 1}) {
      for (const int i : {0, 1}) {
        const double near = (i ? u : 1 - u) * (j ? v : 1 - v);
        if (!std::isnan(post(c + i, r + j))) {
          sum += near * post(c + i, r + j);
          weight += near;
        }
      }
    }
    return weight > 1e-6 ? sum / weight : std::numeric_limits<double>::quiet_NaN();
  }

  PatchFile File_;
  std::shared_ptr<const GridTerrain> Grid_;
  RasterPosts Means_;
  std::vector<double> Weights_;
  mutable std::map<int, std::vector<float>> Levels_;
};

} // namespace dspace::testing

#endif
