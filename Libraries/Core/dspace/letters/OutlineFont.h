// Letters as triangles, from a font's outlines.
#ifndef DSPACE_LETTERS_OUTLINE_FONT_H
#define DSPACE_LETTERS_OUTLINE_FONT_H

#include <memory>

#include <dspace/letters/FillContours.h>
#include <dspace/letters/FontFiles.h>

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
  double EmSize() const;     // the nominal size of the font

private:
  struct Face;
  std::unique_ptr<Face> Face_;
};

} // namespace dspace

#endif
