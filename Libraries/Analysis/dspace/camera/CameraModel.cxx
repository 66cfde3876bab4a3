#include <dspace/camera/CameraModel.h>

#include <algorithm>
#include <cmath>

#include <Eigen/SVD>

#include <dspace/Checks.h>

namespace dspace {
namespace {

constexpr int GridSide = 129;

std::vector<double> ListOf(const Eigen::Vector3d& v) {
  return {v[0], v[1], v[2]};
}

// Turns the vectors of a lens by R.
LensValues Turned(LensValues values, const Eigen::Matrix3d& R) {
  for (const char* name : {"A", "H", "V", "O"}) {
    const auto found = values.find(name);
    if (found != values.end() && found->second.size() == 3) {
      found->second = ListOf(R * Eigen::Vector3d(found->second.data()));
    }
  }
  return values;
}

} // namespace

std::string CameraModel::Label() const {
  return this->name.empty() ? "camera model" : "camera '" + this->name + "'";
}

bool CameraModel::Project(const Eigen::Vector3d& p_M, Eigen::Vector2d& pixel,
                          LensModel::Jacobian* jacobian) const {
  const Eigen::Matrix3d R_CM = this->q_MC.toRotationMatrix().transpose();
  if (!this->lens->Project(R_CM * (p_M - this->p_MC), pixel, jacobian)) {
    return false;
  }
  if (jacobian) {
    *jacobian *= R_CM;
  }
  return true;
}

bool CameraModel::Unproject(const Eigen::Vector2d& pixel, LensRay& ray) const {
  if (!this->lens->Unproject(pixel, ray)) {
    return false;
  }
  ray.origin = this->q_MC * ray.origin + this->p_MC;
  ray.direction = this->q_MC * ray.direction;
  return true;
}

CameraModel CameraModel::Scaled(int to_width, int to_height) const {
  if (this->width < 1 || this->height < 1) {
    Reject(this->Label(), "it does not say for which size of image it is; accepted: a model that "
                          "does, to be scaled");
  }
  const double x = double(to_width) / this->width, y = double(to_height) / this->height;
  if (to_width < 1 || to_height < 1 ||
      std::abs(double(to_width) * this->height / this->width - to_height) > 0.5 + 1e-9) {
    Reject(this->Label(), "a size of " + std::to_string(to_width) + " x " +
                              std::to_string(to_height) + " is not that of its image, " +
                              std::to_string(this->width) + " x " + std::to_string(this->height) +
                              ", times a number; accepted: a size of the same shape");
  }
  CameraModel scaled = *this;
  scaled.width = to_width;
  scaled.height = to_height;
  scaled.lens = this->lens->Scaled(x, y);
  return scaled;
}

LensCheck CheckLens(const CameraModel& model) {
  if (model.width < 1 || model.height < 1) {
    Reject(model.Label(), "it does not say for which size of image it is; accepted: a size in the "
                          "model, or given");
  }
  LensCheck check;
  check.field = model.lens->Field();
  const int columns = std::min(model.width, GridSide), rows = std::min(model.height, GridSide);
  int without = 0;
  check.density[0] = HUGE_VAL;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const Eigen::Vector2d pixel(columns == 1 ? 0.0 : (model.width - 1.0) * i / (columns - 1),
                                  rows == 1 ? 0.0 : (model.height - 1.0) * j / (rows - 1));
      LensRay ray;
      if (!model.lens->Unproject(pixel, ray)) {
        ++without;
        continue;
      }
      const double angle = std::atan2(ray.direction.head<2>().norm(), ray.direction.z());
      check.halfAngle_deg = std::max(check.halfAngle_deg, angle * 180.0 / M_PI);
      check.pupilShift = std::max(check.pupilShift, ray.origin.norm());
      Eigen::Vector2d back;
      LensModel::Jacobian jacobian;
      if (!model.lens->Project(ray.origin + ray.direction, back, &jacobian)) {
        ++without;
        continue;
      }
      check.roundTrip = std::max(check.roundTrip, (back - pixel).norm());
      // At a distance of 1 m a radian across the ray is a metre.
      const Eigen::Matrix3d across =
          Eigen::Matrix3d::Identity() - ray.direction * ray.direction.transpose();
      const Eigen::Matrix2d square = jacobian * across * jacobian.transpose();
      const double trace = square.trace(), determinant = square.determinant();
      const double root = std::sqrt(std::max(0.25 * trace * trace - determinant, 0.0));
      const double degree = M_PI / 180.0;
      check.density[0] =
          std::min(check.density[0], std::sqrt(std::max(0.5 * trace - root, 0.0)) * degree);
      check.density[1] = std::max(check.density[1], std::sqrt(0.5 * trace + root) * degree);
    }
  }
  check.withoutRay = double(without) / (double(columns) * rows);
  check.density[0] = std::isfinite(check.density[0]) ? check.density[0] : 0.0;
  return check;
}

void PutCahvore(const std::string& type, const Eigen::Vector3d& C, const LensValues& values,
                CameraModel& model, const std::string& label) {
  MakeLens(type, values, label); // rejects wrong ones
  const Eigen::Vector3d Z = Eigen::Vector3d(values.at("A").data()).normalized();
  const Eigen::Vector3d H(values.at("H").data());
  Eigen::Matrix3d R_MC;
  R_MC.col(0) = (H - Z.dot(H) * Z).normalized();
  R_MC.col(2) = Z;
  R_MC.col(1) = R_MC.col(2).cross(R_MC.col(0));
  model.q_MC = Eigen::Quaterniond(R_MC).normalized();
  model.p_MC = C;
  RequirePosition(label, "C", C);
  model.lens = MakeLens(type, Turned(values, model.q_MC.toRotationMatrix().transpose()), label);
}

LensValues CahvoreOf(const CameraModel& model) {
  LensValues values = Turned(model.lens->Values(), model.q_MC.toRotationMatrix());
  values["C"] = ListOf(model.p_MC);
  return values;
}

} // namespace dspace
