// Posts in memory and the triangles between them, which define the surface of all terrains.
#ifndef DSPACE_TERRAIN_HEIGHTGRID_H
#define DSPACE_TERRAIN_HEIGHTGRID_H

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace dspace {

// The surface between posts. Grid coordinates (c, r) count posts: (0, 0) is the first post of the
// first row, the centre of the raster's top-left pixel. Each cell of four posts
//
//   (c, r) ----- (c+1, r)
//      |  \         |
//      |    \   B   |        the diagonal joins (c, r) with (c+1, r+1): north-west with
//      |  A   \     |        south-east in a north-up raster
//      |        \   |
//   (c, r+1) --- (c+1, r+1)
//
// is two flat triangles, A below the diagonal and B above it. A triangle with a post that has no
// data is a hole. Heights are doubles in metres; NaN marks no data.
class HeightGrid {
public:
  // The plane under a point: height there and its rise a post along c and r.
  struct Facet {
    bool valid = false;
    double height = 0.0;
    double dc = 0.0;
    double dr = 0.0;
  };

  // `gridToScene` takes (c, r) to scene (x, y) [m]. `name` is for messages. Throws
  // Error(InvalidArgument) for fewer than 2 x 2 posts, a count that does not match, a height
  // beyond 1e9 m, no post with data, or a map that is not invertible or leaves 1e15 m.
  HeightGrid(const std::string& name, int columns, int rows, std::vector<double> heights,
             const Eigen::Affine2d& gridToScene);

  int GetColumns() const { return this->Columns_; } // posts a row
  int GetRows() const { return this->Rows_; }
  double GetMinimum() const { return this->Minimum_; } // [m] over posts with data, as given
  double GetMaximum() const { return this->Maximum_; }
  std::size_t GetHoleCount() const { return this->Holes_; } // posts without data
  const std::vector<double>& GetHeights() const {
    return this->Heights_;
  } // row by row from the top

  // Moves a post that has data, within 1e9 m. GetMinimum() and GetMaximum() stay those of the
  // heights given.
  void Move(int c, int r, double height) {
    this->Heights_[static_cast<std::size_t>(r) * this->Columns_ + c] = height;
  }

  double At(int c, int r) const {
    return this->Heights_[static_cast<std::size_t>(r) * this->Columns_ + c];
  }
  bool HasPost(int c, int r) const { return this->At(c, r) == this->At(c, r); }
  // All three posts of triangle A or B of the cell have data.
  bool HasA(int c, int r) const {
    return this->HasPost(c, r) && this->HasPost(c, r + 1) && this->HasPost(c + 1, r + 1);
  }
  bool HasB(int c, int r) const {
    return this->HasPost(c, r) && this->HasPost(c + 1, r) && this->HasPost(c + 1, r + 1);
  }

  const Eigen::Affine2d& GetGridToScene() const { return this->GridToScene_; }
  Eigen::Vector2d ToScene(const Eigen::Vector2d& g) const { return this->GridToScene_ * g; }
  // A point within a billionth of a cell outside is taken to be on the border.
  Eigen::Vector2d ToGrid(const Eigen::Vector2d& p_S) const { return this->SceneToGrid_ * p_S; }

  // The triangle at a grid point; on an edge or post, one of those there that exist.
  Facet FacetAt(const Eigen::Vector2d& g) const;

  // Unit upward normal and slope [deg] of a facet in the scene.
  Eigen::Vector3d Normal(const Facet& facet) const;
  double Slope(const Facet& facet) const;

  // For shading: the mean, weighted by area, of the normals of the triangles around a post; up
  // where there is none.
  Eigen::Vector3d PostNormal(int c, int r) const;

private:
  Eigen::Vector2d SceneGradient(const Facet& facet) const;
  Facet CellFacet(int c, int r, bool below, double u, double v) const;

  int Columns_;
  int Rows_;
  std::vector<double> Heights_;
  double Minimum_ = 0.0;
  double Maximum_ = 0.0;
  std::size_t Holes_ = 0;
  Eigen::Affine2d GridToScene_;
  Eigen::Affine2d SceneToGrid_;
};

} // namespace dspace

#endif
