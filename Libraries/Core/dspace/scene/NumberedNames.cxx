#include <dspace/scene/NumberedNames.h>

#include <charconv>

namespace dspace {

void NumberedNames::Freed(const std::string& name) {
  const std::size_t space = name.rfind(' ');
  if (space == std::string::npos || space + 1 == name.size() || name[space + 1] == '0') {
    return; // "box 02" is the name of no number
  }
  std::uint64_t number = 0;
  const char* const end = name.data() + name.size();
  const auto read = std::from_chars(name.data() + space + 1, end, number);
  if (read.ec != std::errc() || read.ptr != end || number < 2) {
    return;
  }
  const auto found = this->Numbers_.find(name.substr(0, space));
  if (found != this->Numbers_.end() && number < found->second.next) {
    found->second.freed.insert(number);
  }
}

} // namespace dspace
