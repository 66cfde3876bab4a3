#include <dspace/maps/MapGround.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include <dspace/Error.h>
#include <dspace/surface/GridTerrain.h>
#include <dspace/surface/StreamedTerrain.h>

namespace dspace {
namespace {

constexpr std::int64_t MostPosts = std::int64_t(1) << 28; // that a survey reads
constexpr int Chunk = 512;                                // posts a side

// Heights of a grid, copied.
class CopiedPosts : public PostSource {
public:
  CopiedPosts(std::string name, const HeightGrid& grid)
      : Name_(std::move(name)), Heights_(grid.GetHeights().begin(), grid.GetHeights().end()) {
    this->Lattice_.columns = grid.GetColumns();
    this->Lattice_.rows = grid.GetRows();
  }
  const std::string& GetName() const override { return this->Name_; }
  const PostLattice& GetLattice() const override { return this->Lattice_; }
  void Read(const PostBlock& block, float* heights) const override {
    for (std::int64_t r = block.row; r < block.row + block.height; ++r) {
      for (std::int64_t c = block.column; c < block.column + block.width; ++c) {
        const bool inside =
            c >= 0 && c < this->Lattice_.columns && r >= 0 && r < this->Lattice_.rows;
        *heights++ = inside ? this->Heights_[std::size_t(r * this->Lattice_.columns + c)]
                            : std::numeric_limits<float>::quiet_NaN();
      }
    }
  }

private:
  std::string Name_;
  PostLattice Lattice_;
  std::vector<float> Heights_;
};

} // namespace

MapGround MapGroundOf(const TerrainSurface& surface) {
  MapGround ground;
  ground.name = surface.GetName();
  ground.crs = surface.GetCrs();
  if (const auto* streamed = dynamic_cast<const StreamedTerrain*>(&surface)) {
    ground.pyramid = streamed->Pyramid();
    ground.placement = streamed->Placement();
    ground.postToMap = streamed->Info().pixelToMap * streamed->PixelToPost().inverse();
    ground.firstPixel = streamed->PixelToPost() * Eigen::Vector2d(0.5, 0.5);
    ground.postsAPixel = 1 << streamed->Subdivisions();
    return ground;
  }
  if (const auto* grid = dynamic_cast<const GridTerrain*>(&surface)) {
    ground.pyramid = std::make_shared<ElevationPyramid>(
        std::make_shared<CopiedPosts>(ground.name, grid->Grid()));
    ground.placement =
        PostPlacement::OnPlane(grid->Grid().GetGridToScene(), grid->Frame().GetOriginHeight());
    Eigen::Affine2d centre = Eigen::Affine2d::Identity();
    centre.translation() << 0.5, 0.5;
    ground.postToMap = grid->PixelToMap() * centre;
    ground.postsAPixel = 1 << grid->Subdivisions();
    return ground;
  }
  throw Error(Error::Kind::Unsupported, ground.name,
              "maps are computed on terrain of a raster; accepted: streamed terrain and grids");
}

std::optional<GroundSurvey> Survey(const MapGround& ground, const std::function<bool()>& proceed) {
  ElevationPyramid& pyramid = *ground.pyramid;
  const PostLattice& lattice = pyramid.Lattice();
  int level = 0;
  while (level < lattice.levels - 1 &&
         lattice.ColumnsAt(level) * lattice.RowsAt(level) > MostPosts) {
    ++level;
  }
  GroundSurvey survey;
  survey.exact = level == 0;
  InputHash hash;
  for (const std::int64_t count : {lattice.columns, lattice.rows, std::int64_t(lattice.periodic)}) {
    hash.Add(std::uint64_t(count));
  }
  // Three posts determine where all posts are.
  for (const Eigen::Vector2d& post :
       {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.0, 1.0)}) {
    const Eigen::Vector3d p_S = ground.placement.ToScene(post, 0.0);
    const Eigen::Vector2d map = ground.postToMap * post;
    for (const double value : {p_S.x(), p_S.y(), p_S.z(), map.x(), map.y()}) {
      hash.Add(value);
    }
  }
  float least = std::numeric_limits<float>::infinity();
  float greatest = -least;
  std::vector<float> heights(std::size_t(Chunk) * Chunk);
  for (std::int64_t r = 0; r < lattice.RowsAt(level); r += Chunk) {
    for (std::int64_t c = 0; c < lattice.ColumnsAt(level); c += Chunk) {
      if (proceed && !proceed()) {
        return std::nullopt;
      }
      PostBlock block;
      block.level = level;
      block.column = c;
      block.row = r;
      block.width = int(std::min<std::int64_t>(Chunk, lattice.ColumnsAt(level) - c));
      block.height = int(std::min<std::int64_t>(Chunk, lattice.RowsAt(level) - r));
      pyramid.Read(block, heights.data());
      const std::size_t count = std::size_t(block.width) * block.height;
      for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &heights[i], sizeof(bits));
        hash.Add(std::uint64_t(std::isnan(heights[i]) ? 0x7fc00000u : bits));
        least = heights[i] < least ? heights[i] : least;
        greatest = heights[i] > greatest ? heights[i] : greatest;
      }
    }
  }
  if (!(least <= greatest)) {
    throw Error(Error::Kind::InvalidArgument, ground.name,
                "it has no heights; accepted: a terrain with data");
  }
  const double more = survey.exact ? 0.0 : 0.5 * (double(greatest) - double(least)) + 1.0;
  survey.heights = {double(least) - more, double(greatest) + more};
  survey.hash = hash.Get();
  return survey;
}

void InputHash::Add(std::uint64_t value) { // the finalizer of SplitMix64
  std::uint64_t z = this->State_ ^ value;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  this->State_ = (z ^ (z >> 31)) + 0x9e3779b97f4a7c15ull;
}

void InputHash::Add(double value) {
  std::uint64_t bits = 0;
  const double plain = value == 0.0 ? 0.0 : value; // -0 is 0
  std::memcpy(&bits, &plain, sizeof(bits));
  this->Add(bits);
}

void InputHash::Add(const std::string& text) {
  this->Add(std::uint64_t(text.size()));
  for (const char letter : text) {
    this->Add(std::uint64_t(static_cast<unsigned char>(letter)));
  }
}

} // namespace dspace
