// Clipmap frames against OpenSceneGraph's osgTerrain at equal screen-space error, on one flight.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "vtkDspaceHubWindow.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"
#include "vtkNew.h"

#include <malloc.h>
#include <unistd.h>

#include <dspace/clipmap/gl/ClipmapDrawing.h>

#include "Alternate.h"
#include "BenchGround.h"
#include "OsgGround.h"
#include "ReplayedDraws.h"

using namespace dspace;
using namespace dspace::bench;

namespace {

constexpr int Side = 8192; // posts of the ground: 16.4 km
constexpr double Share = 0.99;
constexpr int UsualCells = 64;     // a side of osgdem's tiles
constexpr double Tolerance = 0.15; // of what equal errors may differ by

void WritePicture(const char* name, int size, const std::vector<std::uint8_t>& pixels,
                  int channels) {
  const char* folder = std::getenv("DSPACE_BENCH_PICTURES"); // PPMs go there
  if (!folder) {
    return;
  }
  std::ofstream out(std::filesystem::path(folder) / (name + std::to_string(size) + ".ppm"));
  out << "P6\n" << Width << " " << Height << "\n255\n";
  for (std::size_t i = 0; i < std::size_t(Width) * Height; ++i) {
    out.write(reinterpret_cast<const char*>(&pixels[i * std::size_t(channels)]), 3);
  }
}

// Both sides look from the same places.
struct Flight {
  Ground& ground;
  vtkDspaceRenderContext* context;

  const Camera& To(double t, OsgGround* osg) {
    this->ground.Fly(t);
    const Camera& camera = this->ground.scene->Vantage("main").ActiveCamera();
    const Pose& X = camera.mount.X_FC;
    if (osg) {
      osg->Look(X.Apply(Eigen::Vector3d::Zero()), X.Apply(Eigen::Vector3d::UnitZ()));
    }
    return camera;
  }
  void Draw() {
    this->ground.viewport->ForceRender();
    this->context->GetRenderWindow()->WaitForCompletion();
  }
};

// The formula itself, between posts, too: it favours neither side's choice of diagonals.
double FormulaAt(const Ground& ground, const Eigen::Vector3d& p) {
  const Eigen::Vector2d post =
      ground.surface->Placement().PostToScene().inverse() * Eigen::Vector2d(p.x(), p.y());
  const bool inside = post.minCoeff() >= 0.0 && post.maxCoeff() <= Side - 1;
  return inside ? Analytic(post.x(), post.y()) : std::nan("");
}

// [m] along the flight; away from the ground's middle, where tiles of every size meet.
constexpr double Begin = 700.0, Length = 210.0;
constexpr double Places[] = {Begin, Begin + 70.0, Begin + 140.0, Begin + Length};

PixelErrors OurErrors(Flight& flight) {
  PixelErrors errors;
  CaptureRequest request;
  request.depth = true;
  for (const double t : Places) {
    const Camera& camera = flight.To(t, nullptr);
    const Capture capture = flight.ground.viewport->GetCapture(request);
    AddErrors(errors, capture.depth, camera,
              [&](const Eigen::Vector3d& p) { return FormulaAt(flight.ground, p); });
  }
  return errors;
}

PixelErrors OsgErrors(Flight& flight, OsgGround& osg) {
  PixelErrors errors;
  for (const double t : Places) {
    const Camera& camera = flight.To(t, &osg);
    osg.Complete();
    AddErrors(errors, osg.Depth(), camera,
              [&](const Eigen::Vector3d& p) { return FormulaAt(flight.ground, p); });
  }
  return errors;
}

OsgGroundOptions OsgOptions(const Ground& ground, int cells, double ratio) {
  OsgGroundOptions options;
  options.cells = cells;
  options.side = Side;
  options.pixel = Pixel;
  options.northWest = ground.surface->Placement().ToScene({0.0, 0.0}, 0.0).head<2>();
  options.height = [](int column, int row) { return Analytic(column, row); };
  options.sun = SunDirection();
  options.ratio = ratio;
  return options;
}

// What osgTerrain is to be compared with: tiles of some size, and how near they are refined.
struct Choice {
  int cells = 0;
  double ratio = 0.0;
  double error = 0.0; // 99 % [pixels]
  std::size_t triangles = 0;
};

// The ratio with which the error is `goal`: a larger one is finer, in steps of whole tiles. Below
// 1.1 a tile that the camera is above may stay coarse.
Choice Matched(Flight& flight, int cells, double goal) {
  double low = std::log(1.1), high = std::log(8.0);
  Choice best;
  for (int i = 0; i < 6; ++i) {
    const double middle = i == 0 ? low : 0.5 * (low + high);
    OsgGround osg(OsgOptions(flight.ground, cells, std::exp(middle)));
    const double error = OsgErrors(flight, osg).Share(Share);
    if (best.cells == 0 || std::abs(error - goal) < std::abs(best.error - goal)) {
      best = {cells, std::exp(middle), error, osg.Triangles()};
    }
    if (i == 0 && error < goal) {
      break; // as coarse as such tiles can be
    }
    (error > goal ? low : high) = middle;
  }
  return best;
}

// Of those whose error is the clipmap's, the one with the fewest triangles, else the nearest; and
// the one of the size that osgdem makes.
std::vector<Choice> Choices(Flight& flight, double goal) {
  const auto miss = [goal](const Choice& c) { return std::abs(c.error / goal - 1.0); };
  Choice best, usual;
  for (const int cells : {16, 24, 32, 48, UsualCells, 128}) {
    const Choice choice = Matched(flight, cells, goal);
    std::printf("  tiles of %d cells, refined within %.2f radii: 99%% %.3f pixels, %zu triangles\n",
                cells, choice.ratio, choice.error, choice.triangles);
    const bool equal = miss(choice) <= Tolerance, had = best.cells && miss(best) <= Tolerance;
    if (best.cells == 0 ||
        (equal && had ? choice.triangles < best.triangles : miss(choice) < miss(best))) {
      best = choice;
    }
    if (cells == UsualCells) {
      usual = choice;
    }
  }
  if (best.cells == UsualCells) {
    return {best};
  }
  return {best, usual};
}

void Print(const char* who, const PixelErrors& errors) {
  std::printf(
      "  %s: screen-space error rms %.3f, 99%% %.3f, greatest %.2f pixels over %zu pixels\n", who,
      errors.Rms(), errors.Share(Share), errors.Greatest(), errors.all.size());
}

double Megabytes() {
  malloc_trim(0);
  return 1e-6 * double(ResidentBytes());
}

void AgainstTiles(Flight& flight, const PixelErrors& ours, const Choice& choice, int pairs) {
  Ground& ground = flight.ground;
  const double before = Megabytes();
  OsgGround osg(OsgOptions(ground, choice.cells, choice.ratio));
  const PixelErrors theirs = OsgErrors(flight, osg);
  const double bytes = Megabytes() - before;

  flight.To(Begin, &osg);
  ReplayedDraws draws;
  const Capture picture = ground.viewport->GetCapture({});
  draws.Begin();
  flight.Draw();
  draws.End();
  osg.Complete();
  WritePicture("clipmap", ground.cells, picture.color, 4);
  WritePicture("osg", choice.cells, osg.Color(), 3);
  std::printf(
      "clipmap of level size %d against osgTerrain in tiles of %d cells, refined within %.2f "
      "radii (osgdem: 7): %zu and %zu triangles; osgTerrain's took %.0f MB resident\n",
      ground.cells, choice.cells, choice.ratio, draws.Triangles(), osg.Triangles(), bytes);
  Print("clipmap", ours);
  Print("osgTerrain", theirs);
  const double equal = theirs.Share(Share) / ours.Share(Share);
  if (std::abs(equal - 1.0) > Tolerance) {
    std::printf("  the errors are NOT equal: osgTerrain's is %.2f times the clipmap's\n", equal);
  }
  for (const bool pixels : {false, true}) {
    osg.LightPixels(pixels);
    int drawn = 0, late = 0;
    const auto place = [&] { return Begin + Length * (drawn++ / 2) / (pairs + 1); };
    const Turns turns = Alternate(
        pairs,
        [&] {
          flight.To(place(), nullptr);
          flight.Draw();
        },
        [&] {
          flight.To(place(), &osg);
          osg.Draw();
          late += osg.Pending();
        });
    char behind[120];
    std::snprintf(behind, sizeof behind, "%d of osgTerrain's frames had tiles on their way", late);
    bench::Print(pixels ? "  frame, both lit in each pixel"
                        : "  frame, osgTerrain lit at vertices (its default)",
                 turns, 1, behind);
  }
}

void Compare(vtkDspaceRenderContext* context, const std::string& path, int level, int pairs) {
  const double before = Megabytes();
  Ground ground(context, path, true, Paint::None, level);
  Flight flight{ground, context};
  const PixelErrors ours = OurErrors(flight);
  std::printf("clipmap of level size %d: 99%% %.3f pixels; resident memory grew by %.0f MB; "
              "osgTerrain to match:\n",
              level, ours.Share(Share), Megabytes() - before);
  for (const Choice& choice : Choices(flight, ours.Share(Share))) {
    AgainstTiles(flight, ours, choice, pairs);
  }
}

} // namespace

int main() {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("dspace-bench-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  WriteTile(folder);
  const std::string path = WriteMosaic(folder, Side, Side);
  {
    vtkNew<vtkDspaceRenderContext> context;
    RegisterClipmapDrawer(context->GetDrawers());
    context->Initialize();
    std::printf("renderer: %s\n", context->GetRendererName().c_str());
    for (const int level : {124, 252}) {
      Compare(context, path, level, 61);
    }
  }
  std::filesystem::remove_all(folder);
  return 0;
}
