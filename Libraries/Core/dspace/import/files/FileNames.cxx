#include <dspace/import/files/FileNames.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <dspace/Error.h>
#include <dspace/Utf8.h>

namespace dspace {

namespace fs = std::filesystem;

namespace {

int HexDigit(char c) {
  if (c >= '0' && c <= '9') {
    return c - '0';
  }
  const char l = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return l >= 'a' && l <= 'f' ? l - 'a' + 10 : -1;
}

} // namespace

std::string LowerExtension(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::string PercentDecode(const std::string& text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '%' && i + 2 < text.size();
    const int high = escape ? HexDigit(text[i + 1]) : -1;
    const int low = escape ? HexDigit(text[i + 2]) : -1;
    if (high >= 0 && low >= 0) {
      out += static_cast<char>(high * 16 + low);
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

std::string ResolveReference(const std::string& fromFile, const std::string& reference) {
  const auto reject = [&](const std::string& why) {
    throw Error(Error::Kind::Unsupported, "file '" + fromFile + "'",
                "refers to '" + reference + "', " + why);
  };
  std::string name = ToUtf8(reference);
  std::replace(name.begin(), name.end(), '\\', '/');
  const std::size_t colon = name.find(':');
  if (name.empty() || name.find('\0') != std::string::npos) {
    reject("which is not a file name");
  }
  if (name[0] == '/' || (colon != std::string::npos && colon < name.find('/'))) {
    reject("which is not a relative file name; only files beside the model are read");
  }
  const fs::path relative = fs::path(name).lexically_normal();
  auto part = relative.begin();
  if (part != relative.end() && *part == "..") {
    ++part;
  }
  if (part != relative.end() && *part == "..") {
    reject("which is more than one folder above the model's own");
  }
  return (fs::path(fromFile).parent_path() / relative).string();
}

} // namespace dspace
