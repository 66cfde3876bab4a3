// Shader code of VTK's as the command that sets it.
#ifndef DSPACE_SESSION_VTK_SHADER_CODE_H
#define DSPACE_SESSION_VTK_SHADER_CODE_H

#include <dspace/proto/objects.pb.h>

class vtkShaderProperty;

namespace dspace::session {

// Its replacements and uniforms; `object` is unset. Throws Error(Unsupported) for what Dspace has
// no counterpart of: replacements in geometry shaders, whole shaders in place of VTK's templates,
// vectors of integers.
v1::SetShader ToSetShader(vtkShaderProperty* property);

} // namespace dspace::session

#endif
