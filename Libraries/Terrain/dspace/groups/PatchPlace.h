// The position of a patch in the lattice of its terrain.
#ifndef DSPACE_TERRAIN_PATCHPLACE_H
#define DSPACE_TERRAIN_PATCHPLACE_H

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/crs/CrsTransform.h>
#include <dspace/posts/PostSource.h>
#include <dspace/raster/ElevationSource.h>

namespace dspace {

// Pixels count from the patch's corner: (0.5, 0.5) is its first pixel's centre.
class PatchPlace {
public:
  static constexpr int SquareSize = 512; // posts a side of one interpolation, at most

  // `object` names the patch. Throws Error(InvalidArgument) for a patch of another body than the
  // base's, or where only one of the two has a CRS.
  PatchPlace(const std::string& object, const ElevationInfo& base, const ElevationInfo& patch);

  // Not finite where the projections have no value.
  Eigen::Vector2d PixelOf(const Eigen::Vector2d& baseMap) const;
  Eigen::Vector2d BaseMapOf(const Eigen::Vector2d& pixel) const;
  // A pixel's sides on the ground in the patch's middle [m].
  const Eigen::Vector2d& Metres() const { return this->Metres_; }
  // The longer side of a pixel of the base, in pixels of the patch: the most of a number of places
  // over the patch; 0 where it has none in the base's CRS.
  double BasePixel() const { return this->BasePixel_; }

  // Sets the lattice. Call it before any function below. With `poles` its first and last row
  // are one point each.
  void SetLattice(const PostLattice& lattice, const Eigen::Affine2d& postToBaseMap, bool poles);
  // Whether any of it lies in the lattice.
  bool Inside() const { return this->Inside_; }
  Eigen::Vector2d PostOf(const Eigen::Vector2d& pixel) const; // level 0, towards the lattice
  double PostSize() const; // BasePixel() for the side between two posts of level 0
  // Whether any of it lies within `sides` of a level's longer sides from a place in level 0.
  bool Reaches(const Eigen::Vector2d& post, int level, double sides) const;
  // Whether it may change posts of level 0 in a box of places.
  bool Touches(const Eigen::AlignedBox2d& posts) const;
  // A square of posts of a level with the pixels at its corners. Places between are interpolated;
  // a square of one post is that post's place.
  struct Corners {
    int level = 0;
    std::int64_t column = 0; // of its first post
    std::int64_t row = 0;
    std::int64_t size = 0; // posts a side
    std::array<Eigen::Vector2d, 4> pixels;
    // (u, v) in shares of the side.
    Eigen::Vector2d At(double u, double v) const {
      const auto& [a, b, c, d] = this->pixels;
      return (1.0 - v) * (a + u * (b - a)) + v * (c + u * (d - c));
    }
  };
  // PixelsOf interpolates in the largest square about a post for which this is true: of
  // SquareSize, or halved; those of one post are its place. Finds the corners' pixels.
  bool Interpolates(Corners& square, double tolerance) const;
  // Whether PixelsOf finds pixels for a post of level 0.
  bool ReachesColumn(std::int64_t column) const {
    return this->Inside_ &&
           this->Columns_.Has(this->Unwrapped(double(column)), this->Widening_.x());
  }
  bool ReachesRow(std::int64_t row) const {
    return this->Inside_ && this->Rows_.Has(double(row), this->Widening_.y());
  }
  // Whether places are costly: a projection is computed.
  bool Projects() const { return this->Transform_ != nullptr; }
  // A box of pixels that holds those of all places in a box of level 0. Found by places in it: how
  // it bends between them is allowed for. Without end where they bend too much.
  Eigen::AlignedBox2d PixelBox(const Eigen::AlignedBox2d& posts) const;
  // Pixels of a block's posts, not finite for those that the patch, widened by two sides
  // of the level, does not reach. PROJ is asked at the corners, edges and middles of squares of
  // posts, and what lies between is interpolated where that is within `tolerance` [pixels] at all
  // of them; else the square is quartered. The squares are the lattice's, hence a post's place does
  // not depend on the block. False where none is reached.
  bool PixelsOf(const PostBlock& block, double tolerance,
                std::vector<Eigen::Vector2d>& pixels) const;

private:
  struct Square;
  struct Reach { // columns or rows of level 0 that the patch touches
    double from = 0.0;
    double to = 0.0;
    bool all = false;
    bool Has(double place, double widened) const {
      return this->all || (place >= this->from - widened && place <= this->to + widened);
    }
  };
  void FindSizes();
  void FindReach();
  void InitPoles();
  double Unwrapped(double column) const;
  Eigen::Vector2d PixelOfPost(const Eigen::Vector2d& post) const {
    return this->PixelOf(this->PostToBaseMap_ * post);
  }
  void Fill(const Square& square, double tolerance, const PostBlock& block,
            std::vector<Eigen::Vector2d>& pixels) const;

  ElevationInfo Base_;
  ElevationInfo Patch_;
  Eigen::Affine2d MapToPixel_;
  std::shared_ptr<const CrsTransform> Transform_; // base to patch; null: the same
  double PatchTurn_ = 0.0;                        // [pixels] around the body; 0: does not repeat
  double BaseTurn_ = 0.0;                         // [base map]
  Eigen::Vector2d Metres_ = Eigen::Vector2d::Ones();
  double BasePixel_ = 0.0;
  Eigen::Vector2d Widening_ = Eigen::Vector2d::Zero(); // two of the longer sides, in columns, rows

  PostLattice Lattice_;
  Eigen::Affine2d PostToBaseMap_ = Eigen::Affine2d::Identity();
  bool Poles_ = false;
  double Turn_ = 0.0; // [posts]
  Reach Columns_;
  Reach Rows_;
  bool Inside_ = false;
};

} // namespace dspace

#endif
