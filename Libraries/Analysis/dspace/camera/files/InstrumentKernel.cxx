#include <dspace/camera/files/InstrumentKernel.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/camera/files/ModelText.h>
#include <dspace/kernels/FieldOfView.h>

namespace dspace {
namespace {

CameraModel CameraOf(const FieldOfView& field, const std::string& name, int width, int height,
                     const std::string& label) {
  CameraModel model;
  model.name = name;
  model.frame = field.frame;
  model.width = width;
  model.height = height;
  const Eigen::Vector3d& z = field.boresight;
  const bool alongX = std::abs(z.x()) > 0.9;
  const Eigen::Vector3d axis = alongX ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d x = (axis - axis.dot(z) * z).normalized();
  Eigen::Matrix3d R_MC;
  R_MC << x, z.cross(x), z;
  model.q_MC = Eigen::Quaterniond(R_MC);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& corner : field.boundary) {
    const Eigen::Vector3d p_C = R_MC.transpose() * corner;
    box.extend(Eigen::Vector2d(p_C.head<2>() / p_C.z()));
  }
  const Eigen::Vector2d focal = Eigen::Vector2d(width, height).cwiseQuotient(box.sizes());
  const Eigen::Vector2d center = -box.min().cwiseProduct(focal) - Eigen::Vector2d::Constant(0.5);
  model.lens =
      MakeLens("pinhole", {{"focal", {focal.x(), focal.y()}}, {"center", {center.x(), center.y()}}},
               label + ", instrument " + name);
  return model;
}

} // namespace

bool IsInstrumentKernel(const std::string& text) {
  return text.compare(0, 6, "KPL/IK") == 0;
}

std::vector<CameraModel> ParseInstrumentKernel(const std::string& text, const std::string& label) {
  KernelPool pool;
  pool.Add(TextKernel::Parse(text, label));
  std::vector<CameraModel> models;
  for (const int instrument : Instruments(pool)) {
    const std::string name = "INS" + std::to_string(instrument);
    if (!pool.Has(name + "_PIXEL_SAMPLES") || !pool.Has(name + "_PIXEL_LINES")) {
      continue;
    }
    const FieldOfView field = FieldOfViewOf(pool, instrument);
    if (field.shape != FieldShape::Rectangle) {
      continue;
    }
    const int width = ImageSide(pool.Number(name + "_PIXEL_SAMPLES"), "the width", label);
    const int height = ImageSide(pool.Number(name + "_PIXEL_LINES"), "the height", label);
    models.push_back(CameraOf(field, name, width, height, label));
  }
  if (models.empty()) {
    throw Error(Error::Kind::Unsupported, label,
                "it has no instrument with a rectangular field of view and a number of pixels "
                "(PIXEL_SAMPLES, PIXEL_LINES); accepted: kernels with one");
  }
  return models;
}

} // namespace dspace
