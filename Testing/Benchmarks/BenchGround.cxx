#include "BenchGround.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "vtkDspaceRenderContext.h"

#include <gdal_priv.h>
#include <unistd.h>

#include <dspace/clipmap/ClipmapTerrain.h>
#include <dspace/clipmap/ColorGridsOf.h>
#include <dspace/layers/raster/ImageLayer.h>

namespace dspace::bench {

double Analytic(double column, double row) {
  const double u = 2.0 * M_PI * std::fmod(column, Tile) / Tile;
  const double v = 2.0 * M_PI * std::fmod(row, Tile) / Tile;
  return 60.0 * std::sin(u) * std::cos(v) + 14.0 * std::sin(5.0 * u + 3.0 * v) +
         3.0 * std::sin(23.0 * u) * std::sin(19.0 * v);
}

std::string WriteTile(const std::filesystem::path& folder) {
  GDALAllRegister();
  const std::string path = (folder / "tile.tif").string();
  GDALDataset* dataset = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path.c_str(), Tile, Tile, 1, GDT_Float32, nullptr);
  double geo[6] = {0.0, Pixel, 0.0, 0.0, 0.0, -Pixel};
  dataset->SetGeoTransform(geo);
  std::vector<float> values(std::size_t(Tile) * Tile);
  for (int r = 0; r < Tile; ++r) {
    for (int c = 0; c < Tile; ++c) {
      values[std::size_t(r) * Tile + c] = float(Analytic(c, r));
    }
  }
  if (dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, Tile, Tile, values.data(), Tile, Tile,
                                          GDT_Float32, 0, 0, nullptr) != CE_None) {
    std::abort();
  }
  GDALClose(dataset);
  return path;
}

std::string WriteMosaic(const std::filesystem::path& folder, int width, int height) {
  const std::string path = (folder / "mosaic.vrt").string();
  std::ofstream out(path);
  out << "<VRTDataset rasterXSize=\"" << width << "\" rasterYSize=\"" << height
      << "\"><GeoTransform>0," << Pixel << ",0,0,0," << -Pixel
      << "</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\">";
  for (int y = 0; y < height; y += Tile) {
    for (int x = 0; x < width; x += Tile) {
      out << "<SimpleSource><SourceFilename relativeToVRT=\"1\" "
             "shared=\"0\">tile.tif</SourceFilename>"
             "<SourceBand>1</SourceBand><SourceProperties RasterXSize=\"1024\" "
             "RasterYSize=\"1024\" "
             "DataType=\"Float32\" BlockXSize=\"1024\" BlockYSize=\"2\"/>"
             "<SrcRect xOff=\"0\" yOff=\"0\" xSize=\"1024\" ySize=\"1024\"/><DstRect xOff=\""
          << x << "\" yOff=\"" << y << "\" xSize=\"1024\" ySize=\"1024\"/></SimpleSource>";
    }
  }
  out << "</VRTRasterBand></VRTDataset>";
  return path;
}

std::size_t ResidentBytes() {
  std::ifstream in("/proc/self/statm");
  std::size_t total = 0;
  std::size_t resident = 0;
  in >> total >> resident;
  return resident * std::size_t(::sysconf(_SC_PAGESIZE));
}

std::string WriteImage(const std::filesystem::path& folder) {
  constexpr int Side = 4096;
  const std::string path = (folder / "image.tif").string();
  char** options = CSLSetNameValue(nullptr, "TILED", "YES");
  GDALDataset* dataset = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path.c_str(), Side, Side, 3, GDT_Byte, options);
  CSLDestroy(options);
  std::vector<std::uint8_t> pixels(std::size_t(Side) * Side);
  for (int band = 1; band <= 3; ++band) {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const std::uint32_t c = i % Side, r = std::uint32_t(i / Side);
      const std::uint32_t noise =
          (c * 2654435761u ^ r * 2246822519u) * 3266489917u * unsigned(band);
      pixels[i] = std::uint8_t(64 + (c / 64 + r / 48) % 64 + (noise >> 25));
    }
    if (dataset->GetRasterBand(band)->RasterIO(GF_Write, 0, 0, Side, Side, pixels.data(), Side,
                                               Side, GDT_Byte, 0, 0, nullptr) != CE_None) {
      std::abort();
    }
  }
  int levels[] = {2, 4, 8, 16};
  dataset->BuildOverviews("AVERAGE", 4, levels, 0, nullptr, nullptr, nullptr);
  GDALClose(dataset);
  return path;
}

Eigen::Vector3d SunDirection() {
  return Eigen::Vector3d(-0.6, 0.3, -0.5).normalized();
}

Ground::Ground(vtkDspaceRenderContext* context, const std::string& path, bool lit, Paint paint,
               int levelSize)
    : cells(levelSize) {
  surface = StreamedTerrain::Open(path);
  ClipmapOptions options;
  options.cells = cells;
  options.heights = surface->HeightRange();
  auto material = std::make_shared<Material>();
  material->color = {0.8, 0.7, 0.6};
  material->roughness = 1.0;
  material->lit = lit;
  if (paint == Paint::Texture) {
    auto image = std::make_shared<Image>();
    image->width = image->height = 2048;
    image->channels = 3;
    for (std::size_t i = 0; i < std::size_t(3) * 2048 * 2048; ++i) {
      image->pixels.push_back(std::uint8_t((i * 2654435761u) >> 24));
    }
    material->texture = image;
    options.postToTexture = Eigen::Affine2d(Eigen::Scaling(1.0 / 1024, -1.0 / 1024));
  }
  options.material = material;
  GraphicsObject ground;
  ground.name = "ground";
  const auto terrain =
      std::make_shared<ClipmapTerrain>(surface->Pyramid(), surface->Placement(), options,
                                       std::vector<ClipmapChart>(), ColorGridsOf(*surface, {}));
  if (paint == Paint::Layer) { // stretched over all of the raster
    const ElevationInfo& info = surface->Info();
    const std::filesystem::path image = std::filesystem::path(path).parent_path() / "image.tif";
    StackedLayer layer;
    layer.name = "image";
    layer.layer = OpenImageLayer(image.string(), {surface->GetName(), info.crs, info.pixelToMap,
                                                  info.window.width, info.window.height});
    terrain->Layers()->Add(layer);
  }
  ground.custom = terrain;
  object = scene->AddObject(ground);
  Light sun;
  sun.name = "sun";
  sun.direction = SunDirection();
  scene->SetLight(sun);
  scene->CreateVantage("main");
  Fly(0.0);
  viewport->Initialize(context, scene, "ground", "main", Width, Height);
  viewport->SetSamples(1);
  viewport->GetCapture({}); // all tiles are there
}

void Ground::Fly(double t) {
  Camera camera;
  camera.name = "camera";
  camera.projection.verticalFov_deg = 60.0;
  camera.projection.nearDistance = 0.1;
  camera.projection.farDistance = 1e7;
  const Eigen::Vector3d eye(t, 0.3 * t, 120.0);
  camera.mount.X_FC = LookAt("camera", eye, eye + Eigen::Vector3d(1.0, 0.35, -down), {0, 0, 1});
  scene->SetCamera("main", camera);
}

double PixelErrors::Rms() const {
  double sum = 0.0;
  for (const double e : this->all) {
    sum += e * e;
  }
  return std::sqrt(sum / double(this->all.size()));
}

double PixelErrors::Share(double part) const {
  std::vector<double> sorted = this->all;
  std::sort(sorted.begin(), sorted.end());
  return sorted[std::size_t(part * double(sorted.size() - 1))];
}

double PixelErrors::Greatest() const {
  return *std::max_element(this->all.begin(), this->all.end());
}

} // namespace dspace::bench
