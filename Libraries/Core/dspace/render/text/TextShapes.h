// Text as geometry: solid letters in the scene, and labels that face the camera.
#ifndef DSPACE_RENDER_TEXT_SHAPES_H
#define DSPACE_RENDER_TEXT_SHAPES_H

#include <array>
#include <memory>
#include <string>

#include <dspace/scene/GraphicsObject.h>

namespace dspace {

// Letters as flat triangles in XY, facing +Z, the baseline along X from the origin; a capital
// letter is `height` metres high. UTF-8 of the characters that the font has (Fonts.h); lines are
// separated by '\n'. Throws Error(InvalidArgument) for an empty text, one of more than 4,096
// characters, a character that cannot be drawn, or a height outside 1e-9 to 1e15 m.
Mesh MakeTextMesh(const std::string& text, double height);

// A billboard (GraphicsObject::billboard): a textured rectangle in pixels whose lower left corner
// stands `offset` pixels right of and above the object's origin. Characters as in MakeTextMesh().
// Size is the font's in pixels, 4 to 200; up to 4,096 characters, and a picture of up to 16,384
// pixels a side and 64 Mi pixels in all. Colours are sRGB with opacity, 0 to 1.
struct LabelStyle {
  int fontSize = 16;
  std::array<double, 3> color = {1, 1, 1};
  std::array<double, 3> background = {0, 0, 0};
  double backgroundOpacity = 0.45;
  std::array<double, 2> offset = {6, 6};
};
Part MakeLabel(const std::string& text, const LabelStyle& style = {});

} // namespace dspace

#endif
