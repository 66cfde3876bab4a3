#include <dspace/commands/beforehand/ReadFiles.h>

#include <dspace/Error.h>
#include <dspace/commands/terrain/TerrainBeforehand.h>
#include <dspace/import/worker/ModelImport.h>

namespace dspace::session {
namespace {

void ReadModels(const v1::ImportObject& command, ReadBeforehand& into) {
  ImportOptions options;
  options.strict = command.strict();
  options.pointCloud = command.point_cloud();
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
         command.has_open_terrain();
}

void NameBeforehand(State& state, v1::Command& command) {
  if (!command.has_open_terrain() || !command.open_terrain().name().empty()) {
    return;
  }
  const auto scene = state.scenes.find(command.scene());
  if (scene != state.scenes.end()) {
    command.mutable_open_terrain()->set_name(FreeTerrainName(scene->second));
  }
}

std::shared_ptr<ReadBeforehand> ReadFiles(const v1::Command& command) {
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
    ReadTerrain(command.open_terrain(), *read);
  }
  return read;
}

} // namespace dspace::session
