// The levels of one view's clipmap: filled from a pyramid, uploaded in pieces.
#ifndef DSPACE_TERRAIN_CLIPMAPLEVELS_H
#define DSPACE_TERRAIN_CLIPMAPLEVELS_H

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <dspace/clipmap/ClipmapStyle.h>
#include <dspace/clipmap/arithmetic/ClipmapWindow.h>
#include <dspace/posts/PostPlacement.h>
#include <dspace/pyramid/ElevationPyramid.h>

namespace dspace {

class ClipmapNoise;

// A post as the GPU reads it.
struct ClipmapTexel {
  float height = 0.0f;      // [m]
  float slopeColumn = 0.0f; // rise a level-0 post along the columns [m]
  float slopeRow = 0.0f;
  // 1: no data; the rest is then 0. Else half of how much of its cell is rolled over, 0 to 0.5.
  float hole = 0.0f;
};
static_assert(sizeof(ClipmapTexel) == 16, "tightly packed");

// Levels are filled from the coarsest down, as far as the view can resolve them and their data is
// there. What a texel holds depends on its post alone, not on how the view came there. Posts that
// change in the pyramid are uploaded again; until they are there the old ones are drawn. No OpenGL.
class ClipmapLevels {
public:
  // The position of the camera.
  struct View {
    Eigen::Vector2d place = Eigen::Vector2d::Zero(); // level-0 posts; may lie outside the lattice
    double height = 0.0;                             // [m] above the vertical datum
    double cellSize = 1.0;                           // [m] of a level-0 cell below it
    std::optional<double> wait; // [s] for missing data; none: use loaded data only
  };
  struct State {
    int finest = 0;       // levels finest..Count()-1 are filled and drawn
    bool complete = true; // as fine as the view can resolve
    Eigen::Vector2d place = Eigen::Vector2d::Zero(); // level-0 posts; within the lattice, and near
                                                     // the last one where that is periodic
    double groundHeight = 0.0; // [m] below the camera, as the finest level has it that has some
    double distance = 0.0;     // [m] from the camera to that place on the ground
    double cellSize = 1.0;     // the view's
  };
  using Upload = std::function<void(int level, const ClipmapUpdate& update, const ClipmapTexel*)>;

  // Throws what ClipmapGeometry throws, and Error(InvalidArgument) when the pyramid's coarsest
  // level is larger than a window.
  ClipmapLevels(std::shared_ptr<ElevationPyramid> pyramid, int cells);
  ~ClipmapLevels();

  // Sets noise that raises posts from the next update on, with matching slopes; default: none. A
  // change refills all levels. `placement` places the posts. Throws what NoiseOptions::Check
  // throws.
  void SetNoise(const std::optional<ClipmapStyle::Noise>& noise, const PostPlacement& placement);

  // Throws what the pyramid's Read() throws when the view waits.
  State Update(const View& view, const Upload& upload);

  int Count() const { return static_cast<int>(this->Levels_.size()); }
  const ClipmapGeometry& Geometry() const { return this->Geometry_; }
  const PostLattice& Lattice() const { return this->Pyramid_->Lattice(); }
  const ClipmapWindow& Window(int level) const { return *this->Levels_[level].window; }
  // Of a filled level; texels() squared, row by row.
  const std::vector<ClipmapTexel>& Texels(int level) const { return this->Levels_[level].texels; }
  // Whether it holds, or held, a post of the lattice without data.
  bool HasHoles(int level) const { return this->Levels_[level].holes; }
  // Whether it holds, or held, a post that is rolled over.
  bool HasTracks(int level) const { return this->Levels_[level].tracks; }
  const ClipmapTexel& Texel(int level, std::int64_t column, std::int64_t row) const;
  // [m] of the ground at a place [level-0 posts], as the finest level from `finest` on has it whose
  // window holds the place; none where none has.
  std::optional<double> HeightNear(const Eigen::Vector2d& place, int finest) const;

  // The height distance of a level: `distance` in its posts.
  static double InPosts(double distance, double cellSize, int level);

private:
  struct Level {
    std::optional<ClipmapWindow> window; // none: nothing in it is valid
    std::vector<ClipmapTexel> texels;
    bool holes = false;
    bool tracks = false;
    std::vector<PostRectangle> changed; // posts of the level that it holds as they were before
  };
  enum class Filled { Not, Before, Wholly }; // Before: with posts as they were before a change
  void NoteChanges();
  std::vector<ClipmapUpdate> ChangesIn(int level, const ClipmapWindow& window) const;
  bool Fill(int level, const std::vector<ClipmapUpdate>& updates, const std::optional<double>& wait,
            const Upload& upload);
  Filled Fill(int level, const ClipmapWindow& window, const std::optional<double>& wait,
              const Upload& upload);
  // Whether a post of the lattice has no data.
  bool ToTexels(int level, const ClipmapUpdate& update, const std::vector<float>& heights,
                std::vector<ClipmapTexel>& texels) const;
  std::optional<double> GroundAt(int level, const Eigen::Vector2d& place) const; // none in a hole

  std::shared_ptr<ElevationPyramid> Pyramid_;
  ClipmapGeometry Geometry_;
  std::vector<Level> Levels_;
  double LastColumn_ = 0.0;
  std::uint64_t Seen_ = 0;                    // change of the pyramid
  std::unique_ptr<const ClipmapNoise> Noise_; // null: none
};

} // namespace dspace

#endif
