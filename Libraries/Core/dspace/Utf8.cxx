#include <dspace/Utf8.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace dspace {
namespace {

constexpr char32_t Replacement = 0xFFFD;

// What Windows-1252 has at 0x80 to 0x9F, where Latin-1 has control characters.
constexpr char32_t Windows1252[32] = {
    0x20AC,      Replacement, 0x201A, 0x0192, 0x201E, 0x2026,      0x2020, 0x2021,
    0x02C6,      0x2030,      0x0160, 0x2039, 0x0152, Replacement, 0x017D, Replacement,
    Replacement, 0x2018,      0x2019, 0x201C, 0x201D, 0x2022,      0x2013, 0x2014,
    0x02DC,      0x2122,      0x0161, 0x203A, 0x0153, Replacement, 0x017E, 0x0178};

char32_t FromWindows1252(unsigned char byte) {
  return byte >= 0x80 && byte < 0xA0 ? Windows1252[byte - 0x80] : byte;
}

// Moves `at` over bytes of ASCII, eight at a time: files of hundreds of megabytes are read.
void SkipAscii(const std::string& text, std::size_t& at) {
  constexpr std::uint64_t High = 0x8080808080808080u;
  std::uint64_t eight = 0;
  while (at + sizeof(eight) <= text.size()) {
    std::memcpy(&eight, text.data() + at, sizeof(eight));
    if ((eight & High) != 0) {
      break;
    }
    at += sizeof(eight);
  }
  while (at < text.size() && static_cast<unsigned char>(text[at]) < 0x80) {
    ++at;
  }
}

// Where the first byte is that is not UTF-8; text.size() where there is none.
std::size_t FirstForeign(const std::string& text, std::size_t at) {
  for (SkipAscii(text, at); at < text.size(); SkipAscii(text, at)) {
    if (NextCharacter(text, at) == NoCharacter) {
      return at;
    }
  }
  return at;
}

} // namespace

char32_t NextCharacter(const std::string& text, std::size_t& at) {
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

std::string CharacterBytes(char32_t c) {
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

bool IsUtf8(const std::string& text) {
  return FirstForeign(text, 0) == text.size();
}

std::string ToUtf8(std::string text) {
  std::size_t foreign = FirstForeign(text, 0);
  if (foreign == text.size()) {
    return text;
  }
  std::string out;
  out.reserve(text.size() + text.size() / 8);
  std::size_t at = 0;
  while (foreign < text.size()) {
    out.append(text, at, foreign - at);
    out += CharacterBytes(FromWindows1252(static_cast<unsigned char>(text[foreign])));
    at = foreign + 1;
    foreign = FirstForeign(text, at);
  }
  return out.append(text, at, std::string::npos);
}

std::string Utf8Beginning(std::string_view text, std::size_t bytes) {
  bytes = std::min(bytes, text.size());
  while (bytes > 0 && bytes < text.size() &&
         (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) {
    --bytes;
  }
  return std::string(text.substr(0, bytes));
}

} // namespace dspace
