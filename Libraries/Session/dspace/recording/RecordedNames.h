// Rewrites the names of packed files within other packed files. Not a public header.
#ifndef DSPACE_SESSION_RECORDED_NAMES_H
#define DSPACE_SESSION_RECORDED_NAMES_H

#include <cstddef>
#include <map>
#include <string>

namespace dspace::session {

// Replaces absolute names in mosaics and robot descriptions (both XML) by the paths of the unpacked
// files.
class RecordedNames {
public:
  // `places`: present paths by recorded path.
  explicit RecordedNames(const std::map<std::string, std::string>& places);

  // Rewrites a file of one of these formats. Does nothing for others. Throws Error(Io).
  void RewriteFile(const std::string& path) const;

  // Replaces whole names only, with or without "file://": names that are delimited as a value in
  // XML.
  std::string Rewritten(const std::string& text) const;

private:
  std::map<std::string, std::string> Names_; // as written in XML
  std::size_t Longest_ = 0;
};

} // namespace dspace::session

#endif
