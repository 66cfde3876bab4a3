// The camera model in a PDS3 or VICAR label.
#ifndef DSPACE_CAMERA_FILES_LABEL_MODEL_H
#define DSPACE_CAMERA_FILES_LABEL_MODEL_H

#include <string>

#include <dspace/camera/CameraModel.h>

namespace dspace {

// The first GEOMETRIC_CAMERA_MODEL of a label: a CAHV, CAHVOR or CAHVORE in its reference
// coordinate system, for the image's own size. Throws Error(Corrupt) for a label that is cut short
// or has none, Error(Unsupported) for other types, or as MakeLens does.
CameraModel ParseLabelModel(const std::string& text, const std::string& label);
// Whether a text begins as a PDS3 or VICAR label.
bool IsLabel(const std::string& text);

} // namespace dspace

#endif
