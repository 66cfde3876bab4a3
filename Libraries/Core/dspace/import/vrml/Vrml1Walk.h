// The walk over a VRML 1.0 or Inventor file. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML1_WALK_H
#define DSPACE_IMPORT_VRML1_WALK_H

#include <dspace/import/vrml/VrmlBuilder.h>

namespace dspace {

// Makes nodes below `parent` for what the file's root holds.
void WalkVrml1(VrmlBuilder& builder, const VrmlFile& file, int parent, int depth);

} // namespace dspace

#endif
