// The fields of a terrain: rasters of values that lie on it.
#ifndef DSPACE_SESSION_TERRAIN_FIELDS_H
#define DSPACE_SESSION_TERRAIN_FIELDS_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/proto/terrain.pb.h>

namespace dspace {
class RasterField;
}

namespace dspace::session {

struct TerrainField {
  v1::AddTerrainField source; // with an absolute path
  std::shared_ptr<const RasterField> field;
};

class TerrainFields {
public:
  // `terrain` is its name, for messages.
  explicit TerrainFields(std::string terrain) : Terrain_(std::move(terrain)) {}

  bool Has(const std::string& name) const;
  // Throws Error(NotFound) that names the existing fields.
  const TerrainField& Get(const std::string& name) const;
  const std::vector<TerrainField>& All() const { return this->Fields_; } // in order of creation
  void Add(TerrainField field) { this->Fields_.push_back(std::move(field)); }
  void Remove(const std::string& name); // throws as Get does
  void Describe(v1::TerrainFieldList& list) const;

private:
  std::string Terrain_;
  std::vector<TerrainField> Fields_;
};

} // namespace dspace::session

#endif
