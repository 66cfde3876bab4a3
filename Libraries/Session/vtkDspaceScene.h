/**
 * @class vtkDspaceScene
 * @brief A scene for VTK code: its frames as vtkTransforms, its objects as vtkActors.
 *
 * A frame is mirrored with its ancestors on first access, and then follows every change of the
 * tree.
 */
#ifndef vtkDspaceScene_h
#define vtkDspaceScene_h

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
class vtkDspaceActors;
class vtkDspaceFrame;

class VTKDSPACESESSION_EXPORT vtkDspaceScene : public vtkObject {
public:
  static vtkDspaceScene* New();
  vtkTypeMacro(vtkDspaceScene, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  std::string GetName();
  /// Null if the frame is not in the tree.
  vtkDspaceFrame* GetFrame(unsigned long long id);
  vtkDspaceFrame* GetFrame(const std::string& path);

  /// Actors of the visible objects and terrains of a fragment (empty: of all), which follow the
  /// frames at once. Later calls return the same collection, brought up to date. Terrains are
  /// meshes of at most 200,000 triangles.
  vtkActorCollection* GetActors(const std::string& fragment);
  /// New actors, which the caller owns; see vtkDspaceActors. `triangleBudget`: of each terrain.
  VTK_NEWINSTANCE vtkDspaceActors* MakeActors(const std::string& fragment, int triangleBudget);

#ifndef __VTK_WRAP__
  /// The ground of an object that is a terrain, as triangles in its axes; empty for others.
  using Ground =
      std::function<std::vector<dspace::Part>(const dspace::GraphicsObject&, std::size_t budget)>;
  /// Call once, before anything else.
  void SetScene(std::shared_ptr<dspace::Scene> scene, Ground ground = {});
  bool Mirrors(const dspace::Scene& scene) const;
#endif

protected:
  vtkDspaceScene();
  ~vtkDspaceScene() override;

private:
  vtkDspaceScene(const vtkDspaceScene&) = delete;
  void operator=(const vtkDspaceScene&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
