// A colour bar over a viewport's picture: the colours of a ramp and their values.
#ifndef DSPACE_SCENE_COLOR_BAR_H
#define DSPACE_SCENE_COLOR_BAR_H

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <dspace/overlay/Overlay.h>

namespace dspace {

// An ornament like a TextTable: physical-only pictures omit it. A vertical bar rises from `low`
// to `high`, with its ticks on the right; a horizontal one goes from left to right, with its ticks
// below. Over it stands "title [unit]".
struct ColorBar {
  std::string name;  // unique among the viewport's colour bars
  std::string title; // texts as of a TextTable
  std::string unit;  // "m", "deg", ...; of "deg" and "°" round values are those of a circle
  double low = 0.0;  // finite, low < high
  double high = 1.0;
  // sRGB, 0 to 1: evenly spaced from low to high, linear between; 1 to 1,024.
  std::vector<std::array<double, 3>> colors;
  int ticks = 6; // at most so many, at round values; 0 to 100
  std::vector<double>
      values; // where there are any: ticks there instead; from low to high, up to 100
  bool horizontal = false;
  TextTable::Anchor anchor = TextTable::Anchor::BottomRight;
  int margin = 8;     // pixels from both edges of the corner, 0 to 16,384
  int length = 200;   // of the bar, 16 to 8,192 pixels
  int thickness = 16; // 2 to 1,024 pixels
  int fontSize = 14;  // pixels, 4 to 200
  std::array<double, 4> textColor = {1, 1, 1, 1};         // sRGB and opacity, 0 to 1
  std::array<double, 4> backgroundColor = {0, 0, 0, 0.5}; // sRGB and opacity, 0 to 1
  // The terrain whose ramp, or the one of whose layer, the bar explains: it is shown while that is.
  // Empty: it is always shown.
  std::string terrain;
  std::string layer;

  bool operator==(const ColorBar& o) const;
  bool operator!=(const ColorBar& o) const { return !(*this == o); }

  // Throws Error(InvalidArgument) naming the bar and the value.
  void Check() const;
  // "title [unit]"; empty: no heading.
  std::string Heading() const;
  // Values and their texts, ascending.
  std::vector<std::pair<double, std::string>> Ticks() const;
  // The colour of a value; values outside the range get the colour of the nearer end.
  std::array<double, 3> ColorAt(double value) const;
};

// Where the parts of a colour bar stand: pixels from its box's lower left corner, y up.
struct ColorBarLayout {
  struct Box {
    int x = 0, y = 0, width = 0, height = 0;
  };
  struct Text {
    std::string text;
    int x = 0, y = 0;      // y is its middle
    bool centered = false; // x is its middle, else its left end
  };
  int width = 0, height = 0;
  Box bar;
  std::vector<Box> marks; // of the ticks
  std::vector<Text> texts;
};
ColorBarLayout LayOut(const ColorBar& bar);

} // namespace dspace

#endif
