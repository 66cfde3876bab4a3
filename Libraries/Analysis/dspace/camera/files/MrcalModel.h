// mrcal's .cameramodel files.
#ifndef DSPACE_CAMERA_FILES_MRCAL_MODEL_H
#define DSPACE_CAMERA_FILES_MRCAL_MODEL_H

#include <string>

#include <dspace/camera/CameraModel.h>

namespace dspace {

// LENSMODEL_PINHOLE, LENSMODEL_OPENCV4, 5, 8, 12, LENSMODEL_CAHVOR, LENSMODEL_CAHVORE_linearity=L.
// M is mrcal's reference coordinate system. Throws Error(Corrupt, Unsupported), or as MakeLens
// does.
CameraModel ParseMrcalModel(const std::string& text, const std::string& label);
bool IsMrcalModel(const std::string& text); // whether it has a 'lensmodel'
std::string MrcalModelOf(const CameraModel& model);

} // namespace dspace

#endif
