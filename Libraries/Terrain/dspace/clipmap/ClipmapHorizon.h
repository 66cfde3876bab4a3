// How far the Sun stands above the horizon at the posts of a clipmap's levels.
#ifndef DSPACE_TERRAIN_CLIPMAPHORIZON_H
#define DSPACE_TERRAIN_CLIPMAPHORIZON_H

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <dspace/clipmap/ClipmapLevels.h>
#include <dspace/horizon/HorizonBlocks.h>

namespace dspace {

// A post as the GPU reads it: the angle [rad] from the horizon up to the Sun's centre, normal to
// the horizon's line there, negative below. LitFraction(all, 0, radius) is what of the disc is
// seen.
struct HorizonTexel {
  float all = 1.5f;     // over all ground
  float distant = 1.5f; // over the ground beyond HorizonOptions::near posts of the level: planes of
                        // numbers follow nearer ground by themselves (ClipmapHorizon.frag)
};
static_assert(sizeof(HorizonTexel) == 8, "tightly packed");

// The horizon is straight between the two swept azimuths about the Sun's, which differs from post
// to post of a body. Where the Sun's azimuths within a block take more than four steps, the steps
// are doubled as often as that asks: in levels whose posts are degrees apart, and below the Sun. On
// a plane the ground is level beyond the data: the Sun sets at elevation 0. Until a block is there,
// an earlier one of other azimuths stands for it, or the coarser level; at last the Sun is seen. No
// OpenGL.
class ClipmapHorizon {
public:
  explicit ClipmapHorizon(std::shared_ptr<HorizonBlocks> blocks) : Blocks_(std::move(blocks)) {}

  // All texels of a level, texels() squared of the geometry, row by row as its heights are.
  using Upload = std::function<void(int level, const std::vector<HorizonTexel>&)>;
  // Brings the levels that `levels` has drawn for the Sun in direction `toSun_S`, unit, in the
  // terrain's frame; uploads what is other than the last time. True: all of it is there. `wait`
  // [s]: waits for it; throws what HorizonBlocks::Get throws.
  bool Update(const ClipmapLevels& levels, const ClipmapLevels::State& state,
              const Eigen::Vector3d& toSun_S, const std::optional<double>& wait,
              const Upload& upload);

private:
  // The Sun over a block, and the azimuths that stand for it.
  struct BlockSun {
    std::vector<Eigen::Vector3d> nodes; // to the Sun: east, north, up, at every NodePosts posts
    bool dark = false;                  // so far below that nothing need be swept
    int first = 0;                      // azimuth, in HorizonBlocks' steps
    int step = 1;                       // of them
    int count = 2;
  };
  struct Shown { // what a block's texels are made of
    BlockSun sun;
    std::vector<HorizonBlocks::Pointer> azimuths;
    bool operator==(const Shown& o) const {
      return this->sun.first == o.sun.first && this->sun.step == o.sun.step &&
             this->azimuths == o.azimuths;
    }
  };
  using Place = std::pair<std::int64_t, std::int64_t>; // column and row of blocks
  struct Level {
    std::optional<ClipmapWindow> window;
    std::map<Place, Shown> blocks; // of the texels
    std::vector<HorizonTexel> texels;
  };
  BlockSun SunOver(int level, const Place& place, const Eigen::Vector3d& toSun_S) const;
  void Compose(const ClipmapLevels& levels, int level, const Place& place, const Shown* shown);

  std::shared_ptr<HorizonBlocks> Blocks_;
  std::vector<Level> Levels_;
  std::optional<Eigen::Vector3d> Sun_; // of the texels
  double Turning_ = 0.0;               // the way its azimuth last went
  std::uint64_t Arrivals_ = 0;
  int Finest_ = -1;
  bool Complete_ = false;
};

} // namespace dspace

#endif
