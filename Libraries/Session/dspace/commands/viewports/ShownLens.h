// The lens that a viewport shows its camera's view through.
#ifndef DSPACE_SESSION_SHOWN_LENS_H
#define DSPACE_SESSION_SHOWN_LENS_H

#include <memory>

#include <dspace/camera/CameraModel.h>
#include <dspace/render/ViewLens.h>

namespace dspace::session {

// The model's image as large as a picture of this size [pixels] holds it whole, in its middle; the
// rest has no ray. Rays start at the middle of the lens' entrance pupils. Throws
// Error(InvalidArgument) for a model without a size or without a ray, and as SourceViews does.
std::shared_ptr<const ViewLens> ShowLens(const dspace::CameraModel& model, int width, int height);

} // namespace dspace::session

#endif
