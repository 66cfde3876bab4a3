/**
 * @class vtkDspaceSensor
 * @brief A detector, for Python: radiance to electrons and counts. It needs no session.
 *
 * Wraps <dspace/camera/sensor/Sensor.h>, which documents units and errors. Methods that return a
 * string return a serialized Reply with the error, or an empty string. No method throws.
 */
#ifndef vtkDspaceSensor_h
#define vtkDspaceSensor_h

#include <memory>
#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkObject.h"

class vtkFloatArray;
class vtkUnsignedShortArray;

class VTKDSPACESESSION_EXPORT vtkDspaceSensor : public vtkObject {
public:
  static vtkDspaceSensor* New();
  vtkTypeMacro(vtkDspaceSensor, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Settings as JSON (Sensor.h). Call it first, once.
  std::string Set(const std::string& json);
  int GetChannels();
  int GetCountChannels();
  double GetResponse(int channel);
  /// radiance: 3 per tuple, one tuple per pixel; falloff: one per pixel, or null.
  std::string Electrons(vtkFloatArray* radiance, int width, int height, vtkFloatArray* falloff,
                        vtkFloatArray* electrons);
  std::string Counts(vtkFloatArray* electrons, int width, int height, int x, int y,
                     unsigned int frame, vtkUnsignedShortArray* counts);

protected:
  vtkDspaceSensor();
  ~vtkDspaceSensor() override;

private:
  vtkDspaceSensor(const vtkDspaceSensor&) = delete;
  void operator=(const vtkDspaceSensor&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
