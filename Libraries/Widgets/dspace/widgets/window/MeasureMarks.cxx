#include <dspace/widgets/window/MeasureMarks.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <vector>

#include <QPainter>

#include "vtkDspaceViewport.h"

#include <dspace/proto/commands.pb.h>
#include <dspace/widgets/measure/MeasureWidget.h>
#include <dspace/widgets/viewport/ShownSession.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/OverlayPane.h>

namespace dspace::widgets {
namespace {

constexpr std::size_t MostPainted = 300; // places of a profile
constexpr double Radius = 4.0;           // of a point [pixels]
const QColor LineColor(0xff, 0xd2, 0x3f);
const QColor Halo(0, 0, 0, 150);

// The places of points in a view, in its own coordinates; NaN: behind the camera.
std::vector<QPointF> Projected(const ShownSession& session, ViewportWidget* view,
                               const std::string& scene,
                               const std::vector<MeasureWidget::Point>& points) {
  vtkDspaceViewport* shown = view->GetViewport();
  v1::Command command;
  command.set_scene(scene);
  v1::ProjectPoints* project = command.mutable_project_points();
  project->mutable_camera()->set_vantage(shown->GetVantage());
  project->mutable_camera()->set_camera(shown->GetCamera());
  project->mutable_camera()->set_width(std::uint32_t(shown->GetWidth()));
  project->mutable_camera()->set_height(std::uint32_t(shown->GetHeight()));
  for (const MeasureWidget::Point& point : points) {
    for (const double value : point) {
      project->add_point(value);
    }
  }
  v1::Reply reply;
  std::vector<QPointF> places;
  if (!reply.ParseFromString(session.Execute(command.SerializeAsString())) ||
      reply.project().pixel_size() != 2 * int(points.size())) {
    return places;
  }
  const double x = double(view->width()) / shown->GetWidth();
  const double y = double(view->height()) / shown->GetHeight();
  for (int i = 0; i < reply.project().pixel_size(); i += 2) {
    places.emplace_back((reply.project().pixel(i) + 0.5) * x,
                        (reply.project().pixel(i + 1) + 0.5) * y);
  }
  return places;
}

bool IsSeen(const QPointF& place) {
  return std::isfinite(place.x()) && std::isfinite(place.y()) && std::abs(place.x()) < 1e5 &&
         std::abs(place.y()) < 1e5;
}

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
  const std::string scene = ShownSession(of).SceneOf(viewport);
  if (of != this->Of_ || scene != this->Scene_) {
    this->Widget_->Clear();
    this->Of_ = of;
    this->Scene_ = scene;
  }
  this->Widget_->Add({pick.in_root().x(), pick.in_root().y(), pick.in_root().z()},
                     QString::fromStdString(pick.terrain()));
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
        Projected(session, view, this->Scene_, Thinned(this->Widget_->Path()));
    if (this->Widget_->IsClosed() && !path.empty()) {
      path.push_back(path.front());
    }
    for (const auto& [color, width] : {std::pair(Halo, 4.0), std::pair(LineColor, 2.0)}) {
      painter.setPen(QPen(color, width, Qt::SolidLine, Qt::RoundCap));
      for (std::size_t i = 1; i < path.size(); ++i) {
        if (IsSeen(path[i - 1]) && IsSeen(path[i])) {
          painter.drawLine(path[i - 1], path[i]);
        }
      }
    }
    std::vector<MeasureWidget::Point> points = this->Widget_->Points();
    const bool pointed = this->Widget_->Pointed() != nullptr;
    if (pointed) {
      points.push_back(*this->Widget_->Pointed());
    }
    const std::vector<QPointF> places = Projected(session, view, this->Scene_, points);
    painter.setPen(QPen(Halo, 1.5));
    for (std::size_t i = 0; i < places.size(); ++i) {
      const bool last = pointed && i + 1 == places.size();
      painter.setBrush(last ? QColor(Qt::white) : LineColor);
      if (IsSeen(places[i])) {
        painter.drawEllipse(places[i], last ? 1.5 * Radius : Radius, last ? 1.5 * Radius : Radius);
      }
    }
  } catch (const std::exception&) {
    return; // the view itself reports what fails
  }
}

} // namespace dspace::widgets
