// VTK's errors as exceptions.
#ifndef DSPACE_RENDER_VTK_ERROR_TRAP_H
#define DSPACE_RENDER_VTK_ERROR_TRAP_H

#include <string>

namespace dspace {

class VtkMessages;

// Receives VTK's messages of its thread during its lifetime. Traps of one thread nest: a message
// goes to the innermost one.
class VtkErrorTrap {
public:
  // `messages` must outlive the trap.
  explicit VtkErrorTrap(VtkMessages& messages);
  VtkErrorTrap(const VtkErrorTrap&) = delete;
  VtkErrorTrap& operator=(const VtkErrorTrap&) = delete;
  ~VtkErrorTrap();
  // Throws Error(Internal) with the first error message, if there was one.
  void Check(const std::string& object) const;
  std::string FirstError() const; // empty: there was none

private:
  friend class VtkMessages;
  VtkMessages& Messages_;
  std::string FirstError_; // guarded by the mutex of Messages_
};

} // namespace dspace

#endif
