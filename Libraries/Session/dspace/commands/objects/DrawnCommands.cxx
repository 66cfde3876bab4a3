// Objects that code of this process draws: plug-ins, and props of VTK.
#include <cctype>

#include <dspace/Checks.h>
#include <dspace/commands/objects/ObjectTools.h>

namespace dspace::session {
namespace {

// "actor" of "vtk:vtkOpenGLActor", "grass" of "grass".
std::string DefaultName(const std::string& drawer) {
  if (drawer.compare(0, 4, "vtk:") != 0) {
    return drawer;
  }
  std::string name = drawer.substr(4);
  for (const std::string prefix : {"vtk", "OpenGL"}) {
    if (name.size() > prefix.size() && name.compare(0, prefix.size(), prefix) == 0) {
      name = name.substr(prefix.size());
    }
  }
  if (name.empty()) {
    return "prop";
  }
  name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
  return name;
}

void CreateDrawn(const Context& context, v1::CreateDrawn& command) {
  v1::ObjectSettings& settings = *command.mutable_object();
  const std::string name = settings.name().empty()
                               ? context.GetScene().FreeObjectName(DefaultName(command.drawer()))
                               : settings.name();
  const std::string label = "object '" + name + "'";
  if (command.drawer().empty()) {
    Reject(label, "it names no drawer; accepted: a drawer that a plug-in registered");
  }
  DrawnObject drawn;
  drawn.drawer = command.drawer();
  if (drawn.IsProp() && (settings.material().ByteSizeLong() > 0 || settings.has_line_width() ||
                         settings.has_point_size())) {
    Reject(label,
           "a material, line width or point size is given; accepted for a prop of VTK: none, "
           "since the prop has its own vtkProperty");
  }
  std::shared_ptr<const CustomGeometry> geometry;
  if (const DrawnGeometries::Maker* make = context.state.drawers.Find(command.drawer())) {
    geometry = (*make)({label, command.drawer(), command.parameters()});
  }
  drawn.leftOut = geometry == nullptr;
  const ObjectId id = AddObject(context, settings, name, {}, false, geometry);
  context.scene->drawn[id] = drawn;
  if (drawn.leftOut) {
    const bool prop = drawn.IsProp();
    context.reply.add_warning(
        label + ": nothing is drawn, since it is drawn by " +
        (prop ? "a " + command.drawer().substr(4) + " of VTK in another process"
              : "plug-in '" + command.drawer() + "', which this process has not loaded"));
  }
}

} // namespace

void AddDrawnCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kCreateDrawn, &C::mutable_create_drawn, CreateDrawn);
}

} // namespace dspace::session
