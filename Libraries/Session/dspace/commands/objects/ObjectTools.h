// Functions that the commands on objects share.
#ifndef DSPACE_SESSION_OBJECT_TOOLS_H
#define DSPACE_SESSION_OBJECT_TOOLS_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/interpreter/Registry.h>

namespace dspace::session {

// "object 'rover'", for messages.
std::string ObjectLabel(const Scene& scene, ObjectId id);

// Throws Error(InvalidArgument) naming `object` and the value.
Reflectance ToReflectance(const v1::Reflectance& from, const std::string& object);

// Applies the overrides `material` to `base`. Loads the texture. Throws Error as the checks and
// ReadImage do.
MaterialOverride ApplyMaterial(v1::Material& material, const MaterialOverride& base, State& state,
                               const std::string& object);
void PutMaterial(const MaterialOverride& from, v1::Material* to);

// Adds an object with these levels and writes its id and name into `settings` and the reply. `what`
// ("box") is its name if `settings` has none. `custom` is drawn instead of levels.
ObjectId AddObject(const Context& context, v1::ObjectSettings& settings, const std::string& what,
                   std::vector<DetailLevel> levels, bool billboard = false,
                   std::shared_ptr<const CustomGeometry> custom = nullptr);

} // namespace dspace::session

#endif
