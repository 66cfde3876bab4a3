#include <dspace/state/TerrainFields.h>

#include <algorithm>

#include <dspace/Error.h>
#include <dspace/layers/raster/RasterField.h>

namespace dspace::session {

bool TerrainFields::Has(const std::string& name) const {
  return std::any_of(this->Fields_.begin(), this->Fields_.end(),
                     [&](const TerrainField& field) { return field.source.name() == name; });
}

const TerrainField& TerrainFields::Get(const std::string& name) const {
  std::string names;
  for (const TerrainField& field : this->Fields_) {
    if (field.source.name() == name) {
      return field;
    }
    names += (names.empty() ? "'" : ", '") + field.source.name() + "'";
  }
  throw Error(Error::Kind::NotFound, "terrain '" + this->Terrain_ + "'",
              "it has no field '" + name + "'; there are: " + (names.empty() ? "none" : names));
}

void TerrainFields::Remove(const std::string& name) {
  this->Fields_.erase(this->Fields_.begin() + (&this->Get(name) - this->Fields_.data()));
}

void TerrainFields::Describe(v1::TerrainFieldList& list) const {
  for (const TerrainField& from : this->Fields_) {
    v1::TerrainFieldList::Field* field = list.add_field();
    field->set_name(from.source.name());
    field->set_path(from.source.path());
    field->set_units(from.field->Units());
    field->set_crs(from.field->GetCrs().GetWkt());
    field->set_pixel_size(from.field->PixelSize());
    field->set_nearest(from.field->Nearest());
    field->set_columns(std::uint32_t(from.field->Columns()));
    field->set_rows(std::uint32_t(from.field->Rows()));
    field->set_band(from.source.band() != 0 ? from.source.band() : 1);
  }
}

} // namespace dspace::session
