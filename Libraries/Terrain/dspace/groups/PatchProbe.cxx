#include <dspace/groups/PatchProbe.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <dspace/groups/Patch.h>
#include <dspace/posts/PostFacets.h>

namespace dspace {
namespace {

constexpr double Endless = std::numeric_limits<double>::infinity();
constexpr std::int64_t FewPosts = 49; // posts that are looked at one by one

} // namespace

PatchProbe::PatchProbe(const Patch& patch) : Patch_(patch), Posts_(patch.Posts().MakeProbe()) {}
PatchProbe::~PatchProbe() = default;
PatchProbe::PatchProbe(PatchProbe&&) noexcept = default;

bool PatchProbe::Reads(const Patch& patch) {
  return patch.LevelFor(0) == 0;
}

// Two by two neighbouring squares are held.
const PatchPlace::Corners& PatchProbe::CornersAbout(std::int64_t column, std::int64_t row) {
  constexpr int Bits = PatchProbe::Bits;
  PatchPlace::Corners& held =
      this->Corners_[std::size_t(((column >> Bits) & 1) + 2 * ((row >> Bits) & 1))];
  const bool holds = column >= held.column && column < held.column + held.size && row >= held.row &&
                     row < held.row + held.size;
  if (!holds) {
    held = this->Patch_.CornersAbout(column, row);
  }
  return held;
}

PatchProbe::Share PatchProbe::At(std::int64_t column, std::int64_t row) {
  const PatchPlace& place = this->Patch_.Place();
  if (!place.ReachesColumn(column) || !place.ReachesRow(row)) {
    return {};
  }
  const PatchPlace::Corners& square = this->CornersAbout(column, row);
  const Eigen::Vector2d pixel =
      square.size == 1 ? square.pixels[0]
                       : square.At(double(column - square.column) / double(square.size),
                                   double(row - square.row) / double(square.size));
  if (!pixel.allFinite()) {
    return {};
  }
  const double weight = this->Patch_.Weight().At(pixel, 0);
  if (!(weight > 0.0)) {
    return {};
  }
  const RasterWindow& window = this->Patch_.Source().Info().window;
  const double x = std::clamp(pixel.x() - 0.5, 0.0, window.width - 1.0);
  const double y = std::clamp(pixel.y() - 0.5, 0.0, window.height - 1.0);
  const std::int64_t c = std::min<std::int64_t>(std::int64_t(x), window.width - 2);
  const std::int64_t r = std::min<std::int64_t>(std::int64_t(y), window.height - 2);
  const double u = x - double(c);
  const double v = y - double(r);
  const auto at = [this](std::int64_t i, std::int64_t j) -> double {
    return this->Posts_->At(i, j);
  };
  const HeightGrid::Facet facet = FacetOfCell(at, c, r, v > u, u, v);
  if (!facet.valid) {
    return {};
  }
  return {weight, facet.height + this->Patch_.AddedTo()};
}

// A box that holds the pixels of a block's posts.
Eigen::AlignedBox2d PatchProbe::PixelsOver(std::int64_t column, std::int64_t row,
                                           std::int64_t size) {
  Eigen::AlignedBox2d box;
  const PatchPlace::Corners& square = this->CornersAbout(column, row);
  if (square.size < size) { // it bends
    box =
        this->Patch_.Place().PixelBox({Eigen::Vector2d(double(column), double(row)),
                                       Eigen::Vector2d(double(column + size), double(row + size))});
  } else {
    const double scale = 1.0 / double(square.size);
    for (int k = 0; k < 4; ++k) {
      box.extend(square.At(double(column - square.column + k % 2 * size) * scale,
                           double(row - square.row + k / 2 * size) * scale));
    }
  }
  // The posts of its last row and column may be other squares', as well as the tolerance allows.
  const Eigen::Vector2d more = Eigen::Vector2d::Constant(4.0 * Patch::Tolerance);
  return {box.min() - more, box.max() + more};
}

// Of the triangles between the patch's posts.
std::array<double, 2> PatchProbe::HeightsIn(const Eigen::AlignedBox2d& pixels, bool& holed) {
  const RasterWindow& window = this->Patch_.Source().Info().window;
  const auto place = [](double pixel, int count) {
    return std::clamp(pixel - 0.5, 0.0, count - 1.0);
  };
  const Eigen::Vector2d low(place(pixels.min().x(), window.width),
                            place(pixels.min().y(), window.height));
  const Eigen::Vector2d high(place(pixels.max().x(), window.width),
                             place(pixels.max().y(), window.height));
  const std::int64_t c0 = std::min<std::int64_t>(std::int64_t(low.x()), window.width - 2);
  const std::int64_t r0 = std::min<std::int64_t>(std::int64_t(low.y()), window.height - 2);
  const std::int64_t columns =
      std::min<std::int64_t>(std::int64_t(high.x()), window.width - 2) - c0 + 2;
  const std::int64_t rows =
      std::min<std::int64_t>(std::int64_t(high.y()), window.height - 2) - r0 + 2;
  if (columns * rows > FewPosts) {
    const Eigen::Vector2d more = Eigen::Vector2d::Constant(2.0);
    return this->Patch_.Weight().Ranges().Of({pixels.min() - more, pixels.max() + more});
  }
  std::array<double, FewPosts> posts = {};
  std::array<double, 2> range = {Endless, -Endless};
  for (std::int64_t j = 0; j < rows; ++j) {
    for (std::int64_t i = 0; i < columns; ++i) {
      const double height = this->Posts_->At(c0 + i, r0 + j);
      posts[std::size_t(j * columns + i)] = height;
      holed = holed || std::isnan(height);
      range = {std::min(range[0], std::isnan(height) ? Endless : height),
               std::max(range[1], std::isnan(height) ? -Endless : height)};
    }
  }
  if (holed) {
    return range;
  }
  // No triangle rises more along a side than the steepest of them.
  Eigen::Vector2d rise = Eigen::Vector2d::Zero();
  for (std::int64_t j = 0; j < rows; ++j) {
    for (std::int64_t i = 0; i < columns; ++i) {
      const double height = posts[std::size_t(j * columns + i)];
      if (i + 1 < columns) {
        rise.x() = std::max(rise.x(), std::abs(posts[std::size_t(j * columns + i + 1)] - height));
      }
      if (j + 1 < rows) {
        rise.y() = std::max(rise.y(), std::abs(posts[std::size_t((j + 1) * columns + i)] - height));
      }
    }
  }
  const Eigen::Vector2d middle = 0.5 * (low + high);
  const auto at = [&](std::int64_t i, std::int64_t j) {
    return posts[std::size_t((j - r0) * columns + i - c0)];
  };
  const std::int64_t c = std::min<std::int64_t>(std::int64_t(middle.x()), window.width - 2);
  const std::int64_t r = std::min<std::int64_t>(std::int64_t(middle.y()), window.height - 2);
  const double u = middle.x() - double(c);
  const double v = middle.y() - double(r);
  const double height = FacetOfCell(at, c, r, v > u, u, v).height;
  const double more = 0.5 * rise.dot(high - low);
  return {std::max(range[0], height - more), std::min(range[1], height + more)};
}

PatchProbe::Bounds PatchProbe::Over(int bits, std::int64_t c, std::int64_t r) {
  const std::int64_t size = std::int64_t(1) << bits;
  const Eigen::Vector2d first(double(c * size), double(r * size));
  const Eigen::Vector2d side = Eigen::Vector2d::Constant(double(size));
  constexpr Bounds nothing = {{Endless, -Endless}, {0.0, 0.0}};
  if (!this->Patch_.Place().Touches({first, first + side})) {
    return nothing;
  }
  const Eigen::AlignedBox2d pixels = this->PixelsOver(c * size, r * size, size);
  if (!pixels.sizes().allFinite()) {
    return {{-Endless, Endless}, {0.0, 1.0}};
  }
  Bounds bounds = {{}, this->Patch_.Weight().Over(pixels)};
  if (!(bounds.weights[1] > 0.0)) {
    return nothing;
  }
  bool holed = false;
  bounds.heights = this->HeightsIn(pixels, holed);
  if (holed) {
    bounds.weights[0] = 0.0; // the ground below is seen
  }
  for (int k = 0; bounds.heights[0] <= bounds.heights[1] && k < 2; ++k) {
    const double rounding = 1.2e-7 * std::abs(bounds.heights[k]) + 1e-9;
    bounds.heights[k] += (k == 0 ? -rounding : rounding) + this->Patch_.AddedTo();
  }
  return bounds;
}

} // namespace dspace
