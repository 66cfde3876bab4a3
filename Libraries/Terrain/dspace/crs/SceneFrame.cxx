#include <dspace/crs/SceneFrame.h>

#include <cmath>

#include <dspace/Error.h>

namespace dspace {

SceneFrame::SceneFrame(const Crs& crs, const Eigen::Vector2d& origin, double originHeight)
    : Origin_(origin), OriginHeight_(originHeight) {
  if (!origin.allFinite() || !std::isfinite(originHeight))
    throw Error(Error::Kind::InvalidArgument, "scene origin", "its coordinates must be finite");
  if (std::abs(originHeight) > 1e9)
    throw Error(Error::Kind::InvalidArgument, "scene origin",
                "its height is " + std::to_string(originHeight) + " m; accepted is -1e9 to 1e9 m");
  Eigen::Vector2d metres(crs.GetUnit(), crs.GetUnit());
  if (crs.GetKind() == Crs::Kind::Geographic) {
    const double latitude_deg = origin.y() * crs.GetUnit();
    if (std::abs(latitude_deg) > 89.0)
      throw Error(Error::Kind::InvalidArgument, "scene origin",
                  "latitude " + std::to_string(latitude_deg) +
                      " is too near the pole; accepted is -89 to 89, or a raster in a polar "
                      "projection");
    const double degree = M_PI / 180.0;
    const double a = crs.GetAxes().semiMajor, b = crs.GetAxes().semiMinor;
    const double s = std::sin(latitude_deg * degree), c = std::cos(latitude_deg * degree);
    const double e2 = 1.0 - (b / a) * (b / a);
    const double w = std::sqrt(1.0 - e2 * s * s);
    const double N = a / w, M = a * (1.0 - e2) / (w * w * w);
    metres = crs.GetUnit() * degree * Eigen::Vector2d(N * c, M);
  }
  this->Metres_ = metres.cwiseProduct(crs.GetAxisSigns());
}

Eigen::Affine2d SceneFrame::PostToScene(const Eigen::Affine2d& pixelToMap) const {
  const Eigen::Vector2d first = pixelToMap * Eigen::Vector2d(0.5, 0.5);
  Eigen::Affine2d m = Eigen::Affine2d::Identity();
  m.linear() = this->Metres_.asDiagonal() * pixelToMap.linear();
  m.translation() = (first - this->Origin_).cwiseProduct(this->Metres_);
  return m;
}

} // namespace dspace
