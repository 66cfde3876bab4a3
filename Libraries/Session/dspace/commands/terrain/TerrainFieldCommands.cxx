// Fields of a terrain: added, removed, listed.
#include <algorithm>
#include <utility>

#include <dspace/Checks.h>
#include <dspace/commands/terrain/ClipmapTerrainObject.h>
#include <dspace/commands/terrain/TerrainLook.h>
#include <dspace/commands/terrain/TerrainTools.h>
#include <dspace/layers/raster/RasterField.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

RasterFieldOptions OptionsOf(const v1::AddTerrainField& command, const std::string& label) {
  RasterFieldOptions options;
  options.band = command.band() != 0 ? ToInt(command.band()) : 1;
  options.nearest = command.nearest();
  options.units = command.units();
  if (!command.crs().empty()) {
    options.raster.crs = command.crs();
  }
  if (command.extent_size() != 0) {
    if (command.extent_size() != 4) {
      Reject(label, "the extent of field '" + command.name() + "' holds " +
                        std::to_string(command.extent_size()) +
                        " numbers; accepted: 4 (left, top, right, bottom) or none");
    }
    options.raster.extent = {command.extent(0), command.extent(1), command.extent(2),
                             command.extent(3)};
  }
  return options;
}

void AddTerrainField(const Context& context, v1::AddTerrainField& command) {
  TerrainObject& terrain = FindTerrain(context, command.terrain());
  const std::string label = "terrain '" + command.terrain() + "'";
  RequireName("field", command.name());
  if (terrain.Fields().Has(command.name())) {
    throw Error(Error::Kind::AlreadyExists, label,
                "it has a field '" + command.name() + "' already; accepted: another name");
  }
  TerrainField field;
  field.source = command;
  field.source.set_path(AbsoluteRaster(command.path()));
  field.field = std::make_shared<const RasterField>(command.name(), field.source.path(),
                                                    terrain.Place(), OptionsOf(command, label));
  command.set_path(field.source.path());
  for (const std::string& warning : field.field->Warnings()) {
    context.reply.add_warning(warning);
  }
  terrain.Fields().Add(std::move(field));
  terrain.Fields().Describe(*context.reply.mutable_terrain_fields());
}

void RemoveTerrainField(const Context& context, v1::RemoveTerrainField& command) {
  TerrainObject& terrain = FindTerrain(context, command.terrain());
  terrain.Fields().Get(command.name()); // throws where there is none
  if (auto* clipmap = dynamic_cast<ClipmapTerrainObject*>(&terrain)) {
    v1::TerrainLayerList list;
    clipmap->Layers().Describe(list);
    for (const v1::TerrainLayerReply& layer : list.layer()) {
      if (layer.field() == command.name()) {
        Reject("terrain '" + command.terrain() + "'",
               "layer '" + layer.name() + "' shows field '" + command.name() +
                   "'; accepted: a field that no layer shows");
      }
    }
  }
  terrain.Fields().Remove(command.name());
}

void ListTerrainFields(const Context& context, v1::ListTerrainFields& command) {
  FindTerrain(context, command.terrain())
      .Fields()
      .Describe(*context.reply.mutable_terrain_fields());
}

} // namespace

void AddTerrainFieldCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kAddTerrainField, &C::mutable_add_terrain_field, AddTerrainField);
  registry.Add(C::kRemoveTerrainField, &C::mutable_remove_terrain_field, RemoveTerrainField);
  registry.Add(C::kListTerrainFields, &C::mutable_list_terrain_fields, ListTerrainFields);
}

} // namespace dspace::session
