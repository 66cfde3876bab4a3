#include <dspace/tracks/GroundTracks.h>

#include <utility>

#include <dspace/Error.h>
#include <dspace/tracks/TrackFile.h>

#include <dspace/pyramid/JoinRectangles.h>

namespace dspace {
namespace {

// Each is compared with every tile in memory, while all who read tiles wait.
constexpr std::size_t MaximumRectangles = 256;

} // namespace

GroundTracks::GroundTracks(const std::string& name, std::shared_ptr<const PostSource> bare,
                           const Eigen::Affine2d& postToScene, const SceneFrame& frame,
                           const Crs& crs, const WheelTracksOptions& options)
    : Frame_(frame), Crs_(crs), Bare_(std::move(bare)),
      Tracks_(std::make_shared<WheelTracks>(name, options)),
      Posts_(std::make_shared<const TrackPosts>(this->Bare_, this->Tracks_, postToScene)) {}

std::vector<PostRectangle> GroundTracks::Add(const std::vector<TrackAddition>& additions) {
  return JoinRectangles(this->Posts_->RectanglesOf(this->Tracks_->Add(additions)),
                        MaximumRectangles);
}

std::vector<PostRectangle> GroundTracks::Restore(const std::vector<TrackStroke>& strokes,
                                                 bool continues) {
  return JoinRectangles(this->Posts_->RectanglesOf(this->Tracks_->Restore(strokes, continues)),
                        MaximumRectangles);
}

std::vector<PostRectangle> GroundTracks::Clear() {
  return this->Posts_->RectanglesOf(this->Tracks_->Clear());
}

void GroundTracks::Save(const std::string& path) const {
  WriteTracks(path, this->Tracks_->Strokes(), this->Crs_, [this](const Eigen::Vector2d& p) {
    return Eigen::Vector2d(this->Frame_.SceneToMap({p.x(), p.y(), 0.0}).head<2>());
  });
}

std::vector<TrackAddition> GroundTracks::Read(const std::string& path, std::size_t most) const {
  std::vector<TrackAddition> tracks =
      ReadTracks(path, this->Crs_, [this](const Eigen::Vector2d& p) {
        return Eigen::Vector2d(this->Frame_.MapToScene({p.x(), p.y(), 0.0}).head<2>());
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
  return tracks;
}

} // namespace dspace
