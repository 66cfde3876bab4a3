#include <dspace/clipmap/arithmetic/ClipmapIndices.h>

#include <algorithm>

namespace dspace {

ClipmapIndices::ClipmapIndices(int cells)
    : Cells_(cells), Blocks_((cells + BlockCells - 1) / BlockCells) {
  std::vector<std::optional<Eigen::Vector2i>> variants = {std::nullopt};
  for (const int r : {0, 1}) {
    for (const int c : {0, 1}) {
      variants.emplace_back(Eigen::Vector2i(cells / 4 + c, cells / 4 + r));
    }
  }
  for (const auto& inner : variants) {
    std::vector<Run>& runs = this->Runs_[this->Variant(inner)];
    for (int row = 0; row < this->Blocks_; ++row) {
      for (int column = 0; column < this->Blocks_; ++column) {
        const auto first = static_cast<std::uint32_t>(this->Indices_.size());
        this->AppendBlock(column, row, inner);
        runs.push_back({first, static_cast<std::uint32_t>(this->Indices_.size()) - first});
      }
    }
  }
}

int ClipmapIndices::Variant(const std::optional<Eigen::Vector2i>& inner) const {
  return inner ? 1 + (inner->x() - this->Cells_ / 4) + 2 * (inner->y() - this->Cells_ / 4) : 0;
}

void ClipmapIndices::AppendBlock(int column, int row, const std::optional<Eigen::Vector2i>& inner) {
  const int posts = this->Cells_ + 1;
  const int half = this->Cells_ / 2;
  const int rows = std::min((row + 1) * BlockCells, this->Cells_);
  const int columns = std::min((column + 1) * BlockCells, this->Cells_);
  for (int r = row * BlockCells; r < rows; ++r) {
    for (int c = column * BlockCells; c < columns; ++c) {
      if (inner && c > inner->x() && c < inner->x() + half - 1 && r > inner->y() &&
          r < inner->y() + half - 1) {
        continue;
      }
      const auto a = static_cast<std::uint16_t>(r * posts + c); // (c, r)
      const auto b = static_cast<std::uint16_t>(a + 1);         // (c + 1, r)
      const auto d = static_cast<std::uint16_t>(a + posts);     // (c, r + 1)
      const auto e = static_cast<std::uint16_t>(d + 1);         // (c + 1, r + 1)
      this->Indices_.insert(this->Indices_.end(), {a, d, e, a, e, b});
    }
  }
}

ClipmapIndices::Run ClipmapIndices::Block(const std::optional<Eigen::Vector2i>& inner, int column,
                                          int row) const {
  return this->Runs_[this->Variant(inner)][std::size_t(row) * this->Blocks_ + column];
}

} // namespace dspace
