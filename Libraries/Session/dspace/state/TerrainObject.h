// Terrain in a scene: a surface for queries, and its drawing.
#ifndef DSPACE_SESSION_TERRAIN_OBJECT_H
#define DSPACE_SESSION_TERRAIN_OBJECT_H

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <dspace/proto/terrain.pb.h>
#include <dspace/raster/RasterPlace.h>
#include <dspace/scene/GraphicsObject.h>
#include <dspace/state/TerrainFields.h>
#include <dspace/surface/TerrainSurface.h>
#include <dspace/tracks/TrackedGround.h>

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
  // The same, for work that may outlive this.
  virtual std::shared_ptr<const TerrainSurface> HeldSurface() const = 0;
  // Whether S is the body-fixed frame. Points then need three coordinates.
  virtual bool OnBody() const { return false; }
  // The surface without wheel tracks.
  virtual const TerrainSurface& Undisturbed() const { return this->Surface(); }
  // Its wheel tracks. A change of them needs FollowTracks().
  virtual TrackedGround& Ground() = 0;
  // Brings its drawing up to date with its wheel tracks. Returns whether Draw() draws otherwise.
  virtual bool FollowTracks() { return false; }
  // Where its raster lies.
  virtual RasterPlace Place() const = 0;
  TerrainFields& Fields() { return this->Fields_; }
  const TerrainFields& Fields() const { return this->Fields_; }
  // Adds its drawing to `object`.
  virtual void Draw(GraphicsObject& object) const = 0;
  // The ground as triangles, in S, at most `triangleBudget` of them where the terrain allows it
  // (TerrainMeshOptions). Reads the data that it needs and waits for them. Throws Error.
  virtual std::vector<Part> Triangles(std::size_t triangleBudget) const = 0;
  // Fills in all fields except name, object and frame.
  virtual void Describe(v1::TerrainReply& reply) const;
  // Draws every post within `radius` metres of the points (in S). Returns whether the drawing
  // changed. Throws Error(InvalidArgument) and changes nothing.
  virtual bool Focus(const std::vector<Eigen::Vector2d>& points_S, double radius) = 0;
  // Removes what is set for one viewport.
  virtual void ForgetViewport(const std::string& /*viewport*/) {}
  // Whether the colours of its ramp, or of a layer, are drawn in the viewport; `shown` says whether
  // a membership is.
  virtual bool Explains(const std::string& /*viewport*/, const std::string& /*layer*/,
                        const std::function<bool(const Membership&)>& /*shown*/) const {
    return false;
  }
  // Cancels background work and removes partial results.
  virtual void EndBackgroundWork() {}

protected:
  explicit TerrainObject(const std::string& name) : Name_(name), Fields_(name) {}

private:
  std::string Name_;
  ObjectId Object_ = 0;
  TerrainFields Fields_;
};

} // namespace dspace::session

#endif
