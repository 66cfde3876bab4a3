// A widget that shows a viewport.
#ifndef DSPACE_WIDGETS_VIEWPORT_WIDGET_H
#define DSPACE_WIDGETS_VIEWPORT_WIDGET_H

#include <functional>
#include <memory>
#include <string>

#include <QWidget>

class vtkDspaceViewport;

namespace dspace {
class Scene;
}

namespace dspace::widgets {

// One event of a widget, in the viewport's pixels: the fields of v1::ViewportEvent.
struct ViewportInput {
  enum class Type { Move, Press, Release, Wheel, Key, DoubleClick };
  enum class Button { None, Left, Middle, Right };
  Type type = Type::Move;
  double x = 0.0; // (0, 0) is the centre of the top-left pixel
  double y = 0.0;
  Button button = Button::None;
  double wheel = 0.0; // notches, positive away from the user
  std::string key;    // "a", "space", "Left", "F5", ...
  bool shift = false;
  bool control = false;
  bool alt = false;
};

// How pictures come to the screen.
enum class PicturePath {
  Fastest, // Texture where the GPU draws; Memory with a software renderer (a third less time)
  Texture, // stays on the GPU; needs a render context of MakeQtContext()
  Memory,  // is read back and painted
};

// Shows the picture of a vtkDspaceViewport and keeps its size: the widget's, times the screen's
// device pixel ratio. Any number of widgets, in any windows, show viewports of one render context;
// a viewport has one widget at a time. It looks for changes up to 60 times a second while it is
// visible, and draws only when the picture is outdated.
// With a render context of MakeQtContext() the picture stays on the GPU; with any other, and with a
// software renderer, it is copied through memory. Errors while drawing are shown in the widget, and
// told once each by failed().
class ViewportWidget : public QWidget {
  Q_OBJECT

public:
  // What takes the events. Without one the widget moves the active camera of the viewport's vantage
  // itself (OrbitController).
  using Handler = std::function<void(const ViewportInput&)>;
  // What sets the viewport's size [pixels], vtkDspaceViewport::Resize() by default.
  using Resizer = std::function<void(int width, int height)>;

  // With a render context that is not of MakeQtContext(), Texture means Memory.
  explicit ViewportWidget(vtkDspaceViewport* viewport, QWidget* parent = nullptr,
                          PicturePath path = PicturePath::Fastest);
  // Makes the viewport of a scene too: through a camera of the vantage "main" (Staging.h makes
  // one), in a render context that all such widgets share while one of them lives, with pictures on
  // the GPU where that is faster. Throws Error: NotFound without such a camera, Resource for what
  // MakeQtContext() rejects.
  ViewportWidget(std::shared_ptr<Scene> scene, const std::string& camera,
                 QWidget* parent = nullptr);
  ~ViewportWidget() override;

  void SetHandler(Handler handler);
  void SetResizer(Resizer resizer);
  // Playbacks and watchers make their viewports anew: the viewport is asked for before every look.
  // Null: it is not there at present, and the last picture stays.
  using Source = std::function<vtkDspaceViewport*()>;
  void SetSource(Source source);
  vtkDspaceViewport* GetViewport() const;

  // Supersampling while the user moves the camera, 1 to 8, at most that of the viewport; default 1.
  // 0.3 s after the last movement the viewport's own is back.
  void SetMovingSamples(int samples);
  // Those of the viewport while the camera rests.
  int OwnSamples() const;
  // Looks for changes now.
  void Refresh();
  // Whether pictures stay on the GPU.
  bool SharesTextures() const;
  // Whether the picture is that of the viewport's present state.
  bool IsUpToDate() const;
  // Pictures shown since the widget was made.
  int ShownPictures() const;
  QSize sizeHint() const override;

signals:
  void failed(const QString& message);
  void shown(); // a new picture

protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  bool event(QEvent* event) override;

private:
  struct Internals;
  std::unique_ptr<Internals> Impl_;
};

} // namespace dspace::widgets

#endif
