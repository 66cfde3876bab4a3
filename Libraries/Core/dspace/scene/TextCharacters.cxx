#include <dspace/scene/TextCharacters.h>

#include <cstdint>
#include <cstdio>

#include <dspace/scene/Checks.h>

namespace dspace {
namespace {

constexpr char32_t NoCharacter = 0xFFFFFFFF;
constexpr std::size_t QuotedLength = 40; // characters

// The character that begins at `at`, which is moved past it; NoCharacter, and `at` unmoved, where
// none begins there.
char32_t Next(const std::string& text, std::size_t& at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(at);
  const int more = first < 0x80 ? 0 : first < 0xC2 ? -1 : first < 0xE0 ? 1 : first < 0xF0 ? 2 : 3;
  if (more < 0 || first > 0xF4 || at + std::size_t(more) >= text.size()) {
    return NoCharacter;
  }
  char32_t character = more == 0 ? first : first & (0x3F >> more);
  for (std::size_t i = at + 1; i <= at + std::size_t(more); ++i) {
    if ((byte(i) & 0xC0) != 0x80) {
      return NoCharacter;
    }
    character = character << 6 | (byte(i) & 0x3F);
  }
  const bool overlong = (more == 2 && character < 0x800) || (more == 3 && character < 0x10000);
  const bool surrogate = character >= 0xD800 && character <= 0xDFFF;
  if (overlong || surrogate || character > 0x10FFFF) {
    return NoCharacter;
  }
  at += std::size_t(more) + 1;
  return character;
}

std::string ToUtf8(char32_t c) {
  std::string text;
  if (c < 0x80) {
    return {char(c)};
  }
  int shift = c < 0x800 ? 6 : c < 0x10000 ? 12 : 18;
  text += char((c < 0x800 ? 0xC0 : c < 0x10000 ? 0xE0 : 0xF0) | (c >> shift));
  while (shift > 0) {
    shift -= 6;
    text += char(0x80 | ((c >> shift) & 0x3F));
  }
  return text;
}

} // namespace

std::vector<char32_t> Characters(const std::string& object, const char* what,
                                 const std::string& text) {
  std::vector<char32_t> characters;
  characters.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const char32_t character = Next(text, at);
    if (character == NoCharacter) {
      char byte[8];
      std::snprintf(byte, sizeof(byte), "0x%02X", unsigned(static_cast<unsigned char>(text[at])));
      Refuse(object, std::string(what) + " holds the byte " + byte + " at place " +
                         std::to_string(at) + ", which is no UTF-8; accepted: UTF-8");
    }
    characters.push_back(character);
  }
  return characters;
}

std::string CharacterText(char32_t character) {
  char code[16];
  std::snprintf(code, sizeof(code), "U+%04X", unsigned(character));
  return IsControlCharacter(character) ? code : code + (" '" + ToUtf8(character) + "'");
}

bool IsControlCharacter(char32_t c) {
  return c < 0x20 || (c >= 0x7F && c < 0xA0) || c == 0x34F || (c >= 0x200B && c <= 0x200F) ||
         (c >= 0x2028 && c <= 0x202E) || (c >= 0x2060 && c <= 0x206F) ||
         (c >= 0xFE00 && c <= 0xFE0F) || c == 0xFEFF || (c >= 0xFFF0 && c <= 0xFFFC);
}

void RequirePlainText(const std::string& object, const char* what, const std::string& text,
                      bool lines) {
  for (const char32_t character : Characters(object, what, text)) {
    if (IsControlCharacter(character) && !(lines && character == U'\n')) {
      Refuse(object, std::string(what) + " holds the control character " +
                         CharacterText(character) + "; accepted: " +
                         (lines ? "line breaks and no other" : "none (no tab, no line break)"));
    }
  }
}

std::string QuotedText(const std::string& text) {
  std::string quoted = "'";
  std::size_t at = 0;
  for (std::size_t count = 0; at < text.size(); ++count) {
    if (count == QuotedLength) {
      return quoted + "...'";
    }
    const char32_t character = Next(text, at);
    if (character == NoCharacter) {
      ++at;
    }
    quoted += character == NoCharacter || IsControlCharacter(character) ? "?" : ToUtf8(character);
  }
  return quoted + "'";
}

} // namespace dspace
