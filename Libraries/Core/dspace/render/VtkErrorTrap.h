// What VTK only logs becomes an exception.
#ifndef DSPACE_RENDER_VTK_ERRORS_H
#define DSPACE_RENDER_VTK_ERRORS_H

#include <memory>
#include <string>

namespace dspace {

// While it lives, VTK's error and warning messages are kept instead of printed.
// Not for use in two threads at once: VTK has one message window a process.
class VtkErrorTrap {
public:
  VtkErrorTrap();
  VtkErrorTrap(const VtkErrorTrap&) = delete;
  VtkErrorTrap& operator=(const VtkErrorTrap&) = delete;
  ~VtkErrorTrap();
  // Throws Error(Internal) with the first error message, if there was one.
  void Check(const std::string& object) const;

private:
  struct Internals;
  std::unique_ptr<Internals> Impl_;
};

} // namespace dspace

#endif
