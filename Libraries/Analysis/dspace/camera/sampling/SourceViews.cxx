#include <dspace/camera/sampling/SourceViews.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <dspace/Checks.h>

namespace dspace {
namespace {

constexpr int GridSide = 129;
constexpr double Far =
    1e3; // where the lens' scale is taken; pupils move by less than a millionth of it
constexpr double MostStretch = 4.0;
constexpr double Largest = 1e6; // pixels of a face's side

// A ray of the grid, with the derivative of the pixel by the direction's point at Z = 1 of a face.
struct Sample {
  bool seen = false;
  Eigen::Vector3d direction;
  LensModel::Jacobian jacobian; // by a point at the distance Far along the direction, times Far
};

// Axes of the faces of a cube: +Z, +X, -X, +Y, -Y, -Z of the camera.
Eigen::Matrix3d CubeFace(int face) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  const auto set = [&R](const Eigen::Vector3d& x, const Eigen::Vector3d& y,
                        const Eigen::Vector3d& z) {
    R.col(0) = x;
    R.col(1) = y;
    R.col(2) = z;
  };
  const Eigen::Vector3d X(1, 0, 0), Y(0, 1, 0), Z(0, 0, 1);
  switch (face) {
  case 1:
    set(-Z, Y, X);
    break;
  case 2:
    set(Z, Y, -X);
    break;
  case 3:
    set(X, -Z, Y);
    break;
  case 4:
    set(X, Z, -Y);
    break;
  case 5:
    set(-X, Y, -Z);
    break;
  default:
    break;
  }
  return R;
}

// Pixels of the image per tangent of the face, along the finest direction. Where a lens draws a
// point out into a circle, as behind an all-round lens, that is without limit: it counts as far as
// it exceeds the coarsest direction by MostStretch.
double ScaleOf(const Sample& sample, const Eigen::Matrix3d& R_CF) {
  const double z = R_CF.col(2).dot(sample.direction);
  // The direction at Z = 1 of the face is 1 / z long.
  const Eigen::Matrix2d across = sample.jacobian * R_CF.leftCols<2>() * z;
  const Eigen::Matrix2d square = across.transpose() * across;
  const double half = 0.5 * square.trace();
  const double root = std::sqrt(std::max(half * half - square.determinant(), 0.0));
  const double finest = std::sqrt(half + root), coarsest = std::sqrt(std::max(half - root, 0.0));
  return std::min(finest, MostStretch * coarsest);
}

} // namespace

SourceViews::SourceViews(const CameraModel& model, int block) : Block_(block) {
  const LensModel& lens = *model.lens;
  if (std::string(lens.Type()) == "line_scan") {
    throw Error(Error::Kind::Unsupported, model.Label(),
                "its row of pixels moves; accepted: a lens whose rays meet, or a range sensor with "
                "a beam for each pixel");
  }
  if (std::string(lens.Type()) == "orthographic") {
    this->SetParallel(model);
    return;
  }
  const int columns = std::min(model.width, GridSide), rows = std::min(model.height, GridSide);
  std::vector<Sample> samples(std::size_t(columns) * std::size_t(rows));
  Eigen::Vector3d low, high;
  low.setConstant(std::numeric_limits<double>::infinity());
  high = -low;
  const auto place = [](int i, int count, int side) { // from edge to edge
    return count == 1 ? 0.5 * (side - 1) : -0.5 + double(side) * i / (count - 1);
  };
  double widest = 0.0;
  bool any = false;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      Sample& sample = samples[std::size_t(j) * std::size_t(columns) + std::size_t(i)];
      LensRay ray;
      Eigen::Vector2d back;
      const Eigen::Vector2d pixel(place(i, columns, model.width), place(j, rows, model.height));
      if (!lens.Unproject(pixel, ray) ||
          !lens.Project(ray.origin + Far * ray.direction, back, &sample.jacobian)) {
        continue;
      }
      any = true;
      sample.seen = true;
      sample.direction = ray.direction;
      sample.jacobian *= Far;
      low = low.cwiseMin(ray.origin);
      high = high.cwiseMax(ray.origin);
      widest = std::max(widest, std::atan2(ray.direction.head<2>().norm(), ray.direction.z()));
    }
  }
  if (!any) {
    Reject(model.Label(), "no pixel of its image has a ray; accepted: a lens whose field covers a "
                          "part of it");
  }
  this->Eye_ = 0.5 * (low + high);
  this->PupilShift_ = 0.5 * (high - low).norm();
  this->Margin_ = lens.MovesPupil() ? MovingMargin : Margin;
  this->HalfAngle_deg_ = widest * 180.0 / M_PI;
  const bool single = this->HalfAngle_deg_ <= WidestSingle_deg;
  for (int side = 0; side < (single ? 1 : 6); ++side) {
    Face face;
    face.R_CF = CubeFace(side);
    double scale = 0.0;
    std::array<double, 4> bounds = {-1.0, 1.0, -1.0, 1.0}; // left, right, top, bottom
    if (single) {
      bounds = {HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};
    }
    double cell = 0.0; // the greatest distance between neighbours: what lies between samples
    for (std::size_t at = 0; at < samples.size(); ++at) {
      const Sample& sample = samples[at];
      if (!sample.seen) {
        continue;
      }
      const Eigen::Vector3d d = face.R_CF.transpose() * sample.direction;
      // A little beyond the face's edges, too: the finest place may lie on one.
      if (!(d.z() > 0.0) || (!single && d.head<2>().cwiseAbs().maxCoeff() > 1.05 * d.z())) {
        continue;
      }
      scale = std::max(scale, ScaleOf(sample, face.R_CF));
      if (single) {
        const Eigen::Vector2d t = d.head<2>() / d.z();
        bounds = {std::min(bounds[0], t.x()), std::max(bounds[1], t.x()),
                  std::min(bounds[2], t.y()), std::max(bounds[3], t.y())};
        for (const std::size_t next : {at + 1, at + std::size_t(columns)}) {
          const bool neighbour = next < samples.size() && samples[next].seen &&
                                 (next != at + 1 || next % std::size_t(columns) != 0);
          if (neighbour) {
            const Eigen::Vector3d& n = samples[next].direction;
            cell = std::max(cell, (n.head<2>() / n.z() - t).cwiseAbs().maxCoeff());
          }
        }
      }
    }
    this->Index_.push_back(scale > 0.0 ? int(this->Faces_.size()) : -1);
    if (!(scale > 0.0)) {
      continue;
    }
    face.scale = scale;
    const double spare =
        cell + this->PupilShift_ / 0.05 + 2.0 / scale; // nothing is nearer than 5 cm
    const double more = single ? spare : 2.0 / scale;
    face.left = bounds[0] - more;
    face.top = bounds[2] - more;
    this->AddFace(face, {bounds[1] + more, bounds[3] + more}, model);
  }
}

// The picture's own pixels, or finer ones where it has other scales across than down.
void SourceViews::SetParallel(const CameraModel& model) {
  this->Parallel_ = true;
  LensRay first, last;
  Eigen::Vector2d back;
  LensModel::Jacobian jacobian;
  const LensModel& lens = *model.lens;
  if (!lens.Unproject({-0.5, -0.5}, first) ||
      !lens.Unproject({model.width - 0.5, model.height - 0.5}, last) ||
      !lens.Project(first.origin + first.direction, back, &jacobian)) {
    Reject(model.Label(), "no pixel of its image has a ray; accepted: finite scales and centre");
  }
  Face face;
  const double finest = jacobian.leftCols<2>().cwiseAbs().maxCoeff();
  const double coarsest = jacobian.leftCols<2>().diagonal().cwiseAbs().minCoeff();
  face.scale = std::min(finest, MostStretch * coarsest);
  const Eigen::Vector2d low = first.origin.head<2>().cwiseMin(last.origin.head<2>());
  const Eigen::Vector2d high = first.origin.head<2>().cwiseMax(last.origin.head<2>());
  // With the picture's scale the grids are the same: no pixel is interpolated.
  face.left = low.x() - 2.0 / face.scale;
  face.top = low.y() - 2.0 / face.scale;
  this->Index_.push_back(0);
  this->AddFace(face, high.array() + 2.0 / face.scale, model);
}

// A face up to `far`, right and bottom.
void SourceViews::AddFace(Face face, const Eigen::Vector2d& far, const CameraModel& model) {
  // What is whole but for rounding has no further pixel.
  const double width = std::ceil((far.x() - face.left) * face.scale - 1e-9);
  const double height = std::ceil((far.y() - face.top) * face.scale - 1e-9);
  if (!(std::max(width, height) <= Largest)) {
    throw Error(Error::Kind::Resource, model.Label(),
                "a source view of " + NumberText(std::max(width, height)) +
                    " pixels a side would be needed; accepted: up to " + NumberText(Largest));
  }
  face.width = int(width);
  face.height = int(height);
  this->Faces_.push_back(face);
}

int SourceViews::FaceOf(const Eigen::Vector3d& d) const {
  if (this->Index_.size() == 1) {
    return d.z() > 0.0 ? 0 : -1;
  }
  const Eigen::Vector3d size = d.cwiseAbs();
  if (size.z() >= size.x() && size.z() >= size.y()) {
    return this->Index_[d.z() > 0.0 ? 0 : 5];
  }
  if (size.x() >= size.y()) {
    return this->Index_[d.x() > 0.0 ? 1 : 2];
  }
  return this->Index_[d.y() > 0.0 ? 3 : 4];
}

SourceViews::Place SourceViews::Find(const LensRay& ray) const {
  Place place;
  place.face = ray.direction.allFinite() ? this->FaceOf(ray.direction) : -1;
  if (place.face < 0) {
    return place;
  }
  const Face& face = this->Faces_[std::size_t(place.face)];
  const Eigen::Vector3d d = face.R_CF.transpose() * ray.direction;
  const Eigen::Vector2d at =
      this->Parallel_ ? ray.origin.head<2>().eval() : (d.head<2>() / d.z()).eval();
  place.x = (at.x() - face.left) * face.scale - 0.5;
  place.y = (at.y() - face.top) * face.scale - 0.5;
  if (!(place.x >= 0.0 && place.y >= 0.0 && place.x <= face.width - 1.0 &&
        place.y <= face.height - 1.0)) {
    place.face = -1;
  }
  return place;
}

SourceViews::Block SourceViews::BlockOf(const Place& place) const {
  return {place.face, int(place.x) / this->Block_, int(place.y) / this->Block_};
}

SourceViews::View SourceViews::ViewOf(const Block& block) const {
  const Face& face = this->Faces_[std::size_t(block.face)];
  View view;
  view.x = block.column * this->Block_ - this->Margin_;
  view.y = block.row * this->Block_ - this->Margin_;
  // The last blocks of a face are smaller.
  view.width = std::min(this->Block_, face.width - block.column * this->Block_) + 2 * this->Margin_;
  view.height = std::min(this->Block_, face.height - block.row * this->Block_) + 2 * this->Margin_;
  view.left = face.left + view.x / face.scale;
  view.right = face.left + (view.x + view.width) / face.scale;
  view.top = face.top + view.y / face.scale;
  view.bottom = face.top + (view.y + view.height) / face.scale;
  return view;
}

} // namespace dspace
