#include <dspace/kernels/FieldOfView.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <set>

#include <Eigen/Geometry>

#include <dspace/Checks.h>

namespace dspace {
namespace {

std::string Upper(std::string text) {
  for (char& c : text) {
    c = char(std::toupper(static_cast<unsigned char>(c)));
  }
  return text;
}

// Reads the variables INS<id>_... of one instrument.
class Reader {
public:
  Reader(const KernelPool& pool, int instrument)
      : Pool_(pool), Prefix_("INS" + std::to_string(instrument) + "_") {}

  std::string Name(const std::string& item) const { return this->Prefix_ + item; }

  [[noreturn]] void Fail(const std::string& item, const std::string& what) const {
    throw Error(Error::Kind::Corrupt, "kernel variable '" + this->Name(item) + "'", what);
  }

  const KernelVariable& Get(const std::string& item) const {
    if (const KernelVariable* found = this->Pool_.Find(this->Name(item))) {
      return *found;
    }
    this->Fail(item, "it is missing; its field of view needs it");
  }

  std::string Text(const std::string& item) const {
    this->Get(item);
    return this->Pool_.Text(this->Name(item));
  }

  Eigen::Vector3d Unit(const std::string& item) const {
    this->Get(item);
    const std::vector<double>& v = this->Pool_.Numbers(this->Name(item), 3);
    return this->Unit(item, v.data());
  }

  Eigen::Vector3d Unit(const std::string& item, const double* v) const {
    const Eigen::Vector3d vector(v[0], v[1], v[2]);
    const double norm = vector.stableNorm();
    if (!(norm > 0.0)) {
      this->Fail(item, "it has a zero vector; accepted: directions");
    }
    return vector / norm;
  }

  // [rad]
  double Angle(const std::string& item) const {
    this->Get(item);
    const std::string units = Upper(this->Text("FOV_ANGLE_UNITS"));
    static const std::pair<const char*, double> Units[] = {
        {"DEGREES", M_PI / 180.0},       {"RADIANS", 1.0},           {"ARCMINUTES", M_PI / 10800.0},
        {"ARCSECONDS", M_PI / 648000.0}, {"HOURANGLE", M_PI / 12.0}, {"MINUTEANGLE", M_PI / 720.0},
        {"SECONDANGLE", M_PI / 43200.0}};
    for (const auto& [name, unit] : Units) {
      if (units == name) {
        return this->Pool_.Number(this->Name(item)) * unit;
      }
    }
    this->Fail("FOV_ANGLE_UNITS", "it is '" + units +
                                      "'; accepted: DEGREES, RADIANS, ARCMINUTES, "
                                      "ARCSECONDS");
  }

private:
  const KernelPool& Pool_;
  std::string Prefix_;
};

std::vector<Eigen::Vector3d> BoundaryFromAngles(const Reader& reader, FieldShape shape,
                                                const Eigen::Vector3d& boresight) {
  const Eigen::Vector3d reference = reader.Unit("FOV_REF_VECTOR");
  const Eigen::Vector3d cross = boresight.cross(reference);
  if (!(cross.norm() > 1e-10)) {
    reader.Fail("FOV_REF_VECTOR", "it lies along the boresight; accepted: another direction");
  }
  const Eigen::Vector3d second = cross.normalized();
  const Eigen::Vector3d first = second.cross(boresight); // the reference vector, square to it
  const double a = reader.Angle("FOV_REF_ANGLE");
  const bool round = shape == FieldShape::Circle;
  if (!(a > 0.0 && a < (round ? M_PI : 0.5 * M_PI))) {
    reader.Fail("FOV_REF_ANGLE", "it is " + NumberText(a * 180.0 / M_PI) +
                                     " degrees; accepted: above 0 and below " +
                                     (round ? "180" : "90"));
  }
  const auto turned = [&](double angle, const Eigen::Vector3d& towards) {
    return Eigen::Vector3d(std::cos(angle) * boresight + std::sin(angle) * towards);
  };
  if (round) {
    return {turned(a, first)};
  }
  const double b = reader.Angle("FOV_CROSS_ANGLE");
  if (!(b > 0.0 && b < 0.5 * M_PI)) {
    reader.Fail("FOV_CROSS_ANGLE",
                "it is " + NumberText(b * 180.0 / M_PI) + " degrees; accepted: above 0, below 90");
  }
  if (shape == FieldShape::Ellipse) {
    return {turned(a, first), turned(b, second)};
  }
  std::vector<Eigen::Vector3d> corners; // where the planes of the sides meet
  for (const auto& [u, v] :
       {std::pair(1.0, 1.0), std::pair(-1.0, 1.0), std::pair(-1.0, -1.0), std::pair(1.0, -1.0)}) {
    corners.push_back(
        (boresight + u * std::tan(a) * first + v * std::tan(b) * second).normalized());
  }
  return corners;
}

} // namespace

const char* FieldShapeName(FieldShape shape) {
  switch (shape) {
  case FieldShape::Polygon:
    return "POLYGON";
  case FieldShape::Rectangle:
    return "RECTANGLE";
  case FieldShape::Circle:
    return "CIRCLE";
  default:
    return "ELLIPSE";
  }
}

double FieldOfView::RadiusDeg() const {
  double radius = 0.0;
  for (const Eigen::Vector3d& v : this->boundary) {
    radius = std::max(radius, std::atan2(v.cross(this->boresight).norm(), v.dot(this->boresight)));
  }
  return radius * 180.0 / M_PI;
}

std::vector<int> Instruments(const KernelPool& pool) {
  std::set<int> out;
  const std::string prefix = "INS";
  const std::string suffix = "_FOV_SHAPE";
  for (auto it = pool.Variables().lower_bound(prefix); it != pool.Variables().end(); ++it) {
    const std::string& name = it->first;
    if (name.compare(0, prefix.size(), prefix) != 0) {
      break;
    }
    if (name.size() > prefix.size() + suffix.size() &&
        name.compare(name.size() - suffix.size(), suffix.size(), suffix) == 0) {
      const std::string id =
          name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
      char* end = nullptr;
      const long value = std::strtol(id.c_str(), &end, 10);
      if (*end == '\0' && id.size() < 10) {
        out.insert(int(value));
      }
    }
  }
  return {out.begin(), out.end()};
}

FieldOfView FieldOfViewOf(const KernelPool& pool, int instrument) {
  const Reader reader(pool, instrument);
  if (!pool.Has(reader.Name("FOV_SHAPE"))) {
    std::string known;
    for (const int other : Instruments(pool)) {
      known += (known.empty() ? "" : ", ") + std::to_string(other);
    }
    throw Error(Error::Kind::NotFound, "instrument " + std::to_string(instrument),
                "no loaded instrument kernel has its field of view; " +
                    (known.empty() ? std::string("none is loaded") : "loaded: " + known));
  }
  FieldOfView out;
  out.instrument = instrument;
  const std::string shape = Upper(reader.Text("FOV_SHAPE"));
  bool known = false;
  for (const FieldShape candidate :
       {FieldShape::Polygon, FieldShape::Rectangle, FieldShape::Circle, FieldShape::Ellipse}) {
    if (shape == FieldShapeName(candidate)) {
      out.shape = candidate;
      known = true;
    }
  }
  if (!known) {
    reader.Fail("FOV_SHAPE",
                "it is '" + shape + "'; accepted: POLYGON, RECTANGLE, CIRCLE, ELLIPSE");
  }
  out.frame = reader.Text("FOV_FRAME");
  out.boresight = reader.Unit("BORESIGHT");
  const std::string spec = pool.Has(reader.Name("FOV_CLASS_SPEC"))
                               ? Upper(reader.Text("FOV_CLASS_SPEC"))
                               : std::string("CORNERS");
  if (spec == "ANGLES") {
    if (out.shape == FieldShape::Polygon) {
      reader.Fail("FOV_CLASS_SPEC", "it is ANGLES for a polygon; accepted: CORNERS");
    }
    out.boundary = BoundaryFromAngles(reader, out.shape, out.boresight);
    return out;
  }
  if (spec != "CORNERS") {
    reader.Fail("FOV_CLASS_SPEC", "it is '" + spec + "'; accepted: CORNERS or ANGLES");
  }
  const std::string corners = pool.Has(reader.Name("FOV_BOUNDARY_CORNERS"))
                                  ? "FOV_BOUNDARY_CORNERS"
                                  : "FOV_BOUNDARY"; // its older name
  reader.Get(corners);
  const std::vector<double>& numbers = pool.Numbers(reader.Name(corners));
  const std::size_t count = numbers.size() / 3;
  const std::size_t least = out.shape == FieldShape::Polygon     ? 3
                            : out.shape == FieldShape::Rectangle ? 4
                            : out.shape == FieldShape::Circle    ? 1
                                                                 : 2;
  if (numbers.size() % 3 != 0 || count < least ||
      (out.shape != FieldShape::Polygon && count != least)) {
    reader.Fail(corners, "it has " + std::to_string(numbers.size()) + " numbers; accepted for " +
                             shape + ": " + (out.shape == FieldShape::Polygon ? "at least " : "") +
                             std::to_string(3 * least));
  }
  for (std::size_t i = 0; i < count; ++i) {
    out.boundary.push_back(reader.Unit(corners, &numbers[3 * i]));
    const double cosine = out.boundary.back().dot(out.boresight);
    if (out.shape != FieldShape::Circle && !(cosine > 0.0)) {
      reader.Fail(corners, "its vector " + std::to_string(i + 1) +
                               " is 90 degrees or more from the boresight; accepted: less");
    }
  }
  return out;
}

} // namespace dspace
