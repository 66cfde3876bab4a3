#include <dspace/commands/viewports/ShownLens.h>

#include <dspace/Checks.h>
#include <dspace/camera/FittedImage.h>
#include <dspace/camera/sampling/LensMap.h>
#include <dspace/commands/viewports/SourceCamera.h>

namespace dspace::session {
namespace {

constexpr int OneBlock = 1 << 20; // source pixels a side: as large as a face is

} // namespace

std::shared_ptr<const ViewLens> ShowLens(const dspace::CameraModel& model, int width, int height) {
  if (model.width < 1 || model.height < 1) {
    Reject(model.Label(), "it does not say for which size of image it is; accepted: a model that "
                          "does");
  }
  const FittedImage fitted = FitImage(model.width, model.height, width, height);
  dspace::CameraModel shown = model;
  shown.width = fitted.width;
  shown.height = fitted.height;
  shown.lens =
      model.lens->Scaled(double(shown.width) / model.width, double(shown.height) / model.height);
  const SourceViews views(shown, OneBlock);
  const auto lens = std::make_shared<ViewLens>();
  lens->width = width;
  lens->height = height;
  std::vector<SourceViews::View> whole;
  for (int i = 0; i < int(views.Faces().size()); ++i) {
    const SourceViews::View view = views.ViewOf({i, 0, 0});
    ViewLens::Source source;
    const SourceCamera camera = SourceCameraOf(views, i, view);
    source.X_CF = camera.X_CF;
    source.projection = camera.projection;
    source.width = view.width;
    source.height = view.height;
    lens->sources.push_back(source);
    whole.push_back(view);
  }
  const LensMap map(views, *shown.lens, 0, 0, shown.width, shown.height);
  lens->places.resize(std::size_t(width) * std::size_t(height));
  for (int y = 0; y < shown.height; ++y) {
    for (int x = 0; x < shown.width; ++x) {
      const LensMap::Pixel& from =
          map.Pixels()[std::size_t(y) * std::size_t(shown.width) + std::size_t(x)];
      if (from.place.face < 0) {
        continue;
      }
      const SourceViews::View& view = whole[std::size_t(from.place.face)];
      ViewLens::Place& place =
          lens->places[std::size_t(y + fitted.y) * std::size_t(width) + std::size_t(x + fitted.x)];
      place.x = float(from.place.x - view.x);
      place.y = float(from.place.y - view.y);
      place.source = float(from.place.face);
      place.footprint = from.footprint;
    }
  }
  return lens;
}

} // namespace dspace::session
