#include <dspace/rays/RayLayer.h>

#include <cmath>

namespace dspace {

const RayTile& RayLayer::TileOf(Hold& hold, std::int64_t c, std::int64_t r) {
  std::shared_ptr<const RayTile>& held = hold.tile;
  if (!held || held->column != c * RayTile::Cells || held->row != r * RayTile::Cells) {
    held = this->Tiles_.Get({this->Surface_.Level(), c, r}, hold.remaining());
  }
  return *held;
}

RayTile::Range RayLayer::RangeOf(Hold& hold, int bits, std::int64_t c, std::int64_t r) {
  const int level = this->Surface_.Level();
  const int up = this->Bits() - bits; // a tile has 2^up of them a side
  if (up == 0) {
    return this->Tiles_.RangeOf({level, c, r}, hold.remaining());
  }
  const RayTile& tile = this->TileOf(hold, c >> up, r >> up);
  if (bits > level) {
    return tile.Of(bits - level, c, r);
  }
  // Floats are rounded to either side.
  const auto about = [](double height) {
    return RayTile::Range{std::nextafter(float(height), -1e30f),
                          std::nextafter(float(height), 1e30f)};
  };
  RayTile::Range range;
  bool holed = false;
  for (int k = 0; k < 4; ++k) {
    const double height = tile((c >> (level - bits)) + k % 2, (r >> (level - bits)) + k / 2);
    holed |= std::isnan(height);
    if (!std::isnan(height)) {
      range.Widen(about(height));
    }
  }
  if (holed) { // finer posts along its sides have heights all the same, and a cover's join them
    return range;
  }
  // Part of a cell between the posts: flat pieces are least and greatest at their corners.
  range = {};
  const std::int64_t parts = std::int64_t(1) << (level - bits);
  const std::int64_t i = c & (parts - 1);
  const std::int64_t j = r & (parts - 1);
  const double size = 1.0 / double(parts);
  const auto take = [&](bool below, std::int64_t di, std::int64_t dj) {
    const HeightGrid::Facet facet =
        this->Surface_.OfCell(tile, c >> (level - bits), r >> (level - bits), below,
                              double(i + di) * size, double(j + dj) * size);
    range.Widen(about(facet.height));
  };
  const bool pole = this->Surface_.AtPole(r >> (level - bits));
  for (const bool below : {true, false}) {
    if (pole || (below ? j >= i : i >= j)) {
      take(below, 0, 0);
      take(below, 1, 1);
      if (below || i != j || pole) {
        take(below, 0, 1);
      }
      if (!below || i != j || pole) {
        take(below, 1, 0);
      }
    }
  }
  return range;
}

} // namespace dspace
