#include "vtkDspaceCameraModel.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include <dspace/RowThreads.h>
#include <dspace/camera/ConvertModel.h>
#include <dspace/camera/files/CameraFiles.h>
#include <dspace/camera/files/CameraJson.h>

#include "ErrorAnswer.h"
#include "vtkDoubleArray.h"
#include "vtkObjectFactory.h"

using dspace::session::ErrorAnswer;

vtkStandardNewMacro(vtkDspaceCameraModel);

struct vtkDspaceCameraModel::Internals {
  std::vector<dspace::CameraModel> models;
  std::size_t selected = 0;

  dspace::CameraModel& Get() {
    if (this->models.empty()) {
      throw dspace::Error(dspace::Error::Kind::Internal, "camera model", "none was read");
    }
    return this->models[this->selected];
  }
};

namespace {

void Put(const std::vector<double>& from, vtkDoubleArray* to) {
  to->SetNumberOfComponents(1);
  to->SetNumberOfTuples(vtkIdType(from.size()));
  std::copy(from.begin(), from.end(), to->GetPointer(0));
}

void RequireComponents(vtkDoubleArray* array, int count) {
  if (!array || array->GetNumberOfComponents() != count) {
    throw dspace::Error(dspace::Error::Kind::Internal, "camera model",
                        "an array has other than " + std::to_string(count) + " components");
  }
}

constexpr int LensWork = 16; // of one point or pixel (ForRows)

int RowsOf(vtkIdType count) {
  if (count > std::numeric_limits<int>::max()) {
    throw dspace::Error(dspace::Error::Kind::InvalidArgument, "camera model",
                        "there are " + std::to_string(count) +
                            " points or pixels; accepted: up to 2147483647");
  }
  return int(count);
}

} // namespace

vtkDspaceCameraModel::vtkDspaceCameraModel() : Impl(std::make_unique<Internals>()) {}

vtkDspaceCameraModel::~vtkDspaceCameraModel() = default;

void vtkDspaceCameraModel::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Models: " << this->Impl->models.size() << "\n";
}

std::string vtkDspaceCameraModel::Read(const std::string& path) {
  return ErrorAnswer([&] {
    this->Impl->models = dspace::ReadCameraModels(path);
    this->Impl->selected = 0;
  });
}

std::string vtkDspaceCameraModel::Parse(const std::string& json) {
  return ErrorAnswer([&] {
    this->Impl->models = dspace::ParseCameraJson(json, "camera model");
    this->Impl->selected = 0;
  });
}

int vtkDspaceCameraModel::GetNumber() {
  return int(this->Impl->models.size());
}

void vtkDspaceCameraModel::Select(int index) {
  if (index >= 0 && index < this->GetNumber()) {
    this->Impl->selected = std::size_t(index);
  }
}

std::string vtkDspaceCameraModel::Write(const std::string& path) {
  return ErrorAnswer([&] { dspace::WriteCameraModel(path, this->Impl->Get()); });
}

std::string vtkDspaceCameraModel::GetJson() {
  return this->Impl->models.empty() ? std::string() : dspace::CameraJsonOf(this->Impl->Get());
}

std::string vtkDspaceCameraModel::Scale(int width, int height) {
  return ErrorAnswer([&] {
    dspace::CameraModel& model = this->Impl->Get();
    model = model.Scaled(width, height);
  });
}

std::string vtkDspaceCameraModel::Convert(const std::string& type, vtkDoubleArray* values) {
  return ErrorAnswer([&] {
    const dspace::ConvertedModel to = dspace::ConvertModel(this->Impl->Get(), type);
    this->Impl->Get() = to.model;
    Put({to.rms, to.greatest, to.covered, to.pupilShift}, values);
  });
}

std::string vtkDspaceCameraModel::Check(vtkDoubleArray* values) {
  return ErrorAnswer([&] {
    const dspace::LensCheck check = dspace::CheckLens(this->Impl->Get());
    Put({check.field.limit_deg, check.withoutRay, check.halfAngle_deg, check.density[0],
         check.density[1], check.pupilShift, check.roundTrip},
        values);
  });
}

std::string vtkDspaceCameraModel::GetFieldEnd() {
  return this->Impl->models.empty() ? std::string() : this->Impl->Get().lens->Field().end;
}

std::string vtkDspaceCameraModel::Project(vtkDoubleArray* points, bool inCamera,
                                          vtkDoubleArray* pixels, vtkDoubleArray* derivatives) {
  return ErrorAnswer([&] {
    const dspace::CameraModel& model = this->Impl->Get();
    RequireComponents(points, 3);
    const vtkIdType count = points->GetNumberOfTuples();
    pixels->SetNumberOfComponents(2);
    pixels->SetNumberOfTuples(count);
    if (derivatives) {
      derivatives->SetNumberOfComponents(6);
      derivatives->SetNumberOfTuples(count);
    }
    const double* from = points->GetPointer(0);
    double* to = pixels->GetPointer(0);
    double* slope = derivatives ? derivatives->GetPointer(0) : nullptr;
    const Eigen::Matrix3d R_CM = inCamera
                                     ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                     : Eigen::Matrix3d(model.q_MC.toRotationMatrix().transpose());
    const Eigen::Vector3d p_MC = inCamera ? Eigen::Vector3d(0, 0, 0) : model.p_MC;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    dspace::ForRows(RowsOf(count), LensWork, [&](int first, int last) {
      for (int i = first; i < last; ++i) {
        const Eigen::Vector3d p_C = R_CM * (Eigen::Vector3d(from + 3 * std::ptrdiff_t(i)) - p_MC);
        Eigen::Vector2d pixel;
        dspace::LensModel::Jacobian jacobian;
        const bool seen = model.lens->Project(p_C, pixel, slope ? &jacobian : nullptr);
        to[2 * std::ptrdiff_t(i)] = seen ? pixel.x() : nan;
        to[2 * std::ptrdiff_t(i) + 1] = seen ? pixel.y() : nan;
        if (slope && seen) {
          jacobian *= R_CM;
        }
        for (int k = 0; slope && k < 6; ++k) {
          slope[6 * std::ptrdiff_t(i) + k] = seen ? jacobian(k / 3, k % 3) : nan;
        }
      }
    });
  });
}

std::string vtkDspaceCameraModel::Unproject(vtkDoubleArray* pixels, bool inCamera,
                                            vtkDoubleArray* rays) {
  return ErrorAnswer([&] {
    const dspace::CameraModel& model = this->Impl->Get();
    RequireComponents(pixels, 2);
    const vtkIdType count = pixels->GetNumberOfTuples();
    rays->SetNumberOfComponents(6);
    rays->SetNumberOfTuples(count);
    const double* from = pixels->GetPointer(0);
    double* to = rays->GetPointer(0);
    dspace::ForRows(RowsOf(count), LensWork, [&](int first, int last) {
      for (int i = first; i < last; ++i) {
        dspace::LensRay ray;
        const Eigen::Vector2d pixel(from + 2 * std::ptrdiff_t(i));
        double* const at = to + 6 * std::ptrdiff_t(i);
        if (inCamera ? model.lens->Unproject(pixel, ray) : model.Unproject(pixel, ray)) {
          std::copy_n(ray.origin.data(), 3, at);
          std::copy_n(ray.direction.data(), 3, at + 3);
        } else {
          std::fill_n(at, 6, std::numeric_limits<double>::quiet_NaN());
        }
      }
    });
  });
}
