#include <dspace/raster/SelfContainedDrivers.h>

#include <algorithm>
#include <array>

namespace dspace {
namespace {

struct Driver {
  const char* name;
  const char* reason;
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
    Driver{"HFA", "its header may name .ige and .rrd files of its own folder, which are listed"},
    Driver{"ISG", OneFile},
    Driver{"ISIS2", Listed},
    Driver{"ISIS3", Listed},
    Driver{"JP2OpenJPEG", "reads one file; links within its GML box are not followed"},
    Driver{"JPEG", OneFile},
    Driver{"LCP", ByRule},
    Driver{"NTv2", OneFile},
    Driver{"PDS", Listed},
    Driver{"PNG", OneFile},
    Driver{"PNM", OneFile},
    Driver{"SIGDEM", OneFile},
    Driver{"SRTMHGT", OneFile},
    Driver{"TGA", OneFile},
    Driver{"USGSDEM", OneFile},
    Driver{"VICAR", OneFile},
    Driver{"WEBP", OneFile},
    Driver{"XYZ", OneFile},
    Driver{"GPKG", "one database; what its SQL functions open passes the driver manager"},
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

} // namespace

const char* const* SelfContainedDrivers() {
  static const auto names = [] {
    std::array<const char*, Drivers.size() + 1> list = {};
    std::transform(Drivers.begin(), Drivers.end(), list.begin(),
                   [](const Driver& driver) { return driver.name; });
    return list;
  }();
  return names.data();
}

bool IsSelfContained(const std::string& driver) {
  return std::any_of(Drivers.begin(), Drivers.end(),
                     [&](const Driver& each) { return driver == each.name; });
}

} // namespace dspace
