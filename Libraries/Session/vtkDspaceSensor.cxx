#include "vtkDspaceSensor.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <dspace/Error.h>
#include <dspace/camera/sensor/Sensor.h>

#include "ErrorAnswer.h"
#include "vtkFloatArray.h"
#include "vtkObjectFactory.h"
#include "vtkUnsignedShortArray.h"

using dspace::session::ErrorAnswer;

vtkStandardNewMacro(vtkDspaceSensor);

struct vtkDspaceSensor::Internals {
  std::optional<dspace::Sensor> sensor;

  const dspace::Sensor& Get() const {
    if (!this->sensor) {
      throw dspace::Error(dspace::Error::Kind::Internal, "sensor", "it has no settings");
    }
    return *this->sensor;
  }
  static std::vector<float> List(vtkFloatArray* from) {
    if (!from) {
      return {};
    }
    const float* begin = from->GetPointer(0);
    return {begin, begin + from->GetNumberOfValues()};
  }
  template<class Value, class Array> static void Put(const std::vector<Value>& from, Array* to) {
    to->SetNumberOfComponents(1);
    to->SetNumberOfTuples(vtkIdType(from.size()));
    std::copy(from.begin(), from.end(), to->GetPointer(0));
  }
};

vtkDspaceSensor::vtkDspaceSensor() : Impl(std::make_unique<Internals>()) {}

vtkDspaceSensor::~vtkDspaceSensor() = default;

void vtkDspaceSensor::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Channels: " << this->GetChannels() << "\n";
}

std::string vtkDspaceSensor::Set(const std::string& json) {
  return ErrorAnswer([&] { this->Impl->sensor.emplace(dspace::ParseSensorJson(json)); });
}

int vtkDspaceSensor::GetChannels() {
  return this->Impl->sensor ? this->Impl->sensor->Channels() : 0;
}

int vtkDspaceSensor::GetCountChannels() {
  return this->Impl->sensor ? this->Impl->sensor->CountChannels() : 0;
}

double vtkDspaceSensor::GetResponse(int channel) {
  return channel >= 0 && channel < this->GetChannels() ? this->Impl->sensor->Response(channel)
                                                       : 0.0;
}

std::string vtkDspaceSensor::Electrons(vtkFloatArray* radiance, int width, int height,
                                       vtkFloatArray* falloff, vtkFloatArray* electrons) {
  return ErrorAnswer([&] {
    Internals::Put(this->Impl->Get().Electrons(Internals::List(radiance), width, height,
                                               Internals::List(falloff)),
                   electrons);
  });
}

std::string vtkDspaceSensor::Counts(vtkFloatArray* electrons, int width, int height, int x, int y,
                                    unsigned int frame, vtkUnsignedShortArray* counts) {
  return ErrorAnswer([&] {
    Internals::Put(this->Impl->Get().Counts(Internals::List(electrons), width, height, x, y, frame),
                   counts);
  });
}
