// Ground that keeps the tracks of wheels.
#ifndef DSPACE_TERRAIN_TRACKEDGROUND_H
#define DSPACE_TERRAIN_TRACKEDGROUND_H

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <dspace/posts/PostSource.h>
#include <dspace/tracks/WheelTracks.h>

namespace dspace {

class GroundTracks;

// Abstract. Places of contacts are x and y in the terrain's frame; on a body longitude and latitude
// [deg], and headings are counter-clockwise from east.
class TrackedGround {
public:
  virtual ~TrackedGround() = default;

  // Adds ruts of wheels, which change drawing and queries from now on. Throws what WheelTracks::Add
  // throws, and Error(Unsupported) where there can be no tracks.
  void AddTracks(const std::vector<TrackAddition>& additions);
  void ClearTracks();
  // Throws what WheelTracks::Restore throws, and Error(Unsupported).
  void RestoreTracks(const std::vector<TrackStroke>& strokes, bool continues = false,
                     const std::optional<Eigen::Vector3d>& anchor = std::nullopt);
  // On a body, the vertical that strokes which are restored need; none on a plane and without
  // tracks.
  std::optional<Eigen::Vector3d> TracksAnchor() const;
  // See TrackFile.h. Loaded tracks are added. A wheel of the same name continues its loaded track.
  void SaveTracks(const std::string& path) const;
  // Throws Error(Resource) for a file of more contacts than `most`.
  void LoadTracks(const std::string& path,
                  std::size_t most = std::numeric_limits<std::size_t>::max());
  const WheelTracks& Tracks() const; // throws Error(Unsupported)

protected:
  // Throws Error(Unsupported) where there can be no tracks.
  virtual GroundTracks& RequireTracks() const = 0;
  // The tracks have changed in these places.
  virtual void TracksChanged(const std::vector<TrackReach>& changed) = 0;
};

} // namespace dspace

#endif
