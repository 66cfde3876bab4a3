// The fonts in which text is drawn, and which characters they have.
#ifndef DSPACE_RENDER_FONTS_H
#define DSPACE_RENDER_FONTS_H

#include <string>

class vtkTextProperty;

namespace dspace {

// Not VTK's built-in fonts, which silently omit letters beyond Latin-1.
enum class Font {
  Sans, // DejaVu Sans: labels and letters in the scene
  Mono  // DejaVu Sans Mono, bold: tables; all characters are equally wide
};

// The font's file, which was found when Dspace was configured.
const char* FontFile(Font font);

// Throws Error(InvalidArgument) naming the first character of `text` that cannot be drawn: the font
// lacks it, or it is written from right to left (letters are set from left to right only);
// Error(Resource) where the font's file cannot be read.
void RequireGlyphs(const std::string& object, const char* what, const std::string& text, Font font);

// Throws Error(Resource): the font's file cannot be read.
[[noreturn]] void RejectFont(Font font);

// Text of this property is drawn in the font.
void UseFont(vtkTextProperty* look, Font font);

} // namespace dspace

#endif
