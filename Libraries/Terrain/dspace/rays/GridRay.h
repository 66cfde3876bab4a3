// Exact rays against the triangles of a HeightGrid.
#ifndef DSPACE_TERRAIN_GRIDRAY_H
#define DSPACE_TERRAIN_GRIDRAY_H

#include <array>
#include <vector>

#include <dspace/posts/HeightGrid.h>

namespace dspace {

// A pyramid of least and greatest heights over blocks of 2^k x 2^k cells; a ray skips every block
// that it passes wholly above or below (max-mipmap march: Tevs, Ihrke, Seidel 2008). In the cells
// that remain, height of ray less height of ground is a piecewise linear function of the distance,
// with bends only where the ray crosses a grid line or a diagonal: its sign is looked at there, and
// carried from cell to cell, so that no ray slips through an edge, however grazing. Arithmetic is
// double; a crossing's error is of the order of 1e-15 of the coordinates involved.
class GridRay {
public:
  struct Hit {
    bool hit = false;
    bool fromBelow = false;
    double distance = 0.0; // in units of the direction's length
    HeightGrid::Facet facet;
  };

  // Keeps a reference to `grid`, which must outlive it.
  explicit GridRay(const HeightGrid& grid);

  // Posts first..last have moved.
  void Update(const Eigen::Vector2i& first, const Eigen::Vector2i& last);

  // Least and greatest height, rounded outwards to floats.
  std::array<double, 2> Range() const {
    return {this->Levels_.back().least[0], this->Levels_.back().greatest[0]};
  }

  // First crossing for 0 <= t <= maximum of origin + t * direction, both in scene coordinates but
  // with z a height above the vertical datum. The direction is finite and not zero.
  Hit Intersect(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                double maximum) const;

private:
  struct March;

  struct Level {
    int columns = 0; // blocks
    int rows = 0;
    std::vector<float> least; // rounded outwards; +infinity and -infinity where there is no post
    std::vector<float> greatest;
  };

  void Build(std::size_t level, int c0, int r0, int c1, int r1);
  bool Visit(March& march, int level, int c, int r, double t0, double t1) const;
  bool VisitCell(March& march, int c, int r, double t0, double t1) const;
  bool Observe(March& march, double t, double above, const HeightGrid::Facet& facet) const;

  const HeightGrid& Grid_;
  std::vector<Level> Levels_; // [k]: blocks of 2^(k+1) cells
};

} // namespace dspace

#endif
