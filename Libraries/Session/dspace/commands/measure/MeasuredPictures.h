// Measurements by pictures: what is in the way is what the graphics card draws in front.
#ifndef DSPACE_SESSION_MEASURED_PICTURES_H
#define DSPACE_SESSION_MEASURED_PICTURES_H

#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <dspace/commands/measure/MeasuredScene.h>
#include <dspace/measure/LitArea.h>
#include <dspace/state/Pictures.h>

namespace dspace::session {

// Pictures of exactly the obstacles of a MeasuredScene, and of `measured` objects: all others are
// hidden as long as this exists, and are then as they were.
class MeasuredPictures {
public:
  // Throws Error(InvalidArgument) for a resolution out of range, Error(Unsupported) where this
  // process draws no pictures.
  MeasuredPictures(const Context& context, const v1::Measuring& measuring,
                   const MeasuredScene& scene, const std::string& command,
                   const std::set<ObjectId>& measured = {});
  ~MeasuredPictures();
  MeasuredPictures(const MeasuredPictures&) = delete;
  MeasuredPictures& operator=(const MeasuredPictures&) = delete;

  double PixelAngle() const; // [deg] of lines of sight and horizons

  // A telephoto picture from one place to the other: whether the ray of its middle pixel reaches to
  // 1e-4 of the distance before the end. `reach`: how far it does [m].
  bool Clear(const Eigen::Vector3d& from_R, const Eigen::Vector3d& to_R, double* reach);
  // Four pictures of 90 degrees, towards north, east, south and west.
  struct Skyline {
    // NaN: the horizon is above the picture, more than 35 degrees high. -90: nothing.
    std::vector<double> elevation_deg;
    std::vector<double> distance; // [m] of the highest pixel that was hit; infinity: nothing
    // Where its ray meets the obstacle, in the root [m]; NaN: nothing.
    std::vector<Eigen::Vector3d> point;
    std::vector<Pose> cameras; // X_RC: X right, Y down, Z forward
  };
  Skyline Horizon(const Eigen::Vector3d& place_R, const LevelAxes& axes, std::size_t count);
  // The area [m^2] of an object that a far observer in a direction sees, and that of a pixel. The
  // picture spans the faces.
  std::pair<double, double> Seen(ObjectId object, const std::vector<Face>& faces,
                                 const Eigen::Vector3d& towards_R);

private:
  PictureSeries& Series(int size);

  const Context& Context_;
  int Resolution_;
  std::set<std::string> HiddenFragments_;
  std::vector<ObjectId> Hidden_;
  std::unique_ptr<PictureSeries> Series_;
  int Size_ = 0;
};

} // namespace dspace::session

#endif
