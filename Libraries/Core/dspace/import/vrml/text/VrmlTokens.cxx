#include <dspace/import/vrml/text/VrmlTokens.h>

#include <dspace/import/files/ImportFile.h>

#include <dspace/Error.h>
#include <dspace/Utf8.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace dspace {

namespace {

bool IsSeparator(char c) {
  return static_cast<unsigned char>(c) <= ' ' || c == ',';
}

bool EndsWord(char c) {
  return IsSeparator(c) || c == '{' || c == '}' || c == '[' || c == ']' || c == '"' || c == '#';
}

} // namespace

VrmlTokens::VrmlTokens(std::string_view text, const std::string& path, int firstLine)
    : Text_(text), Path_(path), Line_(firstLine) {
  this->Scan();
}

void VrmlTokens::Scan() {
  const std::string_view text = this->Text_;
  std::size_t& i = this->Position_;
  while (i < text.size() && (IsSeparator(text[i]) || text[i] == '#')) {
    if (text[i] == '#') {
      i = std::min(text.find_first_of("\r\n", i), text.size());
    } else {
      this->Line_ += text[i] == '\n';
      ++i;
    }
  }
  this->Next_ = {VrmlToken::Kind::End, {}, this->Line_};
  if (i >= text.size()) {
    return;
  }
  const std::size_t begin = i++;
  switch (text[begin]) {
  case '{':
    this->Next_.kind = VrmlToken::Kind::OpenBrace;
    break;
  case '}':
    this->Next_.kind = VrmlToken::Kind::CloseBrace;
    break;
  case '[':
    this->Next_.kind = VrmlToken::Kind::OpenBracket;
    break;
  case ']':
    this->Next_.kind = VrmlToken::Kind::CloseBracket;
    break;
  case '"':
    this->Next_.kind = VrmlToken::Kind::String;
    while (i < text.size() && text[i] != '"') {
      i += text[i] == '\\' ? 1 : 0;
      if (i < text.size()) {
        this->Line_ += text[i] == '\n';
        ++i;
      }
    }
    if (i >= text.size()) {
      this->Fail("the string that begins here does not end");
    }
    ++i;
    break;
  default:
    this->Next_.kind = VrmlToken::Kind::Word;
    while (i < text.size() && !EndsWord(text[i])) {
      ++i;
    }
  }
  this->Next_.text = text.substr(begin, i - begin);
}

VrmlToken VrmlTokens::Take() {
  const VrmlToken token = this->Next_;
  this->Scan();
  return token;
}

VrmlToken VrmlTokens::Expect(VrmlToken::Kind kind, const char* what) {
  if (this->Next_.kind != kind) {
    const std::string found = this->Next_.kind == VrmlToken::Kind::End
                                  ? "the end of the file"
                                  : "'" + Utf8Beginning(this->Next_.text, 60) + "'";
    this->Fail("found " + found + " where " + what + " is expected");
  }
  return this->Take();
}

void VrmlTokens::Fail(const std::string& message) const {
  throw Error(Error::Kind::Corrupt, FileObject(this->Path_),
              "line " + std::to_string(this->Next_.line) + ": " + message);
}

void VrmlTokens::SkipBalanced() {
  long depth = 0;
  do {
    const VrmlToken token = this->Take();
    depth += token.kind == VrmlToken::Kind::OpenBrace || token.kind == VrmlToken::Kind::OpenBracket;
    depth -=
        token.kind == VrmlToken::Kind::CloseBrace || token.kind == VrmlToken::Kind::CloseBracket;
    if (token.kind == VrmlToken::Kind::End) {
      this->Fail("the file ends inside of a node");
    }
  } while (depth > 0);
}

bool ParseVrmlNumber(std::string_view text, double& value) {
  if (!text.empty() && text[0] == '+') {
    text.remove_prefix(1);
  }
  const auto end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  // A value too small for a double is as good as zero.
  const bool tiny =
      result.ec == std::errc::result_out_of_range &&
      (text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos);
  if (tiny) {
    value = 0.0;
  }
  return !text.empty() && result.ptr == end && (tiny || result.ec == std::errc()) &&
         std::abs(value) <= std::numeric_limits<float>::max();
}

bool ParseVrmlInteger(std::string_view text, long long& value) {
  const bool negative = !text.empty() && text[0] == '-';
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
    text.remove_prefix(1);
  }
  int base = 10;
  if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) {
    text.remove_prefix(2);
    base = 16;
  }
  if (text.empty() || text[0] == '-') {
    return false;
  }
  const auto end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value, base);
  value = negative ? -value : value;
  return result.ec == std::errc() && result.ptr == end && value >= -2147483648LL &&
         value <= 4294967295LL;
}

} // namespace dspace
