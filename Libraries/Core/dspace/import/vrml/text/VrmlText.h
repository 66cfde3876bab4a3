// The text of a VRML or Inventor file: unpacked, its dialect known. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML_TEXT_H
#define DSPACE_IMPORT_VRML_TEXT_H

#include <string>

namespace dspace {

enum class VrmlDialect {
  Vrml1, // VRML 1.0 and Inventor 2 text: a state machine of nodes
  Vrml2  // VRML 2.0 (VRML97)
};

struct VrmlText {
  VrmlDialect dialect = VrmlDialect::Vrml2;
  std::string header; // first line, as Coin wants it
  std::string body;   // everything after the first line: line 2 of the file is its first
};

// Reads `path`, unpacking gzip. Throws Error: NotFound, Io, Unsupported (binary Inventor, another
// VRML version), Corrupt (no VRML header, damaged gzip, NUL bytes), Resource (over 512 MiB
// unpacked). Text of another encoding becomes UTF-8 (FileText.h).
VrmlText ReadVrmlText(const std::string& path);

} // namespace dspace

#endif
