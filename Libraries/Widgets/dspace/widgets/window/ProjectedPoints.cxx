#include <dspace/widgets/window/ProjectedPoints.h>

#include <cmath>

#include "vtkDspaceViewport.h"

#include <dspace/proto/commands.pb.h>
#include <dspace/widgets/viewport/ShownSession.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

namespace dspace::widgets {

std::vector<QPointF> ProjectedPoints(const ShownSession& session, const ViewportWidget& view,
                                     const std::string& scene,
                                     const std::vector<std::array<double, 3>>& points) {
  vtkDspaceViewport* shown = view.GetViewport();
  if (shown->HasLens()) {
    return {};
  }
  v1::Command command;
  command.set_scene(scene);
  v1::ProjectPoints* project = command.mutable_project_points();
  project->mutable_camera()->set_vantage(shown->GetVantage());
  project->mutable_camera()->set_camera(shown->GetCamera());
  project->mutable_camera()->set_width(std::uint32_t(shown->GetWidth()));
  project->mutable_camera()->set_height(std::uint32_t(shown->GetHeight()));
  for (const std::array<double, 3>& point : points) {
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
  const double x = double(view.width()) / shown->GetWidth();
  const double y = double(view.height()) / shown->GetHeight();
  for (int i = 0; i < reply.project().pixel_size(); i += 2) {
    places.emplace_back((reply.project().pixel(i) + 0.5) * x,
                        (reply.project().pixel(i + 1) + 0.5) * y);
  }
  return places;
}

bool IsPaintable(const QPointF& place) {
  return std::isfinite(place.x()) && std::isfinite(place.y()) && std::abs(place.x()) < 1e5 &&
         std::abs(place.y()) < 1e5;
}

} // namespace dspace::widgets
