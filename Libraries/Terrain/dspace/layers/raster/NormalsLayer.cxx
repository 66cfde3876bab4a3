#include <dspace/layers/raster/NormalsLayer.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <dspace/Error.h>

#include <dspace/layers/NormalTexels.h>
#include <dspace/layers/raster/BlockSampler.h>
#include <dspace/layers/raster/NormalTurn.h>
#include <dspace/layers/raster/RasterPlacing.h>

namespace dspace {
namespace {

constexpr double Short = 1e-3; // of means: nothing is left of what cancels out

class RasterNormalsLayer : public ColorLayer {
public:
  RasterNormalsLayer(std::shared_ptr<RasterLevels> levels, const PlacedRaster& placed,
                     NormalAxes axes)
      : Name_(levels->Object()), PixelSize_(placed.pixelSize), Axes_(axes),
        Warnings_(levels->Warnings()), Sampler_(std::move(levels), placed.position) {}

  const std::string& GetName() const override { return this->Name_; }
  double PixelSize() const override { return this->PixelSize_; }
  const std::vector<std::string>& Warnings() const override { return this->Warnings_; }
  std::size_t KeptBytes() const override { return this->Sampler_.KeptBytes(); }
  LayerContent Content() const override { return LayerContent::Normals; }

  bool Read(const ColorGrid& grid, const ColorBlock& block, std::uint8_t* bytes) const override {
    std::vector<float> means;
    if (!this->Sampler_.Sample(grid, block, means)) {
      return false;
    }
    const std::vector<Eigen::Matrix2d> turns = this->TurnOf(grid)->Of(grid, block);
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const Eigen::Vector3d mean = Eigen::Vector3f(means.data() + 4 * i).cast<double>();
      TexelOf(mean, means[4 * i + 3], turns[i]).Write(bytes + i * NormalTexel::Bytes);
    }
    return true;
  }

private:
  // `mean`: times opacity. Vectors keep their slope.
  static NormalTexel TexelOf(const Eigen::Vector3d& mean, float opacity,
                             const Eigen::Matrix2d& turn) {
    if (!(opacity > 0.0f) || !turn.allFinite() || mean.norm() <= Short * opacity) {
      return {};
    }
    const Eigen::Vector3d unit = mean.normalized();
    const double flat = unit.head<2>().norm();
    Eigen::Vector3d n = unit;
    n.head<2>() = flat * (turn * unit.head<2>()).stableNormalized();
    return {(double(opacity) * n).cast<float>(), opacity};
  }

  std::shared_ptr<const NormalTurn> TurnOf(const ColorGrid& grid) const {
    const std::pair<int, std::string> key(int(grid.placement.GetKind()), grid.crs.GetWkt());
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    std::shared_ptr<const NormalTurn>& turn = this->Turns_[key];
    if (!turn) {
      const bool map = this->Axes_ == NormalAxes::Map;
      turn = std::make_shared<NormalTurn>(grid, map ? &this->Sampler_.Raster().crs : nullptr);
    }
    return turn;
  }

  std::string Name_;
  double PixelSize_;
  NormalAxes Axes_;
  std::vector<std::string> Warnings_;
  BlockSampler Sampler_;
  mutable std::mutex Mutex_;
  mutable std::map<std::pair<int, std::string>, std::shared_ptr<const NormalTurn>> Turns_;
};

// Reads them: what is no normal is rejected in reading.
void CheckPixels(const RasterLevels& levels) {
  constexpr double Most = double(1 << 24); // pixels that are all looked at
  constexpr double Few = double(1 << 22);
  constexpr int Together = 1 << 18; // pixels
  const int columns = levels.Width();
  const int rows = levels.Height();
  const double pixels = double(columns) * rows;
  const bool all = pixels <= Most;
  const int height = all ? std::clamp(Together / columns, 1, rows) : 1;
  const int every = all ? height : int(std::ceil(pixels / Few));
  std::vector<float> cells(std::size_t(columns) * height * 4);
  bool some = false;
  for (int row = 0; row < rows; row += every) {
    const int here = std::min(height, rows - row);
    levels.Read({0, 0, 0, row, columns, here}, cells.data());
    for (std::size_t i = 0; i < std::size_t(columns) * here; ++i) {
      some = some || cells[4 * i + 3] > 0.0f;
    }
  }
  if (!some) {
    throw Error(Error::Kind::Corrupt, levels.Object(), "all of its values are no-data");
  }
}

void CheckAxes(const std::string& object, const Crs& raster, const RasterPlace& terrain,
               NormalAxes axes) {
  if (axes == NormalAxes::Local) {
    if (!terrain.crs.HasGeographic()) {
      throw Error(Error::Kind::Unsupported, object,
                  "its axes are given as local, but " + terrain.name +
                      " has no longitude and latitude; accepted: axes of the map");
    }
    return;
  }
  if (!raster.Ogr() || !terrain.crs.Ogr() || raster.GetWkt() == terrain.crs.GetWkt()) {
    return;
  }
  constexpr int Places = 5;       // a side
  constexpr double Most = 0.0175; // cosine: a degree
  Eigen::Matrix2Xd places(2, Places * Places);
  for (int k = 0; k < places.cols(); ++k) {
    places.col(k) =
        terrain.pixelToMap * Eigen::Vector2d(terrain.columns * (k % Places + 0.5) / Places,
                                             terrain.rows * (k / Places + 0.5) / Places);
  }
  CrsTransform(terrain.crs, raster).TryApply(places);
  for (const Eigen::Matrix2d& there : GroundAxes(raster).At(places)) {
    if (std::abs(there.col(0).dot(there.col(1))) > Most) { // and finite
      throw Error(
          Error::Kind::Unsupported, object,
          "map x and y of its CRS '" + raster.GetName() +
              "' are not at right angles on the ground; accepted: normals whose axes are "
              "local (east, north, up), or of a CRS with right angles, or of the terrain's");
    }
  }
}

} // namespace

std::shared_ptr<const ColorLayer> OpenNormalsLayer(const std::string& path,
                                                   const RasterPlace& terrain, NormalAxes axes,
                                                   const RasterLayerOptions& options) {
  auto levels = std::make_shared<RasterLevels>("normals '" + path + "'", path, 0, options,
                                               RasterShown::Vectors);
  const PlacedRaster placed = PlaceRaster(*levels, terrain, options);
  CheckAxes(levels->Object(), placed.position.crs, terrain, axes);
  CheckPixels(*levels);
  return std::make_shared<RasterNormalsLayer>(std::move(levels), placed, axes);
}

} // namespace dspace
