#include <dspace/widgets/viewport/ViewportWidget.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <stdexcept>
#include <utility>

#include <QImage>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QNativeGestureEvent>
#include <QPainter>
#include <QTimer>
#include <QWheelEvent>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"
#include "vtkSmartPointer.h"
#include "vtkWeakPointer.h"

#include <dspace/scene/Scene.h>
#include <dspace/scene/controls/OrbitController.h>
#include <dspace/widgets/viewport/PictureSurface.h>
#include <dspace/widgets/viewport/QtContext.h>

namespace dspace::widgets {
namespace {

constexpr int Tick_ms = 16;
constexpr int Settle_ms = 300; // after the last movement of the camera

// Names of keys that have no character of their own, as ViewportEvent has them.
std::string KeyName(const QKeyEvent& event) {
  switch (event.key()) {
  case Qt::Key_Left:
    return "Left";
  case Qt::Key_Right:
    return "Right";
  case Qt::Key_Up:
    return "Up";
  case Qt::Key_Down:
    return "Down";
  case Qt::Key_Space:
    return "space";
  case Qt::Key_Escape:
    return "Escape";
  case Qt::Key_Return:
  case Qt::Key_Enter:
    return "Return";
  case Qt::Key_Tab:
    return "Tab";
  case Qt::Key_Backspace:
    return "BackSpace";
  case Qt::Key_Delete:
    return "Delete";
  case Qt::Key_Home:
    return "Home";
  case Qt::Key_End:
    return "End";
  case Qt::Key_PageUp:
    return "Prior";
  case Qt::Key_PageDown:
    return "Next";
  default:
    break;
  }
  if (event.key() >= Qt::Key_F1 && event.key() <= Qt::Key_F35) {
    return "F" + std::to_string(event.key() - Qt::Key_F1 + 1);
  }
  const QString text = event.text();
  return !text.isEmpty() && text.at(0).isPrint() ? text.toStdString() : std::string();
}

ViewportInput::Button ButtonOf(Qt::MouseButton button) {
  return button == Qt::LeftButton     ? ViewportInput::Button::Left
         : button == Qt::MiddleButton ? ViewportInput::Button::Middle
         : button == Qt::RightButton  ? ViewportInput::Button::Right
                                      : ViewportInput::Button::None;
}

InputEvent::Key CameraKey(const std::string& key) {
  return key == "Left"     ? InputEvent::Key::Left
         : key == "Right"  ? InputEvent::Key::Right
         : key == "Up"     ? InputEvent::Key::Up
         : key == "Down"   ? InputEvent::Key::Down
         : key == "+"      ? InputEvent::Key::Plus
         : key == "-"      ? InputEvent::Key::Minus
         : key == "r"      ? InputEvent::Key::Reset
         : key == "Escape" ? InputEvent::Key::Cancel
                           : InputEvent::Key::None;
}

// Moves the active camera of a viewport's vantage.
void MoveCamera(OrbitController& controller, vtkDspaceViewport& viewport,
                const ViewportInput& input) {
  InputEvent event;
  switch (input.type) {
  case ViewportInput::Type::Press:
    event.type = InputEvent::Type::Press;
    break;
  case ViewportInput::Type::Release:
    event.type = InputEvent::Type::Release;
    break;
  case ViewportInput::Type::Wheel:
    event.type = InputEvent::Type::Wheel;
    break;
  case ViewportInput::Type::Key:
    event.type = InputEvent::Type::Key;
    break;
  case ViewportInput::Type::DoubleClick:
    event.type = InputEvent::Type::DoubleClick;
    break;
  case ViewportInput::Type::Move:
    event.type = InputEvent::Type::Move;
    break;
  }
  event.x = input.x;
  event.y = input.y;
  event.button = static_cast<InputEvent::Button>(static_cast<int>(input.button));
  event.shift = input.shift;
  event.control = input.control;
  event.alt = input.alt;
  event.wheelSteps = input.wheel;
  event.key = CameraKey(input.key);
  Scene& scene = *viewport.GetScene();
  const std::string& vantage = viewport.GetVantage();
  const std::string& camera = viewport.GetCamera();
  OrbitView view;
  view.camera = camera.empty() ? scene.Vantage(vantage).ActiveCamera()
                               : scene.Vantage(vantage).GetCamera(camera);
  view.pose = scene.PlaceCamera(vantage, camera);
  view.width = viewport.GetWidth();
  view.height = viewport.GetHeight();
  if (OrbitController::NeedsPivot(event)) {
    const PickResult pick = viewport.Pick(event.x, event.y);
    if (pick.object != 0) {
      view.pivot_F = view.pose.X_FC.Apply(pick.p_camera);
    }
  }
  const OrbitResult result = controller.Handle(event, view);
  if (result.changed) {
    scene.SetCamera(vantage, result.camera);
  }
}

// One for all widgets that make their viewports.
vtkSmartPointer<vtkDspaceRenderContext> SharedContext() {
  static vtkWeakPointer<vtkDspaceRenderContext> shared;
  vtkSmartPointer<vtkDspaceRenderContext> context = shared.Get();
  if (!context) {
    context = vtkSmartPointer<vtkDspaceRenderContext>::New();
    context->Initialize(MakeQtContext());
    shared = context;
  }
  return context;
}

vtkSmartPointer<vtkDspaceViewport> ViewportOf(std::shared_ptr<Scene> scene,
                                              const std::string& camera) {
  constexpr int Width = 640, Height = 400; // until it is shown
  const char* const vantage = "main";
  scene->Vantage(vantage).GetCamera(camera); // throws
  const auto viewport = vtkSmartPointer<vtkDspaceViewport>::New();
  viewport->Initialize(SharedContext(), std::move(scene), camera, vantage, Width, Height);
  viewport->SetCamera(camera);
  return viewport;
}

} // namespace

struct ViewportWidget::Internals {
  explicit Internals(ViewportWidget* owner) : widget(owner) {}

  ViewportWidget* widget;
  vtkSmartPointer<vtkDspaceViewport> viewport;
  Handler handler;
  Resizer resizer;
  Source source;
  OrbitController controller;
  PictureSurface* surface = nullptr; // null: the widget paints itself
  QTimer ticks;
  QTimer settle;
  int movingSamples = 1;
  std::optional<int> ownSamples; // while the camera moves
  QImage picture;                // where textures are not shared
  bool resizeLater = false;      // the viewport was not there
  bool drawLater = false;        // with the next paint
  QString failure;               // of the last drawing; empty: none
  int pictures = 0;

  // Runs `f`; what it throws is shown and told.
  bool Try(const std::function<void()>& f) {
    try {
      f();
      if (!this->failure.isEmpty()) {
        this->failure.clear();
        this->widget->update();
      }
      return true;
    } catch (const std::exception& error) {
      const QString message = QString::fromUtf8(error.what());
      if (message != this->failure) {
        this->failure = message;
        this->widget->update();
        emit this->widget->failed(message);
      }
      return false;
    }
  }

  QSize Pixels() const {
    const double ratio = this->widget->devicePixelRatioF();
    return {std::max(1, int(std::lround(this->widget->width() * ratio))),
            std::max(1, int(std::lround(this->widget->height() * ratio)))};
  }

  void Resize() {
    const QSize size = this->Pixels();
    if (size.width() == this->viewport->GetWidth() &&
        size.height() == this->viewport->GetHeight()) {
      return;
    }
    this->Try([&] {
      if (this->resizer) {
        this->resizer(size.width(), size.height());
      } else {
        this->viewport->Resize(size.width(), size.height());
      }
    });
  }

  // With the next paint: a window that is made or resized settles its sizes first.
  void DrawSettled() {
    if (this->surface) {
      this->surface->update();
    } else {
      this->drawLater = true;
      this->widget->update();
    }
  }

  void Draw() {
    this->drawLater = false;
    if (this->surface) {
      this->surface->update();
      return;
    }
    this->Try([this] {
      if (this->viewport->Render() || this->picture.isNull()) {
        const std::vector<std::uint8_t> bytes = this->viewport->GetPicture();
        const int width = this->viewport->GetWidth();
        const int height = this->viewport->GetHeight();
        this->picture =
            QImage(bytes.data(), width, height, 4 * width, QImage::Format_RGBX8888)
                .convertToFormat(QImage::Format_RGB32); // a copy, as the screen wants it
        this->picture.setDevicePixelRatio(this->widget->devicePixelRatioF());
        ++this->pictures;
        emit this->widget->shown();
      }
    });
    this->widget->update();
  }

  // Whether there is a viewport to draw.
  bool Find() {
    if (!this->source) {
      return true;
    }
    vtkDspaceViewport* const now = this->source();
    if (now && now != this->viewport) {
      this->viewport = now;
      this->ownSamples.reset();
      this->settle.stop();
      if (this->surface) {
        this->surface->SetViewport(now);
      }
      if (this->widget->isVisible()) {
        this->Resize();
        this->Draw();
      }
    }
    return now != nullptr;
  }

  void Look() {
    if (!this->widget->isVisible() || !this->Find()) {
      return;
    }
    if (std::exchange(this->resizeLater, false)) {
      this->Resize();
    }
    bool outdated = false;
    this->Try([&] { outdated = this->viewport->IsOutdated(); });
    if (outdated) {
      this->Draw();
    }
  }

  void Moving() {
    const int own = this->ownSamples.value_or(this->viewport->GetSamples());
    if (this->movingSamples >= own) {
      return;
    }
    this->ownSamples = own;
    this->viewport->SetSamples(this->movingSamples);
    this->settle.start(Settle_ms);
  }
  void Settled() {
    if (this->ownSamples) {
      const int own = *this->ownSamples;
      this->ownSamples.reset();
      this->Try([&] { this->viewport->SetSamples(own); });
    }
  }

  void Send(const ViewportInput& input) {
    if (!this->Find()) {
      return;
    }
    this->Try([&] {
      if (this->handler) {
        this->handler(input);
      } else {
        MoveCamera(this->controller, *this->viewport, input);
      }
      if (this->viewport->IsOutdated()) {
        this->Moving();
      }
    });
    this->Look();
  }

  // With the place in the viewport's pixels, and the modifiers.
  ViewportInput InputAt(ViewportInput::Type type, const QPointF& place,
                        Qt::KeyboardModifiers modifiers) const {
    ViewportInput input;
    input.type = type;
    const double ratio = this->widget->devicePixelRatioF();
    input.x = place.x() * ratio - 0.5;
    input.y = place.y() * ratio - 0.5;
    input.shift = modifiers.testFlag(Qt::ShiftModifier);
    input.control = modifiers.testFlag(Qt::ControlModifier);
    input.alt = modifiers.testFlag(Qt::AltModifier);
    return input;
  }
};

ViewportWidget::ViewportWidget(vtkDspaceViewport* viewport, QWidget* parent, PicturePath path)
    : QWidget(parent), Impl_(std::make_unique<Internals>(this)) {
  Internals& self = *this->Impl_;
  self.viewport = viewport;
  this->setFocusPolicy(Qt::StrongFocus);
  this->setMouseTracking(true);
  this->setAttribute(Qt::WA_OpaquePaintEvent);
  this->setMinimumSize(16, 16);
  if (path != PicturePath::Memory && PictureSurface::Shares(*viewport) &&
      (path == PicturePath::Texture || !PictureSurface::IsSoftware(*viewport))) {
    self.surface = new PictureSurface(viewport, this);
    self.surface->resize(this->size());
    connect(self.surface, &PictureSurface::drawn, this, [this](bool anew) {
      Internals& impl = *this->Impl_;
      if (anew) {
        ++impl.pictures;
        emit this->shown();
      }
    });
    connect(self.surface, &PictureSurface::failed, this, [this](const QString& message) {
      this->Impl_->Try([&] { throw std::runtime_error(message.toStdString()); });
    });
  }
  self.settle.setSingleShot(true);
  connect(&self.settle, &QTimer::timeout, this, [this] { this->Impl_->Settled(); });
  connect(&self.ticks, &QTimer::timeout, this, [this] { this->Impl_->Look(); });
}

ViewportWidget::ViewportWidget(std::shared_ptr<Scene> scene, const std::string& camera,
                               QWidget* parent)
    : ViewportWidget(ViewportOf(std::move(scene), camera), parent) {}

ViewportWidget::~ViewportWidget() {
  this->Impl_->Settled();
}

void ViewportWidget::SetHandler(Handler handler) {
  this->Impl_->handler = std::move(handler);
}
void ViewportWidget::SetResizer(Resizer resizer) {
  this->Impl_->resizer = std::move(resizer);
}
void ViewportWidget::SetSource(Source source) {
  this->Impl_->source = std::move(source);
}
vtkDspaceViewport* ViewportWidget::GetViewport() const {
  return this->Impl_->viewport;
}
void ViewportWidget::SetMovingSamples(int samples) {
  this->Impl_->movingSamples = std::clamp(samples, 1, 8);
}
int ViewportWidget::OwnSamples() const {
  return this->Impl_->ownSamples.value_or(this->Impl_->viewport->GetSamples());
}
void ViewportWidget::Refresh() {
  this->Impl_->Look();
}
bool ViewportWidget::SharesTextures() const {
  return this->Impl_->surface != nullptr;
}
bool ViewportWidget::IsUpToDate() const {
  const Internals& self = *this->Impl_;
  return self.pictures > 0 && !self.resizeLater &&
         (!self.source || self.source() == self.viewport) && !self.viewport->IsOutdated();
}
int ViewportWidget::ShownPictures() const {
  return this->Impl_->pictures;
}
QSize ViewportWidget::sizeHint() const {
  const double ratio = this->devicePixelRatioF();
  return {int(std::lround(this->Impl_->viewport->GetWidth() / ratio)),
          int(std::lround(this->Impl_->viewport->GetHeight() / ratio))};
}

void ViewportWidget::paintEvent(QPaintEvent*) {
  Internals& self = *this->Impl_;
  if (self.drawLater && self.Find()) {
    self.Draw();
  }
  QPainter painter(this);
  if (!self.failure.isEmpty()) {
    painter.fillRect(this->rect(), Qt::black);
    painter.setPen(Qt::white);
    painter.drawText(this->rect().adjusted(12, 12, -12, -12), Qt::AlignCenter | Qt::TextWordWrap,
                     self.failure);
  } else if (self.picture.isNull()) {
    painter.fillRect(this->rect(), Qt::black);
  } else {
    painter.drawImage(0, 0, self.picture);
  }
}

void ViewportWidget::resizeEvent(QResizeEvent*) {
  if (this->Impl_->surface) {
    this->Impl_->surface->resize(this->size());
  }
  if (this->Impl_->Find()) {
    this->Impl_->Resize();
    this->Impl_->DrawSettled();
  } else {
    this->Impl_->resizeLater = true;
  }
}

void ViewportWidget::showEvent(QShowEvent*) {
  if (this->Impl_->Find()) {
    this->Impl_->Resize();
    this->Impl_->DrawSettled();
  } else {
    this->Impl_->resizeLater = true;
  }
  this->Impl_->ticks.start(Tick_ms);
}

void ViewportWidget::hideEvent(QHideEvent*) {
  this->Impl_->ticks.stop();
}

void ViewportWidget::mousePressEvent(QMouseEvent* event) {
  ViewportInput input =
      this->Impl_->InputAt(ViewportInput::Type::Press, event->position(), event->modifiers());
  input.button = ButtonOf(event->button());
  this->Impl_->Send(input);
}

void ViewportWidget::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) { // a second click of others
    this->mousePressEvent(event);
    return;
  }
  ViewportInput input =
      this->Impl_->InputAt(ViewportInput::Type::DoubleClick, event->position(), event->modifiers());
  input.button = ButtonOf(event->button());
  this->Impl_->Send(input);
}

void ViewportWidget::mouseReleaseEvent(QMouseEvent* event) {
  ViewportInput input =
      this->Impl_->InputAt(ViewportInput::Type::Release, event->position(), event->modifiers());
  input.button = ButtonOf(event->button());
  this->Impl_->Send(input);
}

void ViewportWidget::mouseMoveEvent(QMouseEvent* event) {
  if (event->buttons() != Qt::NoButton) { // what only hovers changes nothing
    this->Impl_->Send(
        this->Impl_->InputAt(ViewportInput::Type::Move, event->position(), event->modifiers()));
  }
}

void ViewportWidget::wheelEvent(QWheelEvent* event) {
  ViewportInput input =
      this->Impl_->InputAt(ViewportInput::Type::Wheel, event->position(), event->modifiers());
  constexpr double Notch_px = 60.0; // that the fingers move on a touchpad without angles
  input.wheel = !event->angleDelta().isNull()
                    ? event->angleDelta().y() / 120.0 // a notch is 15 degrees, in eighths
                    : event->pixelDelta().y() / Notch_px;
  if (input.wheel != 0.0) {
    this->Impl_->Send(input);
  }
  event->accept();
}

void ViewportWidget::keyPressEvent(QKeyEvent* event) {
  const std::string key = KeyName(*event);
  if (key.empty()) {
    QWidget::keyPressEvent(event);
    return;
  }
  QPointF pointer = this->mapFromGlobal(QPointF(QCursor::pos()));
  if (!QRectF(this->rect()).contains(pointer)) {
    pointer = QRectF(this->rect()).center();
  }
  ViewportInput input = this->Impl_->InputAt(ViewportInput::Type::Key, pointer, event->modifiers());
  input.key = key;
  this->Impl_->Send(input);
}

bool ViewportWidget::event(QEvent* event) {
  if (event->type() == QEvent::NativeGesture) {
    const auto* gesture = static_cast<QNativeGestureEvent*>(event);
    if (gesture->gestureType() == Qt::ZoomNativeGesture) { // a pinch on a touchpad
      ViewportInput input = this->Impl_->InputAt(ViewportInput::Type::Wheel, gesture->position(),
                                                 gesture->modifiers());
      // By as much nearer as the fingers go apart.
      input.wheel = std::log(std::clamp(1.0 + gesture->value(), 0.1, 10.0)) /
                    std::log(OrbitController::StepFactor);
      this->Impl_->Send(input);
      event->accept();
      return true;
    }
  }
  if (event->type() == QEvent::ScreenChangeInternal) {
    this->Impl_->Resize();
  }
  return QWidget::event(event);
}

} // namespace dspace::widgets
