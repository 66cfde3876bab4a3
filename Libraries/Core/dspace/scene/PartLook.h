// The look of a part: its material under the overrides of its object and of parts of its name.
#ifndef DSPACE_SCENE_PART_LOOK_H
#define DSPACE_SCENE_PART_LOOK_H

#include <dspace/scene/GraphicsObject.h>

namespace dspace {

// Of the object, and over it that of the part.
MaterialOverride OverrideOf(const GraphicsObject& object, const Part& part);

// False: an override hides the parts of its name.
bool IsPartVisible(const GraphicsObject& object, const Part& part);

// The material that the part is drawn with. `lit` is false where lights never shade: billboards,
// lines, points, meshes without normals. The texture is null without texture coordinates.
Material LookOf(const GraphicsObject& object, const Part& part);

// Whether something is seen through a mesh of this look: opacity below 1, or an alpha channel of
// the texture or of the vertex colours.
bool IsTranslucent(const Material& look, const Mesh& mesh);

} // namespace dspace

#endif
