#include <dspace/state/SkyMotions.h>

#include <iterator>

#include <dspace/Checks.h>
#include <dspace/ephemeris/Fallbacks.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

std::string FrameLabel(const FrameTree& tree, FrameId frame) {
  return "frame '" + tree.Path(frame) + "'";
}

} // namespace

std::shared_ptr<const KernelSet> SkyMotions::Standard() {
  static const std::shared_ptr<const KernelSet> set = std::make_shared<const KernelSet>();
  return set;
}

void SkyMotions::RequireFree(const FrameTree& tree, FrameId frame, const char* what) const {
  if (this->frames.count(frame)) {
    Reject(FrameLabel(tree, frame), std::string("it follows the scene's time and cannot be ") +
                                        what +
                                        "; accepted: other frames, or first set_frame_motion "
                                        "without a place");
  }
}

CelestialPlace SkyMotions::PlaceOf(const v1::CelestialPlace& from) const {
  CelestialPlace place;
  const BodyNames& names = this->kernels->GetEphemeris().Names();
  if (from.body().empty()) {
    Reject("place", "it names no body; accepted: a body's name or NAIF id");
  }
  place.body = names.IdOf(from.body());
  const FrameTable& table = this->kernels->GetFrames().Table();
  if (from.has_site()) {
    place.axes = from.axes().empty() ? table.BodyFixed(place.body).name : from.axes();
    place.site =
        Site{from.site().longitude_deg(), from.site().latitude_deg(), from.site().height(),
             from.site().geodetic() ? LatitudeKind::Geodetic : LatitudeKind::Planetocentric};
  } else {
    place.axes = from.axes().empty() ? "J2000" : from.axes();
  }
  place.axes = table.Get(place.axes).name;
  return place;
}

CelestialPlace SkyMotions::PlaceOf(const FrameTree& tree, FrameId frame) const {
  const auto found = this->frames.find(frame);
  if (found != this->frames.end()) {
    return this->PlaceOf(found->second.place());
  }
  for (const auto& [id, motion] : this->frames) { // what its children say that it stands for
    if (motion.has_parent() && tree.Parent(id) == frame) {
      return this->PlaceOf(motion.parent());
    }
  }
  Reject(FrameLabel(tree, frame), "it follows no body, and no frame in motion on it says what it "
                                  "stands for; accepted: a frame that set_frame_motion moves, or "
                                  "the parent of one");
}

CelestialPlace SkyMotions::ParentOf(const FrameTree& tree, const v1::SetFrameMotion& motion) const {
  return motion.has_parent() ? this->PlaceOf(motion.parent())
                             : this->PlaceOf(tree, tree.Parent(motion.frame()));
}

Pose SkyMotions::PoseAt(const FrameTree& tree, const v1::SetFrameMotion& motion, double tdb) const {
  const Correction correction =
      CorrectionOf(motion.correction().empty() ? "NONE" : motion.correction());
  return PoseOf(*this->kernels, this->PlaceOf(motion.place()), this->ParentOf(tree, motion),
                correction, tdb);
}

v1::SunState SkyMotions::SunAt(const FrameTree& tree, const v1::SetSunMotion& motion,
                               double tdb) const {
  const FrameId frame = ToFrame(motion.frame());
  const dspace::SunAt sun = SunAtPlace(
      *this->kernels,
      motion.has_place() ? this->PlaceOf(motion.place()) : this->PlaceOf(tree, frame), tdb);
  v1::SunState state;
  Put(sun.direction, state.mutable_direction());
  state.set_frame(frame);
  state.set_radius_deg(sun.radius_deg);
  state.set_distance_au(sun.distance / AstronomicalUnit);
  return state;
}

v1::SkyStep SkyMotions::At(const FrameTree& tree, double tdb) const {
  v1::SkyStep step;
  step.set_time_s(tdb);
  for (const auto& [frame, motion] : this->frames) {
    Pose X;
    try {
      X = this->PoseAt(tree, motion, tdb);
    } catch (const Error& error) {
      throw Error(error.GetKind(), FrameLabel(tree, frame),
                  std::string("it follows the scene's time: ") + error.what());
    }
    step.add_frame(frame);
    for (const double value : {X.position.x(), X.position.y(), X.position.z(), X.rotation.w(),
                               X.rotation.x(), X.rotation.y(), X.rotation.z(), X.scale}) {
      step.add_pose(value);
    }
  }
  if (this->sun) {
    *step.mutable_sun() = this->SunAt(tree, *this->sun, tdb);
  }
  return step;
}

std::vector<std::string> SkyMotions::NewFallbacks() {
  std::vector<std::string> added;
  for (std::string& text : FallbackScope::Noted()) {
    if (this->fallbacks.insert(text).second) {
      added.push_back(std::move(text));
    }
  }
  return added;
}

void SkyMotions::EraseRemoved(const FrameTree& tree) {
  for (auto it = this->frames.begin(); it != this->frames.end();) {
    it = tree.Contains(it->first) ? std::next(it) : this->frames.erase(it);
  }
  if (this->sun && !tree.Contains(ToFrame(this->sun->frame()))) {
    this->sun.reset();
  }
}

} // namespace dspace::session
