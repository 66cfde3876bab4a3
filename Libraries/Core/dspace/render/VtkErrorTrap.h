// VTK's errors as exceptions.
#ifndef DSPACE_RENDER_VTK_ERROR_TRAP_H
#define DSPACE_RENDER_VTK_ERROR_TRAP_H

#include <string>

namespace dspace {

class VtkMessages;

// Takes VTK's messages of the thread that made it, while it lives. Traps of one thread nest: each
// message goes to the innermost one.
class VtkErrorTrap {
public:
  // `messages` must outlive the trap.
  explicit VtkErrorTrap(VtkMessages& messages);
  VtkErrorTrap(const VtkErrorTrap&) = delete;
  VtkErrorTrap& operator=(const VtkErrorTrap&) = delete;
  ~VtkErrorTrap();
  // Throws Error(Internal) with the first error message, if there was one.
  void Check(const std::string& object) const;

private:
  friend class VtkMessages;
  VtkMessages& Messages_;
  std::string FirstError_; // guarded by the mutex of Messages_
};

} // namespace dspace

#endif
