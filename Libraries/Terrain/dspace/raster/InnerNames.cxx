#include <dspace/raster/InnerNames.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <memory>
#include <vector>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>

#include <dspace/Error.h>
#include <dspace/FilesRead.h>
#include <dspace/crs/CrsFiles.h>

namespace dspace {
namespace {

constexpr std::size_t StartBytes = 8192; // that tell what a file is: rasters are opened often
constexpr std::size_t ChunkBytes = 4 << 20;
constexpr std::size_t OverlapBytes = 4096;   // longer than any CRS text up to its file's name
constexpr std::size_t LabelBytes = 16 << 20; // of a label that names the files with the pixels

struct CloseFile {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};

// All of a file, in overlapping parts.
class Parts {
public:
  explicit Parts(const std::string& path) : File_(VSIFOpenL(path.c_str(), "rb")) {
    this->Read(StartBytes);
  }

  const std::string& Text() const { return this->Text_; }
  bool Next() { return this->Read(ChunkBytes); }

private:
  bool Read(std::size_t bytes) {
    if (!this->File_) {
      return false;
    }
    this->Text_.erase(0, this->Text_.size() - std::min(this->Text_.size(), OverlapBytes));
    const std::size_t kept = this->Text_.size();
    this->Text_.resize(kept + bytes);
    const std::size_t got = VSIFReadL(&this->Text_[kept], 1, bytes, this->File_.get());
    this->Text_.resize(kept + got);
    return got > 0;
  }

  std::unique_ptr<VSILFILE, CloseFile> File_;
  std::string Text_;
};

bool IsLabel(const std::string& start) {
  const std::string head = start.substr(0, StartBytes);
  return head.find("CCSD") != std::string::npos ||
         head.find("ODL_VERSION_ID") != std::string::npos ||
         head.find("PDS_VERSION_ID") != std::string::npos ||
         head.find("IsisCube") != std::string::npos;
}

// Documents that hold a CRS as text anywhere: JSON, XML, and SQLite's tables.
bool MayHoldCrsText(const std::string& start) {
  if (start.compare(0, 15, "SQLite format 3") == 0) {
    return true;
  }
  const std::string head = start.substr(0, StartBytes);
  const std::size_t first = head.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  const bool document = first != std::string::npos && (head[first] == '{' || head[first] == '<');
  return document ||
         (head.find('\0') == std::string::npos && head.find_first_of("{<#") != std::string::npos);
}

void CheckCrsTexts(const std::string& path, Parts& parts) {
  do {
    const std::string word = CrsFileWordIn(parts.Text());
    if (!word.empty()) {
      throw Error(Error::Kind::InvalidArgument, "file '" + path.substr(0, 1000) + "'",
                  "a coordinate system in it names a file ('" + word +
                      "'); accepted here: coordinate systems without grids, parameter files and "
                      "init");
    }
  } while (parts.Next());
}

std::string FolderOf(const std::string& path) {
  return path.substr(0, path.find_last_of('/') + 1);
}

// The value that follows "=", a first "(" and spaces, without quotes.
std::string ValueAfter(const std::string& text, std::size_t at) {
  const auto skip = [&](const char* characters) {
    at = std::min(text.find_first_not_of(characters, at), text.size());
  };
  skip(" \t\r\n");
  if (at >= text.size() || text[at] != '=') {
    return "";
  }
  ++at;
  skip(" \t\r\n(");
  const bool quoted = at < text.size() && (text[at] == '"' || text[at] == '\'');
  const std::size_t end =
      quoted ? text.find(text[at], at + 1) : text.find_first_of(" \t\r\n,()<", at);
  at += quoted ? 1 : 0;
  return text.substr(std::min(at, text.size()), end == std::string::npos ? end : end - at);
}

// Of a label: from "#" to the end of the line, and what is between "/*" and "*/", as spaces.
std::string WithoutComments(std::string text) {
  char quote = '\0';
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (quote != '\0') {
      quote = text[i] == quote || text[i] == '\n' ? '\0' : quote;
    } else if (text[i] == '"' || text[i] == '\'') {
      quote = text[i];
    } else if (text[i] == '#' || text.compare(i, 2, "/*") == 0) {
      const bool line = text[i] == '#';
      std::size_t end = text.find(line ? "\n" : "*/", i);
      end = end == std::string::npos ? text.size() : end + (line ? 0 : 2);
      std::fill(text.begin() + std::ptrdiff_t(i), text.begin() + std::ptrdiff_t(end), ' ');
    }
  }
  return text;
}

void CheckPointers(const std::string& path, const std::string& text) {
  const auto check = [&](const std::string& name) {
    const bool number =
        std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    if (!number) {
      FilesGuard::CheckFile(name[0] == '/' ? name : FolderOf(path) + name);
    }
  };
  // Those that GDAL opens; others (^DATA_SET_MAP_PROJECTION) are documents for people.
  for (const char* key : {"IMAGE", "QUBE", "SPECTRAL_QUBE", "CORE", "TABLE"}) {
    const std::size_t size = std::strlen(key);
    for (std::size_t at = text.find('^'); at != std::string::npos; at = text.find('^', at + 1)) {
      if (EQUALN(text.c_str() + at + 1, key, size)) {
        check(ValueAfter(text, at + 1 + size));
      }
    }
  }
  std::size_t group = text.find("COMPRESSED_FILE");
  while (group != std::string::npos && group > 1 && text.compare(group - 2, 2, "UN") == 0) {
    group = text.find("COMPRESSED_FILE", group + 1);
  }
  const std::size_t name = group == std::string::npos ? group : text.find("FILE_NAME", group);
  if (name != std::string::npos) {
    check(ValueAfter(text, name + std::strlen("FILE_NAME")));
  }
}

// The file itself when it is a document of text.
void CheckFileItself(const std::string& path) {
  Parts parts(path);
  if (IsLabel(parts.Text())) {
    std::size_t read = 0;
    do {
      CheckPointers(path, WithoutComments(parts.Text()));
      read += parts.Text().size();
    } while (read < LabelBytes && parts.Next());
  } else if (MayHoldCrsText(parts.Text())) {
    CheckCrsTexts(path, parts);
  }
}

bool IsThere(const std::string& path) {
  VSIStatBufL info = {};
  return VSIStatL(path.c_str(), &info) == 0 && !VSI_ISDIR(info.st_mode);
}

void CheckBeside(const std::string& path) {
  const std::string stem = CPLResetExtension(path.c_str(), "");
  std::vector<std::string> names = {path + ".aux.xml", path + ".hdr"};
  for (const char* ending :
       {"aux.xml", "prj", "PRJ", "Prj", "qpj", "QPJ", "hdr", "HDR", "aux", "AUX"}) {
    names.push_back(stem + ending);
  }
  for (const std::string& name : names) {
    if (name != path && IsThere(name)) {
      Parts parts(name);
      CheckCrsTexts(name, parts);
    }
  }
}

} // namespace

void CheckInnerNames(const std::string& path) {
  VSIStatBufL info = {};
  if (VSIStatL(path.c_str(), &info) == 0 && VSI_ISDIR(info.st_mode)) {
    const CPLStringList names(VSIReadDir(path.c_str()));
    for (int i = 0; i < names.size(); ++i) {
      const std::string ending = CPLGetExtension(names[i]);
      if (EQUAL(ending.c_str(), "prj") || EQUAL(ending.c_str(), "qpj")) {
        Parts parts(path + "/" + names[i]);
        CheckCrsTexts(path + "/" + names[i], parts);
      }
    }
    return;
  }
  CheckFileItself(path);
  CheckBeside(path);
}

} // namespace dspace
