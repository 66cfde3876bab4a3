#include <dspace/raster/PixelTiles.h>

#include <algorithm>

namespace dspace {

PixelTiles::Tile PixelTiles::TileAt(int column, int row) const {
  const std::pair<int, int> key(column, row);
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    if (const Tile* kept = this->Tiles_.Find(key)) {
      return *kept;
    }
  }
  const RasterWindow& all = this->Source_->Info().window;
  const RasterWindow part{column * Size, row * Size, std::min(Size, all.width - column * Size),
                          std::min(Size, all.height - row * Size)};
  const auto tile = std::make_shared<const std::vector<double>>(this->Source_->Read(part));
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  this->Tiles_.Insert(key, tile);
  return tile;
}

std::vector<double> PixelTiles::Read(const RasterWindow& w) const {
  std::vector<double> pixels(std::size_t(w.width) * w.height);
  const int columns = this->Source_->Info().window.width;
  for (int row = w.row; row < w.row + w.height;) {
    const int nextRow = std::min((row / Size + 1) * Size, w.row + w.height);
    for (int column = w.column; column < w.column + w.width;) {
      const int next = std::min((column / Size + 1) * Size, w.column + w.width);
      const Tile tile = this->TileAt(column / Size, row / Size);
      const int across = std::min(Size, columns - column / Size * Size);
      for (int r = row; r < nextRow; ++r) {
        std::copy_n(tile->begin() + std::ptrdiff_t(r % Size) * across + column % Size,
                    next - column,
                    pixels.begin() + std::ptrdiff_t(r - w.row) * w.width + (column - w.column));
      }
      column = next;
    }
    row = nextRow;
  }
  return pixels;
}

} // namespace dspace
