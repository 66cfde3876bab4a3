// The files of the fonts in which text is drawn.
#ifndef DSPACE_LETTERS_FONT_FILES_H
#define DSPACE_LETTERS_FONT_FILES_H

namespace dspace {

// Not VTK's built-in fonts, which silently omit letters beyond Latin-1.
enum class Font {
  Sans, // DejaVu Sans: labels and letters in the scene
  Mono  // DejaVu Sans Mono, bold: tables; all characters are equally wide
};

// The font's file, which was found when Dspace was configured.
const char* FontFile(Font font);

// Throws Error(Resource): the font's file cannot be read.
[[noreturn]] void RejectFont(Font font);

} // namespace dspace

#endif
