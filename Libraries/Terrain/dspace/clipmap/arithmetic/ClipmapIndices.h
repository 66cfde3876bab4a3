// The triangles of a clipmap's window, whole or with a hole for the next finer level.
#ifndef DSPACE_TERRAIN_CLIPMAPINDICES_H
#define DSPACE_TERRAIN_CLIPMAPINDICES_H

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace dspace {

// Posts of a window are numbered row by row, (cells + 1) a row. Triangles are HeightGrid's, A and
// B of each cell, counter-clockwise seen with columns to the right and rows downwards. They come
// in blocks of up to BlockCells a side. No OpenGL.
class ClipmapIndices {
public:
  static constexpr int BlockCells = 16;

  struct Run { // of indices
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };

  // `cells` as ClipmapGeometry accepts it, at most 252: indices are 16 bits.
  explicit ClipmapIndices(int cells);

  static constexpr int BlocksOf(int cells) { return (cells + BlockCells - 1) / BlockCells; }
  int BlocksAcross() const { return this->Blocks_; }
  const std::vector<std::uint16_t>& Indices() const { return this->Indices_; }

  // The run of a block in the window that is whole, or whose hole's first cell is at `inner`
  // (ClipmapGeometry::InnerCell). The hole is a cell narrower on each side than what the finer
  // level covers: there both are the same surface, and no gap can open between them.
  Run Block(const std::optional<Eigen::Vector2i>& inner, int column, int row) const;

private:
  int Variant(const std::optional<Eigen::Vector2i>& inner) const;
  void AppendBlock(int column, int row, const std::optional<Eigen::Vector2i>& inner);

  int Cells_;
  int Blocks_;
  std::vector<std::uint16_t> Indices_;
  std::array<std::vector<Run>, 5> Runs_; // whole, then the four places of the hole
};

} // namespace dspace

#endif
