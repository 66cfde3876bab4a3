#include <dspace/raster/SelfContainedDrivers.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <vector>

namespace dspace {
namespace {

struct Driver {
  const char* name;
  const char* reason;
  bool takesNames = false; // of other files, from a file
};

constexpr const char* OneFile = "reads one file";
constexpr const char* ByRule = "reads the file and files of its base name, by a rule of endings";
constexpr const char* Listed = "its label may name a data file, read as raw numbers and listed";

constexpr std::array Drivers = {
    Driver{"GTiff", OneFile},
    Driver{"AAIGrid", ByRule},
    Driver{"ACE2", OneFile},
    Driver{"BMP", OneFile},
    Driver{"BT", ByRule},
    Driver{"BYN", OneFile},
    Driver{"DTED", OneFile},
    Driver{"EHdr", ByRule},
    Driver{"ENVI", ByRule},
    Driver{"GIF", OneFile},
    Driver{"GRASSASCIIGrid", OneFile},
    Driver{"GS7BG", OneFile},
    Driver{"GSAG", OneFile},
    Driver{"GSBG", OneFile},
    Driver{"GTX", OneFile},
    Driver{"HFA", "its header may name .ige and .rrd files of its own folder, which are listed",
           true},
    Driver{"ISG", OneFile},
    Driver{"ISIS2", Listed, true},
    Driver{"ISIS3", Listed, true},
    Driver{"JP2OpenJPEG", "reads one file; links within its GML box are not followed"},
    Driver{"JPEG", OneFile},
    Driver{"LCP", ByRule},
    Driver{"NTv2", OneFile},
    Driver{"PDS", Listed, true},
    Driver{"PNG", OneFile},
    Driver{"PNM", OneFile},
    Driver{"SIGDEM", OneFile},
    Driver{"SRTMHGT", OneFile},
    Driver{"TGA", OneFile},
    Driver{"USGSDEM", OneFile},
    Driver{"VICAR", OneFile},
    Driver{"WEBP", OneFile},
    Driver{"XYZ", OneFile},
    Driver{"GPKG", "one database; what its SQL functions open passes the driver manager", true},
    Driver{"CSV", ByRule},
    Driver{"DXF", OneFile},
    Driver{"ESRI Shapefile", ByRule},
    Driver{"FlatGeobuf", OneFile},
    Driver{"GeoJSON", "reads one file; OfflineScope stops the fetch of a CRS"},
    Driver{"GeoJSONSeq", OneFile},
    Driver{"GPX", OneFile},
    Driver{"KML", "reads one file; network links are not followed"},
    Driver{"OGR_GMT", OneFile},
    Driver{"TopoJSON", OneFile},
};

std::atomic<bool> WithoutNamesOnly = false;

bool TakesNoName(const Driver& driver) {
  return !driver.takesNames;
}

// Ending with a null pointer.
template<class Choice> std::vector<const char*> Names(Choice&& choice) {
  std::vector<const char*> names;
  for (const Driver& driver : Drivers) {
    if (choice(driver)) {
      names.push_back(driver.name);
    }
  }
  names.push_back(nullptr);
  return names;
}

} // namespace

const char* const* SelfContainedDrivers() {
  static const auto all = Names([](const Driver&) { return true; });
  static const auto withoutNames = Names(TakesNoName);
  return (WithoutNamesOnly ? withoutNames : all).data();
}

bool IsSelfContained(const std::string& driver) {
  return std::any_of(Drivers.begin(), Drivers.end(), [&](const Driver& each) {
    return driver == each.name && (!WithoutNamesOnly || TakesNoName(each));
  });
}

bool AreMosaicsAccepted() {
  return !WithoutNamesOnly;
}

void AcceptFilesWithoutNamesOnly() {
  WithoutNamesOnly = true;
}

} // namespace dspace
