// What the commands that import files share.
#ifndef DSPACE_SESSION_IMPORT_TOOLS_H
#define DSPACE_SESSION_IMPORT_TOOLS_H

#include <memory>

#include <dspace/interpreter/Registry.h>

namespace dspace::session {

// "file 'a/b.glb'" of the first level. Throws Error(InvalidArgument) where the command names none.
std::string ImportLabel(const v1::ImportObject& command);
double ImportScale(const v1::ImportObject& command);                // checked
Eigen::Quaterniond ImportRotation(const v1::ImportObject& command); // checked

// Reads a level's file, whose path becomes absolute. Adds the model's warnings to the reply, with
// what is left out and a size that no vehicle has.
std::shared_ptr<const Model> ImportLevel(const Context& context, const v1::ImportObject& command,
                                         v1::ImportObject::Level& level, bool usesLights,
                                         bool usesAnimations);

} // namespace dspace::session

#endif
