#include <dspace/crs/VerticalDatum.h>

#include <cmath>
#include <limits>
#include <sstream>

#include <dspace/Error.h>

namespace dspace {

namespace {

constexpr const char* Accepted =
    "unknown, ellipsoid, sphere[:R], radius[:R], areoid, geoid or relative, R in metres";
constexpr double Degree = 3.14159265358979323846 / 180.0;

bool Near(double a, double b, double tolerance) {
  return std::abs(a - b) < tolerance;
}

// How far the ellipsoid lies below the sphere of its semi-major axis at a planetocentric latitude.
double EllipsoidDrop(double a, double b, double latitude_deg) {
  const double s = std::sin(latitude_deg * Degree), c = std::cos(latitude_deg * Degree);
  return a - a * b / std::sqrt(b * b * c * c + a * a * s * s);
}

} // namespace

std::string VerticalDatum::Text() const {
  std::ostringstream out;
  out.precision(15);
  switch (this->kind) {
  case Kind::Unknown:
    return "unknown";
  case Kind::Ellipsoid:
    return "ellipsoid";
  case Kind::Areoid:
    return "areoid";
  case Kind::Geoid:
    return "geoid";
  case Kind::Relative:
    return "relative";
  case Kind::Sphere:
    out << "sphere";
    break;
  case Kind::Radius:
    out << "radius";
    break;
  }
  if (this->radius > 0.0)
    out << ":" << this->radius;
  return out.str();
}

VerticalDatum VerticalDatum::FromText(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string word = text.substr(0, colon);
  VerticalDatum datum;
  if (word == "unknown")
    datum.kind = Kind::Unknown;
  else if (word == "ellipsoid")
    datum.kind = Kind::Ellipsoid;
  else if (word == "sphere")
    datum.kind = Kind::Sphere;
  else if (word == "radius")
    datum.kind = Kind::Radius;
  else if (word == "areoid")
    datum.kind = Kind::Areoid;
  else if (word == "geoid")
    datum.kind = Kind::Geoid;
  else if (word == "relative")
    datum.kind = Kind::Relative;
  else
    throw Error(Error::Kind::InvalidArgument, "vertical datum '" + text + "'",
                std::string("accepted are ") + Accepted);
  if (colon != std::string::npos) {
    std::istringstream number(text.substr(colon + 1));
    const bool hasRadius = datum.kind == Kind::Sphere || datum.kind == Kind::Radius;
    if (!hasRadius || !(number >> datum.radius) || !number.eof() || !(datum.radius > 0.0) ||
        !std::isfinite(datum.radius))
      throw Error(Error::Kind::InvalidArgument, "vertical datum '" + text + "'",
                  std::string("the radius must be a positive number of metres; accepted are ") +
                      Accepted);
  }
  return datum;
}

double DatumErrorBound(const VerticalDatum& datum, const BodyAxes& axes, double latitude_deg) {
  const double a = axes.semiMajor;
  const bool mars = Near(a, 3396190.0, 6000.0);
  const bool earth = Near(a, 6378137.0, 1000.0);
  switch (datum.kind) {
  case VerticalDatum::Kind::Areoid:
    if (mars)
      return 2000.0 + EllipsoidDrop(3396190.0, 3376200.0, latitude_deg);
    break;
  case VerticalDatum::Kind::Geoid:
    if (earth)
      return 107.0;
    break;
  case VerticalDatum::Kind::Ellipsoid:
    return earth ? 0.0 : EllipsoidDrop(a, axes.semiMinor, latitude_deg);
  case VerticalDatum::Kind::Sphere:
    return datum.radius > 0.0 ? std::abs(datum.radius - a) : 0.0;
  case VerticalDatum::Kind::Radius:
    return 0.0;
  default:
    break;
  }
  return std::numeric_limits<double>::infinity();
}

std::string DatumWarning(const VerticalDatum& datum, const BodyAxes& axes, double latitude_deg) {
  std::ostringstream out;
  const double bound = DatumErrorBound(datum, axes, latitude_deg);
  switch (datum.kind) {
  case VerticalDatum::Kind::Areoid:
  case VerticalDatum::Kind::Geoid:
    out << "heights are above the " << datum.Text()
        << ", whose grid is not used: positions on the body are off by ";
    if (std::isfinite(bound))
      out << "up to " << std::ceil(bound) << " m";
    else
      out << "an amount for which no bound is known on this body";
    break;
  case VerticalDatum::Kind::Unknown:
    out << "the vertical datum is not stated: heights are shown as they are, and their zero is "
           "unknown; give one of "
        << Accepted;
    break;
  default:
    break;
  }
  return out.str();
}

} // namespace dspace
