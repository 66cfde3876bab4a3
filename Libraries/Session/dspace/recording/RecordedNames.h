// Names of packed files within other packed files. Not a public header.
#ifndef DSPACE_SESSION_RECORDED_NAMES_H
#define DSPACE_SESSION_RECORDED_NAMES_H

#include <cstddef>
#include <map>
#include <string>

namespace dspace::session {

// Absolute names in a mosaic or a robot's description, which are XML, made those of unpacked files.
class RecordedNames {
public:
  // The places of paths.
  explicit RecordedNames(const std::map<std::string, std::string>& places);

  // Rewrites a file that is one of these sorts; any other is left as it is. Throws Error(Io).
  void RewriteFile(const std::string& path) const;

  // Whole names only, perhaps after "file://": what stands around one ends a value of XML.
  std::string Rewritten(const std::string& text) const;

private:
  std::map<std::string, std::string> Names_; // as they stand in XML
  std::size_t Longest_ = 0;
};

} // namespace dspace::session

#endif
