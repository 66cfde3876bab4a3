#include <dspace/crs/CrsTransform.h>

#include <cmath>
#include <limits>
#include <mutex>
#include <sstream>

#include <ogr_spatialref.h>

#include <dspace/Error.h>

#include <dspace/crs/ProjGrids.h>
#include <dspace/gdal/GdalErrors.h>
#include <dspace/gdal/OgrLock.h>

namespace dspace {

using Transformation = std::unique_ptr<OGRCoordinateTransformation>;

struct CrsTransform::Implementation {
  std::string name;
  std::mutex mutex; // a transformation object is not safe to share between threads
  Transformation forward;
  Transformation inverse;

  Eigen::Vector2d Run(OGRCoordinateTransformation& transformation, const Eigen::Vector2d& p) {
    const std::lock_guard<std::mutex> lock(this->mutex);
    GdalErrors errors;
    double x = p.x(), y = p.y();
    if (!transformation.Transform(1, &x, &y) || !std::isfinite(x) || !std::isfinite(y)) {
      std::ostringstream out;
      out.precision(15);
      out << "(" << p.x() << ", " << p.y()
          << ") cannot be converted: " << errors.Message("the projection has no value there");
      throw Error(Error::Kind::InvalidArgument, this->name, out.str());
    }
    return {x, y};
  }
};

CrsTransform::CrsTransform(const Crs& from, const Crs& to)
    : Impl_(std::make_unique<Implementation>()) {
  this->Impl_->name = "conversion '" + from.GetName() + "' to '" + to.GetName() + "'";
  if (!from.Ogr() || !to.Ogr())
    throw Error(Error::Kind::Unsupported, this->Impl_->name, "both sides need a CRS");
  const std::lock_guard<std::mutex> lock(OgrMutex());
  GdalErrors errors;
  this->Impl_->forward.reset(OGRCreateCoordinateTransformation(from.Ogr(), to.Ogr()));
  this->Impl_->inverse.reset(OGRCreateCoordinateTransformation(to.Ogr(), from.Ogr()));
  if (!this->Impl_->forward || !this->Impl_->inverse)
    throw Error(Error::Kind::Unsupported, this->Impl_->name,
                errors.Message("PROJ has no conversion; both must be of one body"));
  NoteGrids(*from.Ogr(), *to.Ogr());
}

CrsTransform::~CrsTransform() = default;

Eigen::Vector2d CrsTransform::Apply(const Eigen::Vector2d& p) const {
  return this->Impl_->Run(*this->Impl_->forward, p);
}

Eigen::Vector2d CrsTransform::ApplyInverse(const Eigen::Vector2d& p) const {
  return this->Impl_->Run(*this->Impl_->inverse, p);
}

void CrsTransform::TryApply(Eigen::Matrix2Xd& points) const {
  const auto count = int(points.cols());
  std::vector<double> x(points.cols()), y(points.cols());
  std::vector<int> good(points.cols());
  for (int i = 0; i < count; ++i) {
    x[std::size_t(i)] = points(0, i);
    y[std::size_t(i)] = points(1, i);
  }
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  const GdalErrors quiet;
  this->Impl_->forward->Transform(count, x.data(), y.data(), nullptr, good.data());
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d to(x[std::size_t(i)], y[std::size_t(i)]);
    points.col(i) = good[std::size_t(i)] && to.allFinite()
                        ? to
                        : Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
}

} // namespace dspace
