// URDF text through urdfdom: internal.
#ifndef DSPACE_IMPORT_URDF_TEXT_H
#define DSPACE_IMPORT_URDF_TEXT_H

#include <string>
#include <vector>

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <dspace/import/files/GroupedWarnings.h>

namespace dspace {

// Deepest nesting of XML elements, and of links, that is accepted.
constexpr int MaximumUrdfDepth = 1000;

// Parses URDF text, after checking that no nesting would exhaust the parser's stack. What urdfdom
// logs goes into `warnings`, or into the Error(Corrupt) that is thrown when it rejects the text.
// With `repairs`, text that it rejects or complains of is repaired (UrdfRepair.h) and parsed again;
// without, complaints are errors.
// The links' and joints' own graph is not checked: urdfdom accepts loops and second parents.
urdf::ModelInterfaceSharedPtr ParseUrdfText(const std::string& path, const std::string& text,
                                            std::vector<std::string>& warnings,
                                            GroupedWarnings* repairs);

} // namespace dspace

#endif
