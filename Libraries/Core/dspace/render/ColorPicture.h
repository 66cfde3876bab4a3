// The colour picture of a viewport: its framebuffers, VTK's renderers, and how one is drawn.
#ifndef DSPACE_RENDER_COLOR_PICTURE_H
#define DSPACE_RENDER_COLOR_PICTURE_H

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <dspace/render/Captions.h>
#include <dspace/render/DrawList.h>
#include <dspace/render/ExposurePass.h>
#include <dspace/render/SceneDrawer.h>

class vtkDspaceRenderContext;
class vtkDspaceRenderer;
class vtkOpenGLRenderer;
class vtkRendererCollection;

namespace dspace {

class CornerAxes;

// Drawn supersampled, averaged into the picture that is shown, and overlays drawn on that.
class ColorPicture {
public:
  ColorPicture();
  ColorPicture(const ColorPicture&) = delete;
  ColorPicture& operator=(const ColorPicture&) = delete;
  ~ColorPicture();
  // Once, before anything below but the renderers.
  void Connect(vtkDspaceRenderContext* context);

  vtkDspaceRenderer* Renderer() const { return this->Renderer_; }
  vtkOpenGLRenderer* Overlay() const { return this->Overlay_; }

  struct Request {
    DrawView view; // its size counts samples
    int samples = 1;
    DrawFilter filter;
    SceneDrawer::Background background;
    // Draws into what is bound in place of the scene, in a picture of one sample; none: the scene
    // is drawn, with its captions.
    std::function<void()> instead = {};
    bool overlays = true;       // props of the overlay renderer
    CornerAxes* axes = nullptr; // none: not drawn
    // With the filter that the scene was drawn with (DrawList::Filter), where overlays are drawn.
    std::function<void(const DrawFilter&)> beforeOverlays = {};
    // After that: what tables and colour bars cover, where no caption is put.
    std::function<std::vector<PictureBox>()> covered = {};
  };
  // Errors, OpenGL's and VTK's among them, become dspace::Error about `object`.
  void Draw(const std::string& object, const Scene& scene, const Request& request);
  // Whether all data were there for the last picture.
  bool Complete() const { return this->Complete_; }
  // The factor on linear light of the last picture.
  double Exposure() const { return this->UsedExposure_; }
  // The window's current framebuffer and renderers, as while the scene is drawn.
  void Activate(int width, int height, int samples);

  unsigned int Texture() const;           // of what is shown; 0 before the first Draw()
  std::vector<std::uint8_t> Read() const; // RGBA, rows from the top down, alpha 255; after Draw()

private:
  void DrawNothing();
  // The scene into what is bound (DrawnTarget()), exposed.
  void DrawScene(const DrawView& view, const Request& request);
  void PrepareTargets(int width, int height, int samples);
  RenderTarget& DrawnTarget() const; // what the scene is drawn into
  void ActivateScene();
  void ActivateDisplay();

  vtkSmartPointer<vtkDspaceRenderContext> Context_;
  std::unique_ptr<RenderTarget> SceneTarget_;   // supersampled; none at one sample a pixel
  std::unique_ptr<RenderTarget> DisplayTarget_; // what is shown
  std::unique_ptr<SceneDrawer> Drawer_;
  std::unique_ptr<ExposurePass> Exposure_; // none while lights expose the picture
  DrawList List_;
  CaptionActors Captions_;
  bool Complete_ = false;
  double UsedExposure_ = 1.0;
  vtkNew<vtkDspaceRenderer> Renderer_;
  vtkNew<vtkOpenGLRenderer> Overlay_;
  vtkNew<vtkRendererCollection> SceneRenderers_;
  vtkNew<vtkRendererCollection> OverlayRenderers_;
};

} // namespace dspace

#endif
