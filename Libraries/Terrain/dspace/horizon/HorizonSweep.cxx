#include <dspace/horizon/HorizonSweep.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <dspace/Error.h>

#include <dspace/horizon/HorizonKernel.h>
#include <dspace/horizon/HorizonPiece.h>

namespace dspace {
namespace {

constexpr int MostEvery = 64;
constexpr double LaneError = 5e-4; // of a distance, by which lanes of a pole's chart differ

// Posts of a row about `post` that may share a path, `step` posts of level 0 apart. On a degree
// grid all may: turned about the axis it is the same path. On a pole's chart, d away in twice the
// radius, its lengths differ by d sin c of themselves at colatitude c, and its directions by d
// times its length in that unit.
int SharedLanes(const PostPlacement& placement, const Eigen::Vector2d& post, double step,
                const HorizonOptions& options) {
  if (placement.GetKind() != PostPlacement::Kind::Pole || !options.fine) {
    return HorizonLanes;
  }
  const double radius = placement.Radius();
  const auto dip = [&](double height) {
    return std::acos(std::clamp((radius + options.heights[0]) / (radius + height), -1.0, 1.0));
  };
  const double reach =
      std::min(dip(options.heights[1]) + dip(options.heights[1] + options.above), HorizonFarthest);
  const double colatitude = 2.0 * std::atan(placement.OnPlaneOfPole(post).norm());
  const double most = std::max(std::sin(std::min(colatitude + reach, 0.5 * M_PI)), 0.5 * reach);
  const double lanes = 2.0 * LaneError / (most * placement.PlaneStep() * step);
  return int(std::clamp(lanes, 1.0, double(HorizonLanes)));
}

void Check(const PostBlock& block, const PostLattice& lattice, const std::string& name,
           double azimuth) {
  if (block.width < 1 || block.height < 1 || block.level < 0 || block.level >= lattice.levels) {
    throw Error(Error::Kind::InvalidArgument, name,
                "a horizon of " + std::to_string(block.width) + " x " +
                    std::to_string(block.height) + " posts of level " +
                    std::to_string(block.level) +
                    " is rejected; accepted is one post or more of levels 0 to " +
                    std::to_string(lattice.levels - 1));
  }
  if (!std::isfinite(azimuth)) {
    throw Error(Error::Kind::InvalidArgument, name,
                "azimuth " + std::to_string(azimuth) + " is rejected; accepted is a finite number");
  }
}

} // namespace

HorizonSweep::HorizonSweep(std::shared_ptr<ElevationPyramid> pyramid,
                           const PostPlacement& placement, const HorizonOptions& options)
    : Pyramid_(std::move(pyramid)), Placement_(placement), Options_(options) {
  const std::string& name = this->Pyramid_->Source().GetName();
  const bool power = options.posts > 0 && (options.posts & (options.posts - 1)) == 0;
  if (!power || options.posts < 64 || options.posts > 4096) {
    throw Error(Error::Kind::InvalidArgument, name,
                "horizons over " + std::to_string(options.posts) +
                    " posts a level are rejected; accepted is a power of two from 64 to 4096");
  }
  if (options.near < 1 || options.near > options.posts / 2) {
    throw Error(Error::Kind::InvalidArgument, name,
                "a near zone of " + std::to_string(options.near) +
                    " posts is rejected; accepted is 1 to " + std::to_string(options.posts / 2));
  }
  if (!(options.heights[0] <= options.heights[1]) || !std::isfinite(options.heights[0]) ||
      !std::isfinite(options.heights[1])) {
    throw Error(Error::Kind::InvalidArgument, name,
                "its least height must not exceed its greatest");
  }
  if (!(options.above >= 0.0) || !std::isfinite(options.above)) {
    throw Error(Error::Kind::InvalidArgument, name,
                "observers " + std::to_string(options.above) +
                    " m above the ground are rejected; accepted is 0 or more");
  }
}

HorizonReport HorizonSweep::Sweep(const PostBlock& block, double azimuth_deg, float* all,
                                  float* distant, double seconds) const {
  return this->SweepParts(block, 1, azimuth_deg, all, distant, seconds);
}

HorizonReport HorizonSweep::SweepEvery(const PostBlock& block, int every, double azimuth_deg,
                                       float* all, double seconds) const {
  if (every < 1 || every > MostEvery || block.level != 0) {
    throw Error(Error::Kind::InvalidArgument, this->Pyramid_->Source().GetName(),
                "a horizon at every " + std::to_string(every) + " posts of level " +
                    std::to_string(block.level) + " is rejected; accepted is 1 to " +
                    std::to_string(MostEvery) + " of level 0");
  }
  return this->SweepParts(block, every, azimuth_deg, all, nullptr, seconds);
}

HorizonReport HorizonSweep::SweepParts(const PostBlock& block, int every, double azimuth_deg,
                                       float* all, float* distant, double seconds) const {
  const PostLattice& lattice = this->Pyramid_->Lattice();
  Check(block, lattice, this->Pyramid_->Source().GetName(), azimuth_deg);
  HorizonReport report;
  // The last post of a row may be less than a spacing from the one before it.
  const std::int64_t last = lattice.ColumnsAt(block.level) - 1;
  const bool even =
      lattice.periodic || lattice.ColumnPlace(block.level, last) == last << block.level;
  // Where posts are not held, what a piece reads grows with its rows.
  const int rows = std::max(1, (this->Held_ ? HorizonRows : HorizonRows / 2) / every);
  for (int r = 0; r < block.height; r += rows) {
    for (int c = 0; c < block.width;) {
      PostBlock part = block;
      part.column = block.column + std::int64_t(c) * every;
      part.row = block.row + std::int64_t(r) * every;
      const Eigen::Vector2d post(double(lattice.ColumnPlace(block.level, part.column)),
                                 double(lattice.RowPlace(block.level, part.row)));
      const int lanes =
          SharedLanes(this->Placement_, post, std::ldexp(every, block.level), this->Options_);
      part.width = std::min(lanes, block.width - c);
      part.height = std::min(rows, block.height - r);
      if (!even && part.column < last && part.column + part.width > last) {
        part.width = int(last - part.column);
      } else if (!even && part.column == last) {
        part.width = 1;
      }
      const std::size_t at = std::size_t(r) * block.width + c;
      SweepPiece(*this, part, every, azimuth_deg, seconds, report, all + at,
                 distant ? distant + at : nullptr, std::size_t(block.width));
      c += part.width;
    }
  }
  return report;
}

} // namespace dspace
