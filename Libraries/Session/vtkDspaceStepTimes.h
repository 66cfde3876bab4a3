/**
 * @class vtkDspaceStepTimes
 * @brief Which of a recording's steps is at a time, for Python.
 *
 * Wraps <dspace/recording/StepTimes.h>, which has the rule.
 */
#ifndef vtkDspaceStepTimes_h
#define vtkDspaceStepTimes_h

#include <memory>
#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkObject.h"

class VTKDSPACESESSION_EXPORT vtkDspaceStepTimes : public vtkObject {
public:
  static vtkDspaceStepTimes* New();
  vtkTypeMacro(vtkDspaceStepTimes, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The times of all steps [s]: doubles as the machine has them, one after the other.
  void SetTimes(const std::string& doubles);
  /// The step at a time; -1: there is none.
  long long IndexAt(double time);
  /// False for a step that there is not.
  bool IsAt(long long index, double time);
  bool IsAfter(long long index, double time);
  static double Rounding(double time, double step);

protected:
  vtkDspaceStepTimes();
  ~vtkDspaceStepTimes() override;

private:
  vtkDspaceStepTimes(const vtkDspaceStepTimes&) = delete;
  void operator=(const vtkDspaceStepTimes&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
