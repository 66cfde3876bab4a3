#include <dspace/camera/FittedImage.h>

#include <algorithm>
#include <cmath>

namespace dspace {

FittedImage FitImage(int imageWidth, int imageHeight, int width, int height) {
  const double factor = std::min(double(width) / imageWidth, double(height) / imageHeight);
  const auto side = [factor](int of, int most) {
    return std::clamp(int(std::lround(factor * of)), 1, most);
  };
  FittedImage fitted;
  fitted.width = side(imageWidth, width);
  fitted.height = side(imageHeight, height);
  fitted.x = (width - fitted.width) / 2;
  fitted.y = (height - fitted.height) / 2;
  return fitted;
}

} // namespace dspace
