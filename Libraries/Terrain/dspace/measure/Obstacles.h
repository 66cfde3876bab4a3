// What may stand between two places: grounds of terrain, and triangles.
#ifndef DSPACE_MEASURE_OBSTACLES_H
#define DSPACE_MEASURE_OBSTACLES_H

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/Pose.h>
#include <dspace/measure/MeshRays.h>
#include <dspace/surface/TerrainSurface.h>

namespace dspace {

// Coordinates are those of the scene's root (R) [m].
class Obstacles {
public:
  struct Ground {
    std::string name; // of the terrain
    std::shared_ptr<const TerrainSurface> surface;
    Pose X_RS;            // of the terrain's frame
    std::uint32_t id = 0; // of its object
  };
  struct Solid {
    std::uint32_t id = 0;
    std::shared_ptr<const MeshRays> rays;
    Eigen::Affine3d X_RM = Eigen::Affine3d::Identity();
    Eigen::Affine3d X_MR = Eigen::Affine3d::Identity();
    double albedo = 1.0; // of a Lambertian surface, for range sensors
  };
  struct Hit {
    bool hit = false;
    std::string terrain;                                       // empty: an object
    std::uint32_t object = 0;                                  // 0: a terrain
    double distance = std::numeric_limits<double>::infinity(); // [m] from the start
    Eigen::Vector3d point = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  };

  // A place is lifted to this height [m] above ground that it stands on; what a line meets within
  // this distance of its ends is no obstacle.
  static constexpr double Touch = 1e-6;

  void Add(Ground ground) { this->Grounds_.push_back(std::move(ground)); }
  void Add(std::uint32_t object, std::shared_ptr<const MeshRays> rays, const Eigen::Affine3d& X_RM,
           double albedo = 1.0);
  // Called before every ray; what it throws ends the measurement.
  void SetCheck(std::function<void()> check) { this->Check_ = std::move(check); }
  void Check() const {
    if (this->Check_) {
      this->Check_();
    }
  }

  const std::vector<Ground>& Grounds() const { return this->Grounds_; }
  const std::vector<Solid>& Solids() const { return this->Solids_; }

  // The place in the ground's frame, lifted if it stands on the ground. Throws
  // Error(InvalidArgument) for a place below the ground; `label` names it.
  Eigen::Vector3d Stand(const Ground& ground, const Eigen::Vector3d& p_R,
                        const std::string& label) const;
  // Height [root metres] of a point in the ground's frame above it along the local vertical; NaN
  // where there is no data.
  static double HeightOver(const Ground& ground, const Eigen::Vector3d& p_S);

  // The first obstacle of the line. `labels` as for Stand(). Throws what it throws.
  Hit First(const Eigen::Vector3d& from_R, const Eigen::Vector3d& to_R,
            const std::string& fromLabel, const std::string& toLabel) const;

  // Where rays start, as each ground takes it.
  struct Start {
    Eigen::Vector3d p_R = Eigen::Vector3d::Zero();
    std::vector<Eigen::Vector3d> p_S; // by ground
  };
  // Throws what Stand() throws.
  Start StartAt(const Eigen::Vector3d& p_R, const std::string& label) const;
  // The first obstacle of a ray.
  struct Met {
    const Ground* ground = nullptr;                            // null: a solid, or nothing
    const Solid* solid = nullptr;                              // null: ground, or nothing
    double distance = std::numeric_limits<double>::infinity(); // [m]; infinity: nothing
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();          // in the root, unit, of either side
  };
  // Up to a distance `most`, which may be infinite. `direction_R`: unit.
  Met Meet(const Start& start, const Eigen::Vector3d& direction_R, double most) const;

private:
  std::vector<Ground> Grounds_;
  std::vector<Solid> Solids_;
  std::function<void()> Check_;
};

} // namespace dspace

#endif
