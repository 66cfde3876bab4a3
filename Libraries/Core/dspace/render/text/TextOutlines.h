// Letters as triangles, from a font's outlines.
#ifndef DSPACE_RENDER_TEXT_OUTLINES_H
#define DSPACE_RENDER_TEXT_OUTLINES_H

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include <dspace/render/text/Fonts.h>

namespace dspace {

// A flat area in triangles, counter-clockwise; no corner lies within another triangle's side.
struct FlatArea {
  std::vector<Eigen::Vector2d> points;
  std::vector<std::uint32_t> triangles; // indices of points
};

// What closed contours of whole numbers enclose; where they run about a place more often one way
// than the other, it is inside. Contours may cross themselves and each other.
using Contour = std::vector<Eigen::Vector2i>;
FlatArea FillContours(const std::vector<Contour>& contours);

// A font's file, open. Its units are the height of a capital. Throws Error(Resource) where the file
// cannot be read.
class OutlineFont {
public:
  explicit OutlineFont(Font font);
  OutlineFont(const OutlineFont&) = delete;
  OutlineFont& operator=(const OutlineFont&) = delete;
  ~OutlineFont();

  struct Letter {
    FlatArea area;        // its origin on the baseline
    double advance = 0.0; // to the next letter's origin
  };
  Letter Read(char32_t character);
  double LineHeight() const; // from baseline to baseline

private:
  struct Face;
  std::unique_ptr<Face> Face_;
};

} // namespace dspace

#endif
