// The line of a trajectory, whose look follows the scene's time.
#ifndef DSPACE_SCENE_TRAJECTORY_LINE_H
#define DSPACE_SCENE_TRAJECTORY_LINE_H

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <dspace/scene/CustomGeometry.h>
#include <dspace/scene/GraphicsObject.h>

namespace dspace {

// How a trajectory is drawn. Times are [s], relative to the scene's.
struct TrajectoryLook {
  std::array<double, 3> color = {1.0, 1.0, 1.0};           // sRGB; multiplies the colours of points
  double opacity = 1.0;                                    // 0 to 1
  double before = std::numeric_limits<double>::infinity(); // what is older is not drawn; 0 and more
  double after = std::numeric_limits<double>::infinity();  // what is later is not drawn; 0 and more
  double ahead = 1.0; // factor on the opacity of what is later than the scene's time, 0 to 1
  // The opacity falls to 0 at the ends of the window; where that is infinite, at the line's ends.
  bool fade = false;
  double tickSize = 5.0;  // [pixels], 0: no marks, up to 64
  bool tickLabels = true; // those that have room
  int fontSize = 12;      // of the labels [pixels], 6 to 64
};

// Points in the object's frame O, in double precision. They are drawn relative to the camera: to a
// millimetre of its own surroundings, from anywhere within an astronomical unit.
//
// Between its points the line is straight. About the scene's time it follows `path` instead, ever
// finer towards that time, so that it runs through the craft however near the camera is.
class TrajectoryLine : public CustomGeometry {
public:
  using Color = std::array<std::uint8_t, 4>; // sRGB and opacity
  // A part without gaps. Times ascend.
  struct Strip {
    std::vector<double> times;           // [s]
    std::vector<Eigen::Vector3d> points; // p_O [m], as many
    std::vector<Color> colors;           // as many; empty: white
  };
  struct Tick {
    double time = 0.0;
    Eigen::Vector3d point = Eigen::Vector3d::Zero(); // p_O [m]
    std::string label;                               // empty: none
  };
  // Where the trajectory is at a time within a strip. Called by SetTime().
  using Path = std::function<Eigen::Vector3d(double time_s)>;

  // Throws Error(InvalidArgument) naming `object` and the value: no strip, strips of fewer than two
  // points, times that do not ascend, points beyond 1e18 m.
  TrajectoryLine(const std::string& object, std::vector<Strip> strips, std::vector<Tick> ticks = {},
                 Path path = {});

  // Replaces the points: of an orbit that changes. Throws as the constructor; then nothing changes.
  void SetStrips(const std::string& object, std::vector<Strip> strips);
  // Increases with every change of the points.
  std::uint64_t PointsRevision() const { return this->PointsRevision_; }
  // Throws Error(InvalidArgument) naming `object` and the value; then nothing changes.
  void SetLook(const std::string& object, const TrajectoryLook& look);
  // The scene's time. The picture changes only where the look follows it.
  void SetTime(double time_s);

  const std::vector<Strip>& Strips() const { return this->Strips_; }
  const std::vector<Tick>& Ticks() const { return this->Ticks_; } // as given, ascending
  const TrajectoryLook& Look() const { return this->Look_; }
  double Time() const { return this->Time_; }
  // What stands in place of points first to last of a strip: its own ends are these points.
  struct Detail {
    std::size_t strip = 0;
    std::size_t first = 0;
    std::size_t last = 0;
    Strip points; // empty: none
  };
  const Detail& GetDetail() const { return this->Detail_; }
  // Whether some of it lets through what is behind it.
  bool IsTranslucent() const;
  // Whether the picture depends on the scene's time.
  bool FollowsTime() const;
  // When opacity is 0 before and after the scene's time [s]: those of the look, or of the line.
  std::array<double, 2> FadeLengths() const;

  BoundingSphere Bounds() const override { return this->Bounds_; }
  std::uint64_t Revision() const override { return this->Revision_; }

private:
  static void Check(const std::string& object, const std::vector<Strip>& strips);
  void FindBounds(); // and what its colours are
  void FindDetail();

  std::vector<Strip> Strips_;
  std::vector<Tick> Ticks_;
  Path Path_;
  TrajectoryLook Look_;
  double Time_ = 0.0;
  Detail Detail_;
  bool TranslucentColors_ = false;
  BoundingSphere Bounds_;
  std::uint64_t Revision_ = 1;
  std::uint64_t PointsRevision_ = 1;
};

} // namespace dspace

#endif
