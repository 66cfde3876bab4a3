#include <dspace/maps/HorizonMap.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <sstream>
#include <utility>

#include <gdal_priv.h>

#include <dspace/Checks.h>
#include <dspace/gdal/GdalErrors.h>
#include <dspace/horizon/HorizonKernel.h>
#include <dspace/horizon/HorizonSweep.h>

namespace dspace {
namespace {

// Of the numbers in the file; a change of the method changes it, so that no map is a mix of two.
constexpr int HorizonMapVersion = 2;
constexpr int FollowedPosts = 4096;
constexpr int MostAzimuths = 3600;
constexpr std::int64_t MostHeld = std::int64_t(1) << 27; // posts, 512 MB
constexpr double MostHeight = 1e6;                       // [m]

std::string Exactly(double value) {
  char text[40];
  std::snprintf(text, sizeof(text), "%.17g", value);
  return text;
}

std::string Hex(std::uint64_t value) {
  char text[24];
  std::snprintf(text, sizeof(text), "%016llx", static_cast<unsigned long long>(value));
  return text;
}

// How PlacementOf() reads it.
std::string PlacementText(const PostPlacement& placement) {
  constexpr double Degrees = 180.0 / M_PI;
  std::string text;
  const auto add = [&](double value) { text += " " + Exactly(value); };
  switch (placement.GetKind()) {
  case PostPlacement::Kind::Plane:
    for (const double value : {placement.PostToScene()(0, 0), placement.PostToScene()(0, 1),
                               placement.PostToScene()(0, 2), placement.PostToScene()(1, 0),
                               placement.PostToScene()(1, 1), placement.PostToScene()(1, 2)}) {
      add(value);
    }
    return "plane" + text;
  case PostPlacement::Kind::Sphere:
    for (const double value : {placement.First().x() * Degrees, placement.First().y() * Degrees,
                               placement.Step().x() * Degrees, placement.Step().y() * Degrees}) {
      add(value);
    }
    break;
  case PostPlacement::Kind::Pole:
    add(placement.South() ? 1.0 : 0.0);
    add(placement.PlaneStep());
    add(placement.Pole().x());
    add(placement.Pole().y());
    add(placement.East() * Degrees);
    break;
  }
  add(placement.Body().Equatorial());
  add(placement.Body().Polar());
  return (placement.GetKind() == PostPlacement::Kind::Sphere ? "degrees" : "pole") + text;
}

std::optional<PostPlacement> PlacementOf(const std::string& text) {
  std::istringstream stream(text);
  std::string kind;
  std::vector<double> v;
  stream >> kind;
  for (double value = 0.0; stream >> value;) {
    v.push_back(value);
  }
  if (v.size() != (kind == "pole" ? 7u : 6u)) {
    return std::nullopt;
  }
  if (kind == "plane") {
    Eigen::Affine2d map = Eigen::Affine2d::Identity();
    map.linear() << v[0], v[1], v[3], v[4];
    map.translation() << v[2], v[5];
    return PostPlacement::OnPlane(map);
  }
  if (kind == "degrees") {
    return PostPlacement::OnEllipsoid({v[0], v[1]}, {v[2], v[3]}, BodyEllipsoid(v[4], v[5]));
  }
  return kind == "pole" ? std::optional(PostPlacement::AtPole(v[0] != 0.0, v[1], {v[2], v[3]}, v[4],
                                                              BodyEllipsoid(v[5], v[6])))
                        : std::nullopt;
}

TileFileLayout LayoutOf(const MapGround& ground, const HorizonMapOptions& options,
                        const GroundSurvey& survey) {
  const MapCells& cells = options.cells;
  TileFileLayout layout;
  layout.columns = cells.columns;
  layout.rows = cells.rows;
  layout.cellToMap = cells.CellToMap(ground);
  layout.crs = ground.crs;
  for (int k = 0; k < options.azimuths; ++k) {
    layout.bands.push_back("azimuth " + NumberText(360.0 * k / options.azimuths) + " deg");
  }
  std::map<std::string, std::string>& m = layout.metadata;
  m["DSPACE_KIND"] = "horizon map";
  m["DSPACE_VERSION"] = std::to_string(HorizonMapVersion);
  m["DSPACE_TERRAIN"] = ground.name;
  m["DSPACE_TERRAIN_HASH"] = Hex(survey.hash);
  m["DSPACE_HEIGHT_M"] = Exactly(options.height);
  m["DSPACE_FAST"] = options.fast ? "yes" : "no";
  m["DSPACE_AZIMUTHS"] = std::to_string(options.azimuths);
  m["DSPACE_CELLS"] = std::to_string(cells.column) + " " + std::to_string(cells.row) + " " +
                      std::to_string(cells.every);
  m["DSPACE_UNIT"] = "elevation in degrees over the local horizontal; -90: nothing in sight";
  m["DSPACE_PLACEMENT"] = PlacementText(ground.placement);
  m["DSPACE_NORTH"] = ground.placement.GetKind() == PostPlacement::Kind::Sphere
                          ? "true north"
                          : "the direction against the rows of cells";
  InputHash hash;
  for (const std::int64_t value :
       {std::int64_t(HorizonMapVersion), std::int64_t(FollowedPosts), cells.column, cells.row,
        std::int64_t(cells.columns), std::int64_t(cells.rows), std::int64_t(cells.every),
        std::int64_t(options.azimuths), std::int64_t(options.fast)}) {
    hash.Add(std::uint64_t(value));
  }
  hash.Add(options.height);
  hash.Add(survey.hash);
  hash.Add(ground.name);
  hash.Add(ground.crs.GetWkt());
  layout.hash = hash.Get();
  m["DSPACE_INPUT_HASH"] = Hex(layout.hash);
  return layout;
}

// Maps of parts of the cells.
class Parts {
public:
  Parts(const HorizonMapOptions& options, const GroundSurvey& survey) : Options_(options) {
    for (const std::string& path : options.parts) {
      this->Maps_.push_back(std::make_unique<HorizonMap>(path));
      const HorizonMap& map = *this->Maps_.back();
      if (map.TerrainHash() != survey.hash || map.Height() != options.height ||
          map.Fast() != options.fast || map.Azimuths() != options.azimuths ||
          map.Cells().every != options.cells.every) {
        Reject("file '" + path + "'",
               "it is a part of another horizon map, of terrain '" + map.Terrain() + "' by " +
                   std::to_string(map.Azimuths()) + " azimuths at " + NumberText(map.Height()) +
                   " m" + (map.Fast() ? " in the fast mode" : "") +
                   "; accepted: a part with the ground, the cells' spacing, the height, the "
                   "azimuths and the mode of the whole");
      }
    }
  }

  // The elevations of cells from (column, row) on, in tiles of TileFile; false if no part has them.
  bool Copy(const PostBlock& block, std::vector<float>& elevations) const {
    const int every = this->Options_.cells.every;
    for (const auto& map : this->Maps_) {
      const MapCells& cells = map->Cells();
      const std::int64_t column = (block.column - cells.column) / every;
      const std::int64_t row = (block.row - cells.row) / every;
      if (column * every != block.column - cells.column || row * every != block.row - cells.row ||
          column < 0 || row < 0 || column + block.width > cells.columns ||
          row + block.height > cells.rows) {
        continue;
      }
      const std::vector<float> read = map->Read(int(column), int(row), block.width, block.height);
      auto from = read.begin();
      for (int k = 0; k < this->Options_.azimuths; ++k) {
        for (int r = 0; r < block.height; ++r, from += block.width) {
          std::copy(from, from + block.width,
                    elevations.begin() +
                        std::ptrdiff_t((std::size_t(k) * TileFile::Side + r) * TileFile::Side));
        }
      }
      return true;
    }
    return false;
  }

private:
  const HorizonMapOptions& Options_;
  std::vector<std::unique_ptr<HorizonMap>> Maps_;
};

} // namespace

bool WriteHorizonMap(const MapGround& ground, const HorizonMapOptions& options,
                     const std::string& path, const MapControl& control) {
  Require(options.azimuths >= 1 && options.azimuths <= MostAzimuths, "horizon map",
          "the number of azimuths", options.azimuths, "1 to 3600");
  Require(options.height >= 0.0 && options.height <= MostHeight, "horizon map",
          "the height above the ground", options.height, "0 to 1e6 m");
  const std::uint64_t before = ground.pyramid->LatestChange();
  const std::optional<GroundSurvey> survey =
      Survey(ground, [&] { return !control.progress || control.progress({}); });
  if (!survey) {
    return false;
  }
  const Parts parts(options, *survey);
  const TileFileLayout layout = LayoutOf(ground, options, *survey);
  TileFile file(path, layout, control.replace);
  HorizonOptions sweeping;
  sweeping.posts = FollowedPosts;
  sweeping.near = 1;
  sweeping.heights = survey->heights;
  sweeping.above = options.height;
  sweeping.fine = true;
  sweeping.fast = options.fast;
  HorizonSweep sweep(ground.pyramid, ground.placement, sweeping);
  const MapCells& cells = options.cells;
  if (HeldPosts::CountOf(ground.pyramid->Lattice()) <= MostHeld) {
    auto held = HeldPosts::Read(*ground.pyramid, cells.every, HorizonLanes * cells.every,
                                [&] { return !control.progress || control.progress({}); });
    if (!held) {
      return false;
    }
    sweep.Hold(std::move(held));
  }
  const auto make = [&](int column, int row, std::vector<float>& elevations,
                        const std::atomic<bool>& stop) {
    PostBlock block;
    block.column = cells.column + std::int64_t(column) * TileFile::Side * cells.every;
    block.row = cells.row + std::int64_t(row) * TileFile::Side * cells.every;
    block.width = std::min(TileFile::Side, cells.columns - column * TileFile::Side);
    block.height = std::min(TileFile::Side, cells.rows - row * TileFile::Side);
    if (parts.Copy(block, elevations)) {
      return;
    }
    std::vector<float> tangents(std::size_t(block.width) * block.height);
    for (int k = 0; k < options.azimuths && !stop; ++k) {
      sweep.SweepEvery(block, cells.every, 360.0 * k / options.azimuths, tangents.data());
      for (int r = 0; r < block.height; ++r) {
        ElevationsOf(&tangents[std::size_t(r) * block.width], block.width, HorizonSweep::None,
                     -90.0f, &elevations[(std::size_t(k) * TileFile::Side + r) * TileFile::Side]);
      }
    }
    if (ground.pyramid->LatestChange() != before) {
      throw Error(Error::Kind::Io, ground.name,
                  "its ground changed while a map of it was computed; accepted: a terrain that "
                  "stays as it is until the map is done");
    }
  };
  return FillTiles(file, std::size_t(options.azimuths), control, make);
}

struct HorizonMap::File {
  ~File() {
    if (this->dataset) {
      GDALClose(this->dataset);
    }
  }
  GDALDataset* dataset = nullptr;
  std::mutex mutex;
};

HorizonMap::HorizonMap(const std::string& path) : Path_(path), File_(std::make_unique<File>()) {
  const std::string object = "file '" + path + "'";
  if (!std::filesystem::exists(path)) {
    const bool part = std::filesystem::exists(path + ".part");
    throw Error(Error::Kind::NotFound, object,
                part
                    ? "the horizon map is not complete; accepted: a map that was written to its end"
                    : "there is no such file; accepted: a horizon map");
  }
  std::map<std::string, std::string> m = TileFile::MetadataOf(path);
  const std::string accepted = "; accepted: a file that a horizon map was written to";
  if (m["DSPACE_KIND"] != "horizon map") {
    throw Error(Error::Kind::Corrupt, object, "it is no horizon map" + accepted);
  }
  if (m["DSPACE_VERSION"] != std::to_string(HorizonMapVersion)) {
    throw Error(Error::Kind::Corrupt, object,
                "it has version '" + m["DSPACE_VERSION"] +
                    "' of horizon maps; accepted: " + std::to_string(HorizonMapVersion));
  }
  const auto number = [&](const char* key) { return std::strtod(m[key].c_str(), nullptr); };
  this->Azimuths_ = int(number("DSPACE_AZIMUTHS"));
  this->Height_ = number("DSPACE_HEIGHT_M");
  this->Terrain_ = m["DSPACE_TERRAIN"];
  this->Fast_ = m["DSPACE_FAST"] == "yes";
  this->TerrainHash_ = std::strtoull(m["DSPACE_TERRAIN_HASH"].c_str(), nullptr, 16);
  this->InputHash_ = std::strtoull(m["DSPACE_INPUT_HASH"].c_str(), nullptr, 16);
  GdalErrors errors;
  RegisterGdal();
  const char* const drivers[] = {"GTiff", nullptr};
  this->File_->dataset =
      GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers);
  GDALDataset* dataset = this->File_->dataset;
  if (!dataset || dataset->GetRasterCount() != this->Azimuths_) {
    throw Error(Error::Kind::Corrupt, object, errors.Message("it is damaged") + accepted);
  }
  this->Cells_.columns = dataset->GetRasterXSize();
  this->Cells_.rows = dataset->GetRasterYSize();
  long long column = 0;
  long long row = 0;
  std::array<double, 6> geo = {0, 1, 0, 0, 0, 1};
  dataset->GetGeoTransform(geo.data());
  this->CellToMap_.linear() << geo[1], geo[2], geo[4], geo[5];
  this->CellToMap_.translation() << geo[0], geo[3];
  if (const OGRSpatialReference* srs = dataset->GetSpatialRef()) {
    this->Crs_ = Crs::FromOgr(*srs);
  }
  const std::optional<PostPlacement> placement = PlacementOf(m["DSPACE_PLACEMENT"]);
  if (!placement || std::sscanf(m["DSPACE_CELLS"].c_str(), "%lld %lld %d", &column, &row, // NOLINT
                                &this->Cells_.every) != 3) {
    throw Error(Error::Kind::Corrupt, object, "its metadata lack the places of cells" + accepted);
  }
  this->Placement_ = *placement;
  this->Cells_.column = column;
  this->Cells_.row = row;
  this->Cells_.columns = this->Columns();
  this->Cells_.rows = this->Rows();
}

HorizonMap::~HorizonMap() = default;

std::vector<float> HorizonMap::Read(int column, int row, int width, int height) const {
  std::vector<float> elevations(std::size_t(this->Azimuths_) * std::size_t(width) *
                                std::size_t(height));
  const std::lock_guard<std::mutex> lock(this->File_->mutex);
  GdalErrors errors;
  const CPLErr result = this->File_->dataset->RasterIO(
      GF_Read, column, row, width, height, elevations.data(), width, height, GDT_Float32,
      this->Azimuths_, nullptr, 0, 0, 0, nullptr);
  if (result != CE_None) {
    throw Error(Error::Kind::Corrupt, "file '" + this->Path_ + "'",
                errors.Message("it cannot be read"));
  }
  return elevations;
}

} // namespace dspace
