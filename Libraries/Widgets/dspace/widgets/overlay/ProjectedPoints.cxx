#include <dspace/widgets/overlay/ProjectedPoints.h>

#include <cmath>
#include <limits>

#include "vtkDspaceViewport.h"

#include <dspace/camera/FittedImage.h>
#include <dspace/camera/files/CameraJson.h>
#include <dspace/proto/commands.pb.h>
#include <dspace/widgets/viewport/ShownSession.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

namespace dspace::widgets {

namespace {

// The pixels of a view that the pixels of its camera's image are shown in.
struct Image {
  FittedImage place;
  int width; // of the image itself
  int height;
  std::string lens; // JSON; empty: none
};

Image ImageOf(const ShownSession& session, vtkDspaceViewport& shown) {
  Image image{{0, 0, shown.GetWidth(), shown.GetHeight()}, shown.GetWidth(), shown.GetHeight(), {}};
  if (shown.HasLens()) {
    v1::Command ask;
    ask.mutable_describe_viewport()->set_viewport(shown.GetName());
    v1::Reply reply;
    if (reply.ParseFromString(session.Execute(ask.SerializeAsString())) &&
        !reply.viewport_info().lens().empty()) {
      image.lens = reply.viewport_info().lens();
      const CameraModel model = ParseCameraJson(image.lens, "camera model").front();
      image.width = model.width;
      image.height = model.height;
      image.place = FitImage(model.width, model.height, shown.GetWidth(), shown.GetHeight());
    }
  }
  return image;
}

} // namespace

std::vector<QPointF> ProjectedPoints(const ShownSession& session, const ViewportWidget& view,
                                     const std::string& scene,
                                     const std::vector<std::array<double, 3>>& points) {
  vtkDspaceViewport& shown = *view.GetViewport();
  const Image image = ImageOf(session, shown);
  if (shown.HasLens() && image.lens.empty()) {
    return {}; // the session does not have the view now
  }
  v1::Command command;
  command.set_scene(scene);
  v1::ProjectPoints* project = command.mutable_project_points();
  project->mutable_camera()->set_vantage(shown.GetVantage());
  project->mutable_camera()->set_camera(shown.GetCamera());
  project->mutable_camera()->set_model(image.lens);
  project->mutable_camera()->set_width(std::uint32_t(image.width));
  project->mutable_camera()->set_height(std::uint32_t(image.height));
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
  constexpr double None = std::numeric_limits<double>::quiet_NaN();
  const double x = double(view.width()) / shown.GetWidth();
  const double y = double(view.height()) / shown.GetHeight();
  for (int i = 0; i < reply.project().pixel_size(); i += 2) {
    // From the edge of the image, in its widths and heights.
    const double across = (reply.project().pixel(i) + 0.5) / image.width;
    const double down = (reply.project().pixel(i + 1) + 0.5) / image.height;
    const bool beside =
        !image.lens.empty() && !(across >= 0.0 && across <= 1.0 && down >= 0.0 && down <= 1.0);
    places.emplace_back(beside ? None : (image.place.x + across * image.place.width) * x,
                        beside ? None : (image.place.y + down * image.place.height) * y);
  }
  return places;
}

bool IsPaintable(const QPointF& place) {
  return std::isfinite(place.x()) && std::isfinite(place.y()) && std::abs(place.x()) < 1e5 &&
         std::abs(place.y()) < 1e5;
}

} // namespace dspace::widgets
