// JPL's text files of CAHV, CAHVOR and CAHVORE models.
#ifndef DSPACE_CAMERA_FILES_CAHV_TEXT_H
#define DSPACE_CAMERA_FILES_CAHV_TEXT_H

#include <string>

#include <dspace/camera/CameraModel.h>

namespace dspace {

// "C = x y z" lines, with "Dimensions = width height" and "Model = CAHV ..." where they are. A
// CAHVORE needs "Model = CAHVORE1 ...", "CAHVORE2 ..." or "CAHVORE3,LINEARITY ...". Other lines are
// comments. Throws Error(Corrupt, Unsupported), or as MakeLens does.
CameraModel ParseCahvText(const std::string& text, const std::string& label);
// Whether a text may be one: it has a line "C = ...".
bool IsCahvText(const std::string& text);
std::string CahvTextOf(const CameraModel& model);

} // namespace dspace

#endif
