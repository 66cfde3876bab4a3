#include <dspace/import/obj/ObjText.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <set>

#include <dspace/Error.h>
#include <dspace/Utf8.h>

#include <dspace/import/files/ImportFile.h>
#include <dspace/import/files/NumberWords.h>

namespace dspace {

namespace {

constexpr const char* Blanks = " \t\r\v\f";

std::string Trim(const std::string& text) {
  const std::size_t first = text.find_first_not_of(Blanks);
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(Blanks) - first + 1);
}

// Takes the next word of `text` from `at` on; false at the end.
bool NextWord(const std::string& text, std::size_t& at, std::string& word) {
  const std::size_t first = text.find_first_not_of(Blanks, at);
  if (first == std::string::npos) {
    return false;
  }
  at = std::min(text.find_first_of(Blanks, first), text.size());
  word.assign(text, first, at - first);
  return true;
}

class TextChecker {
public:
  TextChecker(const std::string& path, std::size_t maximumTriangles)
      : Path_(path), MaximumTriangles_(maximumTriangles) {}

  ObjText Run(const std::string& bytes) {
    this->Out_.text.reserve(bytes.size());
    ObjLines lines(bytes);
    std::string keyword, rest;
    while (lines.Next(this->Line_)) {
      SplitKeyword(this->Line_.text, keyword, rest);
      this->Statement(keyword, rest);
    }
    this->CheckLargest(this->Vertices_);
    this->CheckLargest(this->Tcoords_);
    this->CheckLargest(this->Normals_);
    this->Out_.vertices = this->Vertices_.size;
    return std::move(this->Out_);
  }

private:
  void Statement(const std::string& keyword, const std::string& rest) {
    if (keyword == "v") {
      this->Numbers("v", rest, 3, 6, &this->Out_.badVertices, this->Vertices_.size);
      ++this->Vertices_.size;
    } else if (keyword == "vt") {
      this->Numbers("vt", rest, 1, 2, &this->Out_.badTcoords, this->Tcoords_.size);
      ++this->Tcoords_.size;
    } else if (keyword == "vn") {
      this->Numbers("vn", rest, 3, 3, &this->Out_.badNormals, this->Normals_.size);
      ++this->Normals_.size;
    } else if (keyword == "f" || keyword == "fo") {
      this->Corners("f", rest, 3);
    } else if (keyword == "l") {
      this->Corners("l", rest, 2);
    } else if (keyword == "p") {
      this->Corners("p", rest, 1);
    } else if (keyword == "o" || keyword == "g") {
      this->Name_ = rest;
      this->SectionOpen_ = false;
    } else if (keyword == "usemtl") {
      this->Material_ = rest;
      this->SectionOpen_ = false;
    } else if (keyword == "mtllib") {
      this->Out_.libraries.push_back(rest);
    } else if (keyword == "vp" || keyword == "cstype" || keyword == "surf" || keyword == "curv" ||
               keyword == "curv2" || keyword == "call") {
      if (this->LeftOut_.insert(keyword).second) {
        this->Out_.warnings.push_back("line " + std::to_string(this->Line_.number) + ": '" +
                                      keyword + "' statements are left out");
      }
    }
  }

  [[noreturn]] void Fail(const std::string& message,
                         Error::Kind kind = Error::Kind::Corrupt) const {
    throw Error(kind, FileObject(this->Path_),
                "line " + std::to_string(this->Line_.number) + ": " + message);
  }

  // Copies up to `maximum` numbers, of which `minimum` must be there. Three to five beyond a
  // vertex's coordinates are a weight, which is dropped, and not a colour. Where one is not finite,
  // `bad` gets the `index` of the element.
  void Numbers(const char* keyword, const std::string& rest, std::size_t minimum,
               std::size_t maximum, std::vector<std::size_t>* bad, std::size_t index) {
    bool finite = true;
    std::string line = keyword, word;
    std::size_t at = 0, count = 0;
    std::size_t coordinates = 0;
    while (count < maximum && NextWord(rest, at, word)) {
      const bool good = this->CheckNumber(keyword, word);
      finite = finite && (good || count >= 3); // colours after coordinates may be anything
      line += ' ';
      line += word;
      if (++count == minimum) {
        coordinates = line.size();
      }
    }
    if (count < minimum) {
      this->Fail(std::string(keyword) + " has " + std::to_string(count) + " numbers; " +
                 std::to_string(minimum) + " are needed");
    }
    if (count < maximum && maximum == 6) {
      line.resize(coordinates);
    }
    if (!finite) {
      bad->push_back(index);
    }
    this->Out_.text += line;
    this->Out_.text += '\n';
  }

  // False, with 0 in place of the word, for a number that is no finite float.
  bool CheckNumber(const char* keyword, std::string& word) const {
    const char* begin = word.data() + (word[0] == '+' ? 1 : 0);
    const char* end = word.data() + word.size();
    double value = 0.0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error == std::errc::result_out_of_range && word.find_first_of("eE") != std::string::npos &&
        word.find('-', 1) != std::string::npos) {
      word = "0"; // too small for a double
      return true;
    }
    const bool notFinite = error == std::errc::result_out_of_range || IsNotFiniteWord(word);
    if (!notFinite && (error != std::errc() || stop != end)) {
      this->Fail(std::string(keyword) + " has '" + Utf8Beginning(word, 40) +
                 "'; numbers are accepted");
    }
    if (notFinite || !std::isfinite(value) ||
        std::abs(value) > double(std::numeric_limits<float>::max())) {
      word = "0";
      return false;
    }
    return true;
  }

  void Corners(const char* keyword, const std::string& rest, std::size_t minimum) {
    if (!this->SectionOpen_) {
      this->Out_.text += "o " + std::to_string(this->Out_.sections.size()) + '\n';
      this->Out_.sections.push_back({this->Name_, this->Material_, {}});
      this->SectionOpen_ = true;
    }
    const std::size_t start = this->Out_.text.size();
    std::string word;
    std::size_t at = 0, count = 0;
    this->Out_.text += keyword;
    while (NextWord(rest, at, word)) {
      this->Corner(keyword, word);
      ++count;
    }
    this->Out_.text += '\n';
    if (count < minimum) {
      this->Out_.text.resize(start);
      this->Out_.warnings.push_back("line " + std::to_string(this->Line_.number) + ": '" + keyword +
                                    "' with " + std::to_string(count) + " corners is left out");
    } else if (minimum == 3) {
      this->Out_.sections.back().faceCorners.push_back(static_cast<std::uint32_t>(count));
      this->Triangles_ += count - 2;
    }
    if (this->Triangles_ > this->MaximumTriangles_) {
      this->Fail("the file has more than " + std::to_string(this->MaximumTriangles_) +
                     " triangles, which is what is accepted",
                 Error::Kind::Resource);
    }
  }

  // v, v/vt, v//vn or v/vt/vn, counted from 1 or, negative, back from what is there so far.
  void Corner(const char* keyword, const std::string& word) {
    const std::size_t slash = word.find('/');
    const std::size_t second =
        slash == std::string::npos ? std::string::npos : word.find('/', slash + 1);
    this->Out_.text += ' ';
    this->Index(keyword, word.substr(0, slash), this->Vertices_);
    const std::string tcoord =
        slash == std::string::npos ? "" : word.substr(slash + 1, second - slash - 1);
    const std::string normal = second == std::string::npos ? "" : word.substr(second + 1);
    if (!tcoord.empty()) {
      this->Out_.text += '/';
      this->Index(keyword, tcoord, this->Tcoords_);
    }
    if (!normal.empty()) {
      this->Out_.text += tcoord.empty() ? "//" : "/";
      this->Index(keyword, normal, this->Normals_);
    }
  }

  // A list of the file, and the largest index into it, which may be that of an element further on.
  struct List {
    const char* name;
    std::size_t size = 0;
    long long largest = 0;
    std::size_t line = 0; // where `largest` stands
  };

  void Index(const char* keyword, const std::string& word, List& list) {
    long long index = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), index);
    const bool good = error == std::errc() && stop == word.data() + word.size();
    const long long absolute = index < 0 ? static_cast<long long>(list.size) + 1 + index : index;
    if (!good || absolute < 1) {
      this->Fail(std::string(keyword) + " names '" + Utf8Beginning(word, 40) + "' of " +
                 std::to_string(list.size) + " " + list.name);
    }
    if (absolute > list.largest) {
      list.largest = absolute;
      list.line = this->Line_.number;
    }
    this->Out_.text += std::to_string(absolute);
  }

  void CheckLargest(const List& list) {
    if (list.largest > static_cast<long long>(list.size)) {
      this->Line_.number = list.line;
      this->Fail("index " + std::to_string(list.largest) + " of " + std::to_string(list.size) +
                 " " + list.name);
    }
  }

  const std::string& Path_;
  std::size_t MaximumTriangles_;
  ObjText Out_;
  ObjLine Line_{};
  std::string Name_, Material_;
  bool SectionOpen_ = false;
  List Vertices_{"vertices", 0, 0, 0}, Tcoords_{"texture coordinates", 0, 0, 0},
      Normals_{"normals", 0, 0, 0};
  std::size_t Triangles_ = 0;
  std::set<std::string> LeftOut_;
};

} // namespace

bool ObjLines::Next(ObjLine& line) {
  line.text.clear();
  bool continued = false;
  while (this->At_ < this->Bytes_.size()) {
    const std::size_t end = std::min(this->Bytes_.find('\n', this->At_), this->Bytes_.size());
    std::string part = Trim(this->Bytes_.substr(this->At_, end - this->At_));
    this->At_ = end + 1;
    ++this->Number_;
    if (!continued) {
      line.number = this->Number_;
    }
    if (!continued && !part.empty() && part[0] == '#') {
      continue;
    }
    continued = !part.empty() && part.back() == '\\';
    if (continued) {
      part.back() = ' ';
    }
    line.text += part;
    if (!continued && !line.text.empty()) {
      line.text = Trim(line.text);
      if (!line.text.empty()) {
        return true;
      }
    }
  }
  line.text = Trim(line.text);
  return !line.text.empty();
}

void SplitKeyword(const std::string& line, std::string& keyword, std::string& rest) {
  const std::size_t blank = std::min(line.find_first_of(Blanks), line.size());
  keyword = line.substr(0, blank);
  rest = Trim(line.substr(blank));
}

ObjText CheckObjText(const std::string& path, const std::string& bytes,
                     std::size_t maximumTriangles) {
  return TextChecker(path, maximumTriangles).Run(bytes);
}

} // namespace dspace
