// Wheel tracks on posts: what is read with them, and their files.
#ifndef DSPACE_TERRAIN_GROUNDTRACKS_H
#define DSPACE_TERRAIN_GROUNDTRACKS_H

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <dspace/crs/SceneFrame.h>
#include <dspace/tracks/TrackPosts.h>
#include <dspace/tracks/WheelTracks.h>

namespace dspace {

// Functions that change tracks return where; a pyramid over Posts() must invalidate RectanglesOf()
// it.
class GroundTracks {
public:
  // `name` is for messages; `bare` are the posts without tracks, `postToScene` takes those of level
  // 0 to the scene, and files have the map of `frame`, in `crs`. Throws what WheelTracks throws.
  GroundTracks(const std::string& name, std::shared_ptr<const PostSource> bare,
               const Eigen::Affine2d& postToScene, const SceneFrame& frame, const Crs& crs,
               const WheelTracksOptions& options);

  // On a body: `placement` is that of posts of level 0, whose numbers `mapToPost` gives.
  GroundTracks(const std::string& name, std::shared_ptr<const PostSource> bare,
               const PostPlacement& placement, const Eigen::Affine2d& mapToPost, const Crs& crs,
               const WheelTracksOptions& options);

  // The tracks on other posts of the same ground. Body only.
  std::shared_ptr<const TrackPosts> PostsOn(std::shared_ptr<const PostSource> bare,
                                            const PostPlacement& placement) const;

  const std::shared_ptr<const PostSource>& Bare() const { return this->Bare_; }
  const std::shared_ptr<const TrackPosts>& Posts() const { return this->Posts_; }
  std::shared_ptr<const WheelTracks> Tracks() const { return this->Tracks_; }
  bool Empty() const { return this->Tracks_->Empty(); }

  // On a body, places of additions are longitude and latitude [deg], and headings are from east.
  // The first contact is the anchor of the chart that strokes are kept in. Throw what WheelTracks
  // throws, and Error(InvalidArgument) for contacts out of the chart's reach.
  std::vector<TrackReach> Add(const std::vector<TrackAddition>& additions);
  std::vector<TrackReach> Restore(const std::vector<TrackStroke>& strokes, bool continues,
                                  const std::optional<Eigen::Vector3d>& anchor = std::nullopt);
  // What changes on posts with these tracks.
  static std::vector<PostRectangle> RectanglesOf(const TrackPosts& posts,
                                                 const std::vector<TrackReach>& changed);
  // Of the chart that strokes are in; none on a plane and without tracks.
  std::optional<Eigen::Vector3d> Anchor() const;
  std::vector<TrackReach> Clear();
  // In `crs`; see TrackFile.h.
  void Save(const std::string& path) const;
  // Reads a file as additions. Throws Error(Resource) for more contacts than `most`.
  std::vector<TrackAddition> Read(const std::string& path, std::size_t most) const;

private:
  Eigen::Vector2d ToAngles(const Eigen::Vector2d& map) const; // [deg]
  Eigen::Vector2d ToMap(const Eigen::Vector2d& angles) const;

  std::string Name_;
  std::optional<SceneFrame> Frame_; // on a plane
  PostPlacement Placement_;         // on a body, as the next
  Eigen::Affine2d MapToPost_ = Eigen::Affine2d::Identity();
  Crs Crs_;
  std::shared_ptr<const PostSource> Bare_;
  std::shared_ptr<WheelTracks> Tracks_;
  std::shared_ptr<const TrackPosts> Posts_;
};

} // namespace dspace

#endif
