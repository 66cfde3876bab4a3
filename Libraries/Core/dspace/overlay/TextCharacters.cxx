#include <dspace/overlay/TextCharacters.h>

#include <cstdio>

#include <dspace/Checks.h>
#include <dspace/Utf8.h>

namespace dspace {
namespace {

constexpr std::size_t QuotedLength = 40; // characters

} // namespace

std::vector<char32_t> Characters(const std::string& object, const char* what,
                                 const std::string& text) {
  std::vector<char32_t> characters;
  characters.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const char32_t character = NextCharacter(text, at);
    if (character == NoCharacter) {
      char byte[8];
      std::snprintf(byte, sizeof(byte), "0x%02X", unsigned(static_cast<unsigned char>(text[at])));
      Reject(object, std::string(what) + " holds the byte " + byte + " at place " +
                         std::to_string(at) + ", which is not UTF-8; accepted: UTF-8");
    }
    characters.push_back(character);
  }
  return characters;
}

std::string CharacterText(char32_t character) {
  char code[16];
  std::snprintf(code, sizeof(code), "U+%04X", unsigned(character));
  return IsControlCharacter(character) ? code : code + (" '" + CharacterBytes(character) + "'");
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
      Reject(object, std::string(what) + " holds the control character " +
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
    const char32_t character = NextCharacter(text, at);
    if (character == NoCharacter) {
      ++at;
    }
    quoted +=
        character == NoCharacter || IsControlCharacter(character) ? "?" : CharacterBytes(character);
  }
  return quoted + "'";
}

} // namespace dspace
