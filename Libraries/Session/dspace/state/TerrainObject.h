// Terrain in a scene: a surface that answers, and what of it is drawn.
#ifndef DSPACE_SESSION_TERRAIN_OBJECT_H
#define DSPACE_SESSION_TERRAIN_OBJECT_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/proto/terrain.pb.h>
#include <dspace/scene/GraphicsObject.h>
#include <dspace/surface/TerrainSurface.h>

namespace dspace::session {

// Abstract. Its frame S is the frame that its object hangs on.
class TerrainObject {
public:
  virtual ~TerrainObject() = default;
  TerrainObject(const TerrainObject&) = delete;
  TerrainObject& operator=(const TerrainObject&) = delete;

  const std::string& Name() const { return this->Name_; }
  ObjectId Object() const { return this->Object_; }
  void SetObject(ObjectId object) { this->Object_ = object; }

  virtual const TerrainSurface& Surface() const = 0;
  // Its frame is the body-fixed one: points of it need all three coordinates.
  virtual bool OnBody() const { return false; }
  // Without wheel tracks.
  virtual const TerrainSurface& Undisturbed() const { return this->Surface(); }
  // Puts what draws it into `object`.
  virtual void Draw(GraphicsObject& object) const = 0;
  // All but name, object and frame.
  virtual void Describe(v1::TerrainReply& reply) const;
  // Every post is drawn within `radius` metres of the points (in S). Returns whether the drawing
  // changed. Throws Error(InvalidArgument) and changes nothing.
  virtual bool Focus(const std::vector<Eigen::Vector2d>& points_S, double radius) = 0;
  // Gives up what is done in the background; nothing half-made stays.
  virtual void EndBackgroundWork() {}

protected:
  explicit TerrainObject(std::string name) : Name_(std::move(name)) {}

private:
  std::string Name_;
  ObjectId Object_ = 0;
};

} // namespace dspace::session

#endif
