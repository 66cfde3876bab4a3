#include <dspace/widgets/overlay/MeasureMarks.h>

#include <algorithm>
#include <exception>
#include <vector>

#include <QPainter>

#include <dspace/proto/commands.pb.h>
#include <dspace/widgets/measure/MeasureWidget.h>
#include <dspace/widgets/overlay/OverlayPane.h>
#include <dspace/widgets/overlay/ProjectedPoints.h>
#include <dspace/widgets/viewport/ShownSession.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

namespace dspace::widgets {
namespace {

constexpr std::size_t MostPainted = 300; // places of a profile
constexpr double Radius = 4.0;           // of a point [pixels]
const QColor LineColor(0xff, 0xd2, 0x3f);
const QColor Halo(0, 0, 0, 150);

// At most MostPainted of them, the first and the last one included.
std::vector<MeasureWidget::Point> Thinned(const std::vector<MeasureWidget::Point>& path) {
  if (path.size() <= MostPainted) {
    return path;
  }
  std::vector<MeasureWidget::Point> some;
  for (std::size_t i = 0; i < MostPainted; ++i) {
    some.push_back(path[i * (path.size() - 1) / (MostPainted - 1)]);
  }
  return some;
}

} // namespace

MeasureMarks::MeasureMarks(MeasureWidget* widget, QObject* parent)
    : QObject(parent), Widget_(widget) {
  connect(widget, &MeasureWidget::marksChanged, this, &MeasureMarks::Update);
  connect(widget, &MeasureWidget::toolChanged, this, &MeasureMarks::Update);
}

void MeasureMarks::Add(ViewportWidget* view, vtkObject* of, const std::string& viewport) {
  auto* pane =
      new OverlayPane(view, [this, view](QPainter& painter) { this->Paint(painter, view); });
  pane->setObjectName(QStringLiteral("marks"));
  this->Views_[view] = {of, viewport, pane};
  connect(view, &QObject::destroyed, this, [this](QObject* gone) { this->Views_.erase(gone); });
  this->Update();
}

void MeasureMarks::Update() {
  const bool any = !this->Widget_->Points().empty();
  for (const auto& [view, shown] : this->Views_) {
    if (shown.pane) {
      shown.pane->setVisible(any); // a pane costs a repaint a picture
      shown.pane->raise();
      shown.pane->update();
    }
    static_cast<ViewportWidget*>(view)->setCursor(
        this->Widget_->Used().isEmpty() ? Qt::ArrowCursor : Qt::CrossCursor);
  }
}

bool MeasureMarks::Take(vtkObject* of, const std::string& viewport, const std::string& event,
                        const std::string& reply) {
  v1::ViewportEvent given;
  v1::Reply told;
  if (this->Widget_->Used().isEmpty() || !given.ParseFromString(event) ||
      !told.ParseFromString(reply) || !told.has_pick() ||
      given.button() != v1::ViewportEvent::LEFT) {
    return false;
  }
  const v1::PickReply& pick = told.pick();
  if (pick.object() == 0) {
    return true; // the sky: the click is no selection, either
  }
  return this->TakePoint(of, ShownSession(of).SceneOf(viewport),
                         {pick.in_root().x(), pick.in_root().y(), pick.in_root().z()},
                         pick.terrain());
}

bool MeasureMarks::TakePoint(vtkObject* of, const std::string& scene,
                             const std::array<double, 3>& point, const std::string& terrain) {
  if (this->Widget_->Used().isEmpty()) {
    return false;
  }
  if (of != this->Of_ || scene != this->Scene_) {
    this->Widget_->Clear();
    this->Of_ = of;
    this->Scene_ = scene;
  }
  this->Widget_->Add(point, QString::fromStdString(terrain));
  return true;
}

bool MeasureMarks::Handles(const QJsonObject& request) {
  return request["do"].toString() == "measured";
}

void MeasureMarks::Handle(const QJsonObject& request, vtkObject* of, const std::string& scene) {
  this->Of_ = of;
  this->Scene_ = scene;
  this->Widget_->Show(request);
}

bool MeasureMarks::End() {
  if (this->Widget_->Used().isEmpty()) {
    return false;
  }
  this->Widget_->Use(QString());
  return true;
}

void MeasureMarks::Paint(QPainter& painter, ViewportWidget* view) {
  const auto found = this->Views_.find(view);
  if (found == this->Views_.end() || this->Widget_->Points().empty()) {
    return;
  }
  try {
    const ShownSession session(found->second.of);
    if (!session.Viewport(found->second.viewport) || found->second.of != this->Of_ ||
        session.SceneOf(found->second.viewport) != this->Scene_) {
      return;
    }
    std::vector<QPointF> path =
        ProjectedPoints(session, *view, this->Scene_, Thinned(this->Widget_->Path()));
    if (this->Widget_->IsClosed() && !path.empty()) {
      path.push_back(path.front());
    }
    for (const auto& [color, width] : {std::pair(Halo, 4.0), std::pair(LineColor, 2.0)}) {
      painter.setPen(QPen(color, width, Qt::SolidLine, Qt::RoundCap));
      for (std::size_t i = 1; i < path.size(); ++i) {
        if (IsPaintable(path[i - 1]) && IsPaintable(path[i])) {
          painter.drawLine(path[i - 1], path[i]);
        }
      }
    }
    std::vector<MeasureWidget::Point> points = this->Widget_->Points();
    const bool pointed = this->Widget_->Pointed() != nullptr;
    if (pointed) {
      points.push_back(*this->Widget_->Pointed());
    }
    const std::vector<QPointF> places = ProjectedPoints(session, *view, this->Scene_, points);
    painter.setPen(QPen(Halo, 1.5));
    for (std::size_t i = 0; i < places.size(); ++i) {
      const bool last = pointed && i + 1 == places.size();
      painter.setBrush(last ? QColor(Qt::white) : LineColor);
      if (IsPaintable(places[i])) {
        painter.drawEllipse(places[i], last ? 1.5 * Radius : Radius, last ? 1.5 * Radius : Radius);
      }
    }
  } catch (const std::exception&) {
    return; // the view itself reports what fails
  }
}

} // namespace dspace::widgets
