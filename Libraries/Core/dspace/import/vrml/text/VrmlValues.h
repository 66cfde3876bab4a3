// Checks and rewrites the values of VRML fields other than nodes. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML_VALUES_H
#define DSPACE_IMPORT_VRML_VALUES_H

#include <dspace/import/vrml/text/VrmlNodeTable.h>
#include <dspace/import/vrml/text/VrmlTokens.h>

#include <map>
#include <string>
#include <vector>

namespace dspace {

// Warnings about a text: equal ones are counted, and name the line of the first.
class VrmlWarnings {
public:
  void Add(const std::string& message, int line) {
    ++this->Warnings_.emplace(message, std::pair(line, 0)).first->second.second;
  }
  void AppendTo(std::vector<std::string>& warnings, const std::string& path) const;

private:
  std::map<std::string, std::pair<int, int>> Warnings_; // message -> first line, times
};

// Takes a value of that type from `in` and appends it to `out`. Returns false, with nothing
// appended, when the value is unusable and the field's default is to hold: an image whose pixels
// do not match its size, or more than 16384 pixels wide or high. A list loses an incomplete last
// value. Both add a warning. Throws Error(Corrupt) naming the line if anything else than such a
// value follows.
bool WriteVrmlValue(const VrmlFieldType& type, VrmlTokens& in, std::string& out,
                    VrmlWarnings& warnings);

} // namespace dspace

#endif
