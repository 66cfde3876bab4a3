#include <dspace/layers/vector/VectorShapes.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <ogrsf_frmts.h>

#include <dspace/Checks.h>
#include <dspace/FileText.h>
#include <dspace/Utf8.h>
#include <dspace/crs/MapTurn.h>
#include <dspace/gdal/OfflineScope.h>
#include <dspace/raster/DatasetFiles.h>
#include <dspace/raster/NetworkScope.h>
#include <dspace/raster/OpenRaster.h>

#include <dspace/layers/vector/VectorCrs.h>
#include <dspace/layers/vector/VectorPlaces.h>
#include <dspace/layers/vector/VectorTurns.h>

namespace dspace {
namespace {

constexpr double LongestEdge = 5.0; // [deg], or what that is on the body

class Reader {
public:
  Reader(const std::string& object, const VectorLayerOptions& options, VectorFile& file)
      : Object_(object), Options_(options), File_(file) {}

  void Read(OGRLayer& layer, const Crs& crs) {
    VectorGroup group;
    group.crs = crs;
    this->Group_ = &group;
    const double unit = crs.GetUnit();
    const bool degrees = crs.GetKind() == Crs::Kind::Geographic;
    this->Degrees_ = degrees;
    this->Turn_ = MapTurn(crs);
    if (this->Turn_ > 0.0) {
      this->Poles_ = PolesOf(crs, this->Object_);
    }
    this->Longest_ = degrees ? LongestEdge / unit
                     : crs.HasGeographic()
                         ? crs.GetAxes().semiMajor * LongestEdge * M_PI / 180.0 / unit
                         : 0.0;
    for (const auto& feature : layer) {
      if (const OGRGeometry* geometry = feature->GetGeometryRef()) {
        this->File_.looks.push_back(this->LookOf(*feature));
        this->Add(*geometry);
      }
    }
    this->File_.groups.push_back(std::move(group));
  }

private:
  std::optional<std::string> Text(const OGRFeature& feature, const char* name) const {
    const int index = feature.GetFieldIndex(name);
    if (index < 0 || !feature.IsFieldSetAndNotNull(index)) {
      return std::nullopt;
    }
    return ToFileText(const_cast<OGRFeature&>(feature).GetFieldAsString(index), this->Object_);
  }
  void Ignore(const char* name, const std::string& value, const char* accepted) {
    if (!this->Ignored_) {
      this->Ignored_ = true;
      this->File_.warnings.push_back(this->Object_ + ": a feature's '" + name + "' is '" + value +
                                     "', which is left out; accepted: " + accepted);
    }
  }
  // "#rgb" or "#rrggbb".
  void Color(const OGRFeature& feature, const char* name, std::array<double, 4>& color) {
    const std::optional<std::string> value = Text(feature, name);
    if (!value || value->empty()) {
      return;
    }
    const std::string digits = value->substr((*value)[0] == '#' ? 1 : 0);
    const std::size_t each = digits.size() / 3;
    if ((digits.size() != 3 && digits.size() != 6) ||
        digits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos) {
      this->Ignore(name, *value, "#rgb or #rrggbb");
      return;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const int number = std::stoi(digits.substr(k * each, each), nullptr, 16);
      color[k] = number / (each == 1 ? 15.0 : 255.0);
    }
  }
  std::optional<double> Number(const OGRFeature& feature, const char* name, double most,
                               const char* accepted) {
    const std::optional<std::string> value = Text(feature, name);
    if (!value || value->empty()) {
      return std::nullopt;
    }
    char* end = nullptr;
    const double number = std::strtod(value->c_str(), &end);
    if (*end != '\0' || !(number >= 0.0 && number <= most)) {
      this->Ignore(name, *value, accepted);
      return std::nullopt;
    }
    return number;
  }
  VectorStyle LookOf(const OGRFeature& feature) {
    VectorStyle look{this->Options_.line, this->Options_.fill, this->Options_.line, std::nullopt};
    this->Color(feature, "stroke", look.line);
    this->Color(feature, "fill", look.fill);
    this->Color(feature, "marker-color", look.point);
    look.line[3] = this->Number(feature, "stroke-opacity", 1.0, "0 to 1").value_or(look.line[3]);
    look.fill[3] = this->Number(feature, "fill-opacity", 1.0, "0 to 1").value_or(look.fill[3]);
    look.pixels = this->Number(feature, "stroke-width", 64.0, "0 to 64 pixels");
    return look;
  }

  void CheckCount(std::size_t more) const {
    if (this->Vertices_ + more > this->Options_.mostVertices) {
      throw Error(Error::Kind::Resource, this->Object_,
                  "it has more than " + std::to_string(this->Options_.mostVertices) +
                      " vertices, which is the limit");
    }
  }

  void Add(const OGRGeometry& geometry) {
    if (geometry.IsEmpty()) {
      return;
    }
    if (geometry.hasCurveGeometry()) {
      const std::unique_ptr<OGRGeometry> straight(geometry.getLinearGeometry());
      if (straight && !straight->hasCurveGeometry()) {
        this->Add(*straight);
      }
      return;
    }
    switch (wkbFlatten(geometry.getGeometryType())) {
    case wkbPoint: {
      const OGRPoint& point = *geometry.toPoint();
      this->AddShape(VectorShape::Kind::Point, {{{point.getX(), point.getY()}}});
      break;
    }
    case wkbLineString:
      this->AddShape(VectorShape::Kind::Path, {PlacesOf(*geometry.toLineString())});
      break;
    case wkbPolygon:
    case wkbTriangle: {
      std::vector<std::vector<Eigen::Vector2d>> rings;
      for (const OGRLinearRing* ring : *geometry.toPolygon()) {
        rings.push_back(PlacesOf(*ring));
        if (!rings.back().empty() && rings.back().front() != rings.back().back()) {
          rings.back().push_back(rings.back().front());
        }
      }
      this->AddShape(VectorShape::Kind::Area, std::move(rings));
      break;
    }
    case wkbPolyhedralSurface:
    case wkbTIN:
      for (const OGRPolygon* part : *geometry.toPolyhedralSurface()) {
        this->Add(*part);
      }
      break;
    default:
      if (OGR_GT_IsSubClassOf(geometry.getGeometryType(), wkbGeometryCollection)) {
        for (const OGRGeometry* part : *geometry.toGeometryCollection()) {
          this->Add(*part);
        }
      }
    }
  }

  static std::vector<Eigen::Vector2d> PlacesOf(const OGRLineString& line) {
    std::vector<Eigen::Vector2d> places;
    places.reserve(std::size_t(line.getNumPoints()));
    for (int i = 0; i < line.getNumPoints(); ++i) {
      places.emplace_back(line.getX(i), line.getY(i));
    }
    return places;
  }

  void AddShape(VectorShape::Kind kind, std::vector<std::vector<Eigen::Vector2d>> rings) {
    VectorShape shape;
    shape.kind = kind;
    shape.look = this->File_.looks.size() - 1;
    for (std::vector<Eigen::Vector2d>& places : rings) {
      this->CheckPlaces(places);
      this->UnwrapShape(kind, places);
      if (this->Turn_ > 0.0 && &places != &rings.front() && !places.empty()) {
        BesideOf(rings.front(), this->Turn_, places);
      }
      VectorRing ring;
      ring.places = this->Divided(places);
      ring.outline = ring.places.size();
      if (kind == VectorShape::Kind::Area && this->Turn_ > 0.0) {
        CloseOverPole(ring, this->Turn_, this->Poles_);
        ring.places = this->Divided(ring.places); // only what closes it is long
      }
      this->Vertices_ += ring.places.size();
      if (ring.places.size() >= (kind == VectorShape::Kind::Point ? 1U : 2U)) {
        shape.rings.push_back(std::move(ring));
      }
    }
    if (!shape.rings.empty()) {
      this->Group_->shapes.push_back(std::move(shape));
    }
  }

  // A ring that goes around a pole may have one vertex at -180 and at 180 degrees; where it does
  // not go around, such a step is an edge all the way along.
  void UnwrapShape(VectorShape::Kind kind, std::vector<Eigen::Vector2d>& places) const {
    std::vector<Eigen::Vector2d> around = places;
    Unwrap(around, this->Turn_, false);
    if (kind == VectorShape::Kind::Area && !around.empty() &&
        std::abs(around.back().x() - around.front().x()) > 0.5 * this->Turn_) {
      places = std::move(around);
    } else {
      Unwrap(places, this->Turn_, true);
    }
  }

  void CheckPlaces(std::vector<Eigen::Vector2d>& places) const {
    const auto [low, high] = std::minmax(this->Poles_[0], this->Poles_[1]);
    const double beyond = 1e-6 * (high - low); // rounded: at the pole
    for (Eigen::Vector2d& place : places) {
      if (!place.allFinite() || place.cwiseAbs().maxCoeff() > 1e12) {
        throw Error(Error::Kind::Corrupt, this->Object_,
                    "a vertex is (" + NumberText(place.x()) + ", " + NumberText(place.y()) + ")");
      }
      const bool inside = place.y() >= low - beyond && place.y() <= high + beyond;
      if (this->Degrees_ && (!inside || std::abs(place.x()) > 2.0 * this->Turn_)) {
        Reject(this->Object_, "a vertex is (" + NumberText(place.x()) + ", " +
                                  NumberText(place.y()) +
                                  "), which is not a longitude and latitude; accepted: a CRS "
                                  "stated for the layer in which it is a place");
      }
      if (this->Turn_ > 0.0 && inside) {
        place.y() = std::clamp(place.y(), low, high);
      }
    }
  }

  // Edges into pieces on them: long ones are followed better by their pieces in another CRS, and
  // the way around the body stays known.
  std::vector<Eigen::Vector2d> Divided(const std::vector<Eigen::Vector2d>& places) const {
    std::vector<Eigen::Vector2d> result;
    result.reserve(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (i > 0 && this->Longest_ > 0.0) {
        const Eigen::Vector2d edge = places[i] - places[i - 1];
        const double pieces = std::min(std::ceil(edge.norm() / this->Longest_ - 1e-6), 1e5);
        for (double k = 1.0; k < pieces; k += 1.0) {
          result.emplace_back(places[i - 1] + edge * (k / pieces));
        }
      }
      result.push_back(places[i]);
      this->CheckCount(result.size()); // before it is large
    }
    return result;
  }

  const std::string& Object_;
  const VectorLayerOptions& Options_;
  VectorFile& File_;
  VectorGroup* Group_ = nullptr;
  bool Degrees_ = false;
  double Turn_ = 0.0;
  std::array<double, 2> Poles_ = {0.0, 0.0};
  double Longest_ = 0.0;
  std::size_t Vertices_ = 0;
  bool Ignored_ = false;
};

DatasetPointer Open(const std::string& path, const std::string& object, GdalErrors& errors) {
  DatasetPointer file = OpenDataset(path, DatasetKind::Shapes);
  if (!file) {
    VSIStatBufL stat;
    const bool exists = !path.empty() && VSIStatL(path.c_str(), &stat) == 0;
    throw Error(exists ? Error::Kind::Corrupt : Error::Kind::NotFound, object,
                exists ? errors.Message("not a file of shapes that OGR opens")
                       : "there is no such file");
  }
  return file;
}

} // namespace

VectorFile ReadVectorFile(const std::string& path, const RasterPlace& terrain,
                          const VectorLayerOptions& options) {
  const std::string object = "shapes '" + path + "'";
  VectorFile result;
  GdalErrors errors;
  std::optional<OfflineScope> offline;
  if (!IsRemote(path)) {
    offline.emplace();
  }
  const DatasetPointer file = Open(path, object, errors);
  NoteDataset(*file);
  Reader reader(object, options, result);
  std::string names;
  bool found = !options.layer;
  for (OGRLayer* layer : file->GetLayers()) {
    const std::string name = ToUtf8(layer->GetName());
    names += (names.empty() ? "'" : "', '") + name;
    if (!options.layer || *options.layer == name) {
      found = true;
      reader.Read(*layer, VectorCrsOf(*layer, *file, path, terrain, options, result.warnings));
    }
  }
  if (!found) {
    throw Error(Error::Kind::NotFound, object,
                "it has no layer '" + *options.layer + "'; there are: " + names + "'");
  }
  errors.Check(Error::Kind::Corrupt, object);
  for (const std::string& warning : errors.Warnings()) {
    result.warnings.push_back(object + ": " + warning);
  }
  if (std::all_of(result.groups.begin(), result.groups.end(),
                  [](const VectorGroup& group) { return group.shapes.empty(); })) {
    Reject(object, "it has no features with a geometry");
  }
  return result;
}

} // namespace dspace
