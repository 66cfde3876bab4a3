// Functions that the commands on objects share.
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

// Applies the overrides `material` to `base`. Loads the texture. Throws Error as the checks and
// ReadImage do.
MaterialOverride ApplyMaterial(v1::Material& material, const MaterialOverride& base, State& state,
                               const std::string& object);
void PutMaterial(const MaterialOverride& from, v1::Material* to);

// Adds an object with these levels and writes its id and name into `settings` and the reply. `what`
// ("box") is its name if `settings` has none.
ObjectId AddObject(const Context& context, v1::ObjectSettings& settings, const std::string& what,
                   std::vector<DetailLevel> levels, bool billboard = false);

} // namespace dspace::session

#endif
