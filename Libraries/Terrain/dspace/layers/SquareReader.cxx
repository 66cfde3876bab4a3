#include "SquareReader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/terrain/PostLattice.h>

namespace dspace {
namespace {

constexpr int Side = TexelPlaces::Side;
constexpr double LeastCells = 1.5; // a texel's side, in cells of the level that is read
constexpr int MostPlaces = 16;     // in a texel, a side
constexpr int TornPlaces = 4;
constexpr double MostCells = double(1 << 22); // read for one square

// Sums of bilinear values of one texel.
template<int Step> class Summing {
public:
  Summing(const RasterPosition& raster, const LevelWindow& window, const Eigen::Vector2d& scale,
          int columns, int rows, const float* cells)
      : Raster_(raster), Window_(window), Scale_(scale), Columns_(columns), Rows_(rows),
        Cells_(cells) {}

  void Add(const Eigen::Vector2d& pixel) {
    double x = pixel.x();
    const double width = this->Raster_.width;
    if (!(pixel.y() >= 0.0 && pixel.y() <= this->Raster_.height)) {
      return; // also what is not finite
    }
    if (this->Raster_.turn > 0.0) {
      x -= this->Raster_.turn * std::round((x - 0.5 * width) / this->Raster_.turn);
    }
    if (!this->Raster_.periodic && !(x >= 0.0 && x <= width)) {
      return;
    }
    const double column = x * this->Scale_.x() - 0.5;
    const double row = pixel.y() * this->Scale_.y() - 0.5;
    const double left = std::floor(column);
    const double top = std::floor(row);
    const auto u = float(column - left);
    const auto v = float(row - top);
    const int x0 = this->Column(int(left));
    const int x1 = this->Column(int(left) + 1);
    const float* above = this->Row(int(top));
    const float* below = this->Row(int(top) + 1);
    for (int k = 0; k < Step; ++k) {
      const float a = above[x0 + k] + u * (above[x1 + k] - above[x0 + k]);
      const float b = below[x0 + k] + u * (below[x1 + k] - below[x0 + k]);
      this->Sum[k] += a + v * (b - a);
    }
  }

  float Sum[Step] = {};

private:
  int Column(int i) const {
    if (this->Raster_.periodic) {
      i -= this->Window_.column;
      i -= int(FloorDiv(i, this->Columns_)) * this->Columns_;
    } else {
      i = std::clamp(i, 0, this->Columns_ - 1) - this->Window_.column;
    }
    return std::clamp(i, 0, this->Window_.width - 1) * Step;
  }
  const float* Row(int j) const {
    j = std::clamp(j, 0, this->Rows_ - 1) - this->Window_.row;
    return this->Cells_ +
           std::size_t(std::clamp(j, 0, this->Window_.height - 1)) * this->Window_.width * Step;
  }

  const RasterPosition& Raster_;
  const LevelWindow& Window_;
  Eigen::Vector2d Scale_;
  int Columns_;
  int Rows_;
  const float* Cells_;
};

} // namespace

// All pixels that its texels touch, and the least sides of a texel along x and y.
Eigen::AlignedBox2d SquareReader::Reach(TexelSquare& square, Eigen::Vector2d& texel) const {
  Eigen::AlignedBox2d reach;
  Eigen::Vector2d least = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d leastTorn = least;
  for (int y = 0; y < Side; ++y) {
    for (int x = 0; x < Side; ++x) {
      const TexelPlaces::State state = square.places.StateOf(x, y);
      if (state == TexelPlaces::State::Absent) {
        continue;
      }
      const TexelCorners corners = square.places.CornersOf(x, y);
      const Eigen::Vector2d across = corners.Across();
      const Eigen::Vector2d down = corners.Down();
      const Eigen::Vector2d size = (across.cwiseAbs2() + down.cwiseAbs2()).cwiseSqrt();
      if (state == TexelPlaces::State::Regular) {
        least = least.cwiseMin(size);
        for (const Eigen::Vector2d& corner : corners.at) {
          reach.extend(corner);
        }
        continue;
      }
      leastTorn = size.allFinite() ? Eigen::Vector2d(leastTorn.cwiseMin(size)) : leastTorn;
      for (int j = 0; j < TornPlaces; ++j) {
        for (int i = 0; i < TornPlaces; ++i) {
          const Eigen::Vector2d p =
              square.places.Exact(x + (i + 0.5) / TornPlaces, y + (j + 0.5) / TornPlaces);
          square.torn.push_back(p);
          if (p.allFinite()) {
            reach.extend(p);
          }
        }
      }
    }
  }
  texel = least.allFinite() ? least : leastTorn.allFinite() ? leastTorn : Eigen::Vector2d::Ones();
  return reach;
}

// Those of the window's level, widened by what interpolation needs.
bool SquareReader::Columns(const Eigen::AlignedBox2d& reach, LevelWindow& window) const {
  const double scale = this->CellsAPixel(window).x();
  const int columns = this->Levels_.ColumnsAt(window.levelX);
  const double width = this->Raster_.width;
  const double turn = this->Raster_.turn;
  double from = reach.min().x();
  double to = reach.max().x();
  if (this->Raster_.periodic) {
    const double shift = turn * std::floor(from / turn);
    const double first = std::floor((from - shift) * scale - 0.5) - 1.0;
    const double last = std::ceil((to - shift) * scale + 0.5) + 1.0;
    window.column = last - first >= columns ? 0 : int(first + columns) % columns;
    window.width = last - first >= columns ? columns : int(last - first);
    return true;
  }
  Eigen::AlignedBox1d both;
  for (int k = turn > 0.0 ? -1 : 0; k <= (turn > 0.0 ? 1 : 0); ++k) {
    const double near =
        turn > 0.0 ? turn * (k - std::round((0.5 * (from + to) - 0.5 * width) / turn)) : 0.0;
    const double left = std::max(0.0, from + near);
    const double right = std::min(width, to + near);
    if (left <= right) {
      both.extend(Eigen::Matrix<double, 1, 1>(left));
      both.extend(Eigen::Matrix<double, 1, 1>(right));
    }
  }
  if (both.isEmpty()) {
    return false;
  }
  window.column = std::max(0, int(std::floor(both.min().x() * scale - 0.5)) - 1);
  window.width =
      std::min(columns, int(std::ceil(both.max().x() * scale + 0.5)) + 1) - window.column;
  return true;
}

bool SquareReader::Settle(TexelSquare& square) const {
  Eigen::Vector2d texel;
  const Eigen::AlignedBox2d reach = this->Reach(square, texel);
  const double top = std::max(0.0, reach.min().y());
  const double bottom = std::min<double>(this->Raster_.height, reach.max().y());
  if (reach.isEmpty() || !(top <= bottom)) {
    return false;
  }
  const auto levelOf = [](double side) {
    return int(std::clamp(std::floor(std::log2(std::max(side, 1.0) / LeastCells)), 0.0, 30.0));
  };
  LevelWindow& window = square.window;
  window.levelX = levelOf(texel.x());
  window.levelY = levelOf(texel.y());
  while (true) {
    const double scale = this->CellsAPixel(window).y();
    window.row = std::max(0, int(std::floor(top * scale - 0.5)) - 1);
    window.height =
        std::min(this->Levels_.RowsAt(window.levelY), int(std::ceil(bottom * scale + 0.5)) + 1) -
        window.row;
    if (!this->Columns(reach, window)) {
      return false;
    }
    if (double(window.width) * window.height <= MostCells) {
      return true;
    }
    ++(window.width > window.height ? window.levelX : window.levelY); // about a pole
  }
}

void SquareReader::Read(const LevelWindow& window, std::vector<float>& cells) const {
  const int step = this->Levels_.Channels() + 1;
  const int columns = this->Levels_.ColumnsAt(window.levelX);
  cells.resize(std::size_t(window.width) * window.height * step);
  if (window.column + window.width <= columns) {
    this->Levels_.Read(window, cells.data());
    return;
  }
  std::vector<float> part; // across the seam
  for (int done = 0; done < window.width;) {
    LevelWindow piece = window;
    piece.column = (window.column + done) % columns;
    piece.width = std::min(columns - piece.column, window.width - done);
    part.resize(std::size_t(piece.width) * piece.height * step);
    this->Levels_.Read(piece, part.data());
    for (int y = 0; y < piece.height; ++y) {
      std::copy_n(part.data() + std::size_t(y) * piece.width * step, piece.width * step,
                  cells.data() + (std::size_t(y) * window.width + done) * step);
    }
    done += piece.width;
  }
}

void SquareReader::Sample(const TexelSquare& square, const LevelWindow& window,
                          const std::vector<float>& cells, const ColorBlock& block,
                          float* texels) const {
  const Eigen::Vector2d scale = this->CellsAPixel(window);
  const auto run = [&](auto summing) {
    constexpr int Step = sizeof(summing.Sum) / sizeof(float);
    auto torn = square.torn.begin();
    for (int y = 0; y < Side; ++y) {
      for (int x = 0; x < Side; ++x) {
        const TexelPlaces::State state = square.places.StateOf(x, y);
        const auto places = torn;
        torn += state == TexelPlaces::State::Torn ? TornPlaces * TornPlaces : 0;
        const int column = square.blockColumn + x;
        const int row = square.blockRow + y;
        if (state == TexelPlaces::State::Absent || column < 0 || column >= block.width || row < 0 ||
            row >= block.height) {
          continue;
        }
        std::fill_n(summing.Sum, Step, 0.0f);
        int count = TornPlaces * TornPlaces;
        if (state == TexelPlaces::State::Torn) {
          std::for_each(places, torn, [&](const Eigen::Vector2d& p) { summing.Add(p); });
        } else {
          const TexelCorners corners = square.places.CornersOf(x, y);
          const auto placesAlong = [&](const Eigen::Vector2d& side) {
            const double cellsLong = side.cwiseAbs().cwiseProduct(scale).maxCoeff();
            return int(std::clamp(std::ceil(cellsLong - 0.01), 1.0, double(MostPlaces)));
          };
          const int across = placesAlong(corners.Across());
          const int down = placesAlong(corners.Down());
          count = across * down;
          for (int j = 0; j < down; ++j) {
            for (int i = 0; i < across; ++i) {
              summing.Add(corners.Inside((i + 0.5) / across, (j + 0.5) / down));
            }
          }
        }
        float* to = texels + (std::size_t(row) * block.width + column) * Step;
        for (int k = 0; k < Step; ++k) {
          to[k] = summing.Sum[k] / float(count);
        }
      }
    }
  };
  const int columns = this->Levels_.ColumnsAt(window.levelX);
  const int rows = this->Levels_.RowsAt(window.levelY);
  if (this->Levels_.Channels() == 1) {
    run(Summing<2>(this->Raster_, window, scale, columns, rows, cells.data()));
  } else {
    run(Summing<4>(this->Raster_, window, scale, columns, rows, cells.data()));
  }
}

} // namespace dspace
