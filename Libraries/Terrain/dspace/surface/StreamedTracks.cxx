// Wheel tracks on a StreamedTerrain, and the ground as it was before them.
#include <dspace/surface/StreamedTerrain.h>

#include <utility>

#include <dspace/Error.h>
#include <dspace/tracks/TrackFile.h>
#include <dspace/tracks/TrackPosts.h>

#include <dspace/pyramid/JoinRectangles.h>
#include <dspace/pyramid/PostSurface.h>
#include <dspace/rays/SurfaceRay.h>

namespace dspace {
namespace {

// Each is compared with every tile in memory, while all who read tiles wait.
constexpr std::size_t MostRectangles = 256;

} // namespace

Eigen::Affine2d StreamedTerrain::PlanePosts() const {
  // PostToScene() takes posts to stand half a unit from the corner.
  const Eigen::Affine2d postToMap =
      this->Info().pixelToMap * (this->PixelToPost_.inverse() * Eigen::Translation2d(-0.5, -0.5));
  return this->Frame_->PostToScene(postToMap);
}

std::shared_ptr<const PostSource>
StreamedTerrain::WithTracks(std::shared_ptr<const PostSource> source,
                            const StreamedTerrainOptions& options) {
  this->Bare_ = std::move(source);
  this->Tracks_ = std::make_shared<WheelTracks>(this->GetName(), options.tracks);
  this->TrackPosts_ =
      std::make_shared<const TrackPosts>(this->Bare_, this->Tracks_, this->PlanePosts());
  return this->TrackPosts_;
}

const WheelTracks& StreamedTerrain::Tracks() const {
  if (!this->Tracks_) {
    throw Error(Error::Kind::Unsupported, this->GetName(),
                "it stands on a body; wheel tracks are accepted on a plane");
  }
  return *this->Tracks_;
}

void StreamedTerrain::AddTracks(const std::vector<TrackAddition>& additions) const {
  this->Tracks();
  this->Pyramid_->Invalidate(JoinRectangles(
      this->TrackPosts_->RectanglesOf(this->Tracks_->Add(additions)), MostRectangles));
}

void StreamedTerrain::RestoreTracks(const std::vector<TrackStroke>& strokes, bool goesOn) const {
  this->Tracks();
  this->Pyramid_->Invalidate(JoinRectangles(
      this->TrackPosts_->RectanglesOf(this->Tracks_->Restore(strokes, goesOn)), MostRectangles));
}

void StreamedTerrain::ClearTracks() const {
  this->Tracks();
  this->Pyramid_->Invalidate(this->TrackPosts_->RectanglesOf(this->Tracks_->Clear()));
}

void StreamedTerrain::SaveTracks(const std::string& path) const {
  WriteTracks(path, this->Tracks().Strokes(), this->Info().crs, [this](const Eigen::Vector2d& p) {
    return Eigen::Vector2d(this->Frame_->SceneToMap({p.x(), p.y(), 0.0}).head<2>());
  });
}

void StreamedTerrain::LoadTracks(const std::string& path, std::size_t most) const {
  this->Tracks();
  const std::vector<TrackAddition> tracks =
      ReadTracks(path, this->Info().crs, [this](const Eigen::Vector2d& p) {
        return Eigen::Vector2d(this->Frame_->MapToScene({p.x(), p.y(), 0.0}).head<2>());
      });
  std::size_t contacts = 0;
  for (const TrackAddition& track : tracks) {
    contacts += track.contacts.size();
  }
  if (contacts > most) {
    throw Error(Error::Kind::Resource, "file '" + path + "'",
                "its tracks have " + std::to_string(contacts) + " contacts; accepted: up to " +
                    std::to_string(most) + " of a file");
  }
  this->AddTracks(tracks);
}

std::array<double, 2> StreamedTerrain::DrawnHeights() const {
  if (!this->Tracks_) {
    return this->HeightRange_;
  }
  return {this->HeightRange_[0] - TrackProfile::MostSinkage - TrackProfile::MostTread,
          this->HeightRange_[1] + TrackProfile::MostRim};
}

const StreamedTerrain& StreamedTerrain::Undisturbed() const {
  if (!this->Tracks_) {
    return *this;
  }
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  if (!this->Undisturbed_) {
    ElevationPyramidOptions options;
    options.byteBudget = std::size_t(16) << 20;
    std::unique_ptr<StreamedTerrain> bare(
        new StreamedTerrain(this->GetName(), this->Source_, this->GetWarnings()));
    bare->Group_ = this->Group_;
    bare->Pyramid_ = std::make_shared<ElevationPyramid>(this->Bare_, options);
    bare->Surface_ = std::make_unique<PostSurface>(bare->Pyramid_, this->Surface_->Level(),
                                                   this->Poles_, this->Deadline_);
    if (this->Plain_) {
      bare->Plain_ = std::make_unique<PostSurface>(bare->Pyramid_, this->Plain_->Level(),
                                                   this->Poles_, this->Deadline_);
    }
    bare->Posts_ = this->Posts_;
    bare->Filled_ = this->Filled_;
    bare->Holed_ = this->Holed_;
    bare->FullLevel_ = this->FullLevel_;
    bare->Ground_ = this->Ground_;
    bare->BottomOptions_ = this->BottomOptions_;
    bare->Placement_ = this->Placement_;
    bare->Frame_ = this->Frame_;
    bare->PixelToPost_ = this->PixelToPost_;
    bare->MapToPost_ = this->MapToPost_;
    bare->Poles_ = this->Poles_;
    bare->Subdivisions_ = this->Subdivisions_;
    bare->FullLevel_ = this->FullLevel_;
    bare->Deadline_ = this->Deadline_;
    bare->HeightRange_ = this->HeightRange_;
    bare->HeightRangeIsExact_ = this->HeightRangeIsExact_;
    this->Undisturbed_ = std::move(bare);
  }
  return *this->Undisturbed_;
}

} // namespace dspace
