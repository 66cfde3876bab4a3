#include <dspace/recording/RecordedNames.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include <dspace/AtomicFile.h>
#include <dspace/Utf8.h>

namespace dspace::session {
namespace {

constexpr std::size_t Head = 4096;

// As a text of XML; `quotes`: as an attribute's value.
std::string Escaped(const std::string& text, bool quotes) {
  std::string out;
  for (const char c : text) {
    out += c == '&'             ? "&amp;"
           : c == '<'           ? "&lt;"
           : c == '>'           ? "&gt;"
           : c == '"' && quotes ? "&quot;"
                                : std::string(1, c);
  }
  return out;
}

} // namespace

RecordedNames::RecordedNames(const std::map<std::string, std::string>& places) {
  for (const auto& [path, place] : places) {
    this->Names_[path] = Escaped(place, true);
    this->Names_[Escaped(path, false)] = Escaped(place, true);
    this->Names_[Escaped(path, true)] = Escaped(place, true);
  }
  for (const auto& entry : this->Names_) {
    this->Longest_ = std::max(this->Longest_, entry.first.size());
  }
}

std::string RecordedNames::Rewritten(const std::string& text) const {
  std::string out;
  std::size_t kept = 0; // up to here it is in `out`
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    if (text[i] != '"' && text[i] != '\'' && text[i] != '>') {
      continue;
    }
    const std::size_t from = i + (text.compare(i + 1, 7, "file://") == 0 ? 8 : 1);
    const std::string* place = nullptr; // of the longest name
    std::size_t end = from;
    if (from < text.size() && text[from] == '/') {
      const std::size_t last = std::min(text.size(), from + this->Longest_ + 1);
      for (std::size_t to = from + 1; to < last; ++to) {
        if (text[to] == '"' || text[to] == '\'' || text[to] == '<') {
          const auto found = this->Names_.find(text.substr(from, to - from));
          if (found != this->Names_.end()) {
            place = &found->second;
            end = to;
          }
        }
      }
    }
    if (place) {
      out.append(text, kept, from - kept).append(*place);
      kept = end;
      i = end - 1; // what ends one value may begin the next
    }
  }
  return out.append(text, kept, std::string::npos);
}

void RecordedNames::RewriteFile(const std::string& path) const {
  std::ifstream in(path, std::ios::binary);
  std::string start(Head, '\0');
  in.read(start.data(), std::streamsize(Head));
  start.resize(std::size_t(in.gcount()));
  const auto has = [&start](const char* mark) { return start.find(mark) != std::string::npos; };
  if (!has("<VRTDataset") && !has("<OGRVRTDataSource") && !has("<robot")) {
    return;
  }
  std::ostringstream rest;
  if (in) {
    rest << in.rdbuf();
  }
  in.close();
  // UTF-8, as the names are: a robot description in Latin-1 is read as its text in UTF-8 is.
  const std::string mended = this->Rewritten(ToUtf8(start + rest.str()));
  AtomicFile::Save(path, mended.data(), mended.size());
}

} // namespace dspace::session
