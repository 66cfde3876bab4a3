// Means of a raster over boxes of any place and size.
#ifndef DSPACE_TERRAIN_BOXFILTER_H
#define DSPACE_TERRAIN_BOXFILTER_H

#include <cstddef>
#include <vector>

namespace dspace {

// One axis of boxes over a row of pixels; pixel i covers [i, i + 1).
struct BoxSpan {
  double from = 0.0;
  double to = 0.0; // greater than `from`
};

// The mean, weighted by area, of the pixels of `values` (width x height, row by row, NaN for none)
// under each box columns[i] x rows[j], into columns.size() x rows.size() results, row by row.
// Pixels outside the raster have no data. NaN where less than half of a box has data.
std::vector<double> BoxMeans(const std::vector<double>& values, int width, int height,
                             const std::vector<BoxSpan>& columns, const std::vector<BoxSpan>& rows);

// The same from several parts of a raster: their sums are added, then divided.
class BoxSums {
public:
  explicit BoxSums(std::size_t boxes) : Values_(boxes, 0.0), Weights_(boxes, 0.0) {}
  void Add(const std::vector<double>& values, int width, int height,
           const std::vector<BoxSpan>& columns, const std::vector<BoxSpan>& rows);
  // `widths` are those of the whole boxes. `shares`: how much of each has data, 0 to 1.
  std::vector<double> Means(const std::vector<double>& widths, const std::vector<BoxSpan>& rows,
                            std::vector<double>* shares = nullptr) const;

private:
  std::vector<double> Values_;
  std::vector<double> Weights_;
};

} // namespace dspace

#endif
