#include <dspace/widgets/window/ViewSelection.h>

#include <algorithm>
#include <exception>
#include <unordered_set>

#include <QGuiApplication>
#include <QPainter>
#include <QPointer>
#include <QTimer>
#include <QWidget>

#include "vtkDspaceViewport.h"

#include <dspace/proto/commands.pb.h>
#include <dspace/scene/Scene.h>
#include <dspace/widgets/scene/SceneTreeModel.h>
#include <dspace/widgets/scene/SceneTreeWidget.h>
#include <dspace/widgets/script/PythonText.h>
#include <dspace/widgets/viewport/ShownSession.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/ShownScenes.h>

namespace dspace::widgets {
namespace {

constexpr int Rest_ms = 120; // after the last picture
const QColor OutlineColor(0xff, 0x8c, 0x1a);

// Over a view; the mouse goes through it.
class OutlineWidget : public QWidget {
public:
  explicit OutlineWidget(QWidget* view) : QWidget(view) {
    this->setAttribute(Qt::WA_TransparentForMouseEvents);
    this->setAttribute(Qt::WA_NoSystemBackground);
    this->setFocusPolicy(Qt::NoFocus);
    this->hide();
  }
  void Show(const QImage& outline) {
    this->Outline_ = outline;
    this->setVisible(!outline.isNull());
    this->raise();
    this->update();
  }

protected:
  void paintEvent(QPaintEvent*) override {
    QPainter painter(this);
    painter.drawImage(this->rect(), this->Outline_);
  }

private:
  QImage Outline_;
};

} // namespace

struct ViewSelection::Internals {
  struct View {
    QPointer<ViewportWidget> widget;
    QPointer<OutlineWidget> outline;
    vtkObject* of;
    std::string viewport;
    std::unique_ptr<QTimer> rest;
  };
  SceneTreeWidget* tree;
  ShownScenes* scenes;
  std::vector<std::unique_ptr<View>> views;

  // The selected object, or all objects on the selected frame and below.
  std::vector<ObjectId> Selected() const {
    const SceneItem item = this->tree->Selected();
    const auto& scene = this->tree->Model()->GetScene();
    std::vector<ObjectId> ids;
    if (!scene || item.frame == NoFrame || (item.object == 0 && item.frame == RootFrame)) {
      return ids;
    }
    const FrameTree& frames = scene->Frames();
    for (const auto& [id, object] : scene->Objects()) {
      for (FrameId at = object.frame; at != NoFrame && item.object == 0; at = frames.Parent(at)) {
        if (at == item.frame) {
          ids.push_back(id);
          break;
        }
      }
      if (item.object == id) {
        ids.push_back(id);
      }
    }
    return ids;
  }

  void Draw(View& view) const {
    if (!view.widget || !view.outline) {
      return;
    }
    const std::vector<ObjectId> selected = this->Selected();
    const auto active = this->scenes->ActiveScene();
    QImage outline;
    try {
      const ShownSession session(view.of);
      if (!selected.empty() && view.widget->isVisible() && active.first == view.of &&
          session.SceneOf(view.viewport) == active.second && session.Viewport(view.viewport)) {
        CaptureRequest request;
        request.color = false;
        request.label = true;
        const Capture capture = view.widget->GetViewport()->GetCapture(request);
        outline = ViewSelection::Outline(capture.label, capture.width, capture.height, selected);
      }
    } catch (const std::exception&) {
      outline = QImage(); // the view itself says what fails
    }
    view.outline->setGeometry(view.widget->rect());
    view.outline->Show(outline);
  }

  void Later() {
    for (const auto& view : this->views) {
      view->rest->start(Rest_ms);
    }
  }
};

ViewSelection::ViewSelection(SceneTreeWidget* tree, ShownScenes* scenes, QObject* parent)
    : QObject(parent), Impl_(std::make_unique<Internals>()) {
  this->Impl_->tree = tree;
  this->Impl_->scenes = scenes;
  connect(tree, &SceneTreeWidget::selected, this, [this] { this->Impl_->Later(); });
  connect(scenes, &ShownScenes::activated, this, [this] { this->Impl_->Later(); });
}

ViewSelection::~ViewSelection() = default;

void ViewSelection::Add(ViewportWidget* widget, vtkObject* of, const std::string& viewport) {
  Internals& self = *this->Impl_;
  auto view = std::make_unique<Internals::View>();
  view->widget = widget;
  view->outline = new OutlineWidget(widget);
  view->of = of;
  view->viewport = viewport;
  view->rest = std::make_unique<QTimer>();
  view->rest->setSingleShot(true);
  Internals::View* added = view.get();
  connect(view->rest.get(), &QTimer::timeout, this, [this, added] { this->Impl_->Draw(*added); });
  connect(widget, &ViewportWidget::shown, this, [this, added] {
    if (!added->outline || (!added->outline->isVisible() && this->Impl_->Selected().empty())) {
      return;
    }
    if (QGuiApplication::mouseButtons() != Qt::NoButton) { // the user moves the camera
      added->outline->hide();
      added->rest->start(Rest_ms);
    } else if (!added->rest->isActive()) { // a scene that moves has one from time to time
      added->rest->start(Rest_ms);
    }
  });
  connect(widget, &QObject::destroyed, this, [this, added] {
    auto& all = this->Impl_->views;
    all.erase(std::remove_if(all.begin(), all.end(),
                             [added](const auto& each) { return each.get() == added; }),
              all.end());
  });
  self.views.push_back(std::move(view));
}

void ViewSelection::Take(const std::string& event, const std::string& reply) {
  v1::ViewportEvent given;
  v1::Reply told;
  if (!given.ParseFromString(event) || !told.ParseFromString(reply) || !told.has_pick() ||
      given.button() != v1::ViewportEvent::LEFT) {
    return;
  }
  SceneItem item;
  if (told.pick().object() != 0) {
    item = {FrameId(told.pick().frame()), ObjectId(told.pick().object())};
  }
  this->Impl_->tree->Select(item);
}

void ViewSelection::Clear() {
  this->Impl_->tree->Select({});
}

QString ViewSelection::Python() const {
  const SceneItem item = this->Impl_->tree->Selected();
  const auto& scene = this->Impl_->tree->Model()->GetScene();
  if (!scene || item.frame == NoFrame) {
    return {};
  }
  if (item.object != 0) {
    const auto found = scene->Objects().find(item.object);
    return found == scene->Objects().end()
               ? QString()
               : QStringLiteral("scene.objects[%1]")
                     .arg(Quoted(QString::fromStdString(found->second.name)));
  }
  return item.frame == RootFrame || !scene->Frames().Contains(item.frame)
             ? QString()
             : QStringLiteral("scene.frame(%1)")
                   .arg(Quoted(QString::fromStdString(scene->Frames().Path(item.frame))));
}

QImage ViewSelection::Outline(const std::vector<std::uint32_t>& labels, int width, int height,
                              const std::vector<ObjectId>& selected) {
  const std::unordered_set<std::uint32_t> chosen(selected.begin(), selected.end());
  std::vector<char> inside(labels.size());
  bool any = false;
  std::uint32_t last = 0;
  char was = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] != last) {
      last = labels[i];
      was = chosen.count(last) > 0 ? 1 : 0;
    }
    inside[i] = was;
    any = any || was;
  }
  if (!any) {
    return {};
  }
  QImage outline(width, height, QImage::Format_ARGB32_Premultiplied);
  outline.fill(Qt::transparent);
  const QRgb edge = OutlineColor.rgba();
  constexpr int Reach = 2; // [pixels] outside of the object, so that it stays as it is
  const auto at = [&](int x, int y) {
    return inside[std::size_t(y) * std::size_t(width) + std::size_t(x)] != 0;
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!at(x, y) || !((x > 0 && !at(x - 1, y)) || (x + 1 < width && !at(x + 1, y)) ||
                         (y > 0 && !at(x, y - 1)) || (y + 1 < height && !at(x, y + 1)))) {
        continue;
      }
      for (int v = std::max(0, y - Reach); v <= std::min(height - 1, y + Reach); ++v) {
        auto* line = reinterpret_cast<QRgb*>(outline.scanLine(v));
        for (int u = std::max(0, x - Reach); u <= std::min(width - 1, x + Reach); ++u) {
          if (!at(u, v)) {
            line[u] = edge;
          }
        }
      }
    }
  }
  return outline;
}

bool ViewSelection::IsOutlined(ViewportWidget* widget) const {
  for (const auto& view : this->Impl_->views) {
    if (view->widget == widget) {
      return view->outline && view->outline->isVisible();
    }
  }
  return false;
}

} // namespace dspace::widgets
