// What the commands that make or change an object share.
#ifndef DSPACE_SESSION_OBJECT_TOOLS_H
#define DSPACE_SESSION_OBJECT_TOOLS_H

#include <string>
#include <vector>

#include <dspace/interpreter/Registry.h>

namespace dspace::session {

// "object 'rover'", for messages.
std::string ObjectLabel(const Scene& scene, ObjectId id);

// `wanted`, or with " 2", " 3", ... appended the first name that no object has.
std::string FreeObjectName(const Scene& scene, const std::string& wanted);

// `material` laid over `base`. Loads the texture. Throws Error as the checks and ReadImage do.
MaterialOverride ApplyMaterial(v1::Material& material, const MaterialOverride& base, State& state,
                               const std::string& object);
void PutMaterial(const MaterialOverride& from, v1::Material* to);

// Adds an object with these levels, puts its id and name into `settings` and into the reply.
// `what` ("box") names it where `settings` does not.
ObjectId AddObject(const Context& context, v1::ObjectSettings& settings, const std::string& what,
                   std::vector<DetailLevel> levels, bool billboard = false);

} // namespace dspace::session

#endif
