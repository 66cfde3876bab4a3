// Draws the pictures of measurements.
#ifndef DSPACE_SESSION_MEASURING_PICTURES_H
#define DSPACE_SESSION_MEASURING_PICTURES_H

#include <dspace/state/Pictures.h>

namespace dspace::session {

class ViewportCommands;

// In the render context of the session's viewports, which must outlive this.
class MeasuringPictures final : public Pictures {
public:
  explicit MeasuringPictures(ViewportCommands& viewports) : Viewports_(viewports) {}
  std::unique_ptr<PictureSeries> Begin(const std::shared_ptr<Scene>& scene, int width, int height,
                                       const std::set<std::string>& hiddenFragments) override;

private:
  ViewportCommands& Viewports_;
};

} // namespace dspace::session

#endif
