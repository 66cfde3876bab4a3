#include <dspace/pyramid/JoinRectangles.h>

#include <algorithm>
#include <map>
#include <utility>

#include <dspace/pyramid/ElevationPyramid.h>

namespace dspace {
namespace {

PostRectangle Joined(const PostRectangle& a, const PostRectangle& b) {
  PostRectangle both;
  both.column = std::min(a.column, b.column);
  both.row = std::min(a.row, b.row);
  both.width = std::max(a.column + a.width, b.column + b.width) - both.column;
  both.height = std::max(a.row + a.height, b.row + b.height) - both.row;
  both.levels = std::max(a.levels, b.levels);
  return both;
}

} // namespace

std::vector<PostRectangle> JoinRectangles(const std::vector<PostRectangle>& rectangles,
                                          std::size_t most) {
  std::vector<PostRectangle> joined = rectangles;
  for (std::int64_t side = ElevationPyramid::TileSize; joined.size() > most; side *= 2) {
    std::map<std::pair<std::int64_t, std::int64_t>, PostRectangle> squares;
    for (const PostRectangle& rectangle : rectangles) {
      const std::pair<std::int64_t, std::int64_t> square(
          FloorDiv(rectangle.column + rectangle.width / 2, side),
          FloorDiv(rectangle.row + rectangle.height / 2, side));
      const auto [found, isNew] = squares.emplace(square, rectangle);
      if (!isNew) {
        found->second = Joined(found->second, rectangle);
      }
    }
    joined.clear();
    for (const auto& [square, rectangle] : squares) {
      joined.push_back(rectangle);
    }
  }
  return joined;
}

} // namespace dspace
