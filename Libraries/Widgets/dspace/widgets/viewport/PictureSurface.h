// Shows the texture of a viewport's picture without a copy through memory.
#ifndef DSPACE_WIDGETS_PICTURE_SURFACE_H
#define DSPACE_WIDGETS_PICTURE_SURFACE_H

#include <QOpenGLWidget>

#include "vtkSmartPointer.h"

class vtkDspaceViewport;

namespace dspace::widgets {

// Fills a ViewportWidget. Drawing happens in the render context; this one's own context, which
// shares textures with it, copies the picture when it is there.
class PictureSurface : public QOpenGLWidget {
  Q_OBJECT

public:
  // Whether the viewport's render context is one of MakeQtContext().
  static bool Shares(vtkDspaceViewport& viewport);
  // Whether the processor draws. Textures of widgets then cost more than a copy in memory: Qt
  // composes the window of them and reads that back.
  static bool IsSoftware(vtkDspaceViewport& viewport);

  PictureSurface(vtkDspaceViewport* viewport, QWidget* parent);
  ~PictureSurface() override;

  // Another one of the same render context.
  void SetViewport(vtkDspaceViewport* viewport);

signals:
  void drawn(bool anew); // false: the picture was up to date
  void failed(const QString& message);

protected:
  void paintGL() override;

private:
  void Forget();

  vtkSmartPointer<vtkDspaceViewport> Viewport_;
  unsigned int Framebuffer_ = 0; // framebuffers are not shared
};

} // namespace dspace::widgets

#endif
