// The names by which model files name other files: internal.
#ifndef DSPACE_IMPORT_FILE_NAMES_H
#define DSPACE_IMPORT_FILE_NAMES_H

#include <string>

namespace dspace {

// Lower-case extension with its dot (".obj"), or "".
std::string LowerExtension(const std::string& path);

// `text` with %XX decoded; an escape that is not two hexadecimal digits stays as it is.
std::string PercentDecode(const std::string& text);

// The file that `reference`, written in `fromFile`, names: relative to fromFile's folder, with
// \ read as / and bytes of another encoding as ToUtf8 (Utf8.h) takes them. Confined: throws
// Error(Unsupported) for absolute names, other schemes (http:, ...) and names that lead out of the
// folder above fromFile's own, so that a hostile model reads no other file.
std::string ResolveReference(const std::string& fromFile, const std::string& reference);

} // namespace dspace

#endif
