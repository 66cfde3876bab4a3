// Repairs of URDF text that urdfdom rejects: internal.
#ifndef DSPACE_IMPORT_URDF_REPAIR_H
#define DSPACE_IMPORT_URDF_REPAIR_H

#include <string>

#include <dspace/import/files/GroupedWarnings.h>

namespace dspace {

// The text with what urdfdom cannot read left out or replaced: undefined materials, joints without
// limits, numbers that are none, unknown shapes and types, names of joints that occur twice.
// Collisions, inertias and the like, which Dspace does not use, are dropped without a word. Links
// and the tree that joints make of them stay as they are. Text that is no XML is returned
// unchanged.
std::string RepairUrdfText(const std::string& text, GroupedWarnings& warnings);

} // namespace dspace

#endif
