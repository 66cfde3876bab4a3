// UTF-8, the encoding of every text that Dspace stores, sends and records, and conversion into it.
// All decoding of characters is here.
#ifndef DSPACE_UTF8_H
#define DSPACE_UTF8_H

#include <cstddef>
#include <string>
#include <string_view>

namespace dspace {

constexpr char32_t NoCharacter = 0xFFFFFFFF;

// The character whose bytes begin at `at`, which moves behind them. NoCharacter, with `at`
// unmoved, where no character begins there: a byte of another encoding, an overlong form, a
// surrogate, a character that is cut off. `at` must be less than text.size().
char32_t NextCharacter(const std::string& text, std::size_t& at);

// A character's bytes.
std::string CharacterBytes(char32_t character);

// Whether the whole text is UTF-8. An empty text is.
bool IsUtf8(const std::string& text);

// The text as UTF-8, for text from a file or a library that may be in another encoding. Text that
// is UTF-8 returns unchanged. In other text each byte that is no part of a character of UTF-8 is
// taken as Windows-1252, which agrees with Latin-1 on all letters; the five bytes that
// Windows-1252 leaves open become U+FFFD. Never throws an Error. Different texts may become equal:
// a reader whose names must differ compares them after this.
std::string ToUtf8(std::string text);

// The beginning of a text of UTF-8, at most `bytes` long, not cut within a character.
std::string Utf8Beginning(std::string_view text, std::size_t bytes);

} // namespace dspace

#endif
