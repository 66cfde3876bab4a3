// Which characters the fonts have, and how VTK draws in them.
#ifndef DSPACE_RENDER_FONTS_H
#define DSPACE_RENDER_FONTS_H

#include <string>

#include <dspace/letters/FontFiles.h>

class vtkTextProperty;

namespace dspace {

// Throws Error(InvalidArgument) naming the first character of `text` that cannot be drawn: the font
// lacks it, or it is written from right to left (letters are set from left to right only);
// Error(Resource) where the font's file cannot be read.
void RequireGlyphs(const std::string& object, const char* what, const std::string& text, Font font);

// Text of this property is drawn in the font.
void UseFont(vtkTextProperty* look, Font font);

} // namespace dspace

#endif
