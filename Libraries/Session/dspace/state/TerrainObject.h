// Terrain in a scene: a surface for queries, and its drawing.
#ifndef DSPACE_SESSION_TERRAIN_OBJECT_H
#define DSPACE_SESSION_TERRAIN_OBJECT_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/proto/terrain.pb.h>
#include <dspace/scene/GraphicsObject.h>
#include <dspace/surface/TerrainSurface.h>

namespace dspace::session {

// Abstract. Its frame S is the frame that its object is attached to.
class TerrainObject {
public:
  virtual ~TerrainObject() = default;
  TerrainObject(const TerrainObject&) = delete;
  TerrainObject& operator=(const TerrainObject&) = delete;

  const std::string& Name() const { return this->Name_; }
  ObjectId Object() const { return this->Object_; }
  void SetObject(ObjectId object) { this->Object_ = object; }

  virtual const TerrainSurface& Surface() const = 0;
  // Whether S is the body-fixed frame. Points then need three coordinates.
  virtual bool OnBody() const { return false; }
  // The surface without wheel tracks.
  virtual const TerrainSurface& Undisturbed() const { return this->Surface(); }
  // Adds its drawing to `object`.
  virtual void Draw(GraphicsObject& object) const = 0;
  // Fills in all fields except name, object and frame.
  virtual void Describe(v1::TerrainReply& reply) const;
  // Draws every post within `radius` metres of the points (in S). Returns whether the drawing
  // changed. Throws Error(InvalidArgument) and changes nothing.
  virtual bool Focus(const std::vector<Eigen::Vector2d>& points_S, double radius) = 0;
  // Cancels background work and removes partial results.
  virtual void EndBackgroundWork() {}

protected:
  explicit TerrainObject(std::string name) : Name_(std::move(name)) {}

private:
  std::string Name_;
  ObjectId Object_ = 0;
};

} // namespace dspace::session

#endif
