// How large a texel is on the ground. Not for public headers.
#ifndef DSPACE_LAYERS_TEXELSIDES_H
#define DSPACE_LAYERS_TEXELSIDES_H

#include <algorithm>
#include <cmath>

#include <dspace/layers/ColorGrid.h>

namespace dspace {

class TexelSides {
public:
  TexelSides(const ColorGrid& grid, int zoom)
      : Placement_(grid.placement), Texel_(grid.TexelToPost(zoom).linear().diagonal().cwiseAbs()) {
    if (!this->Placement_.OnBody()) {
      const Eigen::Matrix2d sides =
          this->Placement_.PostToScene().linear() * this->Texel_.asDiagonal();
      this->Plane_ = {sides.col(0).norm(), sides.col(1).norm()};
    }
  }
  // Along columns and rows [m], at a post.
  Eigen::Vector2d At(const Eigen::Vector2d& post) const {
    switch (this->Placement_.GetKind()) {
    case PostPlacement::Kind::Plane:
      return this->Plane_;
    case PostPlacement::Kind::Pole:
      return this->Texel_ * this->Placement_.CellSize(post);
    case PostPlacement::Kind::Sphere:
      break;
    }
    const double cosine = std::abs(std::cos(this->Placement_.Angles(post).y()));
    return this->Placement_.Radius() * this->Placement_.Step().cwiseAbs().cwiseProduct(
                                           this->Texel_.cwiseProduct(Eigen::Vector2d(cosine, 1.0)));
  }

private:
  const PostPlacement& Placement_;
  Eigen::Vector2d Texel_; // [posts]
  Eigen::Vector2d Plane_ = Eigen::Vector2d::Zero();
};

} // namespace dspace

#endif
