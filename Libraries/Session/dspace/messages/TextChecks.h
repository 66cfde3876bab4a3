// Checks of text in commands: length and control characters. Inside the library only.
#ifndef DSPACE_SESSION_TEXT_CHECKS_H
#define DSPACE_SESSION_TEXT_CHECKS_H

#include <string>

#include <dspace/Checks.h>
#include <dspace/overlay/TextCharacters.h>

namespace dspace::session {

// Requires up to `most` bytes without control characters; `lines` allows line breaks.
inline void RequireShortText(const std::string& object, const char* what, const std::string& text,
                             std::size_t most, bool lines) {
  if (text.size() > most) {
    Reject(object, std::string(what) + " has " + std::to_string(text.size()) +
                       " bytes; accepted: up to " + std::to_string(most));
  }
  RequirePlainText(object, what, text, lines);
}

inline void RequireLine(const std::string& object, const char* what, const std::string& text,
                        std::size_t most) {
  RequireShortText(object, what, text, most, false);
}

inline void RequireLines(const std::string& object, const char* what, const std::string& text,
                         std::size_t most) {
  RequireShortText(object, what, text, most, true);
}

// Requires a non-empty line.
inline void RequireWord(const std::string& object, const char* what, const std::string& text,
                        std::size_t most) {
  if (text.empty()) {
    Reject(object, std::string(what) + " is empty; accepted: 1 to " + std::to_string(most) +
                       " bytes without control characters");
  }
  RequireLine(object, what, text, most);
}

} // namespace dspace::session

#endif
