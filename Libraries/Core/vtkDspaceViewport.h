/**
 * @class vtkDspaceViewport
 * @brief Draws a SceneVantage in a slot of the render context's one window.
 *
 * Any number of viewports may show one scene; its meshes are on the GPU once. Sizes are pixels,
 * pixel (0, 0) is the centre of the top-left pixel, row 0 the top row. An unchanged viewport is
 * not drawn again; a hidden one costs nothing. Errors of OpenGL and VTK while drawing become
 * dspace::Error.
 */
#ifndef vtkDspaceViewport_h
#define vtkDspaceViewport_h

#include <memory>
#include <string>

#include "vtkDspaceCoreModule.h"
#include "vtkObject.h"

#ifndef __VTK_WRAP__
#include <cstdint>
#include <functional>
#include <vector>

#include <dspace/overlay/ColorBar.h>
#include <dspace/overlay/Overlay.h>
#include <dspace/render/Capture.h>
#include <dspace/render/DrawList.h>
#include <dspace/render/ViewExplanation.h>
#include <dspace/scene/Scene.h>
#include <dspace/scene/controls/Navigation.h>
#endif

#ifndef __VTK_WRAP__
namespace dspace {
struct ViewLens;
}
#endif

class vtkDspaceRenderContext;
class vtkRenderer;
class vtkRenderWindow;

class VTKDSPACECORE_EXPORT vtkDspaceViewport : public vtkObject {
public:
  static vtkDspaceViewport* New();
  vtkTypeMacro(vtkDspaceViewport, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  int GetWidth();
  int GetHeight();
  bool GetVisible();

  /// The renderer of the scene, for VTK code of the user: its world coordinates are the root
  /// frame's, in single precision on the GPU. Use it inside Run() only.
  vtkRenderer* GetRenderer();
  /// The overlay renderer (standard depth, drawn after the scene): 2D actors belong here.
  vtkRenderer* GetOverlayRenderer();
  /// Marks the picture as outdated. Needed after changes made with VTK directly.
  void Invalidate();

#ifndef __VTK_WRAP__
  /// Connects the viewport. Call it once, before anything else. Size 1 to 16384 a side; size
  /// times samples as far as OpenGL draws (GL_MAX_TEXTURE_SIZE a side) and up to 2^28 in all.
  /// Throws Error(InvalidArgument) naming the viewport and the size.
  void Initialize(vtkDspaceRenderContext* context, std::shared_ptr<dspace::Scene> scene,
                  const std::string& name, const std::string& vantage, int width, int height,
                  int samples = 2);
  const std::string& GetName() const;
  std::shared_ptr<dspace::Scene> GetScene() const;
  const std::string& GetVantage() const;

  /// Each function checks its arguments before it changes anything, and marks the picture as
  /// outdated if it differs.
  void SetVantage(const std::string& vantage);
  void SetCamera(const std::string& camera); // of the vantage; "" follows its active camera
  const std::string& GetCamera() const;
  /// Looks from a pose with a projection of the caller's in place of the vantage's camera.
  void SetFixedView(const dspace::CameraPose& camera, const dspace::Projection& projection);
  /// Makes the lens for a size in pixels; may throw Error.
  using LensMaker = std::function<std::shared_ptr<const dspace::ViewLens>(int, int)>;
  /// Shows the camera's view through a lens, in place of the camera's projection; made again for
  /// each size. Empty: none. Pictures then have no captions, no props of GetRenderer(), and a
  /// background of one colour. Throws what the maker throws, and Error(InvalidArgument) where a
  /// source view is larger than OpenGL draws.
  void SetLens(LensMaker maker);
  bool HasLens() const;
  void Resize(int width, int height);
  void SetVisible(bool visible);
  /// sRGB, 0 to 1; with `top`, a vertical gradient.
  void SetBackground(const std::array<double, 3>& bottom, const std::array<double, 3>& top);
  /// Supersampling: n × n samples a pixel, 1 to 8 (default 2): each sample is shaded.
  void SetSamples(int samples);
  void RequireSamples(int samples) const; // throws as SetSamples() would
  int GetSamples() const;
  void SetOrnamentsVisible(bool visible);
  /// Shadows, fill light, exposure. Throws Error(InvalidArgument) naming the viewport and the
  /// value.
  void SetLook(const dspace::ViewLook& look);
  const dspace::ViewLook& GetLook() const;
  /// How a person moves its camera; the picture does not depend on it. Throws
  /// Error(InvalidArgument) naming the viewport and the value.
  void SetNavigation(const dspace::Navigation& navigation);
  const dspace::Navigation& GetNavigation() const;
  /// The factor on linear light of the last picture, as automatic exposure chose it.
  double GetUsedExposure() const;
  void SetFragmentVisible(const std::string& fragment, bool visible); // in this viewport only
  void SetTextTable(const dspace::TextTable& table); // creates or replaces, by name
  void RemoveTextTable(const std::string& name);
  void SetColorBar(const dspace::ColorBar& bar); // creates or replaces, by name
  void RemoveColorBar(const std::string& name);
  void SetCornerAxes(bool visible);

  /// Called before a picture is drawn or found up to date: may set overlays; must not throw. Empty:
  /// none.
  void SetBeforeDrawing(std::function<void()> prepare);

  /// Says whether a colour bar that explains something of a terrain is shown in a picture with a
  /// filter (DrawList::Filter). Must not throw. Empty: such bars are hidden.
  void SetBarShown(std::function<bool(const dspace::ColorBar&, const dspace::DrawFilter&)> shown);

  /// Draws if something changed; returns whether it did. Nothing is done while hidden.
  bool Render();
  /// The last picture: RGBA, rows from the top down, alpha 255. Draws the first one.
  std::vector<std::uint8_t> GetPicture();
  /// The same as an OpenGL texture of the render context, for widgets whose contexts share textures
  /// with it: rows from the bottom up, display values, alpha undefined. 0: nothing was drawn yet.
  /// Its name may be another after each Resize().
  unsigned int GetTexture() const;
  /// Makes the render context current in this thread.
  void MakeContextCurrent();
  /// Draws even if nothing changed (benchmarks).
  void ForceRender();
  /// Throws Error(Internal) with the message of a pipeline of a prop that fails.
  bool IsOutdated();

  /// The picture, and other planes, of the scene as it is now (rendered if need be). Through a lens
  /// colour alone; throws Error(Unsupported) for other planes.
  dspace::Capture GetCapture(const dspace::CaptureRequest& request);
  /// Says of each object whether and why it is not seen in the viewport's picture. Throws
  /// Error(Unsupported) for a picture through a lens.
  std::vector<dspace::ObjectVisibility> Explain();
  /// Picks the object at a pixel, or the nearest one within `radius` pixels if there is none;
  /// through a lens at what the pixel's own ray meets first.
  dspace::PickResult Pick(double x, double y, int radius = 0);
  /// Makes this viewport the window's current one and calls `f` with it.
  void Run(const std::function<void(vtkRenderWindow*)>& f);
#endif

protected:
  vtkDspaceViewport();
  ~vtkDspaceViewport() override;

private:
  vtkDspaceViewport(const vtkDspaceViewport&) = delete;
  void operator=(const vtkDspaceViewport&) = delete;
  friend class vtkDspaceRenderContext;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
