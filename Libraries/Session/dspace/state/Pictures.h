// Pictures that handlers of the plain library need. The VTK module draws them.
#ifndef DSPACE_SESSION_PICTURES_H
#define DSPACE_SESSION_PICTURES_H

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <dspace/Pose.h>
#include <dspace/scene/Projection.h>
#include <dspace/scene/Scene.h>

namespace dspace::session {

// Rows from the top down.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<float> range;         // [m] along the pixel's ray; infinity: nothing was hit
  std::vector<std::uint32_t> label; // ids of objects; 0: nothing
};

// Pictures of one scene in one size, without ornaments, by one sample a pixel. While it exists the
// scene has another vantage, which no command may name.
class PictureSeries {
public:
  virtual ~PictureSeries() = default;
  // X_RC: of a camera (X right, Y down, Z forward) in the root. The picture is that of the finest
  // terrain tiles that the view asks for: it waits for them. Throws Error(Internal) for errors of
  // OpenGL.
  virtual Picture Take(const Projection& projection, const Pose& X_RC) = 0;
};

class Pictures {
public:
  virtual ~Pictures() = default;
  // The scene must outlive the series. Throws Error(InvalidArgument) for a size that OpenGL does
  // not draw.
  virtual std::unique_ptr<PictureSeries> Begin(const std::shared_ptr<Scene>& scene, int width,
                                               int height,
                                               const std::set<std::string>& hiddenFragments) = 0;
};

} // namespace dspace::session

#endif
