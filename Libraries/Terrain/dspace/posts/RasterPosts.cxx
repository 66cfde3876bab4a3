#include <dspace/posts/RasterPosts.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/Error.h>

#include <dspace/posts/PixelWindows.h>
#include <dspace/posts/PostsBetween.h>
#include <dspace/posts/RasterMeans.h>
#include <dspace/posts/RasterProbe.h>

namespace dspace {
namespace {

PostLattice LatticeOf(const ElevationInfo& info, const RasterPostsOptions& options) {
  const std::string object = "raster '" + info.path + "'";
  const int width = info.window.width;
  const int height = info.window.height;
  if (width < 2 || height < 2) {
    throw Error(Error::Kind::InvalidArgument, object,
                std::to_string(width) + " x " + std::to_string(height) +
                    " posts span no surface; at least 2 x 2 are needed");
  }
  if (options.subdivisions < 0 || options.subdivisions > RasterPosts::Most) {
    throw Error(Error::Kind::InvalidArgument, object,
                "subdivisions " + std::to_string(options.subdivisions) +
                    " is rejected; accepted is 0 to 24");
  }
  if (options.poles && (!options.periodic || options.subdivisions < 1)) {
    throw Error(Error::Kind::InvalidArgument, object,
                "poles need a raster that goes once around and subdivisions of 1 or more");
  }
  if (options.columns != 0 && (!options.periodic || options.columns < width)) {
    throw Error(Error::Kind::InvalidArgument, object,
                std::to_string(options.columns) +
                    " columns are rejected; accepted are, where it goes "
                    "once around, " +
                    std::to_string(width) + " or more");
  }
  PostLattice lattice;
  const std::int64_t around = options.columns > 0 ? options.columns : width;
  const std::int64_t parts = std::int64_t(1) << options.subdivisions;
  lattice.periodic = options.periodic;
  lattice.columns = options.periodic ? around * parts : (width - 1) * parts + 1;
  lattice.rows = (options.poles ? height : height - 1) * parts + 1;
  lattice.levels = options.levels > 0 ? options.levels : LevelsFor(lattice, options.coarsest);
  const bool halved = lattice.periodic
                          ? lattice.columns % (std::int64_t(1) << (lattice.levels - 1)) == 0
                          : lattice.levels <= 50;
  if (!halved) {
    throw Error(Error::Kind::InvalidArgument, object,
                std::to_string(around) + " columns around a body cannot be halved for " +
                    std::to_string(lattice.levels) + " levels");
  }
  return lattice;
}

} // namespace

int LevelsFor(const PostLattice& lattice, int coarsest) {
  PostLattice probe = lattice;
  int levels = 1;
  while (levels < 50) {
    const std::int64_t cells =
        std::max(probe.periodic ? probe.ColumnsAt(levels - 1) : probe.ColumnsAt(levels - 1) - 1,
                 probe.RowsAt(levels - 1) - 1);
    const bool odd = probe.periodic && probe.ColumnsAt(levels - 1) % 2 != 0;
    if (cells <= coarsest || odd) {
      break;
    }
    ++levels;
  }
  return levels;
}

std::int64_t ColumnsAround(int columns, int rowCells, int coarsest) {
  int halvings = 0;
  const auto left = [&](int count) {
    return ((std::int64_t(count) - 1) >> halvings) + 1; // rounded up
  };
  while (left(columns) > 2 * std::int64_t(coarsest) || left(rowCells) > coarsest) {
    ++halvings;
  }
  return std::max<std::int64_t>(left(columns), 4) * (std::int64_t(1) << halvings);
}

RasterPosts::RasterPosts(std::shared_ptr<const ElevationSource> source,
                         const RasterPostsOptions& options)
    : Source_(std::move(source)),
      Pixels_(std::make_shared<const PixelWindows>(Source_, options.periodic)),
      Name_("raster '" + Source_->Info().path + "'"), Lattice_(LatticeOf(Source_->Info(), options)),
      Subdivisions_(options.subdivisions), Poles_(options.poles) {
  const int width = this->Source_->Info().window.width;
  const bool stretched = options.columns > width;
  this->Stretch_ = stretched ? double(width) / double(options.columns) : 1.0;
  this->Full_ = stretched ? std::max(0, this->Subdivisions_ - Finer)
                          : this->Subdivisions_ - (this->Poles_ ? 1 : 0);
  this->Means_ = std::make_unique<RasterMeans>(this->Pixels_, this->Lattice_, this->Subdivisions_,
                                               this->Poles_, this->Stretch_);
}

RasterPosts::~RasterPosts() = default;

std::unique_ptr<PostProbe> RasterPosts::MakeProbe() const {
  return this->Stretch_ == 1.0
             ? std::make_unique<RasterProbe>(*this->Pixels_, this->Subdivisions_, this->Poles_)
             : nullptr;
}

int RasterPosts::FirstReducedLevel() const {
  return this->Means_->FirstReducedLevel();
}

void RasterPosts::InvalidateReduced() {
  this->Means_->InvalidateReduced();
}

void RasterPosts::ReadSubdivided(const PostBlock& block, float* heights) const {
  const int step = 1 << (this->Subdivisions_ - block.level); // parts a pixel
  const std::int64_t shift = this->Poles_ ? step / 2 : 0;    // rows from the pole to the pixels
  const std::int64_t first = block.row - shift;
  // A post's column of pixels, and how far it is from there to the next.
  const auto cellOf = [&](int i) {
    if (this->Stretch_ == 1.0) {
      const std::int64_t c = FloorDiv(block.column + i, step);
      return std::pair(c, double(block.column + i - c * step) / step);
    }
    // By whole numbers: each post of a level lies where that of a finer one does.
    const std::int64_t pixels = this->Source_->Info().window.width;
    const std::int64_t posts = this->Lattice_.ColumnsAt(block.level);
    const std::int64_t place = (block.column + i) * pixels;
    const std::int64_t c = FloorDiv(place, posts);
    return std::pair(c, double(place - c * posts) / double(posts));
  };
  const std::int64_t column = cellOf(0).first;
  const std::int64_t row = FloorDiv(first, step);
  const int width = int(cellOf(block.width - 1).first - column) + 2;
  const int height = int(FloorDiv(first + block.height - 1, step) - row) + 2;
  const std::vector<double> pixels = this->Pixels_->Read(column, row, width, height, 1);
  const std::int64_t lastRow = this->Source_->Info().window.height - 1;
  for (int j = 0; j < block.height; ++j) {
    const std::int64_t r = FloorDiv(first + j, step) - row;
    const double v = double(first + j - (r + row) * step) / step;
    const bool north = r + row == -1;
    const bool south = r + row == lastRow && v > 0.0;
    if (this->Poles_ && (north || south)) {
      const double pole = this->Means_->PoleHeight(block.level, south);
      const double share = north ? 2.0 * v - 1.0 : 1.0 - 2.0 * v; // of the row of pixels
      for (int i = 0; i < block.width; ++i) {
        const auto [c, u] = cellOf(i);
        const double* p = pixels.data() + (r + (north ? 1 : 0)) * width + (c - column);
        const double along = u == 0.0 ? p[0] : p[0] + u * (p[1] - p[0]);
        heights[std::size_t(j) * block.width + i] =
            float(share == 0.0 ? pole : pole + share * (along - pole));
      }
      continue;
    }
    for (int i = 0; i < block.width; ++i) {
      const auto [c, u] = cellOf(i);
      const double* p = pixels.data() + r * width + (c - column);
      heights[std::size_t(j) * block.width + i] =
          float(OnTriangles(p[0], p[1], p[width], p[width + 1], u, v));
    }
  }
}

void RasterPosts::Read(const PostBlock& block, float* heights) const {
  std::vector<float> shares(std::size_t(block.width) * block.height);
  this->ReadWithShares(block, heights, shares.data());
}

void RasterPosts::ReadWithShares(const PostBlock& block, float* heights, float* shares) const {
  const bool means = block.level > this->Subdivisions_ - (this->Poles_ ? 1 : 0);
  // With poles, the rows of level `subdivisions` already stand between those of pixels.
  if (this->Stretch_ != 1.0 && block.level < this->Full_) {
    const auto full = [this](const PostBlock& wanted, float* posts) { this->Read(wanted, posts); };
    ReadBetweenPosts(this->Lattice_, this->Poles_, this->Full_, full, block, heights);
  } else if (!means) {
    this->ReadSubdivided(block, heights);
  } else {
    this->Means_->Read(block, heights, shares);
  }
  // What lies outside the lattice is no post.
  const std::int64_t columns = this->Lattice_.ColumnsAt(block.level);
  const std::int64_t posts = this->Lattice_.RowsAt(block.level);
  for (int j = 0; j < block.height; ++j) {
    const bool rowOutside = block.row + j < 0 || block.row + j >= posts;
    for (int i = 0; i < block.width; ++i) {
      const bool outside =
          !this->Lattice_.periodic && (block.column + i < 0 || block.column + i >= columns);
      if (rowOutside || outside) {
        heights[std::size_t(j) * block.width + i] = std::numeric_limits<float>::quiet_NaN();
      }
      float& share = shares[std::size_t(j) * block.width + i];
      if (rowOutside || outside) {
        share = 0.0f;
      } else if (!means) {
        share = std::isnan(heights[std::size_t(j) * block.width + i]) ? 0.0f : 1.0f;
      }
    }
  }
}

} // namespace dspace
