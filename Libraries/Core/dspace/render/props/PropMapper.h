// The mapper of a prop of any kind.
#ifndef DSPACE_RENDER_PROP_MAPPER_H
#define DSPACE_RENDER_PROP_MAPPER_H

#include "vtkAbstractVolumeMapper.h"
#include "vtkActor.h"
#include "vtkImageMapper3D.h"
#include "vtkImageSlice.h"
#include "vtkMapper.h"
#include "vtkVolume.h"

namespace dspace {

// Null for an assembly, and for a prop without one.
inline vtkAbstractMapper3D* MapperOf(vtkProp3D* prop) {
  if (auto* actor = vtkActor::SafeDownCast(prop)) {
    return actor->GetMapper();
  }
  if (auto* volume = vtkVolume::SafeDownCast(prop)) {
    return volume->GetMapper();
  }
  auto* slice = vtkImageSlice::SafeDownCast(prop);
  return slice ? slice->GetMapper() : nullptr;
}

} // namespace dspace

#endif
