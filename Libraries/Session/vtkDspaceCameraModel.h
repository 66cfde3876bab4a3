/**
 * @class vtkDspaceCameraModel
 * @brief A camera model with its lens, for Python. It needs no session.
 *
 * Wraps <dspace/camera/CameraModel.h>, ConvertModel.h and files/CameraFiles.h, which document
 * units, frames and errors. Unless stated otherwise, methods that return a string return a
 * serialized Reply with the error, or an empty string. No method throws a C++ exception. Several
 * threads may call Write, Check, Project and Unproject while none calls the other methods.
 */
#ifndef vtkDspaceCameraModel_h
#define vtkDspaceCameraModel_h

#include <memory>
#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkObject.h"

class vtkDoubleArray;

class VTKDSPACESESSION_EXPORT vtkDspaceCameraModel : public vtkObject {
public:
  static vtkDspaceCameraModel* New();
  vtkTypeMacro(vtkDspaceCameraModel, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Reads the models of a file, and selects the first.
  std::string Read(const std::string& path);
  /// The same from JSON text.
  std::string Parse(const std::string& json);
  int GetNumber();
  /// Selects one of those that were read, from 0 on.
  void Select(int index);

  std::string Write(const std::string& path);
  /// The selected model as JSON; empty: none was read.
  std::string GetJson();

  /// Scales the model for another size of its image.
  std::string Scale(int width, int height);
  /// Makes it the nearest model of another type. `values` gets the rms and the greatest distance
  /// [pixels], the covered fraction, and the lost shift of the pupil [m].
  std::string Convert(const std::string& type, vtkDoubleArray* values);
  /// `values` gets the field's limit [deg], the fraction of pixels without a ray, the widest angle
  /// from the axis [deg], the least and the greatest pixels per degree, the greatest shift of the
  /// pupil [m], and the greatest error of pixel to ray to pixel.
  std::string Check(vtkDoubleArray* values);
  /// What ends the field.
  std::string GetFieldEnd();

  /// Pixels (2 per tuple; NaN: not seen) of points (3 per tuple, metres), in the model's frame or
  /// the camera's axes, and the derivatives (6 per tuple: of x, of y), or null.
  std::string Project(vtkDoubleArray* points, bool inCamera, vtkDoubleArray* pixels,
                      vtkDoubleArray* derivatives);
  /// Rays (6 per tuple: origin, unit direction; NaN: none) of pixels (2 per tuple).
  std::string Unproject(vtkDoubleArray* pixels, bool inCamera, vtkDoubleArray* rays);

protected:
  vtkDspaceCameraModel();
  ~vtkDspaceCameraModel() override;

private:
  vtkDspaceCameraModel(const vtkDspaceCameraModel&) = delete;
  void operator=(const vtkDspaceCameraModel&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
