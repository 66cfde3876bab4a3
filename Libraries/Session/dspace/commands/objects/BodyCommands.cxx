// The Sun, planets and moons.
#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/messages/Convert.h>
#include <dspace/scene/LinearLight.h>
#include <dspace/scene/bodies/BodyTable.h>

namespace dspace::session {
namespace {

constexpr double MostRadiusDifference = 0.02; // of a body and its ground

Atmosphere ToAtmosphere(const v1::BodyAtmosphere& from) {
  Atmosphere air;
  const auto take = [](bool has, double value, double& to) { to = has ? value : to; };
  take(from.has_top(), from.top(), air.top);
  take(from.has_rayleigh_height(), from.rayleigh_height(), air.rayleighHeight);
  take(from.has_mie_height(), from.mie_height(), air.mieHeight);
  take(from.has_mie_asymmetry(), from.mie_asymmetry(), air.mieAsymmetry);
  air.rayleigh = ToVector(from.rayleigh());
  air.mie = ToVector(from.mie());
  air.mieExtinction = from.has_mie_extinction() ? ToVector(from.mie_extinction()) : air.mie;
  return air;
}

void PutAtmosphere(const Atmosphere& from, v1::BodyAtmosphere* to) {
  to->set_top(from.top);
  to->set_rayleigh_height(from.rayleighHeight);
  to->set_mie_height(from.mieHeight);
  to->set_mie_asymmetry(from.mieAsymmetry);
  Put(from.rayleigh, to->mutable_rayleigh());
  Put(from.mie, to->mutable_mie());
  Put(from.mieExtinction, to->mutable_mie_extinction());
}

std::vector<RingBand> ToRings(const v1::CreateBody& command, const std::string& label) {
  std::vector<RingBand> rings;
  for (const v1::BodyRing& from : command.ring()) {
    RingBand ring;
    ring.inner = from.inner();
    ring.outer = from.outer();
    ring.opticalDepth = from.optical_depth();
    if (from.has_color()) {
      ring.color = ToColor(from.color(), label);
    }
    rings.push_back(ring);
  }
  return rings;
}

// Mean luminance, in linear light, over the sphere of an image in plate carree.
double MeanLuminance(const Image& image) {
  std::array<double, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    linear[i] = double(LinearFromSrgb(double(i) / 255.0));
  }
  double sum = 0.0;
  double weights = 0.0;
  for (int y = 0; y < image.height; ++y) {
    const double weight = std::sin(M_PI * (y + 0.5) / image.height);
    double row = 0.0;
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p =
          image.pixels.data() + (std::size_t(y) * image.width + x) * image.channels;
      row += image.channels < 3
                 ? linear[p[0]]
                 : 0.2126 * linear[p[0]] + 0.7152 * linear[p[1]] + 0.0722 * linear[p[2]];
    }
    sum += weight * row / image.width;
    weights += weight;
  }
  return sum / weights;
}

// The factor on colour and texture with which the body has its geometric albedo.
double BrightnessFor(double albedo, const MaterialOverride& material, const std::string& label) {
  double mean = 1.0;
  if (material.color) {
    const std::array<float, 3> color = LinearColor(*material.color);
    mean = 0.2126 * double(color[0]) + 0.7152 * double(color[1]) + 0.0722 * double(color[2]);
  }
  if (material.texture && *material.texture) {
    mean *= MeanLuminance(**material.texture);
  }
  const Reflectance reflectance = material.reflectance.value_or(Reflectance());
  if (reflectance.model == Reflectance::Model::Hapke) {
    Reject(label, "an albedo is given with the model of Hapke, whose parameters have the body's "
                  "brightness; accepted: no albedo");
  }
  if (mean <= 0.0) {
    Reject(label, "an albedo is given with a black colour or texture; accepted: none with these");
  }
  return NormalAlbedo(albedo, reflectance.model) / mean;
}

// Of a terrain's CRS: the radii along X, Y and Z [m].
Eigen::Vector3d GroundRadii(const Context& context, const v1::CreateBody& command,
                            const KnownBody* known, const std::string& label) {
  const TerrainObject* terrain = context.scene->TerrainOf(command.ground());
  if (!terrain) {
    Reject(label, "its ground is object " + std::to_string(command.ground()) +
                      "; accepted: the object of a terrain of scene '" + context.sceneName + "'");
  }
  if (!terrain->OnBody()) {
    Reject(label, "its ground '" + terrain->Name() +
                      "' lies on a plane; accepted: a terrain that was opened on its body");
  }
  const auto axes = terrain->Surface().GetCrs().GetAxes();
  const Eigen::Vector3d radii(axes.semiMajor, axes.semiMajor, axes.semiMinor);
  const Eigen::Vector3d own = command.has_radii() ? ToVector(command.radii())
                              : known             ? known->shape.radii
                                                  : radii;
  if (((radii - own).cwiseAbs().array() > MostRadiusDifference * own.array()).any()) {
    Reject(label, "its ground '" + terrain->Name() + "' is of a body with a radius of " +
                      std::to_string(radii.x()) + " m, the body's is " + std::to_string(own.x()) +
                      " m; accepted: within 2 %");
  }
  return radii;
}

BodyShape ShapeOf(const Context& context, const v1::CreateBody& command, const KnownBody* known,
                  const std::string& label) {
  BodyShape shape = known ? known->shape : BodyShape();
  if (command.ground() != 0) {
    shape.radii = GroundRadii(context, command, known, label);
    shape.ground = command.ground();
  }
  if (command.has_radii()) {
    shape.radii = ToVector(command.radii());
  } else if (command.ground() != 0) {
    // They are those of the ground.
  } else if (!known) {
    Reject(label, "neither body nor radii are given; accepted: one of them, or both");
  }
  if (command.plain()) {
    shape.rings.clear();
    shape.atmosphere.reset();
  }
  shape.leftEdge_deg = command.has_left_edge_deg() ? command.left_edge_deg() : shape.leftEdge_deg;
  shape.geodetic = command.has_geodetic() ? command.geodetic() : shape.geodetic;
  shape.sun = command.has_sun() ? command.sun() : shape.sun;
  shape.eclipses = command.has_eclipses() ? command.eclipses() : !shape.sun;
  shape.brightness = command.has_brightness() ? command.brightness() : 1.0;
  shape.pointGain = command.has_point_gain() ? command.point_gain() : 1.0;
  shape.pointSpread = command.has_point_spread() ? command.point_spread() : 0.0;
  if (command.ring_size() > 0) {
    shape.rings = ToRings(command, label);
  }
  if (command.has_atmosphere()) {
    shape.atmosphere = ToAtmosphere(command.atmosphere());
  }
  return shape;
}

// All that the table gave, so that a recording does not depend on it.
void PutShape(const BodyShape& shape, v1::CreateBody& command) {
  Put(shape.radii, command.mutable_radii());
  command.set_left_edge_deg(shape.leftEdge_deg);
  command.set_geodetic(shape.geodetic);
  command.set_brightness(shape.brightness);
  command.set_point_gain(shape.pointGain);
  command.set_point_spread(shape.pointSpread);
  command.set_sun(shape.sun);
  command.set_eclipses(shape.eclipses);
  command.clear_ring();
  for (const RingBand& ring : shape.rings) {
    v1::BodyRing* to = command.add_ring();
    to->set_inner(ring.inner);
    to->set_outer(ring.outer);
    to->set_optical_depth(ring.opticalDepth);
    Put(ring.color, to->mutable_color());
  }
  if (shape.atmosphere) {
    PutAtmosphere(*shape.atmosphere, command.mutable_atmosphere());
  }
  command.set_plain(true);
}

void CreateBody(const Context& context, v1::CreateBody& command) {
  v1::ObjectSettings& settings = *command.mutable_object();
  const std::string wanted = command.body().empty() ? "body" : command.body();
  const std::string name =
      settings.name().empty() ? context.GetScene().FreeObjectName(wanted) : settings.name();
  const std::string label = "object '" + name + "'";
  const KnownBody* known = command.body().empty() ? nullptr : &FindBody(label, command.body());
  if (settings.has_line_width() || settings.has_point_size() ||
      (settings.material().has_opacity() && settings.material().opacity() != 1.0) ||
      settings.material().has_wireframe()) {
    Reject(label, "opacity, wireframe, a line width or a point size is given; accepted for bodies: "
                  "none of these");
  }
  if (known && !known->shape.sun && !settings.material().has_reflectance()) {
    settings.mutable_material()->mutable_reflectance()->set_model(
        static_cast<v1::Reflectance::Model>(known->model));
  }
  BodyShape shape = ShapeOf(context, command, known, label);
  const MaterialOverride material =
      ApplyMaterial(*settings.mutable_material(), {}, context.state, label);
  const bool textured = material.texture && *material.texture;
  const bool grey =
      known && !shape.sun && !textured && !material.color && !command.has_brightness();
  if (command.has_albedo() && command.has_brightness()) {
    Reject(label, "both an albedo and a brightness are given; accepted: one of them");
  }
  if (command.has_albedo() || grey) {
    Require(!command.has_albedo() || (command.albedo() >= 0.0 && command.albedo() <= 10.0), label,
            "albedo", command.albedo(), "0 to 10");
    shape.brightness = BrightnessFor(
        command.has_albedo() ? command.albedo() : known->geometricAlbedo, material, label);
  }
  if (shape.sun && context.scene->sky.sun) {
    // Its distance would count twice.
    Reject(label, "it is the Sun, but the light 'sun' follows the scene's time by set_sun_motion; "
                  "accepted: stop that, and set the light's irradiance to that at 1 au");
  }
  const auto body = std::make_shared<CelestialBody>(label, shape);
  AddObject(context, settings, name, {}, false, body);
  PutShape(body->Shape(), command);
  command.clear_albedo();
}

} // namespace

void AddBodyCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kCreateBody, &C::mutable_create_body, CreateBody);
}

} // namespace dspace::session
