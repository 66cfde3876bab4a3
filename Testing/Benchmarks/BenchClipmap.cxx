// Clipmap frames: against bare OpenGL, on a small and on a huge raster, and what they err by.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

#include "vtkActor.h"
#include "vtkCellArray.h"
#include "vtkDspaceHubWindow.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"
#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkOpenGLState.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"

#include <gdal_priv.h>
#include <unistd.h>

#include <dspace/layers/ImageLayer.h>
#include <dspace/terrain/ClipmapDrawer.h>
#include <dspace/terrain/ClipmapTerrain.h>
#include <dspace/terrain/StreamedTerrain.h>

#include "Alternate.h"
#include "ReplayedDraws.h"

using namespace dspace;

namespace {

constexpr int Width = 1280;
constexpr int Height = 720;
constexpr int Tile = 1024;    // pixels a side of what the rasters repeat
constexpr double Pixel = 2.0; // [m]

// Periodic in a tile, so that it may be repeated.
double Analytic(int column, int row) {
  const double u = 2.0 * M_PI * (column % Tile) / Tile;
  const double v = 2.0 * M_PI * (row % Tile) / Tile;
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

// The tile again and again: a raster of any size that takes no space.
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

// Colours with structure at every scale.
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

// What colours the ground besides its material.
enum class Paint { None, Texture, Layer }; // one mip-mapped texture; a streamed colour layer

// A scene with one clipmap, lit by a sun.
struct Ground {
  std::shared_ptr<Scene> scene = std::make_shared<Scene>("ground");
  std::shared_ptr<const StreamedTerrain> surface;
  vtkSmartPointer<vtkDspaceViewport> viewport = vtkSmartPointer<vtkDspaceViewport>::New();
  ObjectId object = 0;

  Ground(vtkDspaceRenderContext* context, const std::string& path, bool lit, Paint paint) {
    surface = StreamedTerrain::Open(path);
    ClipmapOptions options;
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
    sun.direction = Eigen::Vector3d(-0.6, 0.3, -0.5).normalized();
    scene->SetLight(sun);
    scene->CreateVantage("main");
    Fly(0.0);
    viewport->Initialize(context, scene, "ground", "main", Width, Height);
    viewport->SetSamples(1);
    viewport->GetCapture({}); // all tiles are there
  }
  // `t` metres along a line over the ground's middle.
  double down = 0.25; // of the look: the horizon is in sight
  void Fly(double t) {
    Camera camera;
    camera.name = "camera";
    camera.projection.verticalFov_deg = 60.0;
    camera.projection.nearDistance = 0.1;
    camera.projection.farDistance = 1e7;
    const Eigen::Vector3d eye(t, 0.3 * t, 120.0);
    camera.mount.X_FC = LookAt("camera", eye, eye + Eigen::Vector3d(1.0, 0.35, -down), {0, 0, 1});
    scene->SetCamera("main", camera);
  }
};

void AgainstBare(vtkDspaceRenderContext* context, const std::string& path, bool lit, Paint paint,
                 int pairs, const char* name, const char* goal) {
  Ground ground(context, path, lit, paint);
  bench::ReplayedDraws replay;
  replay.Begin();
  ground.viewport->ForceRender();
  replay.End();
  const float clear[4] = {0, 0, 0, 1};
  const auto ours = [&] {
    ground.viewport->ForceRender();
    context->GetRenderWindow()->WaitForCompletion();
  };
  const auto bare = [&] {
    context->GetHub()->MakeCurrent();
    context->GetHub()->GetState()->PushFramebufferBindings();
    replay.Replay(clear);
    glFinish();
    context->GetHub()->GetState()->Reset();
    context->GetHub()->GetState()->PopFramebufferBindings();
  };
  const bench::Turns turns = bench::Alternate(pairs, ours, bare);
  char behind[160];
  std::snprintf(behind, sizeof behind, "%zu triangles in %zu draws, goal %s", replay.Triangles(),
                replay.Count(), goal);
  bench::Print(name, turns, 1, behind);
}

// The same camera: a streamed layer, sharp wherever the camera goes, and one mip-mapped texture.
void LayerAgainstTexture(vtkDspaceRenderContext* context, const std::string& path, int pairs) {
  Ground layer(context, path, true, Paint::Layer);
  Ground texture(context, path, true, Paint::Texture);
  for (const double down : {0.25, 1.0}) {
    layer.down = texture.down = down;
    layer.Fly(0.0);
    texture.Fly(0.0);
    layer.viewport->GetCapture({});
    texture.viewport->GetCapture({});
    const auto draw = [context](Ground& ground) {
      ground.viewport->ForceRender();
      context->GetRenderWindow()->WaitForCompletion();
    };
    bench::Print(down < 0.5 ? "frame with one colour layer against one texture"
                            : "the same, the ground filling the picture",
                 bench::Alternate(
                     pairs, [&] { draw(layer); }, [&] { draw(texture); }),
                 1, "lit");
  }
}

void SmallAndHuge(vtkDspaceRenderContext* context, const std::string& small,
                  const std::string& huge, int pairs) {
  const auto begin = std::chrono::steady_clock::now();
  StreamedTerrain::Open(huge);
  std::printf("opening 92160 x 46080: %.0f ms, goal < 1 s\n",
              1e3 *
                  std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  Ground a(context, huge, true, Paint::Layer);
  Ground b(context, small, true, Paint::Layer);
  std::size_t peak = 0;
  a.down = b.down = 1.0; // both fill the picture
  double t = 0.0;
  std::uint64_t incomplete = 0;
  const auto fly = [&](Ground& ground) {
    ground.Fly(t);
    ground.viewport->ForceRender();
    context->GetRenderWindow()->WaitForCompletion();
    peak = std::max(peak, ResidentBytes());
  };
  const bench::Turns turns = bench::Alternate(
      pairs,
      [&] {
        t += 2.0;
        fly(a);
        incomplete += a.surface->Pyramid()->Statistics().pending > 0;
      },
      [&] { fly(b); });
  char behind[200];
  std::snprintf(
      behind, sizeof behind,
      "moving 2 m a frame, lit, one colour layer; %.0f and %.0f frames a second, goal 30; "
      "%llu frames with tiles on their way; goal <= 1.1",
      1.0 / bench::Median(turns.subject), 1.0 / bench::Median(turns.reference),
      static_cast<unsigned long long>(incomplete));
  bench::Print("clipmap frame, 92160 x 46080 against 1024 x 1024", turns, 1, behind);
  const ElevationPyramidStatistics statistics = a.surface->Pyramid()->Statistics();
  std::printf("memory: %.0f MB resident at most, tiles %.1f MB of a budget of 256 MB\n",
              1e-6 * peak, 1e-6 * statistics.bytes);

  std::mt19937 random(1);
  std::uniform_int_distribution<int> column(0, 92159), row(0, 46079);
  double worst = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const int c = column(random), r = row(random);
    const double height = a.surface->SampleMap({(c + 0.5) * Pixel, -(r + 0.5) * Pixel}).height;
    worst = std::max(worst, std::abs(height - Analytic(c, r)));
  }
  std::printf("1000 random heights of the huge raster: at most %.2g m from the formula\n", worst);
}

// All posts of the small raster as one mesh in a plain vtkActor, from the same camera.
void AgainstMesh(vtkDspaceRenderContext* context, const std::string& path, int pairs) {
  Ground ground(context, path, true, Paint::None);
  auto plain = std::make_shared<Scene>("plain");
  plain->CreateVantage("main");
  plain->SetCamera("main", ground.scene->Vantage("main").ActiveCamera());
  plain->SetLight(ground.scene->Fragments().Lights().front());
  auto viewport = vtkSmartPointer<vtkDspaceViewport>::New();
  viewport->Initialize(context, plain, "plain", "main", Width, Height);
  viewport->SetSamples(1);
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> normals;
  normals->SetNumberOfComponents(3);
  vtkNew<vtkCellArray> triangles;
  const PostPlacement& placement = ground.surface->Placement();
  for (int r = 0; r < Tile; ++r) {
    for (int c = 0; c < Tile; ++c) {
      const Eigen::Vector3d p = placement.ToScene({double(c), double(r)}, Analytic(c, r));
      const double dx = (Analytic(c + 1, r) - Analytic(c + Tile - 1, r)) / (2.0 * Pixel);
      const double dy = (Analytic(c, r + Tile - 1) - Analytic(c, r + 1)) / (2.0 * Pixel);
      const Eigen::Vector3d n = Eigen::Vector3d(-dx, -dy, 1.0).normalized();
      points->InsertNextPoint(p.data());
      normals->InsertNextTuple(n.data());
      if (r + 1 < Tile && c + 1 < Tile) {
        const vtkIdType a = vtkIdType(r) * Tile + c;
        const vtkIdType below[3] = {a, a + Tile, a + Tile + 1};
        const vtkIdType above[3] = {a, a + Tile + 1, a + 1};
        triangles->InsertNextCell(3, below);
        triangles->InsertNextCell(3, above);
      }
    }
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->GetPointData()->SetNormals(normals);
  data->SetPolys(triangles);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->SetStatic(1);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  viewport->GetRenderer()->AddActor(actor);
  const auto finish = [context] { context->GetRenderWindow()->WaitForCompletion(); };
  const bench::Turns turns = bench::Alternate(
      pairs,
      [&] {
        ground.viewport->ForceRender();
        finish();
      },
      [&] {
        viewport->ForceRender();
        finish();
      });
  bench::Print("clipmap frame against all posts as a vtkActor", turns, 1,
               "2093058 triangles in the mesh; lit; the error of the clipmap stands below");
}

// Pixels between what is drawn and what is stated, up and down the screen, at distances of the
// coarser rings: the surface's height where a pixel's ray met the clipmap, over metres a pixel.
void ScreenSpaceError(vtkDspaceRenderContext* context, const std::string& path) {
  Ground ground(context, path, false, Paint::None);
  CaptureRequest request;
  request.depth = true;
  const Capture capture = ground.viewport->GetCapture(request);
  const Camera& camera = ground.scene->Vantage("main").ActiveCamera();
  const Pose X = ground.scene->PlaceCamera("main").X_FC;
  std::vector<double> errors;
  for (int y = 0; y < Height; y += 4) {
    for (int x = 0; x < Width; x += 4) {
      const float depth = capture.depth[std::size_t(y) * Width + x];
      if (!std::isfinite(depth)) {
        continue;
      }
      const Projection::Ray ray = camera.projection.PixelRay(x, y, Width, Height);
      const Eigen::Vector3d p = X.Apply(ray.direction * (double(depth) / ray.direction.z()));
      const SurfaceSample sample = ground.surface->Sample(p);
      if (sample.valid) {
        const double metres = camera.projection.MetresPerPixel(depth, Height);
        errors.push_back(std::abs(p.z() - sample.position_S.z()) / metres);
      }
    }
  }
  std::sort(errors.begin(), errors.end());
  double sum = 0.0;
  for (const double e : errors) {
    sum += e * e;
  }
  std::printf(
      "screen-space error against the full-resolution surface: rms %.3f, 99%% %.3f, greatest "
      "%.2f pixels over %zu pixels\n",
      std::sqrt(sum / double(errors.size())), errors[errors.size() * 99 / 100], errors.back(),
      errors.size());
}

void HeightQueries(const std::string& path, int pairs) {
  const auto surface = StreamedTerrain::Open(path);
  constexpr int Count = 200000;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(2.0, Tile * Pixel - 4.0);
  Rows2 points(Count, 2);
  for (int i = 0; i < Count; ++i) {
    points.row(i) << place(random), -place(random);
  }
  Eigen::VectorXd heights(Count);
  GDALDataset* dataset = GDALDataset::Open(path.c_str());
  GDALRasterBand* band = dataset->GetRasterBand(1);
  double sum = 0.0;
  const bench::Turns turns = bench::Alternate(
      pairs, [&] { surface->HeightsMap(points, heights); },
      [&] { // the four posts about each point, as a script would read them; GDAL caches blocks
        for (int i = 0; i < Count; ++i) {
          float posts[4];
          const int c = int(points(i, 0) / Pixel - 0.5), r = int(-points(i, 1) / Pixel - 0.5);
          if (band->RasterIO(GF_Read, c, r, 2, 2, posts, 2, 2, GDT_Float32, 0, 0, nullptr) ==
              CE_None) {
            sum += posts[0];
          }
        }
      });
  char behind[120];
  std::snprintf(behind, sizeof behind, "%.2g queries a second",
                Count / bench::Median(turns.subject));
  bench::Print("height queries against GDAL's RasterIO of four posts", turns, Count, behind);
  GDALClose(dataset);
  if (sum == 0.123) {
    std::puts(""); // the sum is used
  }
}

} // namespace

int main() {
  RegisterClipmapDrawer();
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("dspace-bench-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::string small = WriteTile(folder);
  const std::string huge = WriteMosaic(folder, 92160, 46080);
  WriteImage(folder);
  {
    vtkNew<vtkDspaceRenderContext> context;
    context->Initialize();
    std::printf("renderer: %s\n", context->GetRendererName().c_str());
    AgainstBare(context, small, false, Paint::None, 31, "clipmap frame unlit against bare OpenGL",
                "<= 1.05");
    AgainstBare(context, small, true, Paint::None, 31, "clipmap frame lit against bare OpenGL",
                "<= 1.15");
    AgainstBare(context, small, true, Paint::Texture, 31,
                "clipmap frame lit, one texture, against bare OpenGL", "<= 1.15");
    AgainstBare(context, small, true, Paint::Layer, 31,
                "clipmap frame lit, one colour layer, against bare OpenGL", "<= 1.15");
    LayerAgainstTexture(context, small, 31);
    AgainstMesh(context, small, 15);
    ScreenSpaceError(context, small);
    SmallAndHuge(context, small, huge, 101);
  }
  HeightQueries(small, 7);
  std::filesystem::remove_all(folder);
  return 0;
}
