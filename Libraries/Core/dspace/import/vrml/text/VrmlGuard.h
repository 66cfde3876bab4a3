// Rewrites a VRML file for Coin after strict checks of its text. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML_GUARD_H
#define DSPACE_IMPORT_VRML_GUARD_H

#include <dspace/import/vrml/text/VrmlText.h>

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

namespace dspace {

struct GuardedVrml {
  std::string text;                                   // what Coin is given
  std::unordered_map<std::string, std::string> names; // DEF name in `text` -> name in the file
  // DEF name in `text` of a VRML 1.0 Texture2 -> its file name, which Coin would open at once.
  std::unordered_map<std::string, std::string> textures;
  std::map<std::string, int> leftOut; // types of nodes that a Model cannot hold, and how many
};

// Coin crashes, hangs or opens files on its own on some input, so it never sees the file itself but
// a text rewritten from it, with only the nodes and fields of VrmlNodeTable, every value checked
// for its type. Left out, with a warning each kind: unknown nodes and fields, EXTERNPROTO, USE of
// an unknown name, text; silently: ROUTE, scripts, sensors, lights, viewpoints.
// DEF, PROTO and interface names are replaced by numbered ones.
// Throws Error: Corrupt (a syntax error, with its line; a number that is none, not finite, or out
// of range; USE of a node inside itself; a field of nodes that one node is given twice), Resource
// (nodes nested deeper than 256 through braces, USE and PROTO; more than 1,000,000 nodes when each
// USE is counted, or 200,000 copies by PROTO).
GuardedVrml GuardVrml(const VrmlText& text, const std::string& path,
                      std::vector<std::string>& warnings);

} // namespace dspace

#endif
