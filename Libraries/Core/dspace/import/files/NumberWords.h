// Words that programs write where a number is not finite: internal, not installed.
#ifndef DSPACE_IMPORT_NUMBER_WORDS_H
#define DSPACE_IMPORT_NUMBER_WORDS_H

#include <string>

namespace dspace {

// "nan", "inf", "infinity" in any case and with a sign, "-nan(ind)", and "1.#QNAN", "1.#INF",
// "-1.#IND", which Microsoft's libraries wrote.
bool IsNotFiniteWord(const std::string& word);

} // namespace dspace

#endif
