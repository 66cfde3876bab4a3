// Areas within contours, as triangles.
#ifndef DSPACE_LETTERS_FILL_CONTOURS_H
#define DSPACE_LETTERS_FILL_CONTOURS_H

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace dspace {

// A flat area in triangles, counter-clockwise; no corner lies within another triangle's side.
struct FlatArea {
  std::vector<Eigen::Vector2d> points;
  std::vector<std::uint32_t> triangles; // indices of points
};

// Fills the inside of closed contours with integer coordinates. Where they run about a place more
// often one way than the other, it is inside. Contours may cross themselves and each other.
using Contour = std::vector<Eigen::Vector2i>;
FlatArea FillContours(const std::vector<Contour>& contours);

} // namespace dspace

#endif
