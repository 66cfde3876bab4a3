// Lines of text files of states, and the numbers in them: internal, not installed.
#ifndef DSPACE_TRAJECTORIES_TEXT_LINES_H
#define DSPACE_TRAJECTORIES_TEXT_LINES_H

#include <cstddef>
#include <string>
#include <vector>

namespace dspace {

// The lines of a file, without the blanks at their ends, one after the other.
class TextLines {
public:
  // Notes the file as read (FilesRead.h). Throws Error(NotFound, Io), Error(Corrupt) for an empty
  // file and for one with zero bytes, Error(Resource) beyond 2 GiB.
  explicit TextLines(const std::string& path);

  // The next line that is not empty; false at the end.
  bool Next();
  const std::string& Line() const { return this->Line_; }
  // Its words, split at blanks and tabs.
  std::vector<std::string> Words() const;
  // Throws Error(Corrupt) naming the file, the line and the word, unless it is a finite number.
  double Number(const std::string& word, const char* what) const;
  // Throws Error(Corrupt) naming the file and the line's number.
  [[noreturn]] void Damaged(const std::string& what) const;
  const std::string& Label() const { return this->Label_; } // "file 'NAME'"

private:
  std::string Label_;
  std::string Text_;
  std::string Line_;
  std::size_t Position_ = 0;
  std::size_t Number_ = 0; // of the line, from 1 on
};

} // namespace dspace

#endif
