// Letters as triangles, from a font's outlines.
#ifndef DSPACE_RENDER_TEXT_OUTLINES_H
#define DSPACE_RENDER_TEXT_OUTLINES_H

#include <memory>

#include <dspace/render/text/FillContours.h>
#include <dspace/render/text/Fonts.h>

namespace dspace {

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
