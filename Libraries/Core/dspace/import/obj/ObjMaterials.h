// Materials of OBJ files (MTL): internal.
#ifndef DSPACE_IMPORT_OBJ_MATERIALS_H
#define DSPACE_IMPORT_OBJ_MATERIALS_H

#include <map>
#include <string>
#include <vector>

#include <dspace/import/model/Model.h>

namespace dspace {

struct ObjMaterials {
  std::vector<Material> materials;
  std::map<std::string, int> byName;
  // u' = u * scale[0] + offset[0] of the texture, and v; one a material.
  struct Placement {
    std::array<double, 2> scale = {1.0, 1.0};
    std::array<double, 2> offset = {0.0, 0.0};
  };
  std::vector<Placement> placements;
  bool complete = true; // false where a library is missing
};

// Reads the libraries that an OBJ file's mtllib statements name (each the rest of its line: one
// name, with blanks, or several), and their textures. Each missing file is a warning.
ObjMaterials ReadObjMaterials(const std::string& objPath, const std::vector<std::string>& libraries,
                              std::vector<std::string>& warnings);

} // namespace dspace

#endif
