// Names that may have been meant by one that does not exist.
#ifndef DSPACE_SESSION_NEAR_MATCHES_H
#define DSPACE_SESSION_NEAR_MATCHES_H

#include <string>
#include <vector>

namespace dspace::session {

// Up to three of `names` that are close to `wanted`, the closest first: the same in other case, or
// with at most a third of its bytes (rounded up) changed, added or left out (Levenshtein's
// distance), or one that contains the other. Of paths ("rover/mast") the last parts are compared.
std::vector<std::string> NearMatches(const std::string& wanted,
                                     const std::vector<std::string>& names);

// "; near matches: 'a', 'b'", or an empty text.
std::string NearMatchesText(const std::string& wanted, const std::vector<std::string>& names);

} // namespace dspace::session

#endif
