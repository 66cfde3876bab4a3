#include <dspace/commands/measure/MeasuredPictures.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/measure/PictureReadings.h>

namespace dspace::session {
namespace {

constexpr int StandardResolution = 2048;
constexpr int SightSize = 17;        // pixels of a telephoto picture
constexpr double Reach = 1.0 - 1e-4; // of a line of sight
constexpr double FarAway = 1e6;      // [m] towards the Sun from which shadows fall
constexpr double Margin = 1.02;      // of the picture around an object

// A camera at a place, forward and up in the root; `up` need not be normal to `forward`.
Pose CameraAt(const Eigen::Vector3d& p_R, const Eigen::Vector3d& forward,
              const Eigen::Vector3d& up) {
  Eigen::Matrix3d axes;
  axes.col(2) = forward.normalized();
  Eigen::Vector3d right = axes.col(2).cross(up);
  if (right.norm() < 1e-9) {
    right = axes.col(2).unitOrthogonal();
  }
  axes.col(0) = right.normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  Pose pose;
  pose.position = p_R;
  pose.rotation = Eigen::Quaterniond(axes);
  return pose;
}

} // namespace

MeasuredPictures::MeasuredPictures(const Context& context, const v1::Measuring& measuring,
                                   const MeasuredScene& scene, const std::string& command,
                                   const std::set<ObjectId>& measured)
    : Context_(context),
      Resolution_(measuring.has_resolution() ? int(measuring.resolution()) : StandardResolution),
      HiddenFragments_(measuring.hidden_fragment().begin(), measuring.hidden_fragment().end()) {
  if (measuring.has_resolution() &&
      (measuring.resolution() < 16 || measuring.resolution() > 16384)) {
    Reject(command, "the resolution is " + std::to_string(measuring.resolution()) +
                        "; accepted: 16 to 16,384 pixels");
  }
  if (!context.state.pictures) {
    throw Error(Error::Kind::Unsupported, command,
                "this process draws no pictures; accepted: the method EXACT");
  }
  Scene& shown = context.GetScene();
  for (const auto& [id, object] : shown.Objects()) {
    if (object.visible && !scene.IsObstacle(id) && measured.count(id) == 0) {
      this->Hidden_.push_back(id);
    }
  }
  for (const ObjectId id : this->Hidden_) {
    shown.SetObjectVisible(id, false);
  }
}

MeasuredPictures::~MeasuredPictures() {
  this->Series_.reset();
  for (const ObjectId id : this->Hidden_) {
    this->Context_.GetScene().SetObjectVisible(id, true);
  }
}

PictureSeries& MeasuredPictures::Series(int size) {
  if (size != this->Size_) {
    this->Series_.reset();
    this->Series_ = this->Context_.state.pictures->Begin(this->Context_.scene->scene, size, size,
                                                         this->HiddenFragments_);
    this->Size_ = size;
  }
  return *this->Series_;
}

double MeasuredPictures::PixelAngle() const {
  return dspace::PixelAngle(this->Resolution_);
}

bool MeasuredPictures::Clear(const Eigen::Vector3d& from_R, const Eigen::Vector3d& to_R,
                             double* reach) {
  const Eigen::Vector3d along = to_R - from_R;
  Projection projection;
  projection.verticalFov_deg = std::min(170.0, SightSize * this->PixelAngle());
  // Nearer obstacles count too.
  projection.nearDistance = std::clamp(1e-3 * along.norm(), 1e-6, 1e-3);
  const Picture picture =
      this->Series(SightSize).Take(projection, CameraAt(from_R, along, along.unitOrthogonal()));
  *reach = picture.range[std::size_t(SightSize) * (SightSize / 2) + SightSize / 2];
  return *reach >= Reach * along.norm();
}

MeasuredPictures::Skyline MeasuredPictures::Horizon(const Eigen::Vector3d& place_R,
                                                    const LevelAxes& axes, std::size_t count) {
  constexpr double Nan = std::numeric_limits<double>::quiet_NaN();
  Skyline found;
  found.elevation_deg.resize(count);
  found.distance.assign(count, std::numeric_limits<double>::infinity());
  found.point.assign(count, Eigen::Vector3d::Constant(Nan));
  const int size = this->Resolution_;
  const double half = 0.5 * size; // [pixels] per unit of tangent
  Projection projection;
  projection.verticalFov_deg = 90.0;
  projection.nearDistance = 1e-3;
  for (int side = 0; side < 4; ++side) {
    const double middle = side * M_PI / 2.0;
    const Eigen::Vector3d forward = std::cos(middle) * axes.north + std::sin(middle) * axes.east;
    const Pose& camera = found.cameras.emplace_back(CameraAt(place_R, forward, axes.up));
    const Picture picture = this->Series(size).Take(projection, camera);
    for (std::size_t i = 0; i < count; ++i) {
      double right_deg = 360.0 * double(i) / double(count) - 90.0 * side;
      right_deg -= 360.0 * std::round(right_deg / 360.0);
      if (right_deg < -45.0 || right_deg >= 45.0) {
        continue;
      }
      const HorizonReading reading = ReadHorizon(picture.range, size, right_deg);
      found.elevation_deg[i] = reading.over ? Nan : reading.elevation_deg;
      if (reading.range > 0.0f) {
        const Eigen::Vector3d ray((reading.column + 0.5 - half) / half,
                                  (reading.row + 0.5 - half) / half, 1.0);
        found.distance[i] = double(reading.range);
        found.point[i] = camera.Apply(double(reading.range) * ray.normalized());
      }
    }
  }
  return found;
}

std::pair<double, double> MeasuredPictures::Seen(ObjectId object, const std::vector<Face>& faces,
                                                 const Eigen::Vector3d& towards_R) {
  Eigen::AlignedBox3d box;
  for (const Face& face : faces) {
    for (const Eigen::Vector3d& corner : face) {
      box.extend(corner);
    }
  }
  const double radius = std::max(0.5 * box.diagonal().norm(), 1e-6);
  Projection projection;
  projection.kind = Projection::Kind::Orthographic;
  projection.height = 2.0 * Margin * radius;
  projection.nearDistance = -std::max(FarAway, 10.0 * radius);
  projection.farDistance = 2.0 * radius;
  const int size = this->Resolution_;
  const Picture picture = this->Series(size).Take(
      projection, CameraAt(box.center(), -towards_R, towards_R.unitOrthogonal()));
  const double pixel = projection.height / size;
  return {double(CountLabel(picture.label, object)) * pixel * pixel, pixel * pixel};
}

} // namespace dspace::session
