#include <dspace/posts/GridPosts.h>

#include <limits>
#include <utility>

namespace dspace {

GridPosts::GridPosts(std::string name, const HeightGrid& grid)
    : Name_(std::move(name)), Grid_(grid) {
  this->Lattice_.columns = grid.GetColumns();
  this->Lattice_.rows = grid.GetRows();
}

void GridPosts::Read(const PostBlock& block, float* heights) const {
  for (int j = 0; j < block.height; ++j) {
    for (int i = 0; i < block.width; ++i) {
      const std::int64_t c = block.column + i;
      const std::int64_t r = block.row + j;
      const bool inside = block.level == 0 && c >= 0 && r >= 0 && c < this->Lattice_.columns &&
                          r < this->Lattice_.rows;
      *heights++ =
          inside ? float(this->Grid_.At(int(c), int(r))) : std::numeric_limits<float>::quiet_NaN();
    }
  }
}

} // namespace dspace
