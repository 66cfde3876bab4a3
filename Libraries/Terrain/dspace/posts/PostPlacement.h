// Places the posts of a lattice in the scene: on a plane, or on a body.
#ifndef DSPACE_TERRAIN_POSTPLACEMENT_H
#define DSPACE_TERRAIN_POSTPLACEMENT_H

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
    Pole    // the same scene; a square in the stereographic plane of a pole
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
  // Pole: which; post spacing at the pole over twice the radius; its column and row.
  bool South() const { return this->South_; }
  double PlaneStep() const { return this->PlaneStep_; }
  double Half() const { return this->Half_; }
  // The stereographic plane's place of a post, in twice the radius.
  Eigen::Vector2d OnPlaneOfPole(const Eigen::Vector2d& post) const {
    return this->PlaneStep_ * Eigen::Vector2d(post.x() - this->Half_, this->Half_ - post.y());
  }
  // Longitude and latitude [rad] of a post of a body.
  Eigen::Vector2d Angles(const Eigen::Vector2d& post) const;

  Eigen::Vector3d ToScene(const Eigen::Vector2d& post, double height) const;
  // (c, r, height) of a point. On a sphere c is within half a turn of the middle column; any at the
  // poles, and (0, 0, -radius) at the centre.
  Eigen::Vector3d ToPosts(const Eigen::Vector3d& p_S) const;
  // The local vertical, unit; Z at the body's centre.
  Eigen::Vector3d Up(const Eigen::Vector3d& p_S) const;
  // North, unit: Y on a plane; on a body towards its north pole, any direction at the poles.
  Eigen::Vector3d North(const Eigen::Vector3d& p_S) const;
  // The bounds of posts (0, 0) to `last` at heights from `low` to `high` [m] in the scene; of a
  // plane or a sphere.
  Eigen::AlignedBox3d BoundsOf(const Eigen::Vector2d& last, double low, double high) const;
  // The greater of a cell's two sides there [m], at height 0.
  double CellSize(const Eigen::Vector2d& post) const;

private:
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
  double Half_ = 0.0;
};

} // namespace dspace

#endif
