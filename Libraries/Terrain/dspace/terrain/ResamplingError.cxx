#include "ResamplingError.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace dspace {
namespace {

constexpr int Spots = 16; // and pixels taken in each
constexpr int SpotPixels = 16;
constexpr int SpotSize = 32; // pixels a side

} // namespace

ResamplingReport MeasureResampling(const RasterPosts& posts) {
  const PostLattice& lattice = posts.GetLattice();
  const RasterWindow window = posts.Source().Info().window;
  const int level = posts.FullLevel();
  const int parts = 1 << (posts.Subdivisions() - level);
  const bool poles = lattice.rows - 1 == std::int64_t(window.height) << posts.Subdivisions();
  ResamplingReport report;
  report.columns = lattice.ColumnsAt(posts.Subdivisions());
  std::mt19937 random(1);
  const auto below = [&](int n) { return int(random() % std::uint32_t(std::max(1, n))); };
  double squares = 0.0;
  for (int spot = 0; spot < Spots; ++spot) {
    const RasterWindow part{below(window.width - SpotSize + 1), below(window.height - SpotSize + 1),
                            std::min(SpotSize, window.width), std::min(SpotSize, window.height)};
    const std::vector<double> own = posts.Source().Read(part);
    for (int i = 0; i < SpotPixels; ++i) {
      const int c = below(part.width);
      const int r = below(part.height);
      const double place = (part.column + c) * parts / posts.Stretch();
      // Rows of pixels are rows of posts.
      const std::int64_t row = std::int64_t(part.row + r) * parts + (poles ? parts / 2 : 0);
      const auto column = std::int64_t(std::floor(place));
      float ends[2] = {};
      posts.Read({level, column, row, 2, 1}, ends);
      const double u = place - double(column);
      const double height = ends[0] + u * (double(ends[1]) - ends[0]);
      const double error = height - own[std::size_t(r) * part.width + c];
      if (!std::isnan(error)) {
        squares += error * error;
        report.greatestError = std::max(report.greatestError, std::abs(error));
        ++report.posts;
      }
    }
  }
  report.rmsError = report.posts > 0 ? std::sqrt(squares / report.posts) : 0.0;
  return report;
}

} // namespace dspace
