#include <dspace/crs/CrsFiles.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>

#include <cpl_conv.h>
#include <ogr_spatialref.h>

namespace dspace {
namespace {

// In lower case, without spaces.
std::string Squeezed(const std::string& text) {
  std::string squeezed;
  squeezed.reserve(text.size());
  for (const char c : text) {
    if (!std::isspace(static_cast<unsigned char>(c))) {
      squeezed += char(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return squeezed;
}

std::string WithoutQuotes(std::string text) {
  text.erase(std::remove_if(text.begin(), text.end(), [](char c) { return c == '"' || c == '\''; }),
             text.end());
  return text;
}

// Whether a word occurs, and what follows it is not the grid "@null" alone, which is none. `skip`:
// up to the second string of WKT's keyword.
bool OccursWithFile(const std::string& squeezed, const std::string& word, bool skip = false) {
  for (std::size_t at = squeezed.find(word); at != std::string::npos;
       at = squeezed.find(word, at + 1)) {
    std::size_t value = at + word.size();
    if (skip) {
      value = squeezed.find("\",\"", value);
      value = value == std::string::npos ? squeezed.size() : value + 3;
    }
    value += value < squeezed.size() && squeezed[value] == '"' ? 1 : 0;
    const bool null = squeezed.compare(value, 5, "@null") == 0;
    // A list of grids goes on with a comma.
    if (!null || (value + 5 < squeezed.size() && squeezed[value + 5] == ',')) {
      return true;
    }
  }
  return false;
}

// Operations of PROJ that read a file, in WKT's METHOD and in pipelines.
bool HasFileOperation(const std::string& squeezed) {
  for (const char* word : {"proj=tinshift", "proj=defmodel", "gridshift", "proj=deformation"}) {
    if (squeezed.find(word) != std::string::npos) {
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

bool StartsAt(const std::string& text, std::size_t at, const char* word) {
  for (; *word != '\0'; ++word, ++at) {
    if (at >= text.size() || std::tolower(static_cast<unsigned char>(text[at])) != *word) {
      return false;
    }
  }
  return true;
}

// JSON's \u002b and XML's &#43; and &#x2b; as the characters that they are, \n and the like as
// spaces, and escaped quotes as quotes.
std::string Unescaped(const std::string& text) {
  std::string plain;
  plain.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const bool json = StartsAt(text, i, "\\u");
    const bool hex = json || StartsAt(text, i, "&#x");
    if (json || StartsAt(text, i, "&#")) {
      std::size_t at = i + (json || !hex ? 2 : 3);
      const std::size_t end = json ? at + 4 : text.size();
      std::uint32_t code = 0; // as GDAL counts: the digits that fit
      for (; at < end && at < text.size() && std::isxdigit(static_cast<unsigned char>(text[at]));
           ++at) {
        const int c = std::tolower(static_cast<unsigned char>(text[at]));
        code = code * (hex ? 16U : 10U) + std::uint32_t(c <= '9' ? c - '0' : c - 'a' + 10);
      }
      plain += code > 0 && code < 128 ? char(code) : '?';
      i = at + (!json && at < text.size() && text[at] == ';' ? 1 : 0);
    } else if (text[i] == '\\' && i + 1 < text.size()) {
      plain += std::string("ntrfb").find(text[i + 1]) != std::string::npos ? ' ' : text[i + 1];
      i += 2;
    } else if (StartsAt(text, i, "&quot;") || StartsAt(text, i, "&apos;")) {
      plain += '"';
      i += 6;
    } else {
      plain += text[i++];
    }
  }
  return plain;
}

} // namespace

bool CrsNamesFile(const std::string& crs) {
  const std::string text = WithoutQuotes(Squeezed(crs));
  for (const char* word : {"grids=", "file=", "model=", "init=", "parameterfile", "extension[",
                           "extension(", "dict:", "/vsi", "://"}) {
    if (text.find(word) != std::string::npos) {
      return true;
    }
  }
  const bool proj = text.rfind('+', 0) == 0 || text.find("proj=") != std::string::npos;
  std::error_code error;
  return text.empty() || std::string("/.@~\\").find(text[0]) != std::string::npos ||
         (proj && text.find('/') != std::string::npos) || std::filesystem::exists(crs, error);
}

bool CrsNamesFile(const OGRSpatialReference& srs) {
  for (const char* format : {"FORMAT=WKT2_2019", "FORMAT=WKT1_GDAL"}) {
    const std::string text = Squeezed(Exported(srs, format));
    if (OccursWithFile(text, "parameterfile[", true) ||
        OccursWithFile(text, "extension[\"proj4_grids\",") || OccursWithFile(text, "grids=") ||
        OccursWithFile(text, "+init=") || OccursWithFile(text, "+file=") ||
        HasFileOperation(text)) {
      return true;
    }
  }
  return false;
}

std::string CrsFileWordIn(const std::string& text) {
  const std::string plain = Squeezed(Unescaped(text));
  if (plain.find("+init=") != std::string::npos) {
    return "+init";
  }
  if (OccursWithFile(plain, "parameterfile[", true) ||
      OccursWithFile(plain, "parameterfile(", true)) {
    return "PARAMETERFILE";
  }
  if (OccursWithFile(plain, "\"proj4_grids\",")) {
    return "PROJ4_GRIDS";
  }
  const bool proj =
      plain.find("+proj") != std::string::npos || plain.find("proj-based") != std::string::npos;
  if (proj && HasFileOperation(plain)) {
    return "an operation of PROJ";
  }
  return proj && OccursWithFile(plain, "grids=") ? "grids=" : "";
}

} // namespace dspace
