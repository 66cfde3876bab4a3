// Text tables over a viewport's picture.
#ifndef DSPACE_SCENE_OVERLAY_H
#define DSPACE_SCENE_OVERLAY_H

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace dspace {

// A table of labels and values in a corner of a viewport. Overlays are ornaments: physical-only
// pictures omit them.
struct TextTable {
  enum class Anchor { TopLeft, TopRight, BottomLeft, BottomRight };
  std::string name; // unique in the viewport
  // UTF-8 without line breaks, tabs and other control characters, up to 4,096 characters a text and
  // 1,000 cells.
  std::string title;                                     // empty: no title line
  std::vector<std::pair<std::string, std::string>> rows; // label, value
  Anchor anchor = Anchor::TopLeft;
  int margin = 8;                                 // pixels from both edges of the corner, >= 0
  int fontSize = 14;                              // pixels, 4 to 200
  std::array<double, 4> textColor = {1, 1, 1, 1}; // sRGB and opacity, 0 to 1
  std::array<double, 4> backgroundColor = {0, 0, 0, 0.5}; // sRGB and opacity, 0 to 1
  // Values that are not in textColor, by their row from 0: sRGB, 0 to 1. Their opacity is the
  // text's.
  std::map<std::size_t, std::array<double, 3>> valueColors;

  bool operator==(const TextTable& o) const {
    return this->name == o.name && this->title == o.title && this->rows == o.rows &&
           this->anchor == o.anchor && this->margin == o.margin && this->fontSize == o.fontSize &&
           this->textColor == o.textColor && this->backgroundColor == o.backgroundColor &&
           this->valueColors == o.valueColors;
  }
  bool operator!=(const TextTable& o) const { return !(*this == o); }

  // Throws Error(InvalidArgument) naming the table and the value.
  void Check() const;
};

} // namespace dspace

#endif
