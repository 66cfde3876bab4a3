// Where a StreamedTerrain's ground is made up.
#include <dspace/surface/StreamedTerrain.h>

#include <cmath>

#include <dspace/Error.h>

#include <dspace/pyramid/PostSurface.h>

namespace dspace {
namespace {

void RequireResults(const std::string& name, bool finite, Eigen::Index n, Eigen::Index results) {
  if (!finite || n != results) {
    throw Error(Error::Kind::InvalidArgument, name,
                "finite points and as many results are accepted");
  }
}

} // namespace

// NOLINTNEXTLINE(performance-unnecessary-value-param): a Ref is a view that is written through
void StreamedTerrain::FilledAt(const std::vector<Eigen::Vector2d>& posts,
                               Eigen::Ref<Eigen::VectorXd> filled) const {
  this->HeightsAt(posts, filled);
  for (double& height : filled) {
    height = std::isnan(height) ? height : (this->Holed_ ? 1.0 : 0.0);
  }
  if (this->Holed_) {
    this->Holed_->At(posts, [&](std::size_t i, const HeightGrid::Facet& facet) {
      if (facet.valid) {
        filled[Eigen::Index(i)] = 0.0;
      }
    });
  }
}

void StreamedTerrain::Filled(const Eigen::Ref<const Rows3>& points_S,
                             Eigen::Ref<Eigen::VectorXd> filled) const {
  RequireResults(this->GetName(), points_S.allFinite(), points_S.rows(), filled.size());
  this->FilledAt(this->PostsOf(points_S), filled);
}

void StreamedTerrain::FilledMap(const Eigen::Ref<const Rows2>& map,
                                Eigen::Ref<Eigen::VectorXd> filled) const {
  RequireResults(this->GetName(), map.allFinite(), map.rows(), filled.size());
  std::vector<Eigen::Vector2d> posts;
  posts.reserve(std::size_t(map.rows()));
  for (Eigen::Index i = 0; i < map.rows(); ++i) {
    posts.push_back(this->MapToPost(map.row(i)));
  }
  this->FilledAt(posts, filled);
}

} // namespace dspace
