#include <dspace/posts/RasterProbe.h>

#include <algorithm>
#include <limits>

#include <dspace/posts/PostLattice.h>
#include <dspace/posts/PostsBetween.h>

namespace dspace {

RasterProbe::RasterProbe(const PixelWindows& pixels, int subdivisions, bool poles)
    : Tiles_(pixels.Tiles()), Columns_(pixels.Whole().width), Rows_(pixels.Whole().height),
      Periodic_(pixels.Periodic()), Bits_(subdivisions),
      Shift_(poles ? (std::int64_t(1) << subdivisions) / 2 : 0) {}

bool RasterProbe::HasRows(std::int64_t first, std::int64_t last) const {
  return this->Shift_ == 0 ||
         (first >= this->Shift_ && last <= ((this->Rows_ - 1) << this->Bits_) + this->Shift_);
}

double RasterProbe::Pixel(std::int64_t column, std::int64_t row) {
  if (this->Periodic_) {
    column -= FloorDiv(column, this->Columns_) * this->Columns_;
  }
  if (column < 0 || column >= this->Columns_ || row < 0 || row >= this->Rows_) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  constexpr auto Size = std::uint64_t(PixelTiles::Size);
  const auto c = std::int64_t(std::uint64_t(column) / Size);
  const auto r = std::int64_t(std::uint64_t(row) / Size);
  Held& held = this->Held_[std::size_t((c & 1) + 2 * (r & 1))];
  if (held.column != c || held.row != r) {
    held.tile = this->Tiles_.TileAt(int(c), int(r));
    held.column = c;
    held.row = r;
    held.width = std::min(Size, std::uint64_t(this->Columns_) - std::uint64_t(c) * Size);
  }
  return (*held.tile)[std::uint64_t(row) % Size * held.width + std::uint64_t(column) % Size];
}

float RasterProbe::At(std::int64_t column, std::int64_t row) {
  const std::int64_t mask = (std::int64_t(1) << this->Bits_) - 1;
  row -= this->Shift_;
  const std::int64_t c = column >> this->Bits_; // rounded down
  const std::int64_t r = row >> this->Bits_;
  const double u = double(column & mask) / double(mask + 1);
  const double v = double(row & mask) / double(mask + 1);
  const double nw = this->Pixel(c, r);
  if (u == 0.0 && v == 0.0) {
    return float(nw);
  }
  return float(OnTriangles(nw, this->Pixel(c + 1, r), this->Pixel(c, r + 1),
                           this->Pixel(c + 1, r + 1), u, v));
}

} // namespace dspace
