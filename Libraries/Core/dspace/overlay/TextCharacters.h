// The characters of a text, and the check for characters that no text may contain.
#ifndef DSPACE_SCENE_TEXT_CHARACTERS_H
#define DSPACE_SCENE_TEXT_CHARACTERS_H

#include <cstddef>
#include <string>
#include <vector>

namespace dspace {

// The characters of UTF-8. Throws Error(InvalidArgument) where it is none, naming the byte.
std::vector<char32_t> Characters(const std::string& object, const char* what,
                                 const std::string& text);

// "U+4E2D '中'"; control characters, which would spoil the message, without themselves.
std::string CharacterText(char32_t character);

// Tab, line break and other controls, and invisible characters that control layout and direction.
bool IsControlCharacter(char32_t character);

// Throws Error(InvalidArgument) where `text` is no UTF-8 or holds control characters; line breaks
// ('\n') are accepted if `lines` is true.
void RequirePlainText(const std::string& object, const char* what, const std::string& text,
                      bool lines);

// A text for a message: '<text>', its first characters only if it is long, controls as '?'.
std::string QuotedText(const std::string& text);

} // namespace dspace

#endif
