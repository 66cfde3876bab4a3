// Places the posts of a lattice in the scene: on a plane, or on a body.
#ifndef DSPACE_TERRAIN_POSTPLACEMENT_H
#define DSPACE_TERRAIN_POSTPLACEMENT_H

#include <vector>

#include <Eigen/Geometry>

#include <dspace/crs/BodyEllipsoid.h>

namespace dspace {

// Post coordinates (c, r) count level-0 posts; height is metres above the vertical datum.
class PostPlacement {
public:
  enum class Kind {
    Plane,  // scene: X east, Y north, Z up; z = height - originHeight
    Sphere, // scene: the body-fixed frame, Z to the north pole, X to longitude 0; a degree grid on
            // a sphere or, by geodetic latitude, on an ellipsoid
    Pole    // the same scene; a rectangle in the stereographic plane of a pole
  };

  // `postToScene` takes (c, r) to scene (x, y) [m]; invertible.
  static PostPlacement OnPlane(const Eigen::Affine2d& postToScene, double originHeight = 0.0);
  // Longitude (east) and latitude of post (0, 0), and their steps a column and a row [deg];
  // `radius` [m] is where height is 0; places are given as columns within half a turn of
  // `middleColumn`.
  static PostPlacement OnSphere(const Eigen::Vector2d& first_deg, const Eigen::Vector2d& step_deg,
                                double radius, double middleColumn = 0.0);
  static PostPlacement OnEllipsoid(const Eigen::Vector2d& first_deg,
                                   const Eigen::Vector2d& step_deg, const BodyEllipsoid& body,
                                   double middleColumn = 0.0);

  // Stereographic (Snyder 1987, p. 154; scale 1 at the pole), posts `spacing` [m] apart, post
  // (half, half) at the pole. Columns run along longitude 0 from the pole, rows against the axis
  // that completes it seen from outside: longitude 90 at the north pole, -90 at the south pole.
  // On an ellipsoid the directions of its normals are projected, with `spacing` on a sphere of its
  // equatorial radius.
  static PostPlacement OnPole(bool south, double spacing, double half, double radius);
  static PostPlacement OnPole(bool south, double spacing, double half, const BodyEllipsoid& body);
  // Of a raster in that plane, turned: `planeStep` is the post spacing over twice the radius,
  // `pole` the column and row of the pole (which may lie outside the lattice), and columns run
  // along longitude `east_deg` from it.
  static PostPlacement AtPole(bool south, double planeStep, const Eigen::Vector2d& pole,
                              double east_deg, const BodyEllipsoid& body);

  Kind GetKind() const { return this->Kind_; }
  // Plane: its map; its origin's height.
  const Eigen::Affine2d& PostToScene() const { return this->PostToScene_; }
  const Eigen::Affine2d& SceneToPost() const { return this->SceneToPost_; } // its inverse
  double OriginHeight() const { return this->OriginHeight_; }
  // Sphere [rad].
  const Eigen::Vector2d& First() const { return this->First_; }
  const Eigen::Vector2d& Step() const { return this->Step_; }
  double Radius() const { return this->Radius_; } // of an ellipsoid at the equator
  const BodyEllipsoid& Body() const { return this->Body_; }
  bool OnBody() const { return this->Kind_ != Kind::Plane; }
  // Pole: which; post spacing at the pole over twice the radius; its column and row; the longitude
  // that columns run along from it [rad].
  bool South() const { return this->South_; }
  double PlaneStep() const { return this->PlaneStep_; }
  const Eigen::Vector2d& Pole() const { return this->Pole_; }
  double East() const { return this->East_; }
  // The chart's axes are X along the columns from the pole, Y against the rows, Z out of the pole.
  // Its stereographic plane is X and Y, in twice the radius: the place of a post, and back.
  Eigen::Vector2d OnPlaneOfPole(const Eigen::Vector2d& post) const {
    return this->PlaneStep_ *
           Eigen::Vector2d(post.x() - this->Pole_.x(), this->Pole_.y() - post.y());
  }
  Eigen::Vector2d PostOnPlane(const Eigen::Vector2d& u) const {
    return {this->Pole_.x() + u.x() / this->PlaneStep_, this->Pole_.y() - u.y() / this->PlaneStep_};
  }
  // Of a direction in the chart's axes, of any length but 0. The other pole is infinitely far: a
  // place far outside stands for it.
  Eigen::Vector2d PostTowards(const Eigen::Vector3d& direction_P) const;
  // Vectors between the chart's axes and the scene's.
  Eigen::Vector3d FromChart(const Eigen::Vector3d& v_P) const;
  Eigen::Vector3d ToChart(const Eigen::Vector3d& v_S) const;
  // Longitude and latitude [rad] of a post of a body, and back; around a degree grid as `angles`
  // counts turns.
  Eigen::Vector2d Angles(const Eigen::Vector2d& post) const;
  Eigen::Vector2d PostAt(const Eigen::Vector2d& angles) const;

  Eigen::Vector3d ToScene(const Eigen::Vector2d& post, double height) const;
  // (c, r, height) of a point. On a sphere c is within half a turn of the middle column; any at the
  // poles, and (0, 0, -radius) at the centre.
  Eigen::Vector3d ToPosts(const Eigen::Vector3d& p_S) const;
  // The local vertical, unit; Z at the body's centre.
  Eigen::Vector3d Up(const Eigen::Vector3d& p_S) const;
  // North, unit: Y on a plane; on a body towards its north pole, any direction at the poles.
  Eigen::Vector3d North(const Eigen::Vector3d& p_S) const;
  // The bounds of posts (0, 0) to `last` at heights from `low` to `high` [m] in the scene; not for
  // a pole of an ellipsoid.
  Eigen::AlignedBox3d BoundsOf(const Eigen::Vector2d& last, double low, double high) const;
  // The greater of a cell's two sides there [m], at height 0.
  double CellSize(const Eigen::Vector2d& post) const;

private:
  std::vector<Eigen::Vector2d> ExtremesOf(const Eigen::Vector2d& last) const;

  Kind Kind_ = Kind::Plane;
  Eigen::Affine2d PostToScene_ = Eigen::Affine2d::Identity();
  Eigen::Affine2d SceneToPost_ = Eigen::Affine2d::Identity();
  double OriginHeight_ = 0.0;
  Eigen::Vector2d First_ = Eigen::Vector2d::Zero(); // [rad]
  Eigen::Vector2d Step_ = Eigen::Vector2d::Ones();
  double Radius_ = 0.0;
  BodyEllipsoid Body_;
  double MiddleColumn_ = 0.0;
  bool South_ = false;
  double PlaneStep_ = 0.0;
  Eigen::Vector2d Pole_ = Eigen::Vector2d::Zero();
  double East_ = 0.0;                               // [rad]
  Eigen::Vector2d Turn_ = Eigen::Vector2d::UnitX(); // cosine and sine of it
};

} // namespace dspace

#endif
