/**
 * @class vtkDspaceActors
 * @brief A scene's visible objects and terrains as vtkActors that follow it.
 *
 * vtkDspaceScene creates it. Frames move the actors at once, through their live transforms.
 * Everything else (objects, materials, visibility) follows with Update(), which the renderer of
 * SetRenderer() calls each time it draws. Terrains become meshes once, when they are first seen.
 *
 * Unlit colours are those of Dspace's pictures. Lit ones follow VTK's own shading, which computes
 * with display values. Shader code, labels and objects that draw themselves have no actor.
 */
#ifndef vtkDspaceActors_h
#define vtkDspaceActors_h

#include <memory>
#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkObject.h"

#ifndef __VTK_WRAP__
#include <functional>
#include <vector>

#include <dspace/scene/Scene.h>
#endif

class vtkActorCollection;
class vtkDspaceScene;
class vtkRenderer;

class VTKDSPACESESSION_EXPORT vtkDspaceActors : public vtkObject {
public:
  static vtkDspaceActors* New();
  vtkTypeMacro(vtkDspaceActors, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// As of the last Update().
  vtkActorCollection* GetActors();
  /// Names of visible objects without an actor, one per line.
  std::string GetLeftOut();
  /// Why the last Update() failed; empty if it did not. The actors are then as before it.
  std::string GetFailure();

  /// Adds the actors to a renderer and keeps them up to date there; null: removes them. The
  /// renderer keeps this object.
  void SetRenderer(vtkRenderer* renderer);
  /// A camera that the renderer's camera follows, with exactly its projection. Default: none.
  void SetCamera(const std::string& vantage, const std::string& camera);
  /// Whether the scene's lights stand in place of the renderer's. Release() brings those back.
  /// Default: true. Set it before the renderer.
  void SetLights(bool lights);

  void Update();
  /// Ends everything: the actors leave the renderer and the collection.
  void Release();

#ifndef __VTK_WRAP__
  /// The parts of an object that draws itself, in its axes; empty: it is left out.
  using Terrains = std::function<std::vector<dspace::Part>(const dspace::GraphicsObject&)>;
  /// Call once, before anything else. An empty fragment: all.
  void SetSource(vtkDspaceScene* frames, std::shared_ptr<dspace::Scene> scene,
                 const std::string& fragment, Terrains terrains);
#endif

protected:
  vtkDspaceActors();
  ~vtkDspaceActors() override;

private:
  vtkDspaceActors(const vtkDspaceActors&) = delete;
  void operator=(const vtkDspaceActors&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
