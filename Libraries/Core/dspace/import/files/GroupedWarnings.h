// Warnings of one kind as one text: internal, not installed.
#ifndef DSPACE_IMPORT_GROUPED_WARNINGS_H
#define DSPACE_IMPORT_GROUPED_WARNINGS_H

#include <string>
#include <utility>
#include <vector>

namespace dspace {

// Collects what was repaired or left out, and names the first few places of each kind.
class GroupedWarnings {
public:
  // `kind` is a sentence without its end ("texture coordinates that are not finite become 0"),
  // `place` is a name with its quotes ("mesh 'wing'").
  void Add(const std::string& kind, const std::string& place);
  bool Empty() const { return this->Kinds_.empty(); }
  // One text a kind, in the order of each kind's first place: "KIND: 'a', 'b', 'c' and 4 more".
  std::vector<std::string> Texts() const;

private:
  struct Kind {
    std::string text;
    std::vector<std::string> places; // the first few
    std::size_t count = 0;
  };
  std::vector<Kind> Kinds_;
};

} // namespace dspace

#endif
