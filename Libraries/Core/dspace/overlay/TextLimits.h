// How long texts may be, and how large their pictures.
#ifndef DSPACE_SCENE_TEXT_LIMITS_H
#define DSPACE_SCENE_TEXT_LIMITS_H

#include <algorithm>
#include <cstddef>
#include <string>

#include <dspace/Checks.h>

namespace dspace {

constexpr std::size_t MaximumTextLength = 4096;      // characters
constexpr std::size_t MaximumTableCells = 1000;      // labels and values together
constexpr double MaximumTextSide = 16384.0;          // pixels
constexpr double MaximumTextArea = 64.0 * (1 << 20); // pixels

// Characters, not bytes, of UTF-8.
inline std::size_t CharacterCount(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

inline void RequireTextLength(const std::string& object, const char* what,
                              const std::string& text) {
  // The count of bytes too: a text that is no UTF-8 may have no characters.
  const std::size_t count = std::max(CharacterCount(text), text.size() / 4);
  if (count > MaximumTextLength) {
    Reject(object, std::string(what) + " has " + std::to_string(count) +
                       " characters; accepted: up to " + std::to_string(MaximumTextLength));
  }
}

inline void RequireTextPicture(const std::string& object, double width, double height) {
  if (!(width <= MaximumTextSide && height <= MaximumTextSide &&
        width * height <= MaximumTextArea)) {
    Reject(object, "it is " + NumberText(width) + " x " + NumberText(height) +
                       " pixels large; accepted: up to " + NumberText(MaximumTextSide) +
                       " a side and " + NumberText(MaximumTextArea) +
                       " in all: fewer characters a line or a smaller font");
  }
}

} // namespace dspace

#endif
