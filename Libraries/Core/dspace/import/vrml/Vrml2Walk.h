// The walk over a VRML 2.0 file. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML2_WALK_H
#define DSPACE_IMPORT_VRML2_WALK_H

#include <dspace/import/vrml/VrmlBuilder.h>

namespace dspace {

// Makes nodes below `parent` for what the file's root holds.
void WalkVrml2(VrmlBuilder& builder, const VrmlFile& file, int parent, int depth);

} // namespace dspace

#endif
