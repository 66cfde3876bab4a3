#include <dspace/layers/raster/SquareReader.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <dspace/posts/PostLattice.h>

namespace dspace {
namespace {

constexpr int Side = TexelPlaces::Side;
constexpr double LeastCells = 1.5; // a texel's side, in cells of the level that is read
constexpr int MaximumPlaces = 16;  // in a texel, a side
constexpr double MaximumCells = double(1 << 22); // read for one square

TexelRange Meet(const TexelPatch& patch, const TexelRange& range) {
  return {std::max(patch.x, range.left), std::max(patch.y, range.top),
          std::min(patch.x + patch.size, range.right),
          std::min(patch.y + patch.size, range.bottom)};
}

// All pixels that the texels touch.
Eigen::AlignedBox2d ReachOf(const TexelPlaces& places, const TexelRange& range) {
  constexpr int Torn = TexelPatch::TornPlaces * TexelPatch::TornPlaces;
  Eigen::AlignedBox2d reach;
  for (const TexelPatch& patch : places.Patches()) {
    const TexelRange r = Meet(patch, range);
    if (r.left >= r.right || r.top >= r.bottom) {
      continue;
    }
    if (patch.torn < 0) {
      for (const int y : {r.top, r.bottom}) {
        reach.extend(patch.At(r.left, y));
        reach.extend(patch.At(r.right, y));
      }
      continue;
    }
    for (int i = patch.torn; i < patch.torn + Torn; ++i) {
      const Eigen::Vector2d& p = places.Torn()[std::size_t(i)];
      if (p.allFinite()) {
        reach.extend(p);
      }
    }
  }
  return reach;
}

// The least sides of a texel along x and y. Of a patch each is a part of its rows and one of its
// columns, so that the least of both together is the least of all its texels.
Eigen::Vector2d LeastTexel(const TexelPlaces& places) {
  Eigen::Vector2d least = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d leastTorn = least;
  for (const TexelPatch& patch : places.Patches()) {
    const auto& at = patch.corners.at;
    Eigen::Vector2d across = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Vector2d down = across;
    for (int i = 0; i < patch.size; ++i) {
      const double part = (i + 0.5) / patch.size;
      across =
          across.cwiseMin(((1.0 - part) * (at[1] - at[0]) + part * (at[3] - at[2])).cwiseAbs2());
      down = down.cwiseMin(((1.0 - part) * (at[2] - at[0]) + part * (at[3] - at[1])).cwiseAbs2());
    }
    const Eigen::Vector2d size = (across + down).cwiseSqrt() / patch.size;
    if (patch.torn < 0) {
      least = least.cwiseMin(size);
    } else if (patch.corners.Across().allFinite() && patch.corners.Down().allFinite()) {
      leastTorn = leastTorn.cwiseMin(size);
    }
  }
  return least.allFinite() ? least : leastTorn.allFinite() ? leastTorn : Eigen::Vector2d::Ones();
}

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
    this->Add(above + x0, above + x1, below + x0, below + x1, u, v);
  }

  // `count` places from `first` on. Most lie between cells of the window, in the turn that `shift`
  // takes them to, where neither an edge nor a seam is to be looked for.
  void AddLine(const Eigen::Vector2d& first, const Eigen::Vector2d& step, int count, double shift) {
    Eigen::Vector2d cell =
        Eigen::Vector2d(first.x() + shift, first.y()).cwiseProduct(this->Scale_).array() - 0.5;
    const Eigen::Vector2d next = step.cwiseProduct(this->Scale_);
    const Eigen::Vector2d last = cell + double(count - 1) * next;
    const double left = std::min(cell.x(), last.x());
    const double right = std::max(cell.x(), last.x());
    double column = this->Window_.column;
    column -= this->Raster_.periodic && left < column ? this->Columns_ : 0;
    if (left >= std::max(0.0, column) && right < column + this->Window_.width - 1.0 &&
        right < this->Columns_ - 1.0 && std::min(cell.y(), last.y()) >= this->Window_.row &&
        std::max(cell.y(), last.y()) < this->Window_.row + this->Window_.height - 1.0) {
      cell -= Eigen::Vector2d(column, this->Window_.row);
      const std::size_t below = std::size_t(this->Window_.width) * Step;
      for (int i = 0; i < count; ++i, cell += next) {
        const int x = int(cell.x());
        const int y = int(cell.y());
        const float* at = this->Cells_ + y * below + std::size_t(x) * Step;
        this->Add(at, at + Step, at + below, at + below + Step, float(cell.x() - x),
                  float(cell.y() - y));
      }
      return;
    }
    for (int i = 0; i < count; ++i) {
      this->Add(first + i * step);
    }
  }

  using Values = Eigen::Array<float, Step, 1>;
  Values Sum = Values::Zero();
  static constexpr int Size = Step;

private:
  void Add(const float* above0, const float* above1, const float* below0, const float* below1,
           float u, float v) {
    using From = Eigen::Map<const Values>;
    const Values a = From(above0) + u * (From(above1) - From(above0));
    const Values b = From(below0) + u * (From(below1) - From(below0));
    this->Sum += a + v * (b - a);
  }
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

bool SquareReader::Rows(const Eigen::AlignedBox2d& reach, LevelWindow& window) const {
  const double scale = this->CellsAPixel(window).y();
  const double top = std::max(0.0, reach.min().y());
  const double bottom = std::min<double>(this->Raster_.height, reach.max().y());
  if (reach.isEmpty() || !(top <= bottom)) {
    return false;
  }
  window.row = std::max(0, int(std::floor(top * scale - 0.5)) - 1);
  window.height =
      std::min(this->Levels_.RowsAt(window.levelY), int(std::ceil(bottom * scale + 0.5)) + 1) -
      window.row;
  return true;
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

bool SquareReader::ChooseLevel(TexelSquare& square) const {
  const Eigen::AlignedBox2d wanted = ReachOf(square.places, square.wanted);
  const Eigen::AlignedBox2d all = ReachOf(square.places, TexelRange());
  const Eigen::Vector2d texel = LeastTexel(square.places);
  const auto levelOf = [](double side) {
    return int(std::clamp(std::floor(std::log2(std::max(side, 1.0) / LeastCells)), 0.0, 30.0));
  };
  LevelWindow& window = square.window;
  window.levelX = levelOf(texel.x());
  window.levelY = levelOf(texel.y());
  while (this->Rows(all, window) && this->Columns(all, window)) {
    if (double(window.width) * window.height <= MaximumCells) {
      return this->Rows(wanted, window) && this->Columns(wanted, window);
    }
    ++(window.width > window.height ? window.levelX : window.levelY); // about a pole
  }
  return false;
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
  const auto placesAlong = [&](const Eigen::Vector2d& side) {
    const double cellsLong = side.cwiseAbs().cwiseProduct(scale).maxCoeff();
    return int(std::clamp(std::ceil(cellsLong - 0.01), 1.0, double(MaximumPlaces)));
  };
  const auto run = [&](auto summing) {
    constexpr int Step = decltype(summing)::Size;
    const auto put = [&](int x, int y, int count) {
      float* to =
          texels + (std::size_t(square.blockRow + y) * block.width + square.blockColumn + x) * Step;
      for (int k = 0; k < Step; ++k) {
        to[k] = summing.Sum[k] / float(count);
      }
      summing.Sum.setZero();
    };
    std::array<int, Side> down; // places in texels of a column
    for (const TexelPatch& patch : square.places.Patches()) {
      const TexelRange r = Meet(patch, square.wanted);
      if (r.left >= r.right || r.top >= r.bottom) {
        continue;
      }
      if (patch.torn >= 0) {
        constexpr int Places = TexelPatch::TornPlaces * TexelPatch::TornPlaces;
        for (int i = patch.torn; i < patch.torn + Places; ++i) {
          summing.Add(square.places.Torn()[std::size_t(i)]);
        }
        put(patch.x, patch.y, Places);
        continue;
      }
      const double part = 1.0 / patch.size;
      const auto& at = patch.corners.at;
      const Eigen::Vector2d left = at[2] - at[0];
      const Eigen::Vector2d top = at[1] - at[0];
      const Eigen::Vector2d twist = at[3] - at[1] - left; // from `top` to the bottom edge
      const double turn = this->Raster_.turn;
      const double middle = patch.corners.Inside(0.5, 0.5).x() - 0.5 * this->Raster_.width;
      const double shift = turn > 0.0 ? -turn * std::round(middle / turn) : 0.0;
      for (int x = r.left; x < r.right; ++x) {
        down[std::size_t(x)] = placesAlong(part * (left + (x - patch.x + 0.5) * part * twist));
      }
      for (int y = r.top; y < r.bottom; ++y) {
        const int across = placesAlong(part * (top + (y - patch.y + 0.5) * part * twist));
        for (int x = r.left; x < r.right; ++x) {
          const int lines = down[std::size_t(x)];
          for (int j = 0; j < lines; ++j) {
            const double v = (y - patch.y + (j + 0.5) / lines) * part;
            const Eigen::Vector2d line = top + v * twist;
            const double u = (x - patch.x + 0.5 / across) * part;
            summing.AddLine(at[0] + v * left + u * line, part / across * line, across, shift);
          }
          put(x, y, across * lines);
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
