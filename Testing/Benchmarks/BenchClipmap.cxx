// Clipmap frames: against bare OpenGL, on a small and on a huge raster, and what they err by.
#include <cmath>
#include <cstdio>
#include <filesystem>
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

#include <dspace/clipmap/gl/ClipmapDrawing.h>

#include "Alternate.h"
#include "BenchGround.h"
#include "ReplayedDraws.h"

using namespace dspace;
using namespace dspace::bench;

namespace {

void AgainstBare(vtkDspaceRenderContext* context, const std::string& path, bool lit, Paint paint,
                 int pairs, const char* name, const char* goal) {
  Ground ground(context, path, lit, paint);
  ReplayedDraws replay;
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
  const Turns turns = Alternate(pairs, ours, bare);
  char behind[160];
  std::snprintf(behind, sizeof behind, "%zu triangles in %zu draws, goal %s", replay.Triangles(),
                replay.Count(), goal);
  Print(name, turns, 1, behind);
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
    Print(down < 0.5 ? "frame with one colour layer against one texture"
                     : "the same, the ground filling the picture",
          Alternate(
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
  const Turns turns = Alternate(
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
      1.0 / Median(turns.subject), 1.0 / Median(turns.reference),
      static_cast<unsigned long long>(incomplete));
  Print("clipmap frame, 92160 x 46080 against 1024 x 1024", turns, 1, behind);
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
  const Turns turns = Alternate(
      pairs,
      [&] {
        ground.viewport->ForceRender();
        finish();
      },
      [&] {
        viewport->ForceRender();
        finish();
      });
  Print("clipmap frame against all posts as a vtkActor", turns, 1,
        "2093058 triangles in the mesh; lit; the error of the clipmap stands below");
}

// At distances of the coarser rings: against the surface that is stated.
PixelErrors ScreenSpaceError(Ground& ground) {
  CaptureRequest request;
  request.depth = true;
  PixelErrors errors;
  AddErrors(errors, ground.viewport->GetCapture(request).depth,
            ground.scene->Vantage("main").ActiveCamera(), [&](const Eigen::Vector3d& p) {
              const SurfaceSample sample = ground.surface->Sample(p);
              return sample.valid ? sample.position_S.z() : std::nan("");
            });
  return errors;
}

// Levels of 252 cells against the default's 124: what finer ground costs, and what it gains.
void LevelSizes(vtkDspaceRenderContext* context, const std::string& path, int pairs) {
  Ground fine(context, path, true, Paint::None, 252);
  Ground usual(context, path, true, Paint::None, 124);
  const auto draw = [context](Ground& ground) {
    ground.viewport->ForceRender();
    context->GetRenderWindow()->WaitForCompletion();
  };
  Print("clipmap frame, level size 252 against 124",
        Alternate(
            pairs, [&] { draw(fine); }, [&] { draw(usual); }),
        1, "lit");
  for (Ground* ground : {&usual, &fine}) {
    const PixelErrors errors = ScreenSpaceError(*ground);
    std::printf("screen-space error against the full-resolution surface, level size %d: rms %.3f, "
                "99%% %.3f, greatest %.2f pixels over %zu pixels\n",
                ground == &usual ? 124 : 252, errors.Rms(), errors.Share(0.99), errors.Greatest(),
                errors.all.size());
  }
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
  const Turns turns = Alternate(
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
  std::snprintf(behind, sizeof behind, "%.2g queries a second", Count / Median(turns.subject));
  Print("height queries against GDAL's RasterIO of four posts", turns, Count, behind);
  GDALClose(dataset);
  if (sum == 0.123) {
    std::puts(""); // the sum is used
  }
}

} // namespace

int main() {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("dspace-bench-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::string small = WriteTile(folder);
  const std::string huge = WriteMosaic(folder, 92160, 46080);
  WriteImage(folder);
  {
    vtkNew<vtkDspaceRenderContext> context;
    RegisterClipmapDrawer(context->GetDrawers());
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
    LevelSizes(context, small, 15);
    SmallAndHuge(context, small, huge, 101);
  }
  HeightQueries(small, 7);
  std::filesystem::remove_all(folder);
  return 0;
}
