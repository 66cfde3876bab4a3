#include <dspace/tracks/TrackFile.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>

#include <cpl_vsi.h>
#include <dspace/AtomicFile.h>
#include <dspace/Error.h>
#include <dspace/Utf8.h>
#include <dspace/raster/DatasetFiles.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include <dspace/gdal/GdalErrors.h>
#include <dspace/gdal/OfflineScope.h>
#include <dspace/raster/DatasetGate.h>

namespace dspace {
namespace {

constexpr double Degree = M_PI / 180.0;

struct ProfileField {
  const char* name;
  double TrackProfile::*value;
};
constexpr ProfileField ProfileFields[] = {{"width", &TrackProfile::width},
                                          {"wall", &TrackProfile::wall},
                                          {"rim_width", &TrackProfile::rimWidth},
                                          {"rim_height", &TrackProfile::rimHeight},
                                          {"tread_pitch", &TrackProfile::treadPitch},
                                          {"tread_depth", &TrackProfile::treadDepth}};
constexpr const char* ListFields[] = {"sinkage", "rolled", "heading_deg"};

struct Closer {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, Closer>;

// A name in GDAL's memory, removed with what was written to it.
class MemoryFile {
public:
  MemoryFile() : Name_("/vsimem/dspace-tracks-" + std::to_string(std::uintptr_t(this))) {}
  ~MemoryFile() { VSIUnlink(this->Name_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  const std::string& Name() const { return this->Name_; }

private:
  std::string Name_;
};

[[noreturn]] void FailToWrite(const std::string& file, const GdalErrors& errors) {
  throw Error(Error::Kind::Io, file, errors.Message("it cannot be written"));
}

// All known, or none: then empty.
std::vector<double> Headings(const std::vector<TrackContact>& contacts) {
  std::vector<double> headings;
  bool known = false;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const std::size_t next = i + 1 < contacts.size() ? i + 1 : i;
    const std::size_t from = next == i && i > 0 ? i - 1 : i;
    const Eigen::Vector2d along = contacts[next].place - contacts[from].place;
    const bool given = !std::isnan(contacts[i].heading);
    known |= given;
    headings.push_back((given ? contacts[i].heading : std::atan2(along.y(), along.x())) / Degree);
  }
  return known ? headings : std::vector<double>();
}

// A number for all, or a list of one for each; false where it is absent.
bool ListOf(const OGRFeature& feature, const char* name, std::size_t count,
            const std::string& object, std::vector<double>& values) {
  const int field = feature.GetFieldIndex(name);
  if (field < 0 || !feature.IsFieldSetAndNotNull(field)) {
    return false;
  }
  const OGRFieldType type = feature.GetFieldDefnRef(field)->GetType();
  int n = 0;
  if (type == OFTRealList) {
    const double* list = feature.GetFieldAsDoubleList(field, &n);
    values.assign(list, list + n);
  } else if (type == OFTIntegerList) { // whole numbers throughout
    const int* list = feature.GetFieldAsIntegerList(field, &n);
    values.assign(list, list + n);
  } else if (type == OFTReal || type == OFTInteger || type == OFTInteger64) {
    values.assign(count, feature.GetFieldAsDouble(field));
  } else {
    throw Error(Error::Kind::Corrupt, object,
                std::string("its '") + name + "' holds no numbers; accepted: a number or a list");
  }
  if (values.size() == 1) { // GDAL makes a list of it where another feature has one
    values.assign(count, values[0]);
  }
  if (values.size() != count) {
    throw Error(Error::Kind::Corrupt, object,
                std::string("its '") + name + "' has " + std::to_string(values.size()) +
                    " numbers; accepted: " + std::to_string(count) + ", one a contact");
  }
  return true;
}

TrackAddition ToStroke(const OGRFeature& feature, const std::string& object,
                       const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& mapToScene) {
  const OGRGeometry* geometry = feature.GetGeometryRef();
  if (!geometry || wkbFlatten(geometry->getGeometryType()) != wkbLineString) {
    throw Error(Error::Kind::Corrupt, object,
                std::string("its geometry is ") +
                    (geometry ? geometry->getGeometryName() : "missing") +
                    "; accepted: a LineString");
  }
  TrackAddition stroke;
  stroke.begin = true;
  stroke.exact = true;
  const int wheel = feature.GetFieldIndex("wheel");
  stroke.name = ToUtf8(wheel >= 0 ? feature.GetFieldAsString(wheel) : "");
  for (const ProfileField& field : ProfileFields) {
    std::vector<double> value;
    if (ListOf(feature, field.name, 1, object, value)) {
      stroke.profile.*field.value = value[0];
    }
  }
  const OGRLineString* line = geometry->toLineString();
  const auto count = std::size_t(line->getNumPoints());
  std::vector<double> sinkages;
  std::vector<double> rolled;
  std::vector<double> headings;
  if (!ListOf(feature, "sinkage", count, object, sinkages)) {
    throw Error(Error::Kind::Corrupt, object,
                "it has no 'sinkage'; accepted: metres, a number or a list");
  }
  ListOf(feature, "rolled", count, object, rolled);
  ListOf(feature, "heading_deg", count, object, headings);
  for (std::size_t i = 0; i < count; ++i) {
    TrackContact contact;
    contact.place = mapToScene({line->getX(int(i)), line->getY(int(i))});
    contact.sinkage = sinkages[i];
    contact.rolled = rolled.empty() ? contact.rolled : rolled[i];
    contact.heading = headings.empty() ? contact.heading : headings[i] * Degree;
    stroke.contacts.push_back(contact);
  }
  const bool lone = count == 2 && stroke.contacts[0].place == stroke.contacts[1].place &&
                    !rolled.empty() && rolled[0] == rolled[1];
  if (lone) {
    stroke.contacts.pop_back();
  }
  return stroke;
}

void RequireSameCrs(const OGRFeature& feature, const std::string& object, const Crs& crs) {
  const int field = feature.GetFieldIndex("crs");
  const std::string text = field >= 0 ? feature.GetFieldAsString(field) : "";
  if (text.empty() || text == crs.GetWkt() || !crs.Ogr()) {
    return;
  }
  OGRSpatialReference other;
  if (!ReadCrsText(text, other) || !other.IsSame(crs.Ogr())) {
    const char* name = other.GetName();
    throw Error(Error::Kind::InvalidArgument, object,
                std::string("its map coordinates are of '") + (name ? name : text.c_str()) +
                    "'; accepted: of the terrain's, '" + crs.GetName() + "'");
  }
}

} // namespace

void WriteTracks(const std::string& path, const std::vector<TrackStroke>& strokes, const Crs& crs,
                 const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& sceneToMap) {
  const std::string object = "file '" + path + "'";
  RegisterGdal();
  AtomicFile file(path);
  const MemoryFile text; // the driver overwrites no file
  {
    GdalErrors errors;
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GeoJSON");
    Dataset dataset(driver ? driver->Create(text.Name().c_str(), 0, 0, 0, GDT_Unknown, nullptr)
                           : nullptr);
    if (!dataset) {
      FailToWrite(object, errors);
    }
    CPLStringList options;
    options.SetNameValue("SIGNIFICANT_FIGURES", "17");
    OGRLayer* layer = dataset->CreateLayer("tracks", nullptr, wkbLineString, options.List());
    if (!layer) {
      FailToWrite(object, errors);
    }
    OGRFieldDefn wheel("wheel", OFTString);
    OGRFieldDefn system("crs", OFTString);
    bool made = layer->CreateField(&wheel) == OGRERR_NONE;
    for (const ProfileField& field : ProfileFields) {
      OGRFieldDefn definition(field.name, OFTReal);
      made = made && layer->CreateField(&definition) == OGRERR_NONE;
    }
    for (const char* name : ListFields) {
      OGRFieldDefn definition(name, OFTRealList);
      made = made && layer->CreateField(&definition) == OGRERR_NONE;
    }
    made = made && layer->CreateField(&system) == OGRERR_NONE;
    for (const TrackStroke& stroke : strokes) {
      OGRFeature feature(layer->GetLayerDefn());
      feature.SetField("wheel", stroke.name.c_str());
      feature.SetField("crs", crs.GetWkt().c_str());
      for (const ProfileField& field : ProfileFields) {
        feature.SetField(field.name, stroke.profile.*field.value);
      }
      std::vector<TrackContact> contacts = stroke.contacts;
      if (contacts.size() == 1) {
        contacts.push_back(contacts.front());
      }
      OGRLineString line;
      std::vector<double> sinkages;
      std::vector<double> rolled;
      for (const TrackContact& contact : contacts) {
        const Eigen::Vector2d map = sceneToMap(contact.place);
        line.addPoint(map.x(), map.y());
        sinkages.push_back(contact.sinkage);
        rolled.push_back(contact.rolled);
      }
      const std::vector<double> headings = Headings(contacts);
      feature.SetField("sinkage", int(sinkages.size()), sinkages.data());
      feature.SetField("rolled", int(rolled.size()), rolled.data());
      if (!headings.empty()) {
        feature.SetField("heading_deg", int(headings.size()), headings.data());
      }
      made = made && feature.SetGeometry(&line) == OGRERR_NONE &&
             layer->CreateFeature(&feature) == OGRERR_NONE;
    }
    dataset.reset(); // writes what is left
    if (!made || errors.Failed()) {
      FailToWrite(object, errors);
    }
  }
  vsi_l_offset bytes = 0;
  const GByte* data = VSIGetMemFileBuffer(text.Name().c_str(), &bytes, FALSE);
  file.Write(data, data ? std::size_t(bytes) : 0);
  file.Commit();
}

std::vector<TrackAddition>
ReadTracks(const std::string& path, const Crs& crs,
           const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& mapToScene) {
  const std::string object = "file '" + path + "'";
  RegisterGdal();
  if (!std::filesystem::exists(path)) {
    throw Error(Error::Kind::NotFound, object, "there is no such file");
  }
  GdalErrors errors;
  const OfflineScope offline;
  const char* const drivers[] = {"GeoJSON", nullptr};
  const DatasetPointer dataset = OpenDataset(path, DatasetKind::Shapes, drivers);
  if (!dataset || dataset->GetLayerCount() != 1) {
    throw Error(Error::Kind::Corrupt, object,
                errors.Message("it is no GeoJSON of lines") + "; accepted: as save_tracks writes");
  }
  NoteDataset(*dataset);
  std::vector<TrackAddition> strokes;
  OGRLayer* layer = dataset->GetLayer(0);
  layer->ResetReading();
  while (const OGRFeatureUniquePtr feature{layer->GetNextFeature()}) {
    const std::string label = object + ", feature " + std::to_string(strokes.size());
    RequireSameCrs(*feature, label, crs);
    strokes.push_back(ToStroke(*feature, label, mapToScene));
  }
  errors.Check(Error::Kind::Corrupt, object);
  return strokes;
}

} // namespace dspace
