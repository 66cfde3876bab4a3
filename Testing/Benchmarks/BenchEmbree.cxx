// Horizon maps and lines of sight against Embree's rays over the same triangles.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <random>
#include <vector>

#include <embree3/rtcore.h>
#include <unistd.h>

#include <dspace/maps/HorizonMap.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Alternate.h"
#include "BenchHills.h"

using namespace dspace;

namespace {

constexpr int Side = 1024;    // pixels
constexpr double Pixel = 5.0; // [m]
constexpr int Azimuths = 360;
constexpr double Step = 0.25; // [deg] of the reference's elevations

// The terrain's triangles, in floats about the raster's middle: a cell has the diagonal from its
// north-west to its south-east post, as the terrain has.
class EmbreeGround {
public:
  explicit EmbreeGround(const TerrainSurface& surface, const PostPlacement& placement)
      : Device_(rtcNewDevice("threads=1")), Scene_(rtcNewScene(this->Device_)) {
    RTCGeometry geometry = rtcNewGeometry(this->Device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), std::size_t(Side) * Side));
    auto* indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), std::size_t(Side - 1) * (Side - 1) * 2));
    this->Middle_ = placement.ToScene({0.5 * Side, 0.5 * Side}, 0.0);
    for (int r = 0; r < Side; ++r) {
      for (int c = 0; c < Side; ++c) {
        Eigen::Vector3d p_S = placement.ToScene({double(c), double(r)}, 0.0);
        p_S.z() = surface.Sample(p_S).height;
        for (int k = 0; k < 3; ++k) {
          *vertices++ = float(p_S[k] - this->Middle_[k]);
        }
      }
    }
    const auto at = [](int c, int r) { return unsigned(r) * Side + unsigned(c); };
    for (int r = 0; r + 1 < Side; ++r) {
      for (int c = 0; c + 1 < Side; ++c) {
        for (const unsigned corner :
             {at(c, r), at(c, r + 1), at(c + 1, r + 1), at(c, r), at(c + 1, r + 1), at(c + 1, r)}) {
          *indices++ = corner;
        }
      }
    }
    rtcSetSceneFlags(this->Scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(this->Scene_, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(this->Scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(this->Scene_);
  }
  ~EmbreeGround() {
    rtcReleaseScene(this->Scene_);
    rtcReleaseDevice(this->Device_);
  }
  EmbreeGround(const EmbreeGround&) = delete;
  EmbreeGround& operator=(const EmbreeGround&) = delete;

  bool Blocks(const Eigen::Vector3d& from_S, const Eigen::Vector3d& direction_S,
              double distance = std::numeric_limits<double>::infinity()) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    RTCRay ray = {};
    ray.org_x = float(from_S.x() - this->Middle_.x());
    ray.org_y = float(from_S.y() - this->Middle_.y());
    ray.org_z = float(from_S.z() - this->Middle_.z());
    ray.dir_x = float(direction_S.x());
    ray.dir_y = float(direction_S.y());
    ray.dir_z = float(direction_S.z());
    ray.tfar = float(distance);
    ray.mask = ~0u;
    rtcOccluded1(this->Scene_, &context, &ray);
    ++this->Rays_;
    return ray.tfar < 0.0f;
  }
  std::size_t Rays() const { return this->Rays_; }

private:
  RTCDevice Device_;
  RTCScene Scene_;
  Eigen::Vector3d Middle_;
  std::size_t Rays_ = 0;
};

// The horizon of a place as Steger et al. 2022 (HORAYZON, section 2.3) find it: in each azimuth the
// search begins at the elevation of the one before, and goes up or down by steps until a ray that
// is blocked and one that is free enclose it.
class Seeded {
public:
  Seeded(EmbreeGround& ground) : Ground_(ground) {
    for (int k = 0; k < Azimuths; ++k) {
      const double azimuth = 2.0 * M_PI * k / Azimuths;
      this->Ways_.emplace_back(std::sin(azimuth), std::cos(azimuth));
    }
    for (int i = -Steps; i <= Steps; ++i) {
      const double elevation = i * Step * M_PI / 180.0;
      this->Angles_.emplace_back(std::cos(elevation), std::sin(elevation));
    }
  }

  double operator()(const Eigen::Vector3d& from_S) {
    double sum = 0.0;
    int i = Steps; // elevation 0
    for (const Eigen::Vector2d& way : this->Ways_) {
      const auto blocked = [&](int at) {
        const Eigen::Vector2d& angle = this->Angles_[std::size_t(at)];
        return this->Ground_.Blocks(from_S, {way.x() * angle.x(), way.y() * angle.x(), angle.y()});
      };
      if (blocked(i)) {
        while (blocked(++i)) {
        }
      } else {
        while (i > 1 && !blocked(i - 1)) {
          --i;
        }
      }
      sum += (i - 0.5 - Steps) * Step;
    }
    return sum / Azimuths;
  }

private:
  static constexpr int Steps = int(89.0 / Step);
  EmbreeGround& Ground_;
  std::vector<Eigen::Vector2d> Ways_;
  std::vector<Eigen::Vector2d> Angles_; // cosine and sine
};

void Horizons(const MapGround& ground, const TerrainSurface& surface, EmbreeGround& embree,
              const std::string& path, bool fast) {
  constexpr int Cells = 256;
  constexpr int Apart = 8; // of those that Embree's rays are sent from
  HorizonMapOptions options;
  options.cells.column = 300;
  options.cells.row = 400;
  options.cells.columns = options.cells.rows = Cells;
  options.height = 2.0;
  options.azimuths = Azimuths;
  options.fast = fast;
  MapControl control;
  control.threads = 1;
  control.replace = true;
  std::vector<Eigen::Vector3d> places;
  for (int j = 0; j < Cells; j += Apart) {
    for (int i = 0; i < Cells; i += Apart) {
      Eigen::Vector3d p_S = ground.placement.ToScene(options.cells.Post(i, j), 0.0);
      p_S.z() = surface.Sample(p_S).height + options.height;
      places.push_back(p_S);
    }
  }
  Seeded seeded(embree);
  double theirs = 0.0;
  const std::size_t before = embree.Rays();
  const bench::Turns turns = bench::Alternate(
      5, [&] { WriteHorizonMap(ground, options, path, control); },
      [&] {
        theirs = 0.0;
        for (const Eigen::Vector3d& p_S : places) {
          theirs += seeded(p_S) / double(places.size());
        }
      });
  const double rays = double(embree.Rays() - before) / 6.0;
  const HorizonMap map(path);
  double ours = 0.0;
  for (int j = 0; j < Cells; j += Apart) {
    for (int i = 0; i < Cells; i += Apart) {
      for (const float elevation : map.Read(i, j, 1, 1)) {
        ours += elevation / double(places.size() * Azimuths);
      }
    }
  }
  const double perOurs = bench::Median(turns.subject) / (double(Cells) * Cells * Azimuths);
  const double perTheirs = bench::Median(turns.reference) / (double(places.size()) * Azimuths);
  std::printf(
      "%shorizon map against Embree at %.2f degrees, seeded by the azimuth before, one thread "
      "each: %.3g cell-azimuths a second against %.3g (%.2f rays each, %.3g rays a second): "
      "%.1f times as fast; goal >= %d; mean elevations %.4f and %.4f deg\n",
      fast ? "fast " : "", Step, 1.0 / perOurs, 1.0 / perTheirs,
      rays / (double(places.size()) * Azimuths), rays / bench::Median(turns.reference),
      perTheirs / perOurs, fast ? 25 : 15, ours, theirs);
}

// How far the fast mode's elevations are from the exact ones.
void FastErrors(const std::string& exact, const std::string& fast) {
  const HorizonMap a(exact), b(fast);
  std::vector<double> errors;
  for (int j = 0; j < a.Rows(); j += 64) {
    for (int i = 0; i < a.Columns(); i += 64) {
      const std::vector<float> left = a.Read(i, j, 64, 64), right = b.Read(i, j, 64, 64);
      for (std::size_t k = 0; k < left.size(); ++k) {
        errors.push_back(std::abs(double(left[k]) - double(right[k])));
      }
    }
  }
  std::sort(errors.begin(), errors.end());
  const auto at = [&](double share) {
    return errors[std::size_t(share * double(errors.size() - 1))];
  };
  std::printf("errors of the fast horizon map [deg]: median %.4f, 99 %% %.4f, 99.9 %% %.4f (goal "
              "<= 0.5), greatest %.4f\n",
              at(0.5), at(0.99), at(0.999), at(1.0));
}

// Between masts far apart, and from masts along the ground.
void Sights(const MapGround& ground, const TerrainSurface& surface, EmbreeGround& embree) {
  constexpr int Count = 2000;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(20.0, Side - 20.0);
  struct Line {
    Eigen::Vector3d from;
    Eigen::Vector3d way;
    double length;
  };
  std::vector<Line> lines(Count);
  for (Line& line : lines) {
    const auto mast = [&] {
      Eigen::Vector3d p_S = ground.placement.ToScene({unit(random), unit(random)}, 0.0);
      p_S.z() = surface.Sample(p_S).height + 20.0;
      return p_S;
    };
    line.from = mast();
    const Eigen::Vector3d way = mast() - line.from;
    line.length = way.norm();
    line.way = way / line.length;
  }
  int ours = 0;
  int theirs = 0;
  const bench::Turns turns = bench::Alternate(
      9,
      [&] {
        ours = 0;
        for (const Line& line : lines) {
          const auto found = surface.Intersect(line.from, line.way);
          ours += found.hit && found.distance < line.length;
        }
      },
      [&] {
        theirs = 0;
        for (const Line& line : lines) {
          theirs += embree.Blocks(line.from, line.way, line.length);
        }
      });
  char behind[120];
  std::snprintf(behind, sizeof behind, "%d and %d of %d blocked; goal <= 0.5", ours, theirs, Count);
  bench::Print("a line of sight between masts of 20 m against one Embree ray", turns, Count,
               behind);
}

} // namespace

int main() {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const std::filesystem::path folder = std::filesystem::temp_directory_path() /
                                       ("dspace-bench-embree-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::string raster = bench::WriteHills((folder / "hills.tif").string(), Side, Pixel);
  const auto terrain = StreamedTerrain::Open(raster);
  const MapGround ground = MapGroundOf(*terrain);
  {
    EmbreeGround embree(*terrain, ground.placement);
    const std::string exact = (folder / "horizons.tif").string();
    const std::string fast = (folder / "fast.tif").string();
    Horizons(ground, *terrain, embree, exact, false);
    Horizons(ground, *terrain, embree, fast, true);
    FastErrors(exact, fast);
    Sights(ground, *terrain, embree);
  }
  std::filesystem::remove_all(folder);
  return 0;
}
