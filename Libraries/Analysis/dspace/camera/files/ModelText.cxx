#include <dspace/camera/files/ModelText.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <dspace/Checks.h>
#include <dspace/FilesRead.h>

namespace dspace {
namespace {

constexpr const char* Blanks = " \t\r\n\v\f";

} // namespace

std::string ReadModelText(const std::string& path, std::size_t most) {
  const std::string label = "file '" + path + "'";
  NoteFileRead(path);
  std::error_code failure;
  if (!std::filesystem::exists(path, failure)) {
    throw Error(Error::Kind::NotFound, label, "there is no such file");
  }
  if (!std::filesystem::is_regular_file(path, failure)) {
    throw Error(Error::Kind::Io, label, "it is not a regular file");
  }
  std::ifstream file(path, std::ios::binary);
  std::string text(most, '\0');
  file.read(text.data(), std::streamsize(most));
  if (!file.is_open() || file.bad()) {
    throw Error(Error::Kind::Io, label, "it cannot be read");
  }
  text.resize(std::size_t(file.gcount()));
  if (text.find_first_not_of(Blanks) == std::string::npos) {
    throw Error(Error::Kind::Corrupt, label, "it is empty");
  }
  return text;
}

std::string ExactText(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof(text), value);
  return std::string(text, end.ptr);
}

std::string ExactTexts(const std::vector<double>& values, const char* between) {
  std::string text;
  for (const double value : values) {
    text += (text.empty() ? "" : between) + ExactText(value);
  }
  return text;
}

double NumberIn(const std::string& word, const std::string& label) {
  double value = 0.0;
  const char* begin = word.data() + (!word.empty() && word[0] == '+' ? 1 : 0);
  const char* end = word.data() + word.size();
  const auto read = std::from_chars(begin, end, value);
  if (begin == end || read.ec != std::errc() || read.ptr != end || !std::isfinite(value)) {
    throw Error(Error::Kind::Corrupt, label,
                "it has '" + word.substr(0, 40) + "'; accepted: a finite number");
  }
  return value;
}

int ImageSide(double side, const char* what, const std::string& label) {
  Require(side >= 1.0 && side <= 1e6 && side == std::floor(side), label, what, side,
          "an integer from 1 to 1e6");
  return int(side);
}

std::vector<double> NumbersIn(const std::string& text, const std::string& label) {
  constexpr const char* Between = " \t\r\n\v\f,[](){}";
  std::vector<double> numbers;
  std::size_t at = 0;
  while ((at = text.find_first_not_of(Between, at)) != std::string::npos) {
    const std::size_t end = std::min(text.find_first_of(Between, at), text.size());
    numbers.push_back(NumberIn(text.substr(at, end - at), label));
    at = end;
  }
  return numbers;
}

std::string TrimmedText(const std::string& text) {
  const std::size_t first = text.find_first_not_of(Blanks);
  return first == std::string::npos ? std::string()
                                    : text.substr(first, text.find_last_not_of(Blanks) + 1 - first);
}

std::string UpperText(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return char(std::toupper(c)); });
  return text;
}

} // namespace dspace
