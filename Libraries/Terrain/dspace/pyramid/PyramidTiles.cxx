#include <dspace/pyramid/PyramidTiles.h>

#include <algorithm>

namespace dspace {
namespace {

constexpr std::size_t KeptChanges = 4096;

} // namespace

bool TileBox::Meets(const TileBox& o) const {
  return std::max(this->left, o.left) < std::min(this->right, o.right) &&
         std::max(this->top, o.top) < std::min(this->bottom, o.bottom);
}

void TileBox::Widen(const TileBox& by) {
  if (by.Empty()) {
    return;
  }
  *this = this->Empty()
              ? by
              : TileBox{std::min(this->left, by.left), std::min(this->top, by.top),
                        std::max(this->right, by.right), std::max(this->bottom, by.bottom)};
}

std::vector<TilePiece> CutIntoTiles(const PostLattice& lattice, const PostBlock& block) {
  std::vector<TilePiece> pieces;
  const std::int64_t columns = lattice.ColumnsAt(block.level);
  const std::int64_t rows = lattice.RowsAt(block.level);
  const std::int64_t top = std::clamp<std::int64_t>(block.row, 0, rows);
  const std::int64_t bottom = std::clamp<std::int64_t>(block.row + block.height, 0, rows);
  std::int64_t left = block.column;
  std::int64_t right = block.column + block.width;
  if (!lattice.periodic) {
    left = std::clamp<std::int64_t>(left, 0, columns);
    right = std::clamp<std::int64_t>(right, 0, columns);
  }
  for (std::int64_t r = top; r < bottom;) {
    const std::int64_t nextRow = std::min((r / PyramidTileSize + 1) * PyramidTileSize, bottom);
    for (std::int64_t c = left; c < right;) {
      const std::int64_t at = lattice.Wrapped(block.level, c);
      const std::int64_t end = std::min((at / PyramidTileSize + 1) * PyramidTileSize, columns);
      const std::int64_t run = std::min(end - at, right - c);
      const int x = int(at % PyramidTileSize);
      const int y = int(r % PyramidTileSize);
      pieces.push_back({{block.level, at / PyramidTileSize, r / PyramidTileSize},
                        {x, y, x + int(run), y + int(nextRow - r)},
                        int(c - block.column),
                        int(r - block.row)});
      c += run;
    }
    r = nextRow;
  }
  return pieces;
}

TileBox TouchedOfTile(const PostLattice& lattice, const PostRectangle& posts, const TileKey& key) {
  const std::int64_t columns = lattice.ColumnsAt(int(key[0]));
  TileBox touched;
  // Around a body the rectangle may begin a turn away.
  const std::int64_t turns = lattice.periodic ? FloorDiv(posts.column, columns) : 0;
  for (std::int64_t turn = turns; turn <= (lattice.periodic ? turns + 1 : 0); ++turn) {
    const std::int64_t column = posts.column - turn * columns - key[1] * PyramidTileSize;
    const std::int64_t row = posts.row - key[2] * PyramidTileSize;
    const auto within = [](std::int64_t value) {
      return int(std::clamp<std::int64_t>(value, 0, PyramidTileSize));
    };
    touched.Widen(
        {within(column), within(row), within(column + posts.width), within(row + posts.height)});
  }
  return touched;
}

std::shared_ptr<const PyramidTile> ReadPyramidTile(const PostSource& source, const TileKey& key,
                                                   const TileBox& box, const PyramidTile* old) {
  const int width = box.right - box.left;
  const int height = box.bottom - box.top;
  const std::size_t posts = std::size_t(PyramidTileSize) * PyramidTileSize;
  std::vector<float> heights(std::size_t(width) * height);
  std::vector<float> tracks(heights.size());
  const bool tracked = source.ReadWithTracks({int(key[0]), key[1] * PyramidTileSize + box.left,
                                              key[2] * PyramidTileSize + box.top, width, height},
                                             heights.data(), tracks.data());
  auto tile = old ? std::make_shared<PyramidTile>(*old) : std::make_shared<PyramidTile>();
  tile->heights.resize(posts);
  if (!tracked) {
    tracks.assign(tracks.size(), 0.0f);
  }
  if (tracked || !tile->tracks.empty()) {
    tile->tracks.resize(posts);
  }
  for (int r = 0; r < height; ++r) {
    const std::size_t from = std::size_t(r) * width;
    const std::size_t to = std::size_t(box.top + r) * PyramidTileSize + box.left;
    std::copy_n(heights.data() + from, width, tile->heights.data() + to);
    if (!tile->tracks.empty()) {
      std::copy_n(tracks.data() + from, width, tile->tracks.data() + to);
    }
  }
  if (std::all_of(tile->tracks.begin(), tile->tracks.end(), [](float t) { return t == 0.0f; })) {
    tile->tracks = {};
  }
  return tile;
}

void CopyPiece(const PyramidTile& tile, const TilePiece& piece, int blockWidth,
               const PostPlanes& planes) {
  const TileBox& box = piece.box;
  const int width = box.right - box.left;
  for (int r = 0; r < box.bottom - box.top; ++r) {
    const std::size_t from = std::size_t(box.top + r) * PyramidTileSize + box.left;
    const std::size_t to = std::size_t(piece.row + r) * blockWidth + piece.column;
    std::copy_n(tile.heights.data() + from, width, planes.heights + to);
    if (planes.tracks && !tile.tracks.empty()) {
      std::copy_n(tile.tracks.data() + from, width, planes.tracks + to);
    }
  }
}

void PyramidChangeLog::Add(const PostRectangle& rectangle) {
  this->Log_.emplace_back(++this->Latest_, rectangle);
  if (this->Log_.size() > KeptChanges) {
    this->Log_.pop_front();
  }
}

PyramidChanges PyramidChangeLog::Since(std::uint64_t stamp, const PostLattice& lattice) const {
  PyramidChanges changes{this->Latest_, {}};
  if (stamp<this->Latest_&& this->Log_.front().first> stamp + 1) {
    changes.rectangles.push_back({0, 0, lattice.columns, lattice.rows});
    return changes;
  }
  const auto first =
      std::upper_bound(this->Log_.begin(), this->Log_.end(), stamp,
                       [](std::uint64_t value, const auto& entry) { return value < entry.first; });
  for (auto it = first; it != this->Log_.end(); ++it) {
    changes.rectangles.push_back(it->second);
  }
  return changes;
}

} // namespace dspace
