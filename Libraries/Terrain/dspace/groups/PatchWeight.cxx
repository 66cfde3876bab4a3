#include <dspace/groups/PatchWeight.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dspace {
namespace {

constexpr std::int64_t MaximumCells = 4000000;
constexpr std::int64_t ReadWhole = 16000000; // pixels
constexpr double Inset = 3.0; // cells: then all posts of the triangles about a weight have data

// Squared distances [m^2] of cells from the nearest without data; all around the mask is none.
// `mask` has a ring of one cell more than the raster. Felzenszwalb and Huttenlocher, Distance
// Transforms of Sampled Functions, Theory of Computing 8, 2012.
std::vector<float> SquaredDistances(const std::vector<std::uint8_t>& mask, int width, int height,
                                    const Eigen::Vector2d& cell) {
  std::vector<float> squares(mask.size());
  for (int r = 0; r < height; ++r) { // along the rows: the nearest to the left, then to the right
    const std::uint8_t* has = mask.data() + std::size_t(r) * width;
    float* row = squares.data() + std::size_t(r) * width;
    double distance = 0.0;
    for (int c = 0; c < width; ++c) {
      distance = has[c] ? distance + cell.x() : 0.0;
      row[c] = float(distance);
    }
    for (int c = width - 1; c >= 0; --c) {
      distance = has[c] ? distance + cell.x() : 0.0;
      row[c] = float(std::min<double>(row[c], distance));
      row[c] *= row[c];
    }
  }
  // Down the columns: the lower envelope of parabolas.
  std::vector<double> f(height);
  std::vector<double> from(std::size_t(height) + 1);
  std::vector<int> apex(height);
  const double s = cell.y() * cell.y();
  for (int c = 0; c < width; ++c) {
    for (int r = 0; r < height; ++r) {
      f[r] = squares[std::size_t(r) * width + c] / s;
    }
    int last = 0;
    apex[0] = 0;
    from[0] = -std::numeric_limits<double>::infinity();
    from[1] = std::numeric_limits<double>::infinity();
    for (int q = 1; q < height; ++q) {
      const auto meets = [&](int v) {
        return ((f[q] + double(q) * q) - (f[v] + double(v) * v)) / (2.0 * (q - v));
      };
      double at = meets(apex[last]);
      while (at <= from[last]) {
        at = meets(apex[--last]);
      }
      apex[++last] = q;
      from[last] = at;
      from[last + 1] = std::numeric_limits<double>::infinity();
    }
    int k = 0;
    for (int r = 0; r < height; ++r) {
      while (from[k + 1] < r) {
        ++k;
      }
      const double away = r - apex[k];
      squares[std::size_t(r) * width + c] = float(s * (away * away + f[apex[k]]));
    }
  }
  return squares;
}

} // namespace

// With a ring of cells without data. Finds the range of heights as well.
std::vector<std::uint8_t> PatchWeight::ReadMask(const ElevationSource& source) {
  const RasterWindow all = source.Info().window;
  const std::int64_t pixels = std::int64_t(all.width) * all.height;
  while ((pixels >> (2 * this->Bits_)) > MaximumCells) {
    ++this->Bits_;
  }
  const int side = 1 << this->Bits_;
  Level& finest = this->Levels_.emplace_back();
  finest.columns = 1 + (all.width - 1) / side;
  finest.rows = 1 + (all.height - 1) / side;
  this->Exact_ = pixels <= ReadWhole;
  const int factor = this->Exact_ ? 1 : side;
  if (this->Exact_) {
    this->Ranges_ = PatchRanges(all.width, all.height);
  }
  const int width = finest.columns + 2;
  std::vector<std::uint8_t> mask(std::size_t(width) * (finest.rows + 2), 0);
  for (int r = 0; r < finest.rows; ++r) {
    std::fill_n(mask.begin() + std::ptrdiff_t(r + 1) * width + 1, finest.columns, std::uint8_t(1));
  }
  const int strip = std::max(1, 256 / side) * side;
  for (int top = 0; top < all.height; top += strip) {
    const RasterWindow part{0, top, all.width, std::min(strip, all.height - top)};
    const std::vector<double> heights = source.ReadReduced(part, factor);
    const int columns = 1 + (all.width - 1) / factor;
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const int c = int(i % columns) * factor;
      const int r = top + int(i / columns) * factor;
      if (std::isnan(heights[i])) {
        mask[std::size_t((r >> this->Bits_) + 1) * width + (c >> this->Bits_) + 1] = 0;
      } else {
        this->Heights_[0] = std::min(this->Heights_[0], heights[i]);
        this->Heights_[1] = std::max(this->Heights_[1], heights[i]);
        if (this->Exact_) {
          this->Ranges_.Take(c, r, heights[i]);
        }
      }
    }
  }
  if (this->Exact_) {
    this->Ranges_.Finish();
  }
  return mask;
}

PatchWeight::PatchWeight(const ElevationSource& source, const Eigen::Vector2d& metres,
                         double margin)
    : Heights_{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()} {
  const std::vector<std::uint8_t> mask = this->ReadMask(source);
  Level& finest = this->Levels_.front();
  const Eigen::Vector2d cell = std::ldexp(1.0, this->Bits_) * metres;
  const int width = finest.columns + 2;
  const std::vector<float> squares = SquaredDistances(mask, width, finest.rows + 2, cell);
  const double inset = Inset * cell.maxCoeff();
  finest.weights.resize(std::size_t(finest.columns) * finest.rows);
  this->Shares_ = PatchRanges(finest.columns, finest.rows);
  for (int r = 0; r < finest.rows; ++r) {
    for (int c = 0; c < finest.columns; ++c) {
      const double distance = std::sqrt(double(squares[std::size_t(r + 1) * width + c + 1]));
      const double s = std::clamp((distance - inset) / margin, 0.0, 1.0);
      const double weight = s * s * (3.0 - 2.0 * s);
      finest.weights[std::size_t(r) * finest.columns + c] = float(weight);
      this->Greatest_ = std::max(this->Greatest_, weight);
      this->Shares_.Take(c, r, weight);
    }
  }
  this->Shares_.Finish();
  this->AddLevels();
}

// Means of 2 x 2; beyond the edge is 0.
void PatchWeight::AddLevels() {
  while (this->Levels_.back().columns > 1 || this->Levels_.back().rows > 1) {
    const Level& fine = this->Levels_.back();
    Level coarse;
    coarse.columns = (fine.columns + 1) / 2;
    coarse.rows = (fine.rows + 1) / 2;
    coarse.weights.assign(std::size_t(coarse.columns) * coarse.rows, 0.0f);
    for (int r = 0; r < fine.rows; ++r) {
      for (int c = 0; c < fine.columns; ++c) {
        coarse.weights[std::size_t(r / 2) * coarse.columns + c / 2] +=
            0.25f * fine.weights[std::size_t(r) * fine.columns + c];
      }
    }
    this->Levels_.push_back(std::move(coarse));
  }
}

std::array<double, 2> PatchWeight::Over(const Eigen::AlignedBox2d& pixels) const {
  constexpr double Few = 64.0; // cells that are looked at one by one
  const Level& cells = this->Levels_.front();
  const double scale = std::ldexp(1.0, -this->Bits_);
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5);
  const Eigen::Vector2d low = (scale * pixels.min() - half).array().floor();
  const Eigen::Vector2d high = (scale * pixels.max() - half).array().floor() + 1.0;
  const Eigen::Vector2d last(cells.columns - 1.0, cells.rows - 1.0);
  const bool within = low.minCoeff() >= 0.0 && (last - high).minCoeff() >= 0.0;
  const Eigen::Vector2d from = low.cwiseMax(0.0);
  const Eigen::Vector2d to = high.cwiseMin(last);
  if ((to - from).minCoeff() < 0.0) {
    return {0.0, 0.0};
  }
  std::array<double, 2> range = {within ? 1.0 : 0.0, 0.0};
  if (((to - from).array() + 1.0).prod() <= Few) {
    for (int r = int(from.y()); r <= int(to.y()); ++r) {
      for (int c = int(from.x()); c <= int(to.x()); ++c) {
        const double weight = cells.weights[std::size_t(r) * cells.columns + c];
        range = {std::min(range[0], weight), std::max(range[1], weight)};
      }
    }
    return range;
  }
  const std::array<double, 2> shares =
      this->Shares_.Of({from, to + Eigen::Vector2d::Ones()}); // rounded to either side
  const bool whole = shares[0] >= double(std::nextafter(1.0f, 0.0f));
  const bool none = shares[1] <= double(std::nextafter(0.0f, 1.0f));
  return {std::min(range[0], whole ? 1.0 : std::max(shares[0], 0.0)),
          none ? 0.0 : std::min(shares[1], 1.0)};
}

double PatchWeight::At(const Eigen::Vector2d& pixel, int level) const {
  const int wanted = std::max(0, level - this->Bits_);
  const int top = int(this->Levels_.size()) - 1;
  const Level& cells = this->Levels_[std::min(wanted, top)];
  const Eigen::Vector2d place =
      std::ldexp(1.0, -(this->Bits_ + wanted)) * pixel - Eigen::Vector2d::Constant(0.5);
  if (!(place.x() > -1.0 && place.x() < cells.columns && place.y() > -1.0 &&
        place.y() < cells.rows)) {
    return 0.0;
  }
  const int c = int(std::floor(place.x()));
  const int r = int(std::floor(place.y()));
  double sum = 0.0;
  if (c >= 0 && r >= 0 && c + 1 < cells.columns && r + 1 < cells.rows) { // the same, faster
    const float* north = cells.weights.data() + std::size_t(r) * cells.columns + c;
    const float* south = north + cells.columns;
    if (north[0] == 1.0f && north[1] == 1.0f && south[0] == 1.0f && south[1] == 1.0f &&
        wanted <= top) {
      return 1.0;
    }
    const double west = 1.0 - (place.x() - c);
    const double east = 1.0 - (c + 1 - place.x());
    const double above = 1.0 - (place.y() - r);
    const double below = 1.0 - (r + 1 - place.y());
    sum = west * above * north[0] + east * above * north[1];
    sum = sum + west * below * south[0];
    sum = sum + east * below * south[1];
    return std::ldexp(sum, -2 * std::max(0, wanted - top));
  }
  for (const int j : {r, r + 1}) {
    for (const int i : {c, c + 1}) {
      if (i >= 0 && i < cells.columns && j >= 0 && j < cells.rows) {
        sum += (1.0 - std::abs(place.x() - i)) * (1.0 - std::abs(place.y() - j)) *
               cells.weights[std::size_t(j) * cells.columns + i];
      }
    }
  }
  return std::ldexp(sum, -2 * std::max(0, wanted - top)); // a cell larger than all of it
}

} // namespace dspace
