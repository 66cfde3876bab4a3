#include <dspace/render/text/Fonts.h>

#include <algorithm>
#include <vector>

#include <ft2build.h>
#include FT_FREETYPE_H

#include "vtkTextProperty.h"

#include <dspace/Checks.h>
#include <dspace/Error.h>
#include <dspace/overlay/TextCharacters.h>

namespace dspace {
namespace {

const char* FontName(Font font) {
  return font == Font::Sans ? "DejaVu Sans" : "DejaVu Sans Mono";
}

// VTK's text draws nothing for characters beyond these.
constexpr FT_ULong LastCharacter = 0xFFFF;

// Those that can be drawn, sorted.
std::vector<char32_t> ReadCharacters(Font font) {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  std::vector<char32_t> characters;
  if (FT_Init_FreeType(&library) == 0) {
    if (FT_New_Face(library, FontFile(font), 0, &face) == 0) {
      FT_UInt glyph = 0;
      for (FT_ULong c = FT_Get_First_Char(face, &glyph); glyph != 0 && c <= LastCharacter;
           c = FT_Get_Next_Char(face, c, &glyph)) {
        characters.push_back(static_cast<char32_t>(c));
      }
      FT_Done_Face(face);
    }
    FT_Done_FreeType(library);
  }
  if (characters.empty()) {
    RejectFont(font);
  }
  return characters;
}

// Read when first asked for; what threw is tried again the next time.
const std::vector<char32_t>& CharactersOf(Font font) {
  if (font == Font::Sans) {
    static const std::vector<char32_t> sans = ReadCharacters(Font::Sans);
    return sans;
  }
  static const std::vector<char32_t> mono = ReadCharacters(Font::Mono);
  return mono;
}

// Blocks of Hebrew, Arabic and their neighbours (Unicode's bidirectional classes R and AL).
bool IsRightToLeft(char32_t c) {
  return (c >= 0x0590 && c <= 0x08FF) || (c >= 0xFB1D && c <= 0xFDFF) ||
         (c >= 0xFE70 && c <= 0xFEFF) || (c >= 0x10800 && c <= 0x10FFF) ||
         (c >= 0x1E800 && c <= 0x1EFFF);
}

} // namespace

void RequireGlyphs(const std::string& object, const char* what, const std::string& text,
                   Font font) {
  const std::vector<char32_t>& known = CharactersOf(font);
  for (const char32_t character : Characters(object, what, text)) {
    if (character == U'\n') {
      continue;
    }
    const std::string rejected = std::string(what) + " holds " + CharacterText(character);
    if (IsRightToLeft(character)) {
      Reject(object, rejected + ", of a script that is written from right to left; accepted: "
                                "scripts written from left to right");
    }
    if (!std::binary_search(known.begin(), known.end(), character)) {
      Reject(object,
             rejected + ", which the font " + FontName(font) +
                 " lacks; accepted: the font's characters up to U+FFFF (Latin, Greek, Cyrillic and "
                 "other alphabets, mathematical signs, arrows)");
    }
  }
}

void UseFont(vtkTextProperty* look, Font font) {
  look->SetFontFamily(VTK_FONT_FILE);
  look->SetFontFile(FontFile(font));
}

} // namespace dspace
