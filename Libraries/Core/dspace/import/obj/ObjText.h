// An OBJ file checked line by line and rewritten for tinyobjloader: internal.
#ifndef DSPACE_IMPORT_OBJ_TEXT_H
#define DSPACE_IMPORT_OBJ_TEXT_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace dspace {

// The text for tinyobjloader in place of the file. The library takes NaN for zero, skips faces with
// bad indices, splits names at spaces and knows no continued lines; so every number is checked
// here, and its text has absolute indices and, as object names, numbers of sections.
struct ObjText {
  // Consecutive faces of one group and material.
  struct Section {
    std::string name;
    std::string material;                   // as the file names it; "" for none
    std::vector<std::uint32_t> faceCorners; // a face; tinyobjloader counts in a byte
  };
  std::string text;
  std::vector<Section> sections;
  std::size_t vertices = 0;
  std::vector<std::string> libraries; // what mtllib names, each the rest of its line
  std::vector<std::string> warnings;
  // Vertices, texture coordinates and normals, from 0, with a number that is not finite in float;
  // `text` has 0 in its place.
  std::vector<std::size_t> badVertices, badTcoords, badNormals;
};

// Throws Error(Corrupt) naming the line: a coordinate that is missing or no number, an index that
// is zero or out of range; Error(Resource) beyond `maximumTriangles`.
ObjText CheckObjText(const std::string& path, const std::string& bytes,
                     std::size_t maximumTriangles);

// Lines of an OBJ or MTL file: those that end in \ joined with the next, without comments (# at
// the start) and surrounding blanks; empty ones left out.
struct ObjLine {
  std::size_t number; // of the first, from 1
  std::string text;
};
class ObjLines {
public:
  explicit ObjLines(const std::string& bytes) : Bytes_(bytes) {}
  bool Next(ObjLine& line);

private:
  const std::string& Bytes_;
  std::size_t At_ = 0;
  std::size_t Number_ = 0;
};

// Splits a line at its first blank: keyword and rest, both without surrounding blanks.
void SplitKeyword(const std::string& line, std::string& keyword, std::string& rest);

} // namespace dspace

#endif
