// Sunlit areas.
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <dspace/Checks.h>
#include <dspace/commands/measure/MeasuredPictures.h>
#include <dspace/commands/scene/SunCommands.h>
#include <dspace/measure/LitArea.h>
#include <dspace/messages/Convert.h>
#include <dspace/scene/bodies/SunSeen.h>
#include <dspace/state/SunPlace.h>

namespace dspace::session {
namespace {

constexpr int MostObjects = 10000;
constexpr double BuriedShare = 0.01; // of an object's area; above: the reply has a warning

std::string Quoted(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "'" : ", '") + name + "'";
  }
  return text.empty() ? "none" : text;
}

void AddFaces(const MeasuredScene::ShownPart& part, std::vector<Face>& faces) {
  const bool mirrored = part.X_RM.linear().determinant() < 0.0;
  ForEachTriangle(*part.mesh, [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                  const Eigen::Vector3d& c) {
    faces.push_back(
        {part.X_RM * a, part.X_RM * (mirrored ? c : b), part.X_RM * (mirrored ? b : c)});
  });
}

// The triangles of each object, in the command's order.
std::vector<std::vector<Face>> FacesOf(const Context& context, const v1::LitArea& command) {
  std::vector<std::vector<MeasuredScene::ShownPart>> parts;
  std::set<std::string> names;
  for (const ObjectId id : command.object()) {
    const GraphicsObject& object = context.GetScene().Object(id);
    const std::string label = "object '" + object.name + "'";
    if (context.scene->TerrainOf(id)) {
      Reject(label, "it is terrain, which has no lit area; accepted: objects with triangles");
    }
    if (!object.visible || !context.GetScene().Fragments().Get(object.fragment).visible) {
      Reject(label, "it is not shown; accepted: objects that the scene shows");
    }
    parts.push_back(MeasuredScene::PartsOf(context, object));
    for (const MeasuredScene::ShownPart& part : parts.back()) {
      names.insert(part.name);
    }
  }
  const std::set<std::string> wanted(command.part().begin(), command.part().end());
  for (const std::string& name : wanted) {
    if (names.count(name) == 0) {
      throw Error(Error::Kind::NotFound, "part '" + name + "'",
                  "none of the objects shows a part of this name; accepted: " + Quoted(names));
    }
  }
  std::vector<std::vector<Face>> faces(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (const MeasuredScene::ShownPart& part : parts[i]) {
      if (wanted.empty() || wanted.count(part.name) != 0) {
        AddFaces(part, faces[i]);
      }
    }
    const bool area = std::any_of(faces[i].begin(), faces[i].end(), [](const Face& face) {
      return (face[1] - face[0]).cross(face[2] - face[0]).squaredNorm() > 0.0;
    });
    if (!area) {
      Reject("object '" + context.GetScene().Object(command.object(int(i))).name + "'",
             std::string(wanted.empty() ? "it has" : "its chosen parts have") +
                 " no faces with an area that the scene shows; accepted: objects with triangles");
    }
  }
  return faces;
}

double AreaOf(const std::vector<Face>& faces) {
  double area = 0.0;
  for (const Face& face : faces) {
    area += 0.5 * (face[1] - face[0]).cross(face[2] - face[0]).norm();
  }
  return area;
}

// The middle of faces by their areas.
Eigen::Vector3d MiddleOf(const std::vector<Face>& faces) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area = 0.0;
  for (const Face& face : faces) {
    const double twice = (face[1] - face[0]).cross(face[2] - face[0]).norm();
    sum += twice / 3.0 * (face[0] + face[1] + face[2]);
    area += twice;
  }
  return sum / area;
}

void FindLitArea(const Context& context, v1::LitArea& command) {
  const std::string name = "command lit_area";
  const Methods methods = MethodsOf(command.measuring(), name);
  if (methods.image && command.part_size() > 0) {
    Reject(name,
           "parts of objects are asked for by pictures; accepted: whole objects, or the method "
           "EXACT");
  }
  if (command.object_size() < 1 || command.object_size() > MostObjects) {
    Reject(name, std::to_string(command.object_size()) + " objects; accepted: 1 to 10,000");
  }
  const Scene& scene = context.GetScene();
  const Light* present = FindSunLight(scene);
  if (!command.has_sun() && !(present && IsSun(*present))) {
    Reject(name, "scene '" + context.sceneName +
                     "' has no Sun; accepted: a scene with a Sun, or the argument sun");
  }
  const Light light = command.has_sun() ? ChangedSun(context, *command.mutable_sun()) : *present;
  const SunDisc disc{TowardsSun(scene, light, RootFrame), light.radius_deg * M_PI / 180.0};
  const double brightest = *std::max_element(light.color.begin(), light.color.end());
  const bool off = !command.has_sun() && !light.enabled;
  const double ofLight = off ? 0.0 : SolarConstant * light.intensity * brightest;
  const double efficiency = command.has_efficiency() ? command.efficiency() : 1.0;
  constexpr std::size_t Standard = 4096;
  const std::size_t samples = command.samples() == 0 ? Standard : command.samples();
  std::vector<std::vector<Face>> faces = FacesOf(context, command);
  const MeasuredScene measured(context, command.measuring(), command.without_object(), name);
  std::optional<SunlitBodies> bodies;
  if (!command.has_sun()) {
    bodies.emplace(scene);
  }
  struct Lit {
    SunDisc sun;
    double left = 1.0; // of the Sun's disc, by eclipses
    double irradiance = 0.0;
  };
  std::vector<Lit> lights;
  auto areas = std::make_shared<v1::LitAreaReply>();
  std::optional<MeasuredPictures> pictures;
  if (methods.image) {
    pictures.emplace(context, command.measuring(), measured, name,
                     std::set<ObjectId>(command.object().begin(), command.object().end()));
  }
  for (int i = 0; i < command.object_size(); ++i) {
    v1::LitAreaReply::Surface* surface = areas->add_surface();
    surface->set_object(command.object(i));
    Lit& lit = lights.emplace_back(Lit{disc, 1.0, ofLight});
    if (bodies) {
      if (const auto body = bodies->From(MiddleOf(faces[i]))) {
        lit.sun = {body->towards_R, body->radius};
        lit.left = body->left;
        lit.irradiance *= body->square;
      }
    }
    surface->set_sun_left(lit.left);
    if (i == 0) {
      Put(lit.sun.towards_R, areas->mutable_sun());
      areas->set_irradiance(lit.irradiance);
    }
    if (pictures) {
      const auto [seen, pixel] = pictures->Seen(command.object(i), faces[i], lit.sun.towards_R);
      surface->set_image_projected_area(seen * lit.left);
      surface->set_image_pixel_area(pixel);
    }
    if (!methods.exact) {
      surface->set_area(AreaOf(faces[i]) * (command.both_sides() ? 2.0 : 1.0));
      surface->set_lit_area(std::numeric_limits<double>::quiet_NaN());
      surface->set_projected_area(surface->image_projected_area());
      surface->set_power(surface->image_projected_area() * lit.irradiance * efficiency);
    }
  }
  if (!methods.exact) {
    context.reply.mutable_lit_area()->Swap(areas.get());
    return;
  }
  std::vector<std::string> names;
  for (const ObjectId id : command.object()) {
    names.push_back(scene.Object(id).name);
  }
  measured.Measure([names, faces = std::move(faces), lights, areas, samples, efficiency,
                    bothSides = command.both_sides()](const Obstacles& obstacles, v1::Reply& reply,
                                                      const Works::Proceed& proceed) {
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const auto tell = [&](double part) { proceed((double(i) + part) / double(faces.size())); };
      const Lit& light = lights[i];
      v1::LitAreaReply::Surface* surface = areas->mutable_surface(int(i));
      const LitArea lit = MeasureLitArea(obstacles, light.sun, faces[i], bothSides, samples, tell);
      if (lit.buried > BuriedShare * lit.area) {
        reply.add_warning("object '" + names[i] +
                          "': " + NumberText(100.0 * lit.buried / lit.area) +
                          " % of its area face the Sun and are below the ground, where they are "
                          "dark");
      }
      surface->set_area(lit.area);
      surface->set_lit_area(lit.lit * light.left);
      surface->set_projected_area(lit.projected * light.left);
      surface->set_power(lit.projected * light.left * light.irradiance * efficiency);
    }
    reply.mutable_lit_area()->Swap(areas.get());
  });
}

} // namespace

void AddLitAreaRequest(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kLitArea, &C::mutable_lit_area, FindLitArea);
}

} // namespace dspace::session
