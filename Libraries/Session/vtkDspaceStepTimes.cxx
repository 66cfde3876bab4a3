#include "vtkDspaceStepTimes.h"

#include <cstring>
#include <utility>
#include <vector>

#include <dspace/recording/StepTimes.h>

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkDspaceStepTimes);

struct vtkDspaceStepTimes::Internals {
  dspace::session::StepTimes times;

  bool Has(long long index) const {
    return index >= 0 && static_cast<unsigned long long>(index) < this->times.Times().size();
  }
};

vtkDspaceStepTimes::vtkDspaceStepTimes() : Impl(std::make_unique<Internals>()) {}

vtkDspaceStepTimes::~vtkDspaceStepTimes() = default;

void vtkDspaceStepTimes::SetTimes(const std::string& doubles) {
  std::vector<double> times_s(doubles.size() / sizeof(double));
  if (!times_s.empty()) {
    std::memcpy(times_s.data(), doubles.data(), times_s.size() * sizeof(double));
  }
  this->Impl->times = dspace::session::StepTimes(std::move(times_s));
}

long long vtkDspaceStepTimes::IndexAt(double time) {
  const auto index = this->Impl->times.IndexAt(time);
  return index ? static_cast<long long>(*index) : -1;
}

bool vtkDspaceStepTimes::IsAt(long long index, double time) {
  return this->Impl->Has(index) && this->Impl->times.IsAt(std::size_t(index), time);
}

bool vtkDspaceStepTimes::IsAfter(long long index, double time) {
  return this->Impl->Has(index) && this->Impl->times.IsAfter(std::size_t(index), time);
}

double vtkDspaceStepTimes::Rounding(double time, double step) {
  return dspace::session::StepTimes::Rounding(time, step);
}

void vtkDspaceStepTimes::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Steps: " << this->Impl->times.Times().size() << "\n";
}
