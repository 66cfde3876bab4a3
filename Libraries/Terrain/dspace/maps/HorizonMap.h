// Horizons of whole grids of cells, in a file.
#ifndef DSPACE_MAPS_HORIZON_MAP_H
#define DSPACE_MAPS_HORIZON_MAP_H

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/maps/MapCells.h>
#include <dspace/maps/MapGround.h>
#include <dspace/maps/MapWork.h>

namespace dspace {

struct HorizonMapOptions {
  MapCells cells;
  double height = 0.0; // [m] of the observers above the ground, 0 to 1e6
  bool fast = false;   // HorizonOptions::fast: to half a degree
  int azimuths = 360;  // evenly spaced, clockwise from north, 1 to 3600
  // Paths of complete maps of parts of its cells, which other processes wrote: what they hold is
  // copied. A tile counts if one part has all of it.
  std::vector<std::string> parts;
};

// Writes the map: a band per azimuth, elevations [deg] of the highest ground in sight over the
// plane that is normal to the local vertical at the cell, -90 where there is none, NaN where the
// cell has no data. Azimuths count from true north on a degree grid, and from the map's Y axis on a
// plane. Obstacles are the triangles of this terrain alone, up to 4096 posts away; farther away,
// its coarser levels (HorizonSweep). An edge between two posts counts also where both its triangles
// are holes. A body's curvature counts.
//
// The result depends on the inputs alone, to the byte: neither on the threads nor on interruptions.
// Returns false if control.progress ended it. Throws what TileFile, FillTiles and Survey throw,
// Error(InvalidArgument) for an option out of range and for a part of another ground, height or
// number of azimuths, what HorizonMap throws for a part, and Error(Io) if the terrain changed while
// the map was written.
bool WriteHorizonMap(const MapGround& ground, const HorizonMapOptions& options,
                     const std::string& path, const MapControl& control = {});

// A map that was written. Any thread may read.
class HorizonMap {
public:
  // Throws Error: NotFound; Corrupt for a file that is no whole horizon map.
  explicit HorizonMap(const std::string& path);
  ~HorizonMap();

  const std::string& Path() const { return this->Path_; }
  int Columns() const { return this->Cells_.columns; }
  int Rows() const { return this->Cells_.rows; }
  int Azimuths() const { return this->Azimuths_; }
  double Height() const { return this->Height_; }
  bool Fast() const { return this->Fast_; }
  const std::string& Terrain() const { return this->Terrain_; }    // its name for messages
  std::uint64_t TerrainHash() const { return this->TerrainHash_; } // GroundSurvey::hash
  std::uint64_t InputHash() const { return this->InputHash_; }     // of all that it depends on
  // The posts of the terrain, and which of them are cells.
  const PostPlacement& Placement() const { return this->Placement_; }
  const MapCells& Cells() const { return this->Cells_; }
  const Crs& GetCrs() const { return this->Crs_; }
  const Eigen::Affine2d& CellToMap() const { return this->CellToMap_; }

  // Elevations [deg], azimuth after azimuth, of `width` x `height` cells row by row. Throws
  // Error(Corrupt).
  std::vector<float> Read(int column, int row, int width, int height) const;

private:
  struct File;
  std::string Path_;
  std::unique_ptr<File> File_;
  int Azimuths_ = 0;
  double Height_ = 0.0;
  bool Fast_ = false;
  std::string Terrain_;
  std::uint64_t TerrainHash_ = 0;
  std::uint64_t InputHash_ = 0;
  PostPlacement Placement_;
  MapCells Cells_;
  Crs Crs_;
  Eigen::Affine2d CellToMap_ = Eigen::Affine2d::Identity();
};

} // namespace dspace

#endif
