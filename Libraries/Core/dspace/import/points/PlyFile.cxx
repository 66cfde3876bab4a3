#include <dspace/import/points/PlyFile.h>

#include <dspace/import/files/ImportFile.h>
#include <dspace/import/files/NumberWords.h>

#include <dspace/Error.h>
#include <dspace/Utf8.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

namespace dspace {

namespace {

struct TypeName {
  const char* name;
  PlyType type;
};
constexpr TypeName TypeNames[] = {
    {"char", PlyType::Int8},      {"int8", PlyType::Int8},       {"uchar", PlyType::UInt8},
    {"uint8", PlyType::UInt8},    {"short", PlyType::Int16},     {"int16", PlyType::Int16},
    {"ushort", PlyType::UInt16},  {"uint16", PlyType::UInt16},   {"int", PlyType::Int32},
    {"int32", PlyType::Int32},    {"uint", PlyType::UInt32},     {"uint32", PlyType::UInt32},
    {"float", PlyType::Float32},  {"float32", PlyType::Float32}, {"double", PlyType::Float64},
    {"float64", PlyType::Float64}};

constexpr std::size_t MaximumHeaderLines = 10000;

bool IsSpace(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

// The header's lines, ended by \n, \r\n or \r.
class Lines {
public:
  Lines(const std::string& bytes, const std::string& path) : Bytes_(bytes), Path_(path) {}

  std::vector<std::string> Next() {
    const std::size_t end = this->Bytes_.find_first_of("\r\n", this->Position_);
    if (end == std::string::npos || ++this->Line_ > MaximumHeaderLines) {
      this->Fail("the header has no 'end_header'");
    }
    std::istringstream line(this->Bytes_.substr(this->Position_, end - this->Position_));
    this->Position_ = end + (this->Bytes_.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    std::vector<std::string> words;
    for (std::string word; line >> word;) {
      words.push_back(word);
    }
    return words;
  }

  std::size_t Position() const { return this->Position_; }

  [[noreturn]] void Fail(const std::string& message) const {
    throw Error(Error::Kind::Corrupt, FileObject(this->Path_),
                "header line " + std::to_string(this->Line_) + ": " + message);
  }

private:
  const std::string& Bytes_;
  std::string Path_;
  std::size_t Position_ = 0;
  std::size_t Line_ = 0;
};

PlyType ParseType(const std::string& word, const Lines& lines) {
  for (const TypeName& type : TypeNames) {
    if (word == type.name) {
      return type.type;
    }
  }
  lines.Fail("'" + Utf8Beginning(word, 60) +
             "' is not a type; char, uchar, short, ushort, int, uint, "
             "float and double are");
}

PlyProperty ParseProperty(const std::vector<std::string>& words, const Lines& lines) {
  PlyProperty property;
  if (words.size() == 5 && words[1] == "list") {
    property.list = true;
    property.countType = ParseType(words[2], lines);
    property.type = ParseType(words[3], lines);
  } else if (words.size() == 3) {
    property.type = ParseType(words[1], lines);
  } else {
    lines.Fail("'property <type> <name>' or 'property list <type> <type> <name>' is expected");
  }
  property.name = words.back();
  return property;
}

PlyHeader::Format ParseFormat(const std::vector<std::string>& words, const Lines& lines) {
  if (words.size() == 3 && words[0] == "format" && words[2] == "1.0") {
    if (words[1] == "ascii") {
      return PlyHeader::Format::Text;
    }
    if (words[1] == "binary_little_endian") {
      return PlyHeader::Format::LittleEndian;
    }
    if (words[1] == "binary_big_endian") {
      return PlyHeader::Format::BigEndian;
    }
  }
  lines.Fail("'format ascii|binary_little_endian|binary_big_endian 1.0' is expected");
}

// Fewest bytes that a row can have: in a text, a digit and a separator a value.
std::size_t LeastRowSize(const PlyElement& element, PlyHeader::Format format) {
  std::size_t size = 0;
  for (const PlyProperty& property : element.properties) {
    size += format == PlyHeader::Format::Text
                ? 2
                : PlyTypeSize(property.list ? property.countType : property.type);
  }
  return size;
}

} // namespace

std::size_t PlyTypeSize(PlyType type) {
  static constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

bool IsPlyInteger(PlyType type) {
  return type != PlyType::Float32 && type != PlyType::Float64;
}

int PlyElement::Find(const std::string& property) const {
  for (std::size_t i = 0; i < this->properties.size(); ++i) {
    if (this->properties[i].name == property) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

PlyHeader ParsePlyHeader(const std::string& bytes, const std::string& path) {
  Lines lines(bytes, path);
  PlyHeader header;
  if (lines.Next() != std::vector<std::string>{"ply"}) {
    lines.Fail("'ply' is expected");
  }
  bool format = false;
  for (std::vector<std::string> words = lines.Next();
       words != std::vector<std::string>{"end_header"}; words = lines.Next()) {
    if (words.size() > 2 && words[0] == "comment" && words[1] == "TextureFile") {
      header.texture = words[2];
      for (std::size_t i = 3; i < words.size(); ++i) {
        header.texture += " " + words[i];
      }
    }
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") {
      continue;
    }
    if (words[0] == "format") {
      header.format = ParseFormat(words, lines);
      format = true;
    } else if (words[0] == "element") {
      PlyElement element;
      const std::string count = words.size() == 3 ? words[2] : "";
      const auto result = std::from_chars(count.data(), count.data() + count.size(), element.count);
      if (count.empty() || result.ec != std::errc() || result.ptr != count.data() + count.size()) {
        lines.Fail("'element <name> <count>' is expected");
      }
      element.name = words[1];
      header.elements.push_back(element);
    } else if (words[0] == "property" && !header.elements.empty()) {
      PlyElement& element = header.elements.back();
      element.properties.push_back(ParseProperty(words, lines));
      if (element.Find(words.back()) + 1 != static_cast<int>(element.properties.size())) {
        lines.Fail("property '" + words.back() + "' of " + element.name + " is given twice");
      }
    } else {
      lines.Fail("'" + Utf8Beginning(words[0], 60) + "' is not understood");
    }
  }
  if (!format) {
    lines.Fail("there is no 'format' line");
  }
  header.body = lines.Position();
  std::size_t room = bytes.size() - header.body + 1; // the last value may lack its separator
  for (const PlyElement& element : header.elements) {
    const std::size_t least = LeastRowSize(element, header.format);
    if (element.count > 0 && (least == 0 || element.count > room / least)) {
      throw Error(Error::Kind::Corrupt, FileObject(path),
                  "element " + element.name + ": " + std::to_string(element.count) + " rows of " +
                      std::to_string(element.properties.size()) + " properties do not fit in " +
                      std::to_string(bytes.size() - header.body) + " bytes");
    }
    room -= static_cast<std::size_t>(element.count) * least;
  }
  return header;
}

PlyValues::PlyValues(const std::string& bytes, const PlyHeader& header, const std::string& path)
    : Bytes_(bytes), Format_(header.format), Path_(path), Position_(header.body) {}

void PlyValues::Fail(const std::string& message, const PlyElement& element,
                     std::uint64_t row) const {
  throw Error(Error::Kind::Corrupt, FileObject(this->Path_),
              element.name + " " + std::to_string(row) + ": " + message);
}

double PlyValues::Next(PlyType type, const PlyElement& element, std::uint64_t row) {
  if (this->Format_ == PlyHeader::Format::Text) {
    return this->NextText(type, element, row);
  }
  const std::size_t size = PlyTypeSize(type);
  if (this->Bytes_.size() - this->Position_ < size) {
    this->Fail("the file ends here", element, row);
  }
  std::array<unsigned char, 8> b = {};
  std::memcpy(b.data(), this->Bytes_.data() + this->Position_, size);
  this->Position_ += size;
  if (this->Format_ == PlyHeader::Format::BigEndian) {
    std::reverse(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(size));
  }
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i) {
    bits |= static_cast<std::uint64_t>(b[i]) << (8 * i);
  }
  switch (type) {
  case PlyType::Int8:
    return static_cast<std::int8_t>(bits);
  case PlyType::Int16:
    return static_cast<std::int16_t>(bits);
  case PlyType::Int32:
    return static_cast<std::int32_t>(bits);
  case PlyType::Float32: {
    const auto bits32 = static_cast<std::uint32_t>(bits);
    float value = 0.0f;
    std::memcpy(&value, &bits32, sizeof value);
    return value;
  }
  case PlyType::Float64: {
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  default:
    return static_cast<double>(bits);
  }
}

double PlyValues::NextText(PlyType type, const PlyElement& element, std::uint64_t row) {
  const std::string& text = this->Bytes_;
  std::size_t& i = this->Position_;
  while (i < text.size() && IsSpace(text[i])) {
    ++i;
  }
  const std::size_t begin = i;
  while (i < text.size() && !IsSpace(text[i])) {
    ++i;
  }
  if (begin == i) {
    this->Fail("the file ends here", element, row);
  }
  double value = 0.0;
  const char* first = text.data() + begin + (text[begin] == '+');
  const auto result = std::from_chars(first, text.data() + i, value);
  const std::string word = text.substr(begin, std::min<std::size_t>(i - begin, 60));
  const bool tiny = result.ec == std::errc::result_out_of_range &&
                    word.find_first_of("eE") != std::string::npos &&
                    word.find('-', 1) != std::string::npos;
  const bool huge = result.ec == std::errc::result_out_of_range && !tiny;
  if (huge || IsNotFiniteWord(word)) {
    value = std::numeric_limits<double>::quiet_NaN(); // for RepairMesh to find
  } else if (result.ptr != text.data() + i || (result.ec != std::errc() && !tiny)) {
    this->Fail("'" + word + "' is not a number", element, row);
  }
  value = tiny ? 0.0 : value;
  if (IsPlyInteger(type)) {
    static constexpr double limits[][2] = {
        {-128, 127},      {0, 255}, {-32768, 32767}, {0, 65535}, {-2147483648.0, 2147483647.0},
        {0, 4294967295.0}};
    const double* range = limits[static_cast<std::size_t>(type)];
    if (!(value == std::floor(value) && value >= range[0] && value <= range[1])) {
      this->Fail("'" + word + "' is not an integer of its type", element, row);
    }
  }
  return value;
}

void PlyValues::NextList(const PlyProperty& property, const PlyElement& element, std::uint64_t row,
                         std::vector<double>& values) {
  const double count = this->Next(property.countType, element, row);
  const std::size_t least =
      this->Format_ == PlyHeader::Format::Text ? 2 : PlyTypeSize(property.type);
  const std::size_t room = (this->Bytes_.size() - this->Position_ + 1) / least;
  if (!(count >= 0.0 && count <= static_cast<double>(room) && count == std::floor(count))) {
    std::ostringstream length;
    length << count;
    this->Fail("list '" + property.name + "' of length " + length.str() +
                   " does not fit in the file",
               element, row);
  }
  values.clear();
  for (double i = 0.0; i < count; i += 1.0) {
    values.push_back(this->Next(property.type, element, row));
  }
}

std::size_t PlyValues::BytesLeft() const {
  std::size_t i = this->Position_;
  while (this->Format_ == PlyHeader::Format::Text && i < this->Bytes_.size() &&
         IsSpace(this->Bytes_[i])) {
    ++i;
  }
  return this->Bytes_.size() - i;
}

} // namespace dspace
