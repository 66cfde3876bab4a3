// Kernels of a scene, and what moves with its time because of them.
#ifndef DSPACE_SESSION_SKY_MOTIONS_H
#define DSPACE_SESSION_SKY_MOTIONS_H

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <dspace/FrameTree.h>
#include <dspace/proto/sky.pb.h>
#include <dspace/sky/CelestialMotion.h>

namespace dspace::session {

// Frames and the Sun that follow bodies, spacecraft and sites. Messages are kept as given and
// interpreted when something is computed, so that a recording plays without its kernels.
struct SkyMotions {
  std::shared_ptr<const KernelSet> kernels = Standard();
  std::map<FrameId, v1::SetFrameMotion> frames;
  std::optional<v1::SetSunMotion> sun;
  // Warnings of data of lower accuracy that were given already (FallbackScope).
  std::set<std::string> fallbacks;

  // The set without kernels, made once.
  static std::shared_ptr<const KernelSet> Standard();

  bool Any() const { return !this->frames.empty() || this->sun; }
  // Throws Error(InvalidArgument) for a frame that follows the time.
  void RequireFree(const FrameTree& tree, FrameId frame, const char* what) const;

  // A message's place; unknown bodies throw Error(NotFound).
  CelestialPlace PlaceOf(const v1::CelestialPlace& place) const;
  // What a frame stands for. Throws Error(InvalidArgument) where it follows nothing.
  CelestialPlace PlaceOf(const FrameTree& tree, FrameId frame) const;
  // What the parent of a frame in motion stands for.
  CelestialPlace ParentOf(const FrameTree& tree, const v1::SetFrameMotion& motion) const;
  Pose PoseAt(const FrameTree& tree, const v1::SetFrameMotion& motion, double tdb) const;
  v1::SunState SunAt(const FrameTree& tree, const v1::SetSunMotion& motion, double tdb) const;
  // All of them at a time. Throws what computing one throws, naming its frame.
  v1::SkyStep At(const FrameTree& tree, double tdb) const;

  // What the innermost FallbackScope of this thread has and `fallbacks` lacks; adds it to them.
  std::vector<std::string> NewFallbacks();

  // Forgets frames that are no more.
  void EraseRemoved(const FrameTree& tree);
};

} // namespace dspace::session

#endif
