// How a source view of a lens is drawn.
#ifndef DSPACE_SESSION_SOURCE_CAMERA_H
#define DSPACE_SESSION_SOURCE_CAMERA_H

#include <dspace/Pose.h>
#include <dspace/camera/sampling/SourceViews.h>
#include <dspace/scene/Projection.h>

namespace dspace::session {

struct SourceCamera {
  Pose X_CF; // of the view's camera in the lens'
  Projection projection;
};

// Of a view of a face (SourceViews::ViewOf), whose pixels are square.
SourceCamera SourceCameraOf(const SourceViews& views, int face, const SourceViews::View& view);

} // namespace dspace::session

#endif
