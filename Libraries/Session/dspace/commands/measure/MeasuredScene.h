// The obstacles of a scene for a measurement, and its places.
#ifndef DSPACE_SESSION_MEASURED_SCENE_H
#define DSPACE_SESSION_MEASURED_SCENE_H

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <google/protobuf/repeated_field.h>

#include <dspace/commands/measure/RayTrees.h>
#include <dspace/interpreter/Registry.h>
#include <dspace/measure/HorizonScan.h>
#include <dspace/measure/Obstacles.h>
#include <dspace/proto/sights.pb.h>
#include <dspace/state/Works.h>

namespace dspace::session {

// Of the scene at its present time. The scene must not change while this exists; a Measurement may
// outlive both.
class MeasuredScene {
public:
  // A place with the words that name it in errors.
  struct Spot {
    Eigen::Vector3d p_R = Eigen::Vector3d::Zero(); // in the root [m]
    std::string label;
    FrameId frame = RootFrame;              // of a place
    const TerrainObject* terrain = nullptr; // of a site
  };

  // Physical objects and terrains that the scene shows, without the `without` and hidden ones.
  // Physical objects without triangles are named in warnings of the reply. Throws
  // Error(NotFound) for an unknown fragment or object. `trees`: those of meshes, if they are kept.
  MeasuredScene(const Context& context, const v1::Measuring& measuring,
                const google::protobuf::RepeatedField<std::uint32_t>& without,
                const std::string& command, RayTrees* trees = nullptr);

  // Triangles of an object that the scene shows, at their finest level.
  struct ShownPart {
    std::string name;
    std::shared_ptr<const Mesh> mesh;
    Eigen::Affine3d X_RM = Eigen::Affine3d::Identity();
    double albedo = 0.0; // mean of its material's linear red, green and blue
  };
  // `any`, if given: whether it has triangles, shown or not.
  static std::vector<ShownPart> PartsOf(const Context& context, const GraphicsObject& object,
                                        bool* any = nullptr);

  // What is computed against obstacles, which end it by an exception in one of their checks, and
  // where that is written. Holds nothing of the scene or of this.
  using Measurement =
      std::function<void(const Obstacles&, v1::Reply& reply, const Works::Proceed& proceed)>;
  // Measures in this thread, or with `wait_s` in one of its own (Works).
  void Measure(Measurement measure) const;

  bool IsObstacle(ObjectId object) const { return this->Ids_.count(object) != 0; } // a terrain too
  const Obstacles& Get() const { return this->Obstacles_; }
  // Throws Error: NotFound for an unknown frame or terrain, InvalidArgument for a position or a
  // height out of range and for a site off the terrain's data. `what` begins the label: "start 3".
  Spot At(const v1::Place& place, const std::string& what) const;
  Spot At(const v1::Site& site, const std::string& what) const;
  // A site: of its terrain. A place: of the first terrain by name that is an obstacle and has data
  // below it; without one, the axes of its frame.
  LevelAxes AxesAt(const Spot& spot) const;
  // The azimuth of AxesAt's north, clockwise from the meridian's north [deg]: 0 on a body; on a
  // plane that of the map's Y axis. Without terrain below, and without longitudes and latitudes,
  // nothing.
  std::optional<double> NorthAt(const Spot& spot) const;

private:
  // The terrain whose north a place has, and its pose; null: none.
  std::pair<const TerrainSurface*, Pose> GroundOf(const Spot& spot) const;
  void AddObject(const Context& context, const GraphicsObject& object, RayTrees* trees);

  const Context& Context_;
  Deadline Deadline_;
  std::optional<double> Wait_; // [s]
  Obstacles Obstacles_;
  std::set<ObjectId> Ids_; // of the obstacles
};

// The methods that a measurement asks for. Throws Error(InvalidArgument) for an unknown one.
struct Methods {
  bool exact = true;
  bool image = false;
};
Methods MethodsOf(const v1::Measuring& measuring, const std::string& command);

} // namespace dspace::session

#endif
