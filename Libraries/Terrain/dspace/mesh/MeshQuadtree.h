// Decimation of a grid without cracks: which squares are drawn as one, and how they meet.
#ifndef DSPACE_TERRAIN_MESHQUADTREE_H
#define DSPACE_TERRAIN_MESHQUADTREE_H

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <dspace/posts/HeightGrid.h>

namespace dspace {

// A forest of quadtrees over a grid's cells: squares of 2^k cells, k = 0 .. top. Squares that share
// an edge differ by one level at most (restricted quadtree: Von Herzen and Barr 1987). A square of
// level 0 is the grid's two triangles, always; a larger one is two triangles on the same diagonal,
// or, where a neighbour is finer, a fan about its middle post with that neighbour's vertex on the
// shared edge. So the coarser side takes the finer side's vertices, edges match one to one, and the
// finest squares are exactly the surface that queries answer.
//
// A square is drawn whole only when all of its posts have data: holes and the ragged right and
// bottom border are cut down to single cells.
class MeshQuadtree {
public:
  // A square that is drawn. Bits of `fan`: a vertex in the middle of its west (1), south (2),
  // east (4) or north (8) edge, in the grid's sense: west is less c, north less r.
  struct Leaf {
    int level = 0;
    int c = 0; // first post
    int r = 0;
    unsigned fan = 0;
  };

  // Squares of 2^top cells at most. Keeps a reference to `grid`.
  MeshQuadtree(const HeightGrid& grid, int top);

  int GetTop() const { return this->Top_; }
  int GetRootColumns() const { return this->Levels_[this->Top_].columns; }
  int GetRootRows() const { return this->Levels_[this->Top_].rows; }
  // Greatest error of any square; with it as tolerance only what must be split is.
  double GetGreatestError() const { return this->GreatestError_; }
  // Triangles of the grid, which all are drawn with a tolerance of 0: errors are rounded up.
  std::size_t GetFinestTriangles() const { return this->FinestTriangles_; }

  // Cells in which nothing may be decimated. Marked are the squares of 2 x 2 cells around cells
  // c0 <= c <= c1, r0 <= r <= r1 for which `touches` says so of the first cell's (c, r).
  void ClearZone();
  void MarkZone(double c0, double r0, double c1, double r1,
                const std::function<bool(int c, int r)>& touches);

  // Posts that are always drawn, with all four cells around each, as if marked.
  void ClearPins();
  void Pin(int c, int r);

  // Splits every square whose error exceeds `tolerance` [m], or that has a marked one or, if
  // `pins`, a pinned post in it, and what must follow. The result depends on these alone, not on
  // what was there before.
  void Refine(double tolerance, bool pins = true);

  std::size_t CountTriangles() const;
  // Leaves of one root, always in the same order.
  std::vector<Leaf> Leaves(int rootColumn, int rootRow) const;

  // Greatest vertical difference [m] between a leaf's triangles and the grid's, exactly: both are
  // linear between the grid's posts and the places where their edges cross, and it looks at all.
  double LeafError(const Leaf& leaf) const;

private:
  enum State : std::uint8_t { Empty, Mixed, Full };

  struct Level {
    int columns = 0;
    int rows = 0;
    std::vector<std::uint8_t> state;
    std::vector<std::uint8_t> split; // level 1 and up, as the next three
    std::vector<std::uint8_t> zone;
    std::vector<std::uint8_t> pinned;
    std::vector<float> error; // of this square and all within it

    std::size_t Index(int c, int r) const {
      return static_cast<std::size_t>(r) * this->columns + c;
    }
    bool Inside(int c, int r) const {
      return c >= 0 && r >= 0 && c < this->columns && r < this->rows;
    }
  };

  void BuildLevel(int level);
  void BuildRows(int level, int first, int last);
  void RefineNode(int level, int c, int r, double tolerance, bool pins);
  void Split(int level, int c, int r);
  void Require(int level, int c, int r);
  template<typename Visitor> void VisitLeaves(int level, int c, int r, Visitor&& visit) const;
  unsigned FanOf(int level, int c, int r) const;

  const HeightGrid& Grid_;
  int Top_;
  std::vector<Level> Levels_;
  double GreatestError_ = 0.0;
  std::size_t FinestTriangles_ = 0;
};

} // namespace dspace

#endif
