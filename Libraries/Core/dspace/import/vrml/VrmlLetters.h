// Text and AsciiText to meshes. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML_LETTERS_H
#define DSPACE_IMPORT_VRML_LETTERS_H

#include <string>
#include <vector>

#include <dspace/import/vrml/VrmlFaces.h>

namespace dspace {

// VRML97 6.22 and 6.47: horizontal lines from left to right, downwards.
struct VrmlLetters {
  enum class Justify { Begin, First, Middle, End };
  std::vector<std::string> lines; // UTF-8
  double size = 1.0;              // of the font
  double spacing = 1.0;           // from baseline to baseline, in sizes
  Justify major = Justify::Begin; // along the lines
  Justify minor = Justify::First; // across them
  std::vector<double> lengths;    // a line is stretched to its length, unless that is 0
  double maximumExtent = 0.0;     // all lines are compressed if one is longer; 0: any
};

// "BEGIN", "FIRST", "MIDDLE", "END"; anything else is `fallback`.
VrmlLetters::Justify VrmlJustify(const std::string& word, VrmlLetters::Justify fallback);

// Flat letters in XY that face +Z, of DejaVu Sans whatever the file's font. Empty, and a complaint,
// for sizes that are not positive or more than 4,096 characters.
Mesh MakeVrmlLetters(const VrmlLetters& letters, VrmlComplaints& complaints);

} // namespace dspace

#endif
