#include <dspace/commands/terrain/TerrainLook.h>

#include <algorithm>
#include <filesystem>

#include <dspace/Checks.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/mesh/DrapeImage.h>
#include <dspace/mesh/ShadedRelief.h>
#include <dspace/mesh/WarpImage.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {

// A path of GDAL's need not be a file ("/vsicurl/...", "PDS4:..."): only files are made absolute.
std::string AbsoluteRaster(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(path, error) ? AbsolutePath(path) : path;
}

namespace {

DrapeImage Relief(const GridTerrain& grid, const v1::OpenTerrain::ShadedRelief& from) {
  ShadedReliefOptions options;
  if (from.has_sun_azimuth_deg()) {
    options.sunAzimuth_deg = from.sun_azimuth_deg();
  }
  if (from.has_sun_elevation_deg()) {
    options.sunElevation_deg = from.sun_elevation_deg();
  }
  if (from.color_by_height()) {
    options.ramp = TerrainRamp();
  }
  return ShadedRelief(grid, options);
}

DrapeSource ToDrape(v1::OpenTerrain::Drape& from) {
  DrapeSource source;
  from.set_path(AbsoluteRaster(from.path()));
  source.path = from.path();
  if (!from.crs().empty()) {
    source.crs = from.crs();
  }
  if (from.extent_size() != 0) {
    if (from.extent_size() != 4) {
      Reject("file '" + from.path() + "'",
             "its extent holds " + std::to_string(from.extent_size()) +
                 " numbers; accepted: 4 (left, top, right, bottom) or none");
    }
    source.extent = {from.extent(0), from.extent(1), from.extent(2), from.extent(3)};
  }
  return source;
}

DrapeImage Draped(const GridTerrain& grid, v1::OpenTerrain::Drape& from) {
  DrapeImage image = WarpImage(PlaceOf(grid), ToDrape(from));
  if (image.coverage.empty()) {
    return image;
  }
  const std::vector<std::string> warnings = image.warnings;
  image = Over(image, ShadedRelief(grid));
  image.warnings = warnings;
  return image;
}

std::shared_ptr<const Image> ToImage(const Context& context, DrapeImage drape,
                                     const std::string& name) {
  for (const std::string& warning : drape.warnings) {
    context.reply.add_warning(warning);
  }
  auto image = std::make_shared<Image>();
  image->name = name;
  image->width = drape.width;
  image->height = drape.height;
  image->channels = 3;
  image->pixels = std::move(drape.pixels);
  return image;
}

// The lights shade it, as they do every other surface.
std::array<double, 3> PlainGround() {
  return ShadedReliefOptions().ramp.front();
}

std::shared_ptr<Material> MattMaterial(const v1::OpenTerrain& command, const std::string& terrain) {
  auto material = std::make_shared<Material>();
  material->name = "terrain";
  material->roughness = 1.0;
  material->repeatTexture = false;
  material->lit = !command.unlit();
  if (command.has_reflectance()) {
    material->reflectance = ToReflectance(command.reflectance(), terrain);
  }
  return material;
}

} // namespace

std::shared_ptr<const Image> RampImage(const ColorRamp& ramp) {
  constexpr int Width = 1024;
  auto image = std::make_shared<Image>();
  image->name = "colours by height";
  image->width = Width;
  image->height = 1;
  image->channels = 3;
  for (int x = 0; x < Width; ++x) {
    const double at = double(x) / (Width - 1) * double(ramp.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(at), ramp.size() - 1);
    const auto high = std::min(low + 1, ramp.size() - 1);
    for (int k = 0; k < 3; ++k) {
      const double value = ramp[low][k] + (at - double(low)) * (ramp[high][k] - ramp[low][k]);
      image->pixels.push_back(static_cast<std::uint8_t>(255.0 * value + 0.5));
    }
  }
  return image;
}

std::shared_ptr<const Material> MeshMaterial(const Context& context, const GridTerrain& grid,
                                             v1::OpenTerrain& command) {
  auto material = MattMaterial(command, grid.GetName());
  if (!command.has_drape() && !command.has_relief()) {
    material->color =
        command.has_color() ? ToColor(command.color(), grid.GetName()) : PlainGround();
    return material;
  }
  material->color = {1, 1, 1};
  material->texture =
      command.has_drape()
          ? ToImage(context, Draped(grid, *command.mutable_drape()), command.drape().path())
          : ToImage(context, Relief(grid, command.relief()), grid.GetName() + " relief");
  return material;
}

ClipmapOptions ClipmapLook(const StreamedTerrain& surface, const v1::OpenTerrain& command) {
  ClipmapOptions options;
  options.postToMap = surface.Info().pixelToMap * surface.PixelToPost().inverse();
  auto material = MattMaterial(command, surface.GetName());
  material->color = PlainGround();
  if (command.has_color()) {
    material->color = ToColor(command.color(), surface.GetName());
  } else if (command.relief().has_sun_azimuth_deg() || command.relief().has_sun_elevation_deg()) {
    Reject(surface.GetName(), "a clipmap's relief is lit by the scene's lights; accepted: no sun "
                              "angles, or mode triangles");
  }
  options.material = material;
  return options;
}

} // namespace dspace::session
