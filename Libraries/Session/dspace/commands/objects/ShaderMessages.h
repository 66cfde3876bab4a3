// Shader code of objects as messages.
#ifndef DSPACE_SESSION_SHADER_MESSAGES_H
#define DSPACE_SESSION_SHADER_MESSAGES_H

#include <memory>
#include <string>

#include <dspace/proto/objects.pb.h>
#include <dspace/scene/ShaderCode.h>

namespace dspace::session {

// Null for a command without replacements and uniforms. Throws Error(InvalidArgument) naming
// `object` and the value: empty tags, names that GLSL does not accept or that begin with "gl_" or
// "dspace", names that come twice, a wrong number of values, values that are not finite or that
// their type cannot hold, arrays of 3 × 3 matrices, more than 1,024 elements.
std::shared_ptr<const ShaderCode> ToShaderCode(const v1::SetShader& from,
                                               const std::string& object);

// All fields but the object.
void PutShader(const ShaderCode& from, v1::SetShader* to);

// Whether the programs of both have the same text: uniforms may have other values.
bool HaveSamePrograms(const ShaderCode& a, const ShaderCode& b);

} // namespace dspace::session

#endif
