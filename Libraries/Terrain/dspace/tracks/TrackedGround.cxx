#include <dspace/tracks/TrackedGround.h>

#include <dspace/tracks/GroundTracks.h>

namespace dspace {

const WheelTracks& TrackedGround::Tracks() const {
  return *this->RequireTracks().Tracks();
}

void TrackedGround::AddTracks(const std::vector<TrackAddition>& additions) {
  this->TracksChanged(this->RequireTracks().Add(additions));
}

std::optional<Eigen::Vector3d> TrackedGround::TracksAnchor() const {
  return this->RequireTracks().Anchor();
}

void TrackedGround::RestoreTracks(const std::vector<TrackStroke>& strokes, bool continues,
                                  const std::optional<Eigen::Vector3d>& anchor) {
  this->TracksChanged(this->RequireTracks().Restore(strokes, continues, anchor));
}

void TrackedGround::ClearTracks() {
  this->TracksChanged(this->RequireTracks().Clear());
}

void TrackedGround::SaveTracks(const std::string& path) const {
  this->RequireTracks().Save(path);
}

void TrackedGround::LoadTracks(const std::string& path, std::size_t most) {
  this->AddTracks(this->RequireTracks().Read(path, most));
}

} // namespace dspace
