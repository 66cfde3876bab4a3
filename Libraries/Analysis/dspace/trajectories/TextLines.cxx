#include <dspace/trajectories/TextLines.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include <dspace/Error.h>
#include <dspace/FileText.h>
#include <dspace/FilesRead.h>

namespace dspace {
namespace {

constexpr std::uintmax_t Largest = std::uintmax_t(1) << 31;
constexpr const char* Blanks = " \t\r\v\f";

} // namespace

TextLines::TextLines(const std::string& path) : Label_("file '" + path + "'") {
  NoteFileRead(path);
  std::error_code failure;
  if (!std::filesystem::exists(path, failure)) {
    throw Error(Error::Kind::NotFound, this->Label_, "there is no such file");
  }
  if (!std::filesystem::is_regular_file(path, failure)) {
    throw Error(Error::Kind::Io, this->Label_, "it is not a regular file");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, failure);
  if (failure || size > Largest) {
    throw Error(failure ? Error::Kind::Io : Error::Kind::Resource, this->Label_,
                failure ? failure.message() : "it is larger than 2 GiB");
  }
  std::ifstream file(path, std::ios::binary);
  this->Text_.resize(std::size_t(size));
  if (!file || !file.read(this->Text_.data(), std::streamsize(size))) {
    throw Error(Error::Kind::Io, this->Label_, "it cannot be read");
  }
  if (this->Text_.find_first_not_of(" \t\r\n\v\f") == std::string::npos) {
    throw Error(Error::Kind::Corrupt, this->Label_, "it is empty");
  }
  if (this->Text_.find('\0') != std::string::npos) {
    throw Error(Error::Kind::Corrupt, this->Label_,
                "it has bytes of value 0, which no text has; accepted: text");
  }
  this->Text_ = ToFileText(std::move(this->Text_), this->Label_);
  if (this->Text_.compare(0, 3, "\xEF\xBB\xBF") == 0) { // the mark of UTF-8
    this->Position_ = 3;
  }
}

bool TextLines::Next() {
  while (this->Position_ < this->Text_.size()) {
    const std::size_t end = std::min(this->Text_.find('\n', this->Position_), this->Text_.size());
    const std::size_t first = this->Text_.find_first_not_of(Blanks, this->Position_);
    ++this->Number_;
    const bool empty = first == std::string::npos || first >= end;
    if (!empty) {
      const std::size_t last = this->Text_.find_last_not_of(Blanks, end - 1);
      this->Line_ = this->Text_.substr(first, last + 1 - first);
    }
    this->Position_ = end + 1;
    if (!empty) {
      return true;
    }
  }
  return false;
}

std::vector<std::string> TextLines::Words() const {
  std::vector<std::string> words;
  std::size_t at = 0;
  while ((at = this->Line_.find_first_not_of(Blanks, at)) != std::string::npos) {
    const std::size_t end = std::min(this->Line_.find_first_of(Blanks, at), this->Line_.size());
    words.push_back(this->Line_.substr(at, end - at));
    at = end;
  }
  return words;
}

double TextLines::Number(const std::string& word, const char* what) const {
  const char* begin = word.data() + (word[0] == '+' ? 1 : 0);
  const char* end = word.data() + word.size();
  double value = 0.0;
  const auto read = std::from_chars(begin, end, value);
  if (begin == end || read.ec != std::errc() || read.ptr != end || !std::isfinite(value)) {
    this->Damaged(std::string(what) + " is '" + word + "'; accepted: a finite number");
  }
  return value;
}

void TextLines::Damaged(const std::string& what) const {
  throw Error(Error::Kind::Corrupt, this->Label_ + ", line " + std::to_string(this->Number_), what);
}

} // namespace dspace
