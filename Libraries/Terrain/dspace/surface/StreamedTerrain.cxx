#include <dspace/surface/StreamedTerrain.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <dspace/Error.h>
#include <dspace/clipmap/arithmetic/ClipmapWindow.h>
#include <dspace/posts/RasterPosts.h>

#include <dspace/pyramid/PostSurface.h>
#include <dspace/rays/SurfaceRay.h>

namespace dspace {
namespace {


} // namespace

StreamedTerrain::StreamedTerrain(const std::string& name,
                                 std::shared_ptr<const ElevationSource> source,
                                 std::vector<std::string> warnings)
    : TerrainSurface(name, source->Info().crs, source->Info().verticalDatum, std::move(warnings)),
      Source_(std::move(source)) {}

StreamedTerrain::~StreamedTerrain() = default;

const ElevationInfo& StreamedTerrain::Info() const {
  return this->Source_->Info();
}

const SceneFrame& StreamedTerrain::Frame() const {
  if (!this->Frame_) {
    throw Error(Error::Kind::Unsupported, this->GetName(),
                "it stands on a body; only one on a plane has such a frame");
  }
  return *this->Frame_;
}

Eigen::Vector2d StreamedTerrain::MapToPost(const Eigen::Vector2d& map) const {
  Eigen::Vector2d post = this->MapToPost_ * map;
  if (this->OnBody()) { // towards the data
    const double turn = 2.0 * M_PI / std::abs(this->Placement_.Step().x());
    const double last = double(this->Pyramid_->Lattice().columns) - 1.0;
    if (this->Pyramid_->Lattice().periodic) {
      post.x() -= turn * std::floor(post.x() / turn);
    } else if (post.x() < 0.0 || post.x() > last) {
      post.x() -= turn * std::round((post.x() - 0.5 * last) / turn);
    }
  }
  return post;
}

// Unit, upward, of the facet at a place of the surface.
Eigen::Vector3d StreamedTerrain::NormalAt(const HeightGrid::Facet& facet,
                                          const Eigen::Vector3d& p_S) const {
  const Eigen::Vector2d rise(facet.dc, facet.dr);
  if (!this->OnBody()) {
    const Eigen::Vector2d g = this->Placement_.SceneToPost().linear().transpose() * rise;
    return Eigen::Vector3d(-g.x(), -g.y(), 1.0).normalized();
  }
  // p = (R + h(c, r)) up(c, r): its derivatives by c and r span the tangent plane.
  const double distance = this->Placement_.Radius() + facet.height;
  const Eigen::Vector3d up = this->Placement_.Up(p_S);
  const double parallel = std::max(up.head<2>().norm(), 1e-12); // cosine of the latitude
  const Eigen::Vector3d north = this->DoNorth(p_S);
  const Eigen::Vector3d east = north.cross(up);
  const Eigen::Vector2d& step = this->Placement_.Step();
  const double toEast = rise.x() == 0.0 ? 0.0 : rise.x() / (distance * parallel * step.x());
  const double toNorth = rise.y() / (distance * step.y());
  return (up - toEast * east - toNorth * north).normalized();
}

const PostSurface& StreamedTerrain::SurfaceAt(const Eigen::Vector2d& post) const {
  const bool plain =
      this->Plain_ && !this->Tracked() && !this->Group_->Reaches(post, this->Plain_->Level());
  return plain ? *this->Plain_ : this->Surface();
}

// Each surface is asked for all of its places at once.
// NOLINTNEXTLINE(performance-unnecessary-value-param): a Ref is a view that is written through
void StreamedTerrain::HeightsAt(const std::vector<Eigen::Vector2d>& posts,
                                Eigen::Ref<Eigen::VectorXd> heights) const {
  std::map<const PostSurface*, std::vector<std::size_t>> parts;
  for (std::size_t i = 0; i < posts.size(); ++i) {
    parts[&this->SurfaceAt(posts[i])].push_back(i);
  }
  for (const auto& [surface, indices] : parts) {
    std::vector<Eigen::Vector2d> places;
    places.reserve(indices.size());
    for (const std::size_t i : indices) {
      places.push_back(posts[i]);
    }
    const std::vector<std::size_t>& at = indices; // bindings are not captured
    surface->At(places, [&](std::size_t k, const HeightGrid::Facet& facet) {
      heights[Eigen::Index(at[k])] =
          facet.valid ? facet.height : std::numeric_limits<double>::quiet_NaN();
    });
  }
}

// The surface at a place; `vertical_S` is the point of space that was asked for, whose vertical it
// is found on.
SurfaceSample StreamedTerrain::SampleAt(const Eigen::Vector2d& post,
                                        const Eigen::Vector3d& vertical_S) const {
  const HeightGrid::Facet facet = this->SurfaceAt(post).At(post);
  SurfaceSample sample;
  if (!facet.valid) {
    return sample;
  }
  sample.valid = true;
  sample.level = 0;
  sample.height = facet.height;
  const Eigen::Vector3d up = this->Placement_.Up(vertical_S);
  if (this->OnBody()) {
    sample.position_S = (this->Placement_.Radius() + facet.height) * up;
  } else {
    sample.position_S << vertical_S.head<2>(), facet.height - this->Placement_.OriginHeight();
  }
  sample.normal_S = this->NormalAt(facet, vertical_S);
  sample.slope_deg = std::atan2(sample.normal_S.cross(up).norm(), sample.normal_S.dot(up)) * 180.0 / M_PI;
  return sample;
}

SurfaceSample StreamedTerrain::DoSample(const Eigen::Vector3d& p_S) const {
  if (this->OnBody() && p_S.isZero(0.0)) {
    return {}; // its centre lies under no place
  }
  return this->SampleAt(this->Placement_.ToPosts(p_S).head<2>(), p_S);
}

SurfaceSample StreamedTerrain::DoSampleMap(const Eigen::Vector2d& map) const {
  const Eigen::Vector2d post = this->MapToPost(map);
  return this->SampleAt(post, this->OnBody() ? this->Placement_.ToScene(post, 0.0)
                                             : this->DoMapToScene({map.x(), map.y(), 0.0}));
}

std::vector<Eigen::Vector2d>
StreamedTerrain::PostsOf(const Eigen::Ref<const Rows3>& points_S) const {
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<Eigen::Vector2d> posts(points_S.rows());
  for (Eigen::Index i = 0; i < points_S.rows(); ++i) {
    const Eigen::Vector3d p_S = points_S.row(i);
    posts[i] = this->OnBody() && p_S.isZero(0.0)
                   ? Eigen::Vector2d(none, none)
                   : Eigen::Vector2d(this->Placement_.ToPosts(p_S).head<2>());
  }
  return posts;
}

void StreamedTerrain::DoHeights(const Eigen::Ref<const Rows3>& points_S,
                                Eigen::Ref<Eigen::VectorXd> heights) const {
  this->HeightsAt(this->PostsOf(points_S), heights);
}

void StreamedTerrain::DoHeightsMap(const Eigen::Ref<const Rows2>& map,
                                   Eigen::Ref<Eigen::VectorXd> heights) const {
  std::vector<Eigen::Vector2d> posts(map.rows());
  for (Eigen::Index i = 0; i < map.rows(); ++i) {
    posts[i] = this->MapToPost(map.row(i));
  }
  this->HeightsAt(posts, heights);
}

Eigen::Vector3d StreamedTerrain::DoMapToScene(const Eigen::Vector3d& map) const {
  return this->OnBody() ? this->Placement_.ToScene(this->MapToPost_ * map.head<2>(), map.z())
                        : this->Frame_->MapToScene(map);
}

Eigen::Vector3d StreamedTerrain::DoSceneToMap(const Eigen::Vector3d& p_S) const {
  if (!this->OnBody()) {
    return this->Frame_->SceneToMap(p_S);
  }
  const Eigen::Vector3d post = this->Placement_.ToPosts(p_S);
  const Eigen::Vector2d map = this->MapToPost_.inverse() * Eigen::Vector2d(post.head<2>());
  return {map.x(), map.y(), post.z()};
}

Eigen::Vector3d StreamedTerrain::DoUp(const Eigen::Vector3d& p_S) const {
  return this->Placement_.Up(p_S);
}

Eigen::Vector3d StreamedTerrain::DoNorth(const Eigen::Vector3d& p_S) const {
  if (!this->OnBody()) {
    return Eigen::Vector3d::UnitY();
  }
  const Eigen::Vector3d up = this->Placement_.Up(p_S);
  const double longitude = std::atan2(up.y(), up.x());
  return up.cross(Eigen::Vector3d(-std::sin(longitude), std::cos(longitude), 0.0));
}

int StreamedTerrain::DoResidentLevel(const Eigen::Vector2d& map) const {
  const PostLattice& lattice = this->Pyramid_->Lattice();
  const Eigen::Vector2d post = this->MapToPost(map);
  const double edge = 1e-9;
  if (!(lattice.periodic ||
        (post.x() >= -edge && post.x() <= double(lattice.columns - 1) + edge)) ||
      !(post.y() >= -edge && post.y() <= double(lattice.rows - 1) + edge)) {
    return -1;
  }
  std::array<float, 4> heights = {};
  for (int level = 0; level < lattice.levels; ++level) {
    const Eigen::Vector2d place = post.cwiseMax(0.0) * std::ldexp(1.0, -level);
    const auto c = std::int64_t(std::floor(place.x()));
    const auto r = std::int64_t(std::floor(place.y()));
    if (this->Pyramid_->TryRead({level, c, r, 2, 2}, heights.data())) {
      return level;
    }
  }
  return -1;
}

} // namespace dspace
