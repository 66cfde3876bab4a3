// Copies of the viewports that others have made, as views of one's own.
#ifndef DSPACE_SESSION_VIEWPORT_COPIES_H
#define DSPACE_SESSION_VIEWPORT_COPIES_H

#include <string>
#include <vector>

#include <dspace/interpreter/Interpreter.h>
#include <dspace/ledger/LedgerViewports.h>

namespace dspace::session {

// Follows the viewports of an interpreter, and tells the commands that make a viewport like one of
// them: with the same camera, look, tables and colour bars.
class ViewportCopies {
public:
  ViewportCopies() = default;
  ~ViewportCopies();
  ViewportCopies(const ViewportCopies&) = delete;
  ViewportCopies& operator=(const ViewportCopies&) = delete;

  // Begins anew with an interpreter without viewports, which must outlive this object or the next
  // call.
  void Follow(Interpreter& interpreter);
  // Empty: there is no viewport of this name. `table`: a text table that is left out.
  std::vector<v1::Command> Commands(const std::string& viewport, const std::string& as,
                                    const std::string& table = {}) const;

private:
  void Detach();

  LedgerViewports Ledger_;
  Interpreter* Followed_ = nullptr;
  Interpreter::Token Token_ = 0; // of the listener there
};

} // namespace dspace::session

#endif
