// Text of files as UTF-8: the boundary that every text of an importer passes.
#ifndef DSPACE_FILE_TEXT_H
#define DSPACE_FILE_TEXT_H

#include <set>
#include <string>
#include <vector>

namespace dspace {

// The text of a file, or a part of it, as UTF-8. Text that is UTF-8 returns unchanged. Other text
// is converted from the encoding that the file declares, "ISO-8859-2" for example, if the system
// knows it and the text is in it. Otherwise ToUtf8 (Utf8.h) takes it as Windows-1252, and the file
// is noted in the present ForeignTextScope. `object` names the file in the warning: "file 'PATH'".
// Never throws an Error.
std::string ToFileText(std::string text, const std::string& object,
                       const std::string& declared = {});

// The encoding that an XML document declares; empty without a declaration.
std::string DeclaredEncoding(const std::string& xml);

// Collects the files of this thread whose text was taken as Windows-1252, during its lifetime.
// Scopes nest: at its end an inner one adds its files to the outer one.
class ForeignTextScope {
public:
  ForeignTextScope();
  ~ForeignTextScope();
  ForeignTextScope(const ForeignTextScope&) = delete;
  ForeignTextScope& operator=(const ForeignTextScope&) = delete;

  // As ToFileText was given them.
  const std::set<std::string>& Objects() const { return this->Objects_; }
  // One warning a file.
  std::vector<std::string> Warnings() const;

private:
  friend std::string ToFileText(std::string, const std::string&, const std::string&);
  friend void NoteForeignText(const std::string& object);
  std::set<std::string> Objects_;
  ForeignTextScope* Outer_;
};

// Notes a file in the present scope, which another process has read for this one.
void NoteForeignText(const std::string& object);

} // namespace dspace

#endif
