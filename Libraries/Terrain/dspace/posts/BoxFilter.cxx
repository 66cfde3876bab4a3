#include <dspace/posts/BoxFilter.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace dspace {
namespace {

// Sums of value x weight and of weight.
struct Sums {
  double value = 0.0;
  double weight = 0.0;
};

template<typename Element> Sums Gather(const BoxSpan& span, int count, const Element& element) {
  Sums sums;
  const int first = std::max(0, static_cast<int>(std::floor(span.from)));
  const int last = std::min(count - 1, static_cast<int>(std::ceil(span.to)) - 1);
  for (int i = first; i <= last; ++i) {
    const double overlap = std::min<double>(span.to, i + 1) - std::max<double>(span.from, i);
    const Sums one = element(i);
    sums.value += overlap * one.value;
    sums.weight += overlap * one.weight;
  }
  return sums;
}

} // namespace

void BoxSums::Add(const std::vector<double>& values, int width, int height,
                  const std::vector<BoxSpan>& columns, const std::vector<BoxSpan>& rows) {
  // Boxes are products of spans: first along the rows, then down the columns.
  std::vector<Sums> along(static_cast<std::size_t>(height) * columns.size());
  for (int r = 0; r < height; ++r) {
    const double* row = values.data() + static_cast<std::size_t>(r) * width;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      along[r * columns.size() + c] = Gather(columns[c], width, [row](int i) {
        return std::isnan(row[i]) ? Sums{} : Sums{row[i], 1.0};
      });
    }
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const Sums box = Gather(rows[r], height, [&](int i) {
        return along[static_cast<std::size_t>(i) * columns.size() + c];
      });
      this->Values_[r * columns.size() + c] += box.value;
      this->Weights_[r * columns.size() + c] += box.weight;
    }
  }
}

std::vector<double> BoxSums::Means(const std::vector<double>& widths,
                                   const std::vector<BoxSpan>& rows,
                                   std::vector<double>* shares) const {
  std::vector<double> means(widths.size() * rows.size());
  if (shares) {
    shares->resize(means.size());
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < widths.size(); ++c) {
      const std::size_t i = r * widths.size() + c;
      const double area = (rows[r].to - rows[r].from) * widths[c];
      means[i] = this->Weights_[i] >= 0.5 * area ? this->Values_[i] / this->Weights_[i]
                                                 : std::numeric_limits<double>::quiet_NaN();
      if (shares) {
        const double share = this->Weights_[i] / area;
        (*shares)[i] = share > 1.0 - 1e-9 ? 1.0 : share; // rounding
      }
    }
  }
  return means;
}

std::vector<double> BoxMeans(const std::vector<double>& values, int width, int height,
                             const std::vector<BoxSpan>& columns,
                             const std::vector<BoxSpan>& rows) {
  BoxSums sums(columns.size() * rows.size());
  sums.Add(values, width, height, columns, rows);
  std::vector<double> widths;
  for (const BoxSpan& span : columns) {
    widths.push_back(span.to - span.from);
  }
  return sums.Means(widths, rows);
}

} // namespace dspace
