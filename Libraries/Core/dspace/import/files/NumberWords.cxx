#include <dspace/import/files/NumberWords.h>

#include <cctype>

namespace dspace {

bool IsNotFiniteWord(const std::string& word) {
  std::string text;
  for (const char c : word) {
    text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
    text.erase(0, 1);
  }
  return text == "nan" || text == "inf" || text == "infinity" || text.rfind("nan(", 0) == 0 ||
         text.rfind("1.#", 0) == 0;
}

} // namespace dspace
