#include <dspace/mesh/TerrainMesh.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include <dspace/Error.h>

#include <dspace/mesh/TileBuilder.h>

namespace dspace {

namespace {

[[noreturn]] void Reject(const std::string& message) {
  throw Error(Error::Kind::InvalidArgument, "terrain mesh", message);
}

int TopOf(const GridTerrain& terrain, const TerrainMeshOptions& options) {
  const int given = options.tileCells;
  if (given != 0 && (given < 8 || given > 1024 || (given & (given - 1)) != 0))
    Reject(std::to_string(given) + " cells a tile given; accepted are powers of two from 8 to "
                                   "1024, and 0");
  if (options.triangleBudget == 0)
    Reject("a budget of 0 triangles given; accepted is 1 or more");
  if (!(options.zoneShare >= 0.0 && options.zoneShare < 1.0))
    Reject("zone share " + std::to_string(options.zoneShare) + " given; accepted is 0 to below 1");
  const auto tiles = [&](int cells) {
    const auto across = [&](int posts) { return (posts - 2) / cells + 1; }; // whole tiles
    return 1.0 * across(terrain.Grid().GetColumns()) * across(terrain.Grid().GetRows());
  };
  int top = 5;
  while (given == 0 && top < 10 && tiles(1 << top) > 400.0)
    ++top;
  if (given != 0)
    for (top = 3; (1 << top) != given; ++top) {
    }
  return top;
}

} // namespace

TerrainMesh::TerrainMesh(std::shared_ptr<const GridTerrain> terrain,
                         const TerrainMeshOptions& options)
    : Terrain_(terrain
                   ? std::move(terrain)
                   : throw Error(Error::Kind::InvalidArgument, "terrain mesh", "no terrain given")),
      Options_(options),
      Tree_(this->Terrain_->Undisturbed().Grid(), TopOf(*this->Terrain_, options)) {
  this->ChooseSteps();
  const double share = 1.0 - options.zoneShare;
  this->FarTolerance_ = this->ToleranceFor(
      static_cast<std::size_t>(share * static_cast<double>(options.triangleBudget)));
  this->Tiles_.resize(static_cast<std::size_t>(this->GetTileColumns()) * this->GetTileRows());
  this->Tracks_.resize(this->Tiles_.size());
  const HeightGrid& grid = this->Terrain_->Grid();
  this->FollowTracks({{0, 0, grid.GetColumns(), grid.GetRows(), 1, 0}});
}

void TerrainMesh::ChooseSteps() {
  const HeightGrid& grid = this->Terrain_->Undisturbed().Grid();
  const Eigen::Matrix2d m = grid.GetGridToScene().linear();
  // 24 bits hold every multiple of the step up to half a tile's extent, with a bit to spare for
  // the rounding of its origin.
  const auto step = [](double half) { return std::exp2(std::ceil(std::log2(half)) + 1.0 - 24.0); };
  const double half = 0.5 * (1 << this->Tree_.GetTop());
  this->StepXY_ = step(half * (m.cwiseAbs() * Eigen::Vector2d::Ones()).maxCoeff());
  // The greatest half range of heights in one tile, with the deepest ruts.
  constexpr double ruts =
      TrackProfile::MaximumSinkage + TrackProfile::MaximumTread + TrackProfile::MaximumRim;
  double range = 0.0;
  const int cells = 1 << this->Tree_.GetTop();
  for (int row = 0; row < this->GetTileRows(); ++row)
    for (int column = 0; column < this->GetTileColumns(); ++column)
      range = std::max(range, 0.5 * (TileHeights(grid, column, row, cells).Size() + ruts));
  this->StepZ_ = step(range);
  this->Report_.budget = this->Options_.triangleBudget;
  this->Report_.roundingXY = 0.5 * this->StepXY_;
  this->Report_.roundingZ = 0.5 * this->StepZ_;
}

// A tolerance whose mesh keeps the budget and nearly uses it up: fewer triangles with every greater
// one.
double TerrainMesh::ToleranceFor(std::size_t budget) {
  const auto count = [&](double tolerance) {
    this->Tree_.Refine(tolerance, false);
    return static_cast<double>(this->Tree_.CountTriangles());
  };
  const double wanted = static_cast<double>(budget);
  double low = 0.0, high = this->Tree_.GetGreatestError();
  auto most = static_cast<double>(this->Tree_.GetFinestTriangles());
  double least = count(high);
  if (most <= wanted)
    return low;
  // Counts fall nearly as a power of the tolerance, and jump where many squares have the same
  // error: interpolation between logarithms, and halves where that narrows the bracket too slowly.
  // A tolerance within 1 in 2^12, or a count within 1 in 2^9, is as near as it need be.
  constexpr double Fine = 1.0 / (1 << 12);
  for (int step = 0; high - low > Fine * high && least < wanted * (1.0 - 1.0 / (1 << 9)); ++step) {
    double middle = 0.5 * (low + high);
    if (low > 0.0 && step % 3 != 2 && most > least) {
      const double share = std::log(most / wanted) / std::log(most / least);
      middle = low * std::pow(high / low, std::clamp(share + 1e-3, 0.02, 0.98));
    } else if (low == 0.0) {
      middle = high / 16.0;
    }
    const double triangles = count(middle);
    if (triangles <= wanted) {
      high = middle;
      least = triangles;
    } else {
      low = middle;
      most = triangles;
    }
  }
  return high;
}

std::vector<TerrainMesh::Disc> TerrainMesh::Discs(const std::vector<TerrainZone>& zones) const {
  std::vector<Disc> discs;
  const Eigen::Matrix2d m = this->Terrain_->Grid().GetGridToScene().linear();
  const double cell = std::min(m.col(0).norm(), m.col(1).norm());
  for (const TerrainZone& zone : zones) {
    if (zone.path_S.empty())
      Reject("a zone's path is empty; at least one point is needed");
    if (!(zone.radius > 0.0) || !std::isfinite(zone.radius))
      Reject("zone radius " + std::to_string(zone.radius) +
             " given; accepted is a positive number "
             "of metres");
    for (const Eigen::Vector2d& p : zone.path_S)
      if (!p.allFinite())
        Reject("a point of a zone's path is not finite");
    const double pitch = std::max(0.5 * zone.radius, cell);
    // A point stands up to pitch/sqrt(2) from its snapped place, and up to pitch/2 from the next
    // point that is looked at on its path.
    const double radius = zone.radius + pitch * (M_SQRT1_2 + 0.5);
    const auto add = [&](const Eigen::Vector2d& p) {
      const Disc disc{(p / pitch).array().round() * pitch, radius};
      if (discs.empty() || !(discs.back() == disc))
        discs.push_back(disc);
    };
    const Eigen::AlignedBox3d box = this->Terrain_->GetBounds().scene;
    Eigen::AlignedBox2d near(box.min().head<2>(), box.max().head<2>());
    near.min().array() -= radius;
    near.max().array() += radius;
    add(zone.path_S.front());
    for (std::size_t i = 1; i < zone.path_S.size(); ++i) {
      const Eigen::Vector2d& a = zone.path_S[i - 1];
      const Eigen::Vector2d step = zone.path_S[i] - a;
      // A line from far away is walked only where the terrain is.
      double t0 = 0.0, t1 = 1.0;
      for (int k = 0; k < 2; ++k)
        if (step[k] != 0.0) {
          const double x = (near.min()[k] - a[k]) / step[k], y = (near.max()[k] - a[k]) / step[k];
          t0 = std::max(t0, std::min(x, y));
          t1 = std::min(t1, std::max(x, y));
        }
      if (t0 > t1)
        continue;
      const double count = std::ceil((t1 - t0) * step.norm() / pitch);
      for (double n = 0.0; n <= count; ++n)
        add(a + step * (t0 + (t1 - t0) * (count > 0.0 ? n / count : 0.0)));
    }
  }
  const auto before = [](const Disc& a, const Disc& b) {
    return std::make_tuple(a.radius, a.middle_S.x(), a.middle_S.y()) <
           std::make_tuple(b.radius, b.middle_S.x(), b.middle_S.y());
  };
  std::sort(discs.begin(), discs.end(), before);
  discs.erase(std::unique(discs.begin(), discs.end()), discs.end());
  return discs;
}

void TerrainMesh::MarkDiscs() {
  const HeightGrid& grid = this->Terrain_->Grid();
  const Eigen::Matrix2d m = grid.GetGridToScene().linear();
  const Eigen::Matrix2d inverse = m.inverse();
  // A circle around a square of 2 x 2 cells.
  const double around = std::max((m.col(0) + m.col(1)).norm(), (m.col(0) - m.col(1)).norm());
  this->Tree_.ClearZone();
  for (const Disc& disc : this->Discs_) {
    const Eigen::Vector2d g = grid.ToGrid(disc.middle_S);
    const Eigen::Vector2d half = disc.radius * inverse.rowwise().norm();
    this->Tree_.MarkZone(
        g.x() - half.x(), g.y() - half.y(), g.x() + half.x(), g.y() + half.y(), [&](int c, int r) {
          const double reach = disc.radius + around;
          return (grid.ToScene({c + 1.0, r + 1.0}) - disc.middle_S).squaredNorm() <= reach * reach;
        });
  }
}

std::vector<std::size_t> TerrainMesh::SetZones(const std::vector<TerrainZone>& zones) {
  std::vector<Disc> discs = this->Discs(zones);
  if (discs == this->Discs_) {
    this->Report_.tilesBuilt = 0;
    return {};
  }
  this->Discs_ = std::move(discs);
  this->Chosen_ = false;
  return this->Rebuild();
}

std::vector<std::size_t> TerrainMesh::FollowTracks(const std::vector<PostRectangle>& changed) {
  if (changed.empty()) {
    this->Report_.tilesBuilt = 0;
    return {};
  }
  const std::int64_t cells = std::int64_t(1) << this->Tree_.GetTop();
  std::vector<bool> reached(this->Tiles_.size(), false);
  for (const PostRectangle& posts : changed) {
    // Tiles with these posts or those beside them.
    const auto tile = [cells](std::int64_t post, int count) {
      return int(std::clamp<std::int64_t>(FloorDiv(post, cells), 0, count - 1));
    };
    const int lastColumn = tile(posts.column + posts.width + 1, this->GetTileColumns());
    const int lastRow = tile(posts.row + posts.height + 1, this->GetTileRows());
    for (int row = tile(posts.row - 2, this->GetTileRows()); row <= lastRow; ++row)
      for (int column = tile(posts.column - 2, this->GetTileColumns()); column <= lastColumn;
           ++column)
        reached[static_cast<std::size_t>(row) * this->GetTileColumns() + column] = true;
  }
  for (std::size_t i = 0; i < reached.size(); ++i)
    if (reached[i]) {
      const int columns = this->GetTileColumns();
      this->Tracks_[i] = TracksId(*this->Terrain_, int(i) % columns, int(i) / columns, int(cells));
    }
  this->PinTracks();
  return this->Rebuild();
}

// Those of the whole grid: what is pinned does not depend on the order of changes.
void TerrainMesh::PinTracks() {
  const HeightGrid& grid = this->Terrain_->Grid();
  this->Tree_.ClearPins();
  const int cells = 1 << this->Tree_.GetTop();
  for (std::size_t i = 0; i < this->Tiles_.size(); ++i) {
    if (this->Tracks_[i] == 0)
      continue;
    const int c0 = int(i) % this->GetTileColumns() * cells;
    const int r0 = int(i) / this->GetTileColumns() * cells;
    for (int r = r0; r <= std::min(r0 + cells, grid.GetRows() - 1); ++r)
      for (int c = c0; c <= std::min(c0 + cells, grid.GetColumns() - 1); ++c)
        if (this->Terrain_->Rolled(c, r) >= 0.0f)
          this->Tree_.Pin(c, r);
  }
}

std::vector<std::size_t> TerrainMesh::Rebuild() {
  const std::size_t budget = this->Options_.triangleBudget;
  if (!this->Chosen_) {
    this->MarkDiscs();
    this->Tolerance_ = this->FarTolerance_;
    this->Tree_.Refine(this->Tolerance_, false);
    if (this->Tree_.CountTriangles() > budget)
      this->Tolerance_ = this->ToleranceFor(budget);
    this->Tree_.Refine(this->Tolerance_, false);
    this->Bare_ = this->Tree_.CountTriangles();
    this->Chosen_ = true;
  }
  this->Tree_.Refine(this->Tolerance_);

  std::vector<std::size_t> changed;
  TerrainMeshReport& report = this->Report_;
  report.triangles = 0;
  report.verticalError = 0.0;
  for (int row = 0; row < this->GetTileRows(); ++row)
    for (int column = 0; column < this->GetTileColumns(); ++column) {
      const std::size_t i = static_cast<std::size_t>(row) * this->GetTileColumns() + column;
      const std::vector<MeshQuadtree::Leaf> leaves = this->Tree_.Leaves(column, row);
      std::shared_ptr<const TerrainTile>& tile = this->Tiles_[i];
      if (!tile || tile->id != ContentId(column, row, leaves, this->Tracks_[i])) {
        tile = std::make_shared<const TerrainTile>(this->Build(column, row, leaves));
        changed.push_back(i);
      }
      report.triangles += tile->TriangleCount();
      report.verticalError = std::max(report.verticalError, tile->verticalError);
    }
  report.budgetMet = this->Bare_ <= budget;
  report.tilesBuilt = changed.size();
  return changed;
}

TerrainTile TerrainMesh::Build(int column, int row,
                               const std::vector<MeshQuadtree::Leaf>& leaves) const {
  TileBuilder builder(*this->Terrain_, column, row, 1 << this->Tree_.GetTop(), this->StepXY_,
                      this->StepZ_);
  double error = 0.0;
  for (const MeshQuadtree::Leaf& leaf : leaves) {
    builder.Add(leaf);
    error = std::max(error, this->Tree_.LeafError(leaf));
  }
  TerrainTile tile = builder.Take();
  tile.id =
      ContentId(column, row, leaves,
                this->Tracks_[static_cast<std::size_t>(row) * this->GetTileColumns() + column]);
  tile.verticalError = error;
  return tile;
}

} // namespace dspace
