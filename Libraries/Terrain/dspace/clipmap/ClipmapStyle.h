// The style over a clipmap's own colour: ramps, levels, contour lines, grids.
#ifndef DSPACE_TERRAIN_CLIPMAPSTYLE_H
#define DSPACE_TERRAIN_CLIPMAPSTYLE_H

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <dspace/import/model/Model.h>
#include <dspace/layers/PerlinNoise.h>
#include <dspace/scene/CustomGeometry.h>

namespace dspace {

// Stacked in this order, each with its opacity (0 to 1). Colours are sRGB, 0 to 1. Each element but
// the noise, which is the ground's shape, is shown and hidden with its fragment.
struct ClipmapStyle {
  // A tiling texture that adds structure closer than the posts: the colour times the texture's over
  // its mean, where slope and height are within their ranges (soft over 2 degrees and a fiftieth of
  // the heights' range). Tiles lie along the scene's axes from its origin. Planes only.
  struct Detail {
    static constexpr std::size_t Most = 2;
    std::shared_ptr<const Image> image;
    double size = 1.0;                           // [m] a tile's side, 1e-3 to 1e6
    std::array<double, 2> slopes = {0, 90};      // [deg]
    std::array<double, 2> heights = {-1e9, 1e9}; // [m] above the vertical datum
    double opacity = 0.5;
    Membership member = Membership::Physical();
    Eigen::Vector3d mean = Eigen::Vector3d::Ones(); // of the image, linear light: SetStyle finds it
  };
  // Where wheels have rolled, less so up the walls of their ruts.
  struct Tracks {
    std::array<double, 3> color = {0, 0, 0};
    double opacity = 0.35;
    Membership member = Membership::Physical();
    bool hidden = false; // ShownBy() sets it
  };
  struct Ramp {
    enum class By {
      Height, // [m] above the vertical datum
      Slope,  // [deg] from level
      Aspect, // azimuth of steepest descent [deg] clockwise from north, 0 to 360; level ground,
              // which has none, keeps its colour
      Normal  // no ramp: the colour is 0.5 + 0.5 n, n in the place's east, north, up
    };
    By by = By::Height;
    std::array<double, 2> range = {0, 1}; // values of its two ends; beyond them the end's colour
    std::shared_ptr<const Image> image; // a row of pixels: left is the first value; none of Normal
    std::vector<std::array<double, 3>> colors; // that the image shows, evenly spaced: for legends
    double opacity = 1.0;
    Membership member = {};
    // Whether lights shade it and what lies over it; false: its colours are those of its legend.
    bool shaded = false;
  };
  struct Lines {
    double interval = 1.0; // contours: [m]; grid: [map units] (degrees of a degree grid)
    double width = 1.0;    // pixels, (0, 64]
    std::array<double, 3> color = {0, 0, 0};
    double opacity = 1.0;
    Membership member = {};
  };
  // Heights of noise on what is drawn, below the data's resolution: decoration. Pictures, their
  // depth images and labels, and this style's ramps and lines have it; queries, analyses, tracks
  // and what stands on the ground do not. It is to be off where something is measured in a picture.
  // A post has the octaves that its level's posts resolve (two to four posts a wavelength): with a
  // `wavelength` of at most two of the data's pixels only posts closer than those differ.
  struct Noise {
    NoiseOptions options;
    double amplitude = 0.1; // [m] that the longest octave adds at most, (0, 1e6]
    bool operator==(const Noise& o) const {
      return this->options == o.options && this->amplitude == o.amplitude;
    }
  };
  // The values of the grid's lines, written over the picture where the grid is shown.
  struct GridLabels {
    int fontSize = 13; // pixels, 4 to 200
    std::array<double, 3> color = {1, 1, 1};
    std::array<double, 3> background = {0, 0, 0}; // of the box behind a value
    double backgroundOpacity = 0.5;
    bool degrees = false; // "12°E", "30°S"; else map units, "4,500 E", "-200 N"
  };
  std::vector<Detail> details; // at most Detail::Most
  Tracks tracks;               // where there are any
  std::optional<Ramp> ramp;
  std::optional<double> levels; // opacity of a colour for each clipmap level
  Membership levelsMember = {};
  std::optional<Lines> contours;
  std::optional<Lines> grid;            // along the map's axes
  std::optional<GridLabels> gridLabels; // only with a grid
  std::optional<Noise> noise;           // of the ground's shape

  bool Empty() const { return details.empty() && !ramp && !levels && !contours && !grid; }
  // The elements that there are; the tracks only in a fragment that is not their standard one.
  std::vector<CustomGeometry::Member> Members() const;
  // Without the elements whose membership is not shown.
  ClipmapStyle ShownBy(const std::function<bool(const Membership&)>& shown) const;
  // Throws Error(InvalidArgument) naming `terrain` and the value.
  void Check(const std::string& terrain) const;
};

} // namespace dspace

#endif
