#include <dspace/layers/vector/VectorCrs.h>

#include <cmath>
#include <memory>

#include <cpl_vsi.h>
#include <ogrsf_frmts.h>

#include <dspace/Utf8.h>

namespace dspace {
namespace {

// Whether a JSON text has a member "crs" in its outermost object: read piece by piece.
class CrsMember {
public:
  bool FoundIn(const char* text, std::size_t size) {
    for (std::size_t i = 0; i < size && !this->Found_; ++i) {
      this->Take(text[i]);
    }
    return this->Found_;
  }

private:
  void Take(char c) {
    if (this->InString_) {
      if (this->Escaped_) {
        this->Escaped_ = false;
      } else if (c == '\\') {
        this->Escaped_ = true;
      } else if (c == '"') {
        this->InString_ = false;
        return;
      }
      if (this->Depth_ == 1 && this->Last_.size() < 8) {
        this->Last_ += c;
      }
    } else if (c == '"') {
      this->InString_ = true;
      this->Last_.clear();
    } else if (c == '{' || c == '[') {
      ++this->Depth_;
    } else if (c == '}' || c == ']') {
      --this->Depth_;
    } else if (c == ':') {
      this->Found_ = this->Depth_ == 1 && this->Last_ == "crs";
    }
  }
  int Depth_ = 0;
  bool InString_ = false;
  bool Escaped_ = false;
  bool Found_ = false;
  std::string Last_; // string of the outermost object
};

bool StatesCrs(const std::string& path) {
  CrsMember member;
  VSILFILE* file = VSIFOpenL(path.c_str(), "rb");
  if (!file) {
    return member.FoundIn(path.data(), path.size()); // OGR opens a text, too
  }
  const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> close(file, VSIFCloseL);
  std::vector<char> piece(std::size_t(1) << 16);
  while (const std::size_t size = VSIFReadL(piece.data(), 1, piece.size(), file)) {
    if (member.FoundIn(piece.data(), size)) {
      return true;
    }
  }
  return false;
}

bool IsEarth(const Crs& crs) {
  return crs.HasGeographic() && std::abs(crs.GetAxes().semiMajor / 6378137.0 - 1.0) < 0.01;
}

} // namespace

Crs VectorCrsOf(OGRLayer& layer, GDALDataset& file, const std::string& path,
                const RasterPlace& terrain, const VectorLayerOptions& options,
                std::vector<std::string>& warnings) {
  if (options.crs) {
    return Crs::FromText(*options.crs);
  }
  const std::string object = "shapes '" + path + "'";
  const std::string driver = file.GetDriverName();
  if ((driver == "GeoJSON" && !StatesCrs(path)) || driver == "GeoJSONSeq") {
    if (!terrain.crs.HasGeographic()) {
      warnings.push_back(object + " states no CRS: map coordinates of " + terrain.name +
                         " are used; `crs` states another");
      return terrain.crs;
    }
    if (!IsEarth(terrain.crs)) {
      const Crs degrees = terrain.crs.Geographic();
      warnings.push_back(object + " states no CRS: longitude and latitude of '" +
                         degrees.GetName() + "' are used; `crs` states another");
      return degrees;
    }
  }
  if (const OGRSpatialReference* srs = layer.GetSpatialRef()) {
    return Crs::FromOgr(*srs);
  }
  warnings.push_back(object + ", layer '" + ToUtf8(layer.GetName()) + "', states no CRS: that of " +
                     terrain.name + " is used; `crs` states another");
  return terrain.crs;
}

} // namespace dspace
