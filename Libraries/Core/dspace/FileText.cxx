#include <dspace/FileText.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include <iconv.h>

#include <dspace/Utf8.h>

namespace dspace {
namespace {

thread_local ForeignTextScope* InnermostText = nullptr;

constexpr std::size_t LongestName = 64; // of an encoding [bytes]

// Whether the encoding is what ToUtf8 takes for granted. Files that declare Latin-1 are often in
// Windows-1252, which has letters where Latin-1 has control characters.
bool IsWindows1252(std::string encoding) {
  std::transform(encoding.begin(), encoding.end(), encoding.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return encoding == "iso-8859-1" || encoding == "latin1" || encoding == "latin-1" ||
         encoding == "windows-1252" || encoding == "cp1252";
}

// None where the system does not know the encoding, or the text is not in it.
std::optional<std::string> Converted(const std::string& text, const std::string& encoding) {
  const bool plain = !encoding.empty() && encoding.size() <= LongestName &&
                     std::all_of(encoding.begin(), encoding.end(), [](char c) {
                       return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
                              (c >= 'A' && c <= 'Z') || c == '-' || c == '_' || c == '.';
                     });
  const iconv_t converter = plain ? ::iconv_open("UTF-8", encoding.c_str()) : iconv_t(-1);
  if (converter == iconv_t(-1)) {
    return std::nullopt;
  }
  std::string out(4 * text.size() + 16, '\0'); // a byte becomes four at most
  char* from = const_cast<char*>(text.data());
  char* to = out.data();
  std::size_t left = text.size();
  std::size_t room = out.size();
  const bool good = ::iconv(converter, &from, &left, &to, &room) != std::size_t(-1) && left == 0;
  ::iconv_close(converter);
  out.resize(out.size() - room);
  return good && IsUtf8(out) ? std::optional<std::string>(std::move(out)) : std::nullopt;
}

} // namespace

std::string ToFileText(std::string text, const std::string& object, const std::string& declared) {
  if (IsUtf8(text)) {
    return text;
  }
  if (!IsWindows1252(declared)) {
    if (std::optional<std::string> converted = Converted(text, declared)) {
      return std::move(*converted);
    }
  }
  if (InnermostText && !IsWindows1252(declared)) {
    InnermostText->Objects_.insert(object);
  }
  return ToUtf8(std::move(text));
}

std::string DeclaredEncoding(const std::string& xml) {
  const std::size_t begin = xml.compare(0, 3, "\xEF\xBB\xBF") == 0 ? 3 : 0; // the mark of UTF-8
  const std::size_t end = xml.find("?>", begin);
  if (xml.compare(begin, 5, "<?xml") != 0 || end == std::string::npos) {
    return {};
  }
  const std::string head = xml.substr(begin, end - begin);
  std::size_t at = head.find("encoding");
  at = at == std::string::npos ? at : head.find_first_not_of(" \t\r\n=", at + 8);
  if (at == std::string::npos || (head[at] != '"' && head[at] != '\'')) {
    return {};
  }
  const std::size_t close = head.find(head[at], at + 1);
  return close == std::string::npos ? std::string() : head.substr(at + 1, close - at - 1);
}

void NoteForeignText(const std::string& object) {
  if (InnermostText) {
    InnermostText->Objects_.insert(object);
  }
}

ForeignTextScope::ForeignTextScope() : Outer_(std::exchange(InnermostText, this)) {}

ForeignTextScope::~ForeignTextScope() {
  InnermostText = this->Outer_;
  if (InnermostText) {
    InnermostText->Objects_.merge(this->Objects_);
  }
}

std::vector<std::string> ForeignTextScope::Warnings() const {
  std::vector<std::string> warnings;
  for (const std::string& object : this->Objects_) {
    warnings.push_back(object + ": its text is not UTF-8 and not in an encoding that it declares; "
                                "it is read as Windows-1252 (Latin-1)");
  }
  return warnings;
}

} // namespace dspace
