// Why objects are seen or not in a picture. No OpenGL.
#ifndef DSPACE_RENDER_VIEW_EXPLANATION_H
#define DSPACE_RENDER_VIEW_EXPLANATION_H

#include <cstdint>
#include <string>
#include <vector>

#include <dspace/scene/GraphicsObject.h>

namespace dspace {

class Scene;
struct DrawFilter;
struct DrawView;

struct ObjectVisibility {
  // In the order in which they are tried: the first that holds is the reason.
  enum class Reason {
    Hidden,
    FragmentHidden,
    OrnamentsHidden,
    Empty,
    Transparent,
    Seen,
    Behind,
    BeforeNear,
    BeyondFar,
    Outside,
    TooSmall,
    Occluded
  };
  ObjectId object = 0;
  Reason reason = Reason::Seen;
  std::string text;         // a sentence with the numbers
  std::uint64_t pixels = 0; // that show it
};

// One entry for each object of the scene, by id. `view` is that of the picture, one sample a pixel,
// with its near and far distances set (LabelPicture::View); `filter` what the viewport leaves out;
// `labels` the label of each pixel. An object counts as outside where the corners of its box (of
// custom geometry: its bounding sphere) are all beyond one border.
std::vector<ObjectVisibility> ExplainView(const Scene& scene, const DrawView& view,
                                          const DrawFilter& filter,
                                          const std::vector<std::uint32_t>& labels);

} // namespace dspace

#endif
