// Wheel tracks on the posts of a plane: what is read with them, and their files.
#ifndef DSPACE_TERRAIN_GROUNDTRACKS_H
#define DSPACE_TERRAIN_GROUNDTRACKS_H

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <dspace/crs/SceneFrame.h>
#include <dspace/tracks/TrackPosts.h>
#include <dspace/tracks/WheelTracks.h>

namespace dspace {

// Functions that change tracks return the changed rectangles, which a pyramid over Posts() must
// invalidate.
class GroundTracks {
public:
  // `name` is for messages; `bare` are the posts without tracks, `postToScene` takes those of level
  // 0 to the scene, and files have the map of `frame`, in `crs`. Throws what WheelTracks throws.
  GroundTracks(const std::string& name, std::shared_ptr<const PostSource> bare,
               const Eigen::Affine2d& postToScene, const SceneFrame& frame, const Crs& crs,
               const WheelTracksOptions& options);

  const std::shared_ptr<const PostSource>& Bare() const { return this->Bare_; }
  const std::shared_ptr<const TrackPosts>& Posts() const { return this->Posts_; }
  std::shared_ptr<const WheelTracks> Tracks() const { return this->Tracks_; }
  bool Empty() const { return this->Tracks_->Empty(); }

  // Throw what WheelTracks throws.
  std::vector<PostRectangle> Add(const std::vector<TrackAddition>& additions);
  std::vector<PostRectangle> Restore(const std::vector<TrackStroke>& strokes, bool continues);
  std::vector<PostRectangle> Clear();
  // In `crs`; see TrackFile.h.
  void Save(const std::string& path) const;
  // Reads a file as additions. Throws Error(Resource) for more contacts than `most`.
  std::vector<TrackAddition> Read(const std::string& path, std::size_t most) const;

private:
  SceneFrame Frame_;
  Crs Crs_;
  std::shared_ptr<const PostSource> Bare_;
  std::shared_ptr<WheelTracks> Tracks_;
  std::shared_ptr<const TrackPosts> Posts_;
};

} // namespace dspace

#endif
