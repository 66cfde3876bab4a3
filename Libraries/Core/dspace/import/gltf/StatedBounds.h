// Bounds that a model file states of itself, for when its geometry cannot be read.
#ifndef DSPACE_IMPORT_STATED_BOUNDS_H
#define DSPACE_IMPORT_STATED_BOUNDS_H

#include <string>

#include <Eigen/Geometry>

namespace dspace {

// Axis-aligned bounds of `path` in its own coordinates and units, as Model::Bounds: of a glTF the
// minima and maxima that its positions' accessors state, carried through its nodes (of a turned
// node, those of the box's eight corners). Its buffers are not opened and need not exist. Empty
// where nothing usable is stated, and for other formats. Throws nothing but std::bad_alloc.
Eigen::AlignedBox3d ReadStatedBounds(const std::string& path);

} // namespace dspace

#endif
