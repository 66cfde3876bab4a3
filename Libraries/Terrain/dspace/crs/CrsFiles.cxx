#include <dspace/crs/CrsFiles.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>

#include <cpl_conv.h>
#include <ogr_spatialref.h>

namespace dspace {
namespace {

// In lower case, without spaces and quotes.
std::string Squeezed(const std::string& text) {
  std::string squeezed;
  squeezed.reserve(text.size());
  for (const char c : text) {
    if (!std::isspace(static_cast<unsigned char>(c)) && c != '"' && c != '\'') {
      squeezed += char(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return squeezed;
}

// Whether a word occurs, and what follows it is not the grid "@null", which is none. `skip`: up to
// its first comma (of WKT's names).
bool OccursWithFile(const std::string& squeezed, const std::string& word, bool skip = false) {
  for (std::size_t at = squeezed.find(word); at != std::string::npos;
       at = squeezed.find(word, at + 1)) {
    std::size_t value = at + word.size();
    if (skip) {
      value = std::min(squeezed.find(',', value), squeezed.size() - 1) + 1;
    }
    if (squeezed.compare(value, 5, "@null") != 0) {
      return true;
    }
  }
  return false;
}

std::string Exported(const OGRSpatialReference& srs, const char* format) {
  char* text = nullptr;
  const char* const options[] = {format, "MULTILINE=NO", nullptr};
  const bool good = srs.exportToWkt(&text, options) == OGRERR_NONE && text;
  std::string wkt = good ? text : "";
  CPLFree(text);
  return wkt;
}

// JSON's \u002b and XML's &#43; and &#x2b; as the characters that they are, without escaped quotes.
std::string Unescaped(const std::string& text) {
  std::string plain;
  plain.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    char* end = nullptr;
    unsigned long code = 0;
    std::size_t next = 0;
    if (text.compare(i, 2, "\\u") == 0 && i + 6 <= text.size()) {
      code = std::strtoul(text.substr(i + 2, 4).c_str(), &end, 16);
      next = i + 6;
    } else if (text.compare(i, 2, "&#") == 0) {
      const bool hex = i + 2 < text.size() && (text[i + 2] == 'x' || text[i + 2] == 'X');
      const std::string digits = text.substr(i + (hex ? 3 : 2), 12);
      code = std::strtoul(digits.c_str(), &end, hex ? 16 : 10);
      const auto used = static_cast<std::size_t>(end - digits.c_str());
      next = i + (hex ? 3 : 2) + used + (used < digits.size() && digits[used] == ';' ? 1 : 0);
    }
    if (code > 0 && code < 128) {
      plain += char(code);
      i = next;
    } else if (text[i] == '\\') {
      ++i;
    } else if (text.compare(i, 6, "&quot;") == 0 || text.compare(i, 6, "&apos;") == 0) {
      i += 6;
    } else {
      plain += text[i++];
    }
  }
  return plain;
}

} // namespace

bool CrsNamesFile(const std::string& crs) {
  const std::string text = Squeezed(crs);
  for (const char* word : {"grids=", "file=", "model=", "init=", "parameterfile", "extension[",
                           "extension(", "dict:", "/vsi", "://"}) {
    if (text.find(word) != std::string::npos) {
      return true;
    }
  }
  const bool proj = text.find("+") == 0 || text.find("proj=") != std::string::npos;
  std::error_code error;
  return text.empty() || std::string("/.@~\\").find(text[0]) != std::string::npos ||
         (proj && text.find('/') != std::string::npos) || std::filesystem::exists(crs, error);
}

bool CrsNamesFile(const OGRSpatialReference& srs) {
  for (const char* format : {"FORMAT=WKT2_2019", "FORMAT=WKT1_GDAL"}) {
    const std::string text = Squeezed(Exported(srs, format));
    if (OccursWithFile(text, "parameterfile[", true) ||
        OccursWithFile(text, "extension[proj4_grids,") || OccursWithFile(text, "grids=") ||
        OccursWithFile(text, "+init=") || OccursWithFile(text, "+file=")) {
      return true;
    }
  }
  return false;
}

std::string CrsFileWordIn(const std::string& text) {
  const std::string plain = Squeezed(Unescaped(text));
  if (plain.find("+init") != std::string::npos) {
    return "+init";
  }
  if (OccursWithFile(plain, "parameterfile[", true) ||
      OccursWithFile(plain, "parameterfile(", true)) {
    return "PARAMETERFILE";
  }
  if (OccursWithFile(plain, "proj4_grids,")) {
    return "PROJ4_GRIDS";
  }
  return plain.find("+proj") != std::string::npos && OccursWithFile(plain, "grids=") ? "grids="
                                                                                     : "";
}

} // namespace dspace
