#include <dspace/commands/beforehand/ReadFiles.h>

#include <algorithm>

#include <dspace/Error.h>
#include <dspace/commands/terrain/TerrainBeforehand.h>
#include <dspace/import/worker/ModelImport.h>

namespace dspace::session {
namespace {

ImportOptions OptionsOf(const v1::ImportObject& command) {
  ImportOptions options;
  options.strict = command.strict();
  options.pointCloud = command.point_cloud();
  return options;
}

void ReadModels(const v1::ImportObject& command, ReadBeforehand& into) {
  const ImportOptions options = OptionsOf(command);
  for (const v1::ImportObject::Level& level : command.level()) {
    into.kept.push_back(into.models.LoadModel(AbsolutePath(level.path()), options));
  }
}

void ReadVisuals(const std::string& path, const ImportOptions& options, ReadBeforehand& into) {
  for (const UrdfLink& link : ImportUrdf(AbsolutePath(path), options).links) {
    for (const UrdfVisual& visual : link.visuals) {
      if (visual.shape != UrdfVisual::Shape::Mesh || visual.missing) {
        continue;
      }
      try {
        into.kept.push_back(into.models.LoadModel(visual.meshPath, options));
      } catch (const Error&) {
        if (options.strict) {
          throw;
        }
      }
    }
  }
}

} // namespace

bool ReadsFiles(const v1::Command& command) {
  return command.has_import_object() || command.has_import_nodes() || command.has_load_robot() ||
         command.has_open_terrain() || command.has_add_terrain_layer();
}

bool HasFiles(State& state, const v1::Command& command) {
  if (!command.has_import_object() && !command.has_import_nodes()) {
    return false;
  }
  const v1::ImportObject& import =
      command.has_import_object() ? command.import_object() : command.import_nodes().import();
  return std::all_of(import.level().begin(), import.level().end(), [&](const auto& level) {
    return state.models.Has(AbsolutePath(level.path()), OptionsOf(import));
  });
}

StateBeforehand NameBeforehand(State& state, v1::Command& command) {
  StateBeforehand before;
  const auto scene = state.scenes.find(command.scene());
  if (scene == state.scenes.end()) {
    return before;
  }
  if (command.has_add_terrain_layer()) {
    before.layer = LayerReader(scene->second, command.add_terrain_layer());
  }
  if (!command.has_open_terrain()) {
    return before;
  }
  v1::OpenTerrain& terrain = *command.mutable_open_terrain();
  if (terrain.name().empty()) {
    terrain.set_name(FreeTerrainName(scene->second));
  }
  try {
    before.sun_S = ReliefSun(*scene->second.scene, terrain);
  } catch (const Error&) {
    // The command says which frame it does not find.
  }
  return before;
}

std::shared_ptr<ReadBeforehand> ReadFiles(const v1::Command& command,
                                          const StateBeforehand& state) {
  auto read = std::make_shared<ReadBeforehand>();
  if (command.has_import_object()) {
    ReadModels(command.import_object(), *read);
  } else if (command.has_import_nodes()) {
    ReadModels(command.import_nodes().import(), *read);
  } else if (command.has_load_robot()) {
    ImportOptions options;
    options.strict = command.load_robot().strict();
    ReadVisuals(command.load_robot().path(), options, *read);
    for (const v1::LoadRobot::Level& level : command.load_robot().level()) {
      ReadVisuals(level.path(), options, *read);
    }
  } else if (command.has_open_terrain()) {
    ReadTerrain(command.open_terrain(), state.sun_S, *read);
  } else if (state.layer) {
    state.layer(*read);
  }
  return read;
}

} // namespace dspace::session
