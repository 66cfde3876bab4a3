// Charts without a terrain, files of shapes and what a layer paints, for tests of vector layers.
#ifndef DSPACE_TEST_VECTORTESTSUPPORT_H
#define DSPACE_TEST_VECTORTESTSUPPORT_H

#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/layers/vector/VectorLayer.h>

#include "Grids.h"
#include "RasterFile.h"

namespace dspace::testing {

constexpr double Mars = 3396190.0;

inline std::string Degrees() {
  return "+proj=longlat +R=3396190 +no_defs";
}

// 512 x 512 pixels of 2 m from map (x, y); texels of 4 / 2^zoom metres.
struct PlaneChart {
  RasterPlace place;
  ColorGrid grid;
  explicit PlaneChart(const std::string& crs = "", double x = 1000.0, double y = 5000.0) {
    place.name = "terrain 'plane'";
    place.crs = crs.empty() ? Crs() : Crs::FromText(crs);
    place.pixelToMap = NorthUp(x, y, 2.0);
    place.columns = place.rows = 512;
    grid.placement = PostPlacement::OnPlane(NorthUp(-511.0, 511.0, 2.0));
    grid.crs = place.crs;
    grid.firstPost.setConstant(-0.5);
    grid.rootPosts.setConstant(512.0);
    grid.postToMap = place.pixelToMap * Eigen::Translation2d(0.5, 0.5);
    grid.extent = Eigen::AlignedBox2d(Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(511.5, 511.5));
  }
};

// A whole body in pixels of a degree, and its pole charts.
struct BodyChart {
  RasterPlace place;
  ColorGrid grid;
  BodyChart() {
    place.name = "terrain 'body'";
    place.crs = Crs::FromText(Degrees());
    place.pixelToMap = NorthUp(-180.0, 90.0, 1.0);
    place.columns = 360;
    place.rows = 180;
    grid.placement = PostPlacement::OnSphere({-179.5, 89.5}, {1.0, -1.0}, Mars, 179.5);
    grid.crs = place.crs;
    grid.firstPost.setConstant(-0.5);
    grid.rootPosts.setConstant(180.0);
    grid.rootColumns = 2;
    grid.periodic = true;
    grid.postToMap = place.pixelToMap * Eigen::Translation2d(0.5, 0.5);
    grid.extent = Eigen::AlignedBox2d(Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(359.5, 179.5));
  }
  // 512 posts of 20 km about a pole.
  static ColorGrid Pole(bool south) {
    ColorGrid grid;
    grid.placement = PostPlacement::OnPole(south, 20000.0, 256.0, Mars);
    grid.crs = Crs::FromText(std::string("+proj=stere +lon_0=-90 +R=3396190 +no_defs +lat_0=") +
                             (south ? "-90" : "90"));
    grid.rootPosts.setConstant(512.0);
    grid.postToMap = NorthUp(-256.0 * 20000.0, 256.0 * 20000.0, 20000.0);
    grid.extent = Eigen::AlignedBox2d(Eigen::Vector2d(0, 0), Eigen::Vector2d(512, 512));
    return grid;
  }
};

struct Painted {
  ColorBlock block;
  bool some = false;
  std::vector<std::uint8_t> rgba;
  Painted(const ColorLayer& layer, const ColorGrid& grid, const ColorBlock& of)
      : block(of), rgba(std::size_t(4) * of.width * of.height, 0) {
    some = layer.Read(grid, of, rgba.data());
  }
  const std::uint8_t* At(int x, int y) const {
    return rgba.data() + 4 * (std::size_t(y) * block.width + x);
  }
  double Opacity(int x, int y) const { return At(x, y)[3] / 255.0; }
  double Sum() const {
    double sum = 0.0;
    for (int y = 0; y < block.height; ++y) {
      for (int x = 0; x < block.width; ++x) {
        sum += Opacity(x, y);
      }
    }
    return sum;
  }
};

// Opacity of the texel that a map place of a chart is in.
inline double OpacityAt(const ColorLayer& layer, const ColorGrid& grid, int zoom,
                        const Eigen::Vector2d& map) {
  const Eigen::Vector2d texel = grid.TexelToMap(zoom).inverse() * map;
  return Painted(
             layer, grid,
             {zoom, std::int64_t(std::floor(texel.x())), std::int64_t(std::floor(texel.y())), 1, 1})
      .Opacity(0, 0);
}

// A feature of GeoJSON; `geometry` as in its "type" and "coordinates".
inline std::string Feature(const std::string& type, const std::string& coordinates,
                           const std::string& properties = "") {
  return R"({"type":"Feature","properties":{)" + properties + R"(},"geometry":{"type":")" + type +
         R"(","coordinates":)" + coordinates + "}}";
}

inline std::string Write(const std::string& path, const std::string& features,
                         const std::string& members = "") {
  std::ofstream(path) << R"({"type":"FeatureCollection",)" << members << R"("features":[)"
                      << features << "]}";
  return path;
}

inline VectorLayerOptions FillOnly(double opacity = 1.0) {
  VectorLayerOptions options;
  options.fill = {1.0, 0.0, 0.0, opacity};
  options.pixels = 0.0;
  return options;
}

} // namespace dspace::testing

#endif
