#include <dspace/commands/terrain/ClipmapTerrainObject.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <dspace/Checks.h>
#include <dspace/clipmap/ColorGridsOf.h>
#include <dspace/clipmap/PoleCharts.h>
#include <dspace/commands/terrain/ClipmapMesh.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

std::shared_ptr<ClipmapTerrain> MakeClipmap(const StreamedTerrain& surface,
                                            const ClipmapOptions& options,
                                            const ElevationPyramidOptions& pyramid) {
  const std::vector<ClipmapChart> poles = PoleChartsOf(surface, options.cells, pyramid);
  return std::make_shared<ClipmapTerrain>(surface.Pyramid(), surface.Placement(), options, poles,
                                          ColorGridsOf(surface, poles));
}

} // namespace

ClipmapTerrainObject::ClipmapTerrainObject(std::string name,
                                           std::shared_ptr<StreamedTerrain> surface,
                                           const ClipmapOptions& options,
                                           const ElevationPyramidOptions& pyramid,
                                           std::string cacheFolder)
    : TerrainObject(std::move(name)), Surface_(std::move(surface)),
      Clipmap_(MakeClipmap(*Surface_, options, pyramid)), Layers_(this->Name(), Clipmap_->Layers()),
      CacheFolder_(std::move(cacheFolder)) {}

std::vector<Part> ClipmapTerrainObject::Triangles(std::size_t triangleBudget) const {
  return ClipmapMesh(*this->Clipmap_, triangleBudget);
}

void ClipmapTerrainObject::DescribeLayers(v1::TerrainLayerList& list) const {
  this->Layers_.Describe(list);
  const ColorTilesStatistics statistics = this->Clipmap_->TileStatistics();
  list.set_bytes(statistics.bytes);
  list.set_kept_bytes(statistics.keptBytes);
  list.set_reads(statistics.reads);
  list.set_compositions(statistics.compositions);
  list.set_failures(statistics.failures);
  list.set_last_failure(statistics.lastFailure);
}

void ClipmapTerrainObject::Describe(v1::TerrainReply& reply) const {
  TerrainObject::Describe(reply);
  const StreamedTerrain& surface = *this->Surface_;
  const ElevationInfo& info = surface.Info();
  reply.set_mode(v1::OpenTerrain::CLIPMAP);
  reply.set_on_body(this->OnBody());
  reply.set_columns(std::uint32_t(info.window.width));
  reply.set_rows(std::uint32_t(info.window.height));
  reply.set_pixel_width(info.pixelToMap.linear().col(0).norm());
  reply.set_pixel_height(info.pixelToMap.linear().col(1).norm());
  reply.set_minimum_height(surface.HeightRange()[0]);
  reply.set_maximum_height(surface.HeightRange()[1]);
  if (!reply.on_body()) {
    const Eigen::Vector2d& origin = surface.Frame().GetOrigin();
    Put(Eigen::Vector3d(origin.x(), origin.y(), surface.Frame().GetOriginHeight()),
        reply.mutable_map_origin());
  }
  reply.set_levels(std::uint32_t(surface.Pyramid()->Lattice().levels));
  reply.set_subdivisions(std::uint32_t(surface.Subdivisions()));
  reply.set_post_columns(std::uint64_t(surface.Pyramid()->Lattice().columns));
  reply.set_post_rows(std::uint64_t(surface.Pyramid()->Lattice().rows));
  reply.set_overlap_columns(info.overlapColumns);
  reply.set_vertical_scale(info.verticalScale);
  reply.set_vertical_offset(info.verticalOffset);
  const int built = this->Overviews_;
  reply.set_overviews(std::uint32_t(built > 0 ? built : info.overviews));
  reply.set_overviews_are_cached(built > 0 || info.overviewsAreCached);
  if (this->Build_) {
    using State = OverviewBuild::State;
    const State state = this->Build_->GetState();
    reply.set_overview_build(state == State::Building ? v1::TerrainReply::BUILDING
                             : state == State::Built  ? v1::TerrainReply::BUILT
                                                      : v1::TerrainReply::FAILED);
    reply.set_overview_progress(this->Build_->Progress());
    reply.set_overview_failure(this->Build_->Failure());
  }
  if (surface.Resampling()) {
    reply.set_resampled_columns(std::uint64_t(surface.Resampling()->columns));
    reply.set_resampling_posts(std::uint32_t(surface.Resampling()->posts));
    reply.set_resampling_rms_error(surface.Resampling()->rmsError);
    reply.set_resampling_greatest_error(surface.Resampling()->greatestError);
  }
  const ElevationPyramidStatistics statistics = surface.Pyramid()->Statistics();
  reply.set_tile_bytes(statistics.bytes);
  reply.set_tile_loads(statistics.loads);
  reply.set_tile_failures(statistics.failures);
  reply.set_last_failure(statistics.lastFailure);
  const TrackStatistics tracks = surface.Tracks().Statistics();
  reply.set_track_bytes(tracks.bytes);
  reply.set_track_contacts(tracks.contacts);
  reply.set_track_length(tracks.length);
  for (std::size_t i = 0; surface.Group() && i < surface.Group()->patches.size(); ++i) {
    const PatchReport& from = surface.Group()->patches[i];
    v1::PatchReply* patch = reply.add_patch();
    patch->set_name(from.name);
    patch->set_used(from.used);
    patch->set_pixel_size(from.pixel);
    patch->set_margin(from.margin);
    patch->set_added(from.addedTo);
    patch->set_minimum_height(from.heights[0]);
    patch->set_maximum_height(from.heights[1]);
    patch->set_posts(std::uint32_t(from.posts));
    patch->set_rms_error(from.rmsError);
    patch->set_greatest_error(from.greatestError);
  }
}

void ClipmapTerrainObject::BuildOverviews(const std::string& folder,
                                          const ElevationOptions& options) {
  const auto built = [this] {
    std::vector<std::shared_ptr<ElevationPyramid>> poles;
    for (std::size_t i = 1; i < this->Clipmap_->Charts().size(); ++i) {
      poles.push_back(this->Clipmap_->Charts()[i].pyramid);
    }
    this->Overviews_ = this->Surface_->LoadOverviews(poles);
  };
  this->Build_ =
      std::make_unique<OverviewBuild>(folder, this->Surface_->Info().path, options, built);
}

bool ClipmapTerrainObject::Focus(const std::vector<Eigen::Vector2d>& points_S, double radius) {
  const std::string label = "terrain '" + this->Name() + "'";
  for (const Eigen::Vector2d& point : points_S) {
    if (!point.allFinite()) {
      Reject(label, "a point of the focus is not finite");
    }
  }
  if (!points_S.empty() && !(radius > 0.0 && std::isfinite(radius))) {
    Reject(label, "the radius of the focus is " + NumberText(radius) + "; accepted: > 0 m, finite");
  }
  return false;
}

bool ClipmapTerrainObject::Explains(const std::string& viewport, const std::string& layer,
                                    const std::function<bool(const Membership&)>& shown) const {
  if (layer.empty()) {
    return this->Clipmap_->StyleIn(viewport).ShownBy(shown).ramp.has_value();
  }
  const std::vector<StackedLayer> layers = this->Clipmap_->Layers()->Layers();
  return std::any_of(layers.begin(), layers.end(), [&](const StackedLayer& each) {
    return each.name == layer && LayerChoice().Takes(each) && shown(each.member);
  });
}

} // namespace dspace::session
