// A tile of a horizon map, and how its cells see a body in the sky.
#ifndef DSPACE_MAPS_HORIZON_TILE_H
#define DSPACE_MAPS_HORIZON_TILE_H

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <dspace/horizon/HorizonPath.h>
#include <dspace/maps/HorizonMap.h>

namespace dspace {

// Directions are found at nodes and are linear between them. From each node to the next, across and
// down, the east turns by less than 0.01 rad, or each cell is a node. Angles are floats, to 1e-7 of
// them.
class HorizonTile {
public:
  // The tile whose first cell is `column`, `row` of the map, which must outlive it. Throws what
  // HorizonMap::Read throws.
  HorizonTile(const HorizonMap& map, int column, int row);

  int Width() const { return this->Width_; } // cells; the map's last tiles may be smaller
  int Height() const { return this->Height_; }
  bool HasData(int cell) const; // row by row

  // Finds the direction to a place [m, the terrain's frame] from the cells, for SeeRow().
  void LookAt(const Eigen::Vector3d& p_S);
  // What a row's cells see of it, from left to right, in arrays of Width(): how far it stands above
  // the horizon and the rise of the horizon to the next azimuth [rad], NaN without data; and the
  // secant of its elevation over the local horizontal, MostSecant at most.
  void SeeRow(int row, float* above, float* rise, float* secant) const;
  // Towards the zenith azimuths have no width.
  static constexpr double MostSecant = 4.0;

  // The part of the Sun's disc that another disc leaves [radii in m]. Returns whether it leaves
  // less than all of it anywhere.
  bool Eclipse(const Eigen::Vector3d& sun_S, double sunRadius, const Eigen::Vector3d& other_S,
               double otherRadius);
  double LeftAt(int cell) const; // of the last Eclipse() that returned true

private:
  struct Node {
    ChartAxes axes;
    Eigen::Vector3d p_S;
  };
  // A piece of a row between two nodes: at its first cell, and from cell to cell.
  struct Piece {
    int first, count; // cells of the row
    double azimuth, azimuthStep;
    double elevation, elevationStep;
    double secant, secantStep;
  };
  static Node NodeAt(const PostPlacement& placement, const Eigen::Vector2d& post);
  double LargestTurn() const; // of the east from a node to the next, across or down [rad]
  void SeePiece(int row, const Piece& piece, float* above, float* rise, float* secant) const;

  int Width_;
  int Height_;
  int Azimuths_;
  std::vector<float> Horizons_; // [rad], azimuth after azimuth
  int Step_ = 1;                // cells between nodes
  int Across_ = 1;              // nodes
  std::vector<Node> Nodes_;     // one: of a plane, where all cells have the same direction
  std::vector<double> Azimuth_; // of the nodes [rad]
  std::vector<double> Elevation_;
  std::vector<double> Secant_;
  std::vector<double> Left_; // of the Sun's disc
};

} // namespace dspace

#endif
