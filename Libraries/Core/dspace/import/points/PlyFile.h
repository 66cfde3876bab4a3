// A PLY file as its header describes it, and the values of its body. Internal, not installed.
#ifndef DSPACE_IMPORT_PLY_FILE_H
#define DSPACE_IMPORT_PLY_FILE_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace dspace {

enum class PlyType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };
std::size_t PlyTypeSize(PlyType type);
bool IsPlyInteger(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::Float32;
  bool list = false;
  PlyType countType = PlyType::UInt8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  int Find(const std::string& property) const; // index, or -1
};

struct PlyHeader {
  enum class Format { Text, LittleEndian, BigEndian };
  Format format = Format::Text;
  std::vector<PlyElement> elements;
  std::string texture;  // what MeshLab's "comment TextureFile" names; or empty
  std::size_t body = 0; // where the values begin
};

// Throws Error(Corrupt) naming the line, also when the file is too short for the rows that it
// claims, so that nothing is ever allocated for rows that cannot be there.
PlyHeader ParsePlyHeader(const std::string& bytes, const std::string& path);

// The values of the body, one after the other.
class PlyValues {
public:
  PlyValues(const std::string& bytes, const PlyHeader& header, const std::string& path);

  // The next value. `where` names the row that it belongs to, for errors.
  // Throws Error(Corrupt) at the end of the file or when a text is no number of that type.
  double Next(PlyType type, const PlyElement& element, std::uint64_t row);

  // A list of a row, its length first, checked against what is left of the file.
  void NextList(const PlyProperty& property, const PlyElement& element, std::uint64_t row,
                std::vector<double>& values);

  std::size_t BytesLeft() const; // white space of a text not counted

private:
  [[noreturn]] void Fail(const std::string& message, const PlyElement& element,
                         std::uint64_t row) const;
  double NextText(PlyType type, const PlyElement& element, std::uint64_t row);

  const std::string& Bytes_;
  PlyHeader::Format Format_;
  std::string Path_;
  std::size_t Position_;
};

} // namespace dspace

#endif
