/**
 * @class vtkDspaceStepTimes
 * @brief Selects a recording's step for a time, for Python.
 *
 * Wraps <dspace/recording/StepTimes.h>, which documents the rule.
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

  /// Sets the times of all steps [s]: an array of native doubles.
  void SetTimes(const std::string& doubles);
  /// The index of the step for a time; -1: there is none.
  long long IndexAt(double time);
  /// False for an invalid index.
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
