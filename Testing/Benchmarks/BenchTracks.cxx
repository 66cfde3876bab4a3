// Six wheels over kilometres: what a step costs while it is drawn, and what the ruts weigh.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"
#include "vtkNew.h"
#include "vtkRenderWindow.h"
#include "vtkSmartPointer.h"

#include <gdal_priv.h>
#include <unistd.h>

#include <dspace/Error.h>
#include <dspace/clipmap/ClipmapTerrain.h>
#include <dspace/clipmap/gl/ClipmapDrawing.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Alternate.h"

using namespace dspace;

namespace {

constexpr int Side = 2048;    // pixels
constexpr double Pixel = 0.8; // [m]; posts are a 32nd of it apart, 2.5 cm
constexpr double Step = 0.01; // [m] along the path from contact to contact
constexpr double Length = 2000.0;
constexpr int Frames = 150; // drawn of all steps, evenly

std::size_t ResidentBytes() {
  std::ifstream in("/proc/self/statm");
  std::size_t total = 0;
  std::size_t resident = 0;
  in >> total >> resident;
  return resident * std::size_t(::sysconf(_SC_PAGESIZE));
}

std::string Write(const std::string& path) {
  GDALAllRegister();
  GDALDataset* dataset = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path.c_str(), Side, Side, 1, GDT_Float32, nullptr);
  const double half = 0.5 * Side * Pixel;
  double geo[6] = {-half, Pixel, 0.0, half, 0.0, -Pixel};
  dataset->SetGeoTransform(geo);
  std::vector<float> row(Side);
  for (int r = 0; r < Side; ++r) {
    for (int c = 0; c < Side; ++c) {
      row[c] = float(4.0 * std::sin(0.02 * c) * std::cos(0.03 * r));
    }
    if (dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, r, Side, 1, row.data(), Side, 1,
                                            GDT_Float32, 0, 0, nullptr) != CE_None) {
      std::abort();
    }
  }
  GDALClose(dataset);
  return path;
}

// A spiral outwards whose turns lie 4 m apart; the vehicle's place and course after `s` metres.
Eigen::Vector3d Along(double s) {
  const double turn = 4.0 / (2.0 * M_PI);
  const double angle = std::sqrt(2.0 * (s + 20.0) / turn);
  return {turn * angle * std::cos(angle), turn * angle * std::sin(angle),
          angle + std::atan2(angle, 1.0)};
}

std::vector<TrackAddition> StepAt(double s) {
  const Eigen::Vector3d at = Along(s);
  const Eigen::Vector2d ahead(std::cos(at.z()), std::sin(at.z()));
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  std::vector<TrackAddition> wheels(6);
  for (int wheel = 0; wheel < 6; ++wheel) {
    TrackAddition& addition = wheels[wheel];
    addition.name = "wheel " + std::to_string(wheel);
    addition.profile.width = 0.16;
    addition.profile.rimWidth = 0.08;
    addition.profile.rimHeight = 0.01;
    addition.profile.treadPitch = 0.1;
    addition.profile.treadDepth = 0.01;
    TrackContact contact;
    contact.place = at.head<2>() + (wheel / 2 - 1) * 0.6 * ahead + (wheel % 2 - 0.5) * 1.1 * left;
    contact.sinkage = 0.03;
    contact.heading = at.z();
    contact.rolled = s;
    addition.contacts = {contact};
  }
  return wheels;
}

} // namespace

int main() {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() /
                                       ("dspace-bench-tracks-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  StreamedTerrainOptions options;
  options.subdivisions = 5;
  const auto terrain = StreamedTerrain::Open(Write((folder / "field.tif").string()), options);
  {
    vtkNew<vtkDspaceRenderContext> context;
    RegisterClipmapDrawer(context->GetDrawers());
    context->Initialize();
    const auto scene = std::make_shared<Scene>("tracks");
    ClipmapOptions clipmap;
    clipmap.heights = terrain->DrawnHeights();
    GraphicsObject ground;
    ground.name = "ground";
    ground.custom =
        std::make_shared<ClipmapTerrain>(terrain->Pyramid(), terrain->Placement(), clipmap);
    scene->AddObject(ground);
    Light sun;
    sun.name = "sun";
    sun.direction = Eigen::Vector3d(-0.6, 0.3, -0.5).normalized();
    scene->SetLight(sun);
    scene->CreateVantage("main");
    auto viewport = vtkSmartPointer<vtkDspaceViewport>::New();
    const auto look = [&](double s) { // from behind and above the vehicle
      const Eigen::Vector3d at = Along(s);
      const Eigen::Vector3d eye(at.x() - 6.0 * std::cos(at.z()), at.y() - 6.0 * std::sin(at.z()),
                                8.0);
      Camera camera;
      camera.name = "camera";
      camera.projection.nearDistance = 0.1;
      camera.projection.farDistance = 1e5;
      camera.mount.X_FC = LookAt("camera", eye, {at.x(), at.y(), 0.0}, {0, 0, 1});
      scene->SetCamera("main", camera);
    };
    look(0.0);
    viewport->Initialize(context, scene, "tracks", "main", 1280, 720);
    viewport->SetSamples(1);
    viewport->GetCapture({});
    const std::size_t before = ResidentBytes();
    using Clock = std::chrono::steady_clock;
    const auto seconds = [](Clock::time_point since) {
      return std::chrono::duration<double>(Clock::now() - since).count();
    };
    std::vector<double> adds, steps, stills;
    const int count = int(Length / Step);
    for (int i = 0; i < count; ++i) {
      const double s = i * Step;
      const bool drawn = i % (count / Frames) == count / Frames - 1;
      const auto begin = Clock::now();
      terrain->AddTracks(StepAt(s));
      adds.push_back(seconds(begin));
      if (drawn) { // the step and its picture, then a picture of what is there already
        look(s);
        viewport->GetCapture({}); // the camera is here now; tiles came
        const auto step = Clock::now();
        terrain->AddTracks(StepAt(s + 0.5 * Step));
        viewport->GetCapture({});
        steps.push_back(seconds(step));
        const auto still = Clock::now();
        viewport->GetCapture({});
        stills.push_back(seconds(still));
      }
    }
    const TrackStatistics statistics = terrain->Tracks().Statistics();
    std::printf("a step of six wheels: %.4f ms (99%% %.4f ms), %d steps of %.2f m\n",
                1e3 * bench::Median(adds),
                1e3 * (std::nth_element(adds.begin(), adds.begin() + count / 100 * 99, adds.end()),
                       adds[std::size_t(count / 100 * 99)]),
                count, Step);
    std::printf("a step and its picture: %.2f ms; the picture alone %.2f ms (1280 x 720)\n",
                1e3 * bench::Median(steps), 1e3 * bench::Median(stills));
    std::printf("tracks: %.0f m of ruts, %zu contacts kept of %d, %.1f MB of a budget of 64 MiB "
                "(%.0f bytes a metre); %.0f MB resident more than before\n",
                statistics.length, statistics.contacts, 6 * (count + Frames),
                1e-6 * double(statistics.bytes), double(statistics.bytes) / statistics.length,
                1e-6 * (double(ResidentBytes()) - double(before)));
    double s = Length; // then without pictures, until the budget is used up
    try {
      for (; s < 1e5; s += 0.5) {
        terrain->AddTracks(StepAt(s));
      }
    } catch (const Error& error) {
      std::printf("the budget held %.1f km of path: %s\n", 1e-3 * s, error.what());
    }
  }
  std::filesystem::remove_all(folder);
  return 0;
}
