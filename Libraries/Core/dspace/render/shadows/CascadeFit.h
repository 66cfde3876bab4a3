// Fits the shadow maps of the Sun to what a camera sees.
#ifndef DSPACE_RENDER_SHADOWS_CASCADE_FIT_H
#define DSPACE_RENDER_SHADOWS_CASCADE_FIT_H

#include <vector>

#include <Eigen/Core>

#include <dspace/scene/Projection.h>
#include <dspace/scene/ViewLook.h>

namespace dspace {

// The Sun as a camera sees it. Light axes: U and V across its rays, S towards the Sun.
struct SunPlace {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity(); // rows U, V, S; from view axes (OpenGL's)
  // The camera along U and V, from the origin of the light's frame [m]: the texels of the maps hold
  // still there while the camera moves.
  Eigen::Vector2d camera = Eigen::Vector2d::Zero();
  double radius = 0.0; // of its disc [rad]
};

// U and V of a light whose unit direction is S, as the rows of a matrix: a rotation that depends
// only on S, continuous but where S is along -Z.
Eigen::Matrix3d LightAxes(const Eigen::Vector3d& toSun);

// Cascaded shadow maps (Dimitrov 2007): map k serves the view down to a depth, and covers a sphere
// around that part of the view, so that its size does not change as the camera turns. Each sphere
// contains the part of the map before it. Centres are whole texels of the map.
struct CascadeFit {
  struct Cascade {
    double end = 0.0;       // [m] along the view's axis
    double radius = 0.0;    // [m] of the square that the map covers, to its sides
    Eigen::Vector2d center; // along U and V, from the camera [m]
    double low = 0.0;       // along S, from the camera [m]: what the map's depths 0 and 1 are
    double high = 0.0;

    double Texel(int size) const { return 2.0 * this->radius / size; } // [m]
  };
  SunPlace sun;
  int size = 0; // texels a side
  // There are more maps, coarser, of what takes the shadows that it throws on itself from elsewhere
  // (CustomDrawer::ShadowsItself), for all else: one a cascade for each ShadowGround.
  bool ground = false;
  int GroundSize() const { return this->size / GroundsAcross; }
  static constexpr int GroundsAcross = 4; // ground maps side by side in one of the others
  std::vector<Cascade> cascades;

  // How far above a place [m] blockers are whose penumbra fills a map's filter: farther ones are
  // the next map's (Shadow.glsl).
  double Reach(const Cascade& cascade) const;
  // From where above a place on [m] map k takes blockers: less than the reach of the map before it,
  // for where blockers beside each other are on either side of that, neither map alone is dark.
  double Beginning(std::size_t k) const;
  // Clip from view coordinates of a map, reversed depth: 1 towards the Sun.
  Eigen::Matrix4d ClipFromView(const Cascade& cascade) const;
};

// `nearest`, `farthest` [m]: depths along the view's axis that something is drawn at. For
// orthographic views each map has all between the two, each is four times as wide as the one
// before, for the penumbrae that that one does not resolve, and ShadowLook::distance has no
// meaning. For others the depths at which the maps end grow by a constant factor. A
// ShadowLook::distance of 0 reaches to `farthest`, or 2048 times `nearest` if that is less.
// `nearest` is rounded to a power of the square root of 2, so that the maps keep their sizes while
// a camera moves a little. Maps begin at the camera, those of a long lens (`nearest` is more than
// half of `farthest`) just before `nearest`: a rover seen from 3 km has the texels that it has from
// 30 m in a picture of the same size.
CascadeFit FitCascades(const Projection& projection, int width, int height, const SunPlace& sun,
                       double nearest, double farthest, const ShadowLook& look);

} // namespace dspace

#endif
