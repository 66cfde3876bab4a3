// A trajectory of a scene: its states, its line, and the frame that moves along it.
#ifndef DSPACE_SESSION_TRAJECTORY_OBJECT_H
#define DSPACE_SESSION_TRAJECTORY_OBJECT_H

#include <memory>
#include <string>

#include <dspace/FrameTree.h>
#include <dspace/scene/trajectories/TrajectoryLine.h>
#include <dspace/trajectories/Attitude.h>
#include <dspace/trajectories/MovingFrame.h>

namespace dspace::session {

// What a trajectory is of, as its source names it; empty: not stated.
struct TrajectorySource {
  TrajectoryPtr path; // in F about the centre
  std::string center;
  std::string frame; // F
  std::string objectName;
};

class TrajectoryObject {
public:
  // How the conic at the scene's time is drawn in place of the path.
  struct Osculating {
    double mu = 0.0;       // [m^3/s^2]; 0: the path is drawn
    double farthest = 0.0; // [m]; 0: ten times the distance
  };

  // `axes`: of the object's frame O in F; null: those of F. `line` is drawn; of an osculating one
  // SetTime() sets the points.
  TrajectoryObject(std::string label, TrajectorySource source, MovingFramePtr axes,
                   std::shared_ptr<TrajectoryLine> line, Osculating osculating);

  const TrajectorySource& Source() const { return this->Source_; }
  const std::shared_ptr<TrajectoryLine>& Line() const { return this->Line_; }
  bool IsOsculating() const { return this->Osculating_.mu > 0.0; }
  // As it is drawn: in O.
  const TrajectoryPtr& Shown() const { return this->Shown_; }

  // The line at the scene's time. Returns a warning; empty: none.
  std::string SetTime(double time_s);

  // The frame that moves along it; 0: none.
  FrameId Follower() const { return this->Follower_; }
  // Its pose before it moved, to which it goes back.
  const Pose& PoseBefore() const { return this->PoseBefore_; }
  // `attitude`: q_FB; null: the axes of O.
  void Follow(FrameId frame, const Pose& before, AttitudePtr attitude);
  // The pose of the moved frame in O at a time, or at the nearest one with a state: `warning` says
  // so. Throws Error(InvalidArgument) where a rule has no direction.
  Pose FollowerPose(double time_s, std::string& warning) const;

  // The points of the conic at a time, in O. Throws as ElementsOf and OrbitPoints.
  static std::vector<TrajectoryLine::Strip> ConicAt(const std::string& label,
                                                    const Trajectory& path, const MovingFrame* axes,
                                                    const Osculating& look, double time_s);

private:
  std::string Label_;
  TrajectorySource Source_;
  MovingFramePtr Axes_;
  TrajectoryPtr Shown_;
  std::shared_ptr<TrajectoryLine> Line_;
  Osculating Osculating_;
  FrameId Follower_ = NoFrame;
  Pose PoseBefore_;
  AttitudePtr Attitude_;
};

// The time of `parts` (Trajectory::Parts) that is nearest to `time_s`.
double NearestTime(const std::vector<TimeSpan>& parts, double time_s);

} // namespace dspace::session

#endif
