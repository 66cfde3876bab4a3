#include <dspace/commands/objects/RobotLevels.h>

#include <algorithm>
#include <set>

#include <dspace/Error.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/import/worker/ModelImport.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

constexpr std::size_t NoLink = std::size_t(-1);

std::size_t LinkOf(const Urdf& urdf, const std::string& name) {
  const auto found = std::find_if(urdf.links.begin(), urdf.links.end(),
                                  [&](const UrdfLink& link) { return link.name == name; });
  return found == urdf.links.end() ? NoLink : std::size_t(found - urdf.links.begin());
}

void Check(const std::string& path, const Urdf& coarse, const Urdf& urdf) {
  for (const UrdfLink& link : coarse.links) {
    const std::size_t at = LinkOf(urdf, link.name);
    if (at == NoLink) {
      Reject("file '" + path + "'", "its link '" + link.name + "' is not in '" + urdf.path +
                                        "'; accepted for a level: links of that file");
    }
    const std::size_t wanted = urdf.links[at].visuals.size();
    if (!link.visuals.empty() && link.visuals.size() != wanted) {
      Reject("file '" + path + "'", "its link '" + link.name + "' has " +
                                        std::to_string(link.visuals.size()) +
                                        " visuals; accepted for a level: 0, or " +
                                        std::to_string(wanted) + " as in '" + urdf.path + "'");
    }
  }
}

// Parts in the axes of the finest geometry's object.
DetailLevel LevelOf(UrdfGeometry geometry, const Eigen::Affine3d& X_LO, double minimumPixels) {
  for (Part& part : geometry.parts) {
    part.X_OP = X_LO.inverse() * geometry.X_LO * part.X_OP;
  }
  DetailLevel level;
  level.parts = std::move(geometry.parts);
  level.minimumPixels = minimumPixels;
  return level;
}

} // namespace

std::vector<std::vector<std::vector<DetailLevel>>>
RobotLevels(const Context& context, v1::LoadRobot& command, const Urdf& urdf,
            std::vector<std::vector<UrdfGeometry>> finest, const ImportOptions& options) {
  std::vector<std::vector<std::vector<DetailLevel>>> levels(finest.size());
  for (std::size_t link = 0; link < finest.size(); ++link) {
    for (UrdfGeometry& visual : finest[link]) {
      levels[link].push_back({LevelOf(visual, visual.X_LO, command.minimum_pixels())});
    }
  }
  for (v1::LoadRobot::Level& given : *command.mutable_level()) {
    given.set_path(AbsolutePath(given.path()));
    const Urdf coarse = ImportUrdf(given.path(), options);
    Check(given.path(), coarse, urdf);
    for (const std::string& warning : UrdfWarnings(coarse)) {
      context.reply.add_warning(warning);
    }
    auto geometry = LoadVisuals(context, coarse, options);
    for (std::size_t link = 0; link < finest.size(); ++link) {
      const std::size_t at = LinkOf(coarse, urdf.links[link].name);
      for (std::size_t i = 0; i < finest[link].size(); ++i) {
        if (at == NoLink) {
          levels[link][i].back().minimumPixels = given.minimum_pixels();
        } else if (!geometry[at].empty()) {
          levels[link][i].push_back(
              LevelOf(std::move(geometry[at][i]), finest[link][i].X_LO, given.minimum_pixels()));
        }
      }
    }
  }
  return levels;
}

} // namespace dspace::session
