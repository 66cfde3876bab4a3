/**
 * @class vtkDspaceMessageTrap
 * @brief Collects VTK's errors and warnings while a pipeline is updated.
 *
 * Between Begin() and End() it gets what every thread reports to VTK's message window, because
 * filters report from worker threads too. The window itself gets every message as before. Filters
 * that have an observer for ErrorEvent or WarningEvent report to it and not here.
 */
#ifndef vtkDspaceMessageTrap_h
#define vtkDspaceMessageTrap_h

#include <memory>
#include <string>

#include "vtkDspaceCoreModule.h"
#include "vtkObject.h"

class VTKDSPACECORE_EXPORT vtkDspaceMessageTrap : public vtkObject {
public:
  static vtkDspaceMessageTrap* New();
  vtkTypeMacro(vtkDspaceMessageTrap, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Forgets earlier messages and starts to collect.
  void Begin();
  void End();
  /// The first error; empty: there was none.
  std::string GetError();
  /// The different warnings, at most 20, in their order.
  int GetNumberOfWarnings();
  std::string GetWarning(int index);

protected:
  vtkDspaceMessageTrap();
  ~vtkDspaceMessageTrap() override;

private:
  vtkDspaceMessageTrap(const vtkDspaceMessageTrap&) = delete;
  void operator=(const vtkDspaceMessageTrap&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
