#include <dspace/surface/ResamplingError.h>

#include <algorithm>
#include <cmath>

#include <dspace/raster/RandomPixels.h>

namespace dspace {

ResamplingReport MeasureResampling(const RasterPosts& posts) {
  const PostLattice& lattice = posts.GetLattice();
  const RasterWindow window = posts.Source().Info().window;
  const int level = posts.FullLevel();
  const int parts = 1 << (posts.Subdivisions() - level);
  const bool poles = lattice.rows - 1 == std::int64_t(window.height) << posts.Subdivisions();
  ResamplingReport report;
  report.columns = lattice.ColumnsAt(posts.Subdivisions());
  double squares = 0.0;
  AtRandomPixels(posts.Source(), [&](int c, int r, double own) {
    const double place = c * parts / posts.Stretch();
    // Rows of pixels are rows of posts.
    const std::int64_t row = std::int64_t(r) * parts + (poles ? parts / 2 : 0);
    const auto column = std::int64_t(std::floor(place));
    float ends[2] = {};
    posts.Read({level, column, row, 2, 1}, ends);
    const double u = place - double(column);
    const double height = ends[0] + u * (double(ends[1]) - ends[0]);
    const double error = height - own;
    if (!std::isnan(error)) {
      squares += error * error;
      report.greatestError = std::max(report.greatestError, std::abs(error));
      ++report.posts;
    }
  });
  report.rmsError = report.posts > 0 ? std::sqrt(squares / report.posts) : 0.0;
  return report;
}

} // namespace dspace
