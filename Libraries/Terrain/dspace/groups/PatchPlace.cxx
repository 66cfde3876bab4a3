#include <dspace/groups/PatchPlace.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <dspace/Error.h>

#include <dspace/crs/CrsTransform.h>
#include <dspace/crs/MapTurn.h>

namespace dspace {
namespace {

constexpr double Degree = M_PI / 180.0;
constexpr double OneBody = 0.01; // of an axis: what spheres of one body differ by at most
const Eigen::Vector2d Nowhere = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());

std::string NameOf(const Crs& crs) {
  return crs.GetKind() == Crs::Kind::None
             ? std::string("none")
             : "'" + crs.GetName() + "' (semi-major axis " +
                   std::to_string(std::llround(crs.GetAxes().semiMajor)) + " m)";
}

void RejectOthers(const std::string& object, const Crs& base, const Crs& patch) {
  const bool baseHas = base.Ogr() != nullptr;
  const bool patchHas = patch.Ogr() != nullptr;
  if (baseHas != patchHas) {
    throw Error(Error::Kind::InvalidArgument, object,
                "its CRS is " + NameOf(patch) + ", that of the raster below is " + NameOf(base) +
                    "; accepted is a CRS for both (give crs), or for neither");
  }
  const double a = base.GetAxes().semiMajor;
  const double b = patch.GetAxes().semiMajor;
  if (a > 0.0 && b > 0.0 && std::abs(a - b) > OneBody * a) {
    throw Error(Error::Kind::InvalidArgument, object,
                "it is of another body: its CRS is " + NameOf(patch) +
                    ", that of the raster below is " + NameOf(base) +
                    "; accepted is a patch of the same body");
  }
}

Eigen::Vector2d Applied(const CrsTransform* transform, const Eigen::Vector2d& p, bool inverse) {
  if (!p.allFinite() || !transform) {
    return p;
  }
  try {
    return inverse ? transform->ApplyInverse(p) : transform->Apply(p);
  } catch (const Error&) {
    return Nowhere;
  }
}

} // namespace

PatchPlace::PatchPlace(const std::string& object, const ElevationInfo& base,
                       const ElevationInfo& patch)
    : Base_(base), Patch_(patch), MapToPixel_(patch.pixelToMap.inverse()) {
  RejectOthers(object, base.crs, patch.crs);
  if (base.crs.Ogr() && base.crs.GetWkt() != patch.crs.GetWkt()) {
    this->Transform_ = std::make_shared<const CrsTransform>(base.crs, patch.crs);
  }
  this->BaseTurn_ = MapTurn(base.crs);
  if (this->MapToPixel_.linear()(1, 0) == 0.0) {
    this->PatchTurn_ = MapTurn(patch.crs) * std::abs(this->MapToPixel_.linear()(0, 0));
  }
  this->FindSizes();
}

Eigen::Vector2d PatchPlace::PixelOf(const Eigen::Vector2d& baseMap) const {
  Eigen::Vector2d pixel = this->MapToPixel_ * Applied(this->Transform_.get(), baseMap, false);
  if (this->PatchTurn_ > 0.0) {
    const double middle = 0.5 * this->Patch_.window.width;
    pixel.x() -= this->PatchTurn_ * std::round((pixel.x() - middle) / this->PatchTurn_);
  }
  return pixel;
}

Eigen::Vector2d PatchPlace::BaseMapOf(const Eigen::Vector2d& pixel) const {
  return Applied(this->Transform_.get(), this->Patch_.pixelToMap * pixel, true);
}

void PatchPlace::FindSizes() {
  const RasterWindow& window = this->Patch_.window;
  const Eigen::Vector2d middle(0.5 * window.width, 0.5 * window.height);
  const Eigen::Affine2d& toMap = this->Patch_.pixelToMap;
  const Crs& crs = this->Patch_.crs;
  const auto half = [](int axis) { return Eigen::Vector2d(0.5 * Eigen::Vector2d::Unit(axis)); };
  std::unique_ptr<CrsTransform> geographic;
  double degrees = 1.0;
  if (crs.HasGeographic()) {
    const Crs below = crs.Geographic();
    geographic = std::make_unique<CrsTransform>(crs, below);
    degrees = below.GetUnit();
  }
  for (const int axis : {0, 1}) {
    this->Metres_[axis] = toMap.linear().col(axis).norm() * crs.GetUnit();
    if (geographic) {
      const auto direction = [&](const Eigen::Vector2d& pixel) {
        const Eigen::Vector2d p =
            Applied(geographic.get(), toMap * pixel, false) * degrees * Degree;
        return Eigen::Vector3d(std::cos(p.y()) * std::cos(p.x()), std::cos(p.y()) * std::sin(p.x()),
                               std::sin(p.y()));
      };
      const double metres =
          crs.GetAxes().semiMajor *
          (direction(middle + half(axis)) - direction(middle - half(axis))).norm();
      if (std::isfinite(metres) && metres > 0.0) {
        this->Metres_[axis] = metres;
      } else if (crs.GetKind() == Crs::Kind::Geographic) {
        this->Metres_[axis] =
            toMap.linear().col(axis).norm() * crs.GetUnit() * Degree * crs.GetAxes().semiMajor;
      }
    }
  }
  // A thousandth of a base pixel's side, since the whole of it may leave the projection.
  const double part = 1.0 / 1024.0;
  Eigen::Vector2d least = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  for (int j = 0; j <= 8; ++j) {
    for (int i = 0; i <= 8; ++i) {
      const Eigen::Vector2d map =
          this->BaseMapOf({window.width * i / 8.0, window.height * j / 8.0});
      const Eigen::Vector2d here = this->PixelOf(map);
      for (const int axis : {0, 1}) {
        const Eigen::Vector2d side = this->Base_.pixelToMap.linear().col(axis) * part;
        const double size = (this->PixelOf(map + side) - here).norm() / part;
        if (std::isfinite(size)) {
          this->BasePixel_ = std::max(this->BasePixel_, size);
          least[axis] = std::min(least[axis], size);
        }
      }
    }
  }
  const double tiny = 1e-9 * this->BasePixel_; // where meridians meet
  this->Widening_ = 2.0 * this->BasePixel_ * least.cwiseMax(tiny).cwiseInverse();
}

void PatchPlace::SetLattice(const PostLattice& lattice, const Eigen::Affine2d& postToBaseMap,
                            bool poles) {
  this->Lattice_ = lattice;
  this->PostToBaseMap_ = postToBaseMap;
  this->Poles_ = poles;
  this->Turn_ = 0.0;
  if (lattice.periodic) {
    this->Turn_ = double(lattice.columns);
  } else if (postToBaseMap.linear()(1, 0) == 0.0) {
    this->Turn_ = this->BaseTurn_ / std::abs(postToBaseMap.linear()(0, 0));
  }
  this->FindReach();
}

double PatchPlace::Unwrapped(double column) const {
  if (this->Turn_ > 0.0) {
    const double middle = 0.5 * (this->Columns_.from + this->Columns_.to);
    column -= this->Turn_ * std::round((column - middle) / this->Turn_);
  }
  return column;
}

Eigen::Vector2d PatchPlace::PostOf(const Eigen::Vector2d& pixel) const {
  Eigen::Vector2d post = this->PostToBaseMap_.inverse() * this->BaseMapOf(pixel);
  if (this->Lattice_.periodic) {
    post.x() -= this->Turn_ * std::floor(post.x() / this->Turn_);
  } else if (this->Turn_ > 0.0) {
    const double middle = 0.5 * double(this->Lattice_.columns - 1);
    post.x() -= this->Turn_ * std::round((post.x() - middle) / this->Turn_);
  }
  return post;
}

double PatchPlace::PostSize() const {
  return this->BasePixel_ * this->PostToBaseMap_.linear().col(0).norm() /
         this->Base_.pixelToMap.linear().col(0).norm();
}

// By places along the patch's edges and within.
void PatchPlace::FindReach() {
  const RasterWindow& window = this->Patch_.window;
  std::vector<Eigen::Vector2d> posts;
  const auto take = [&](double u, double v) {
    Eigen::Vector2d post = this->PostOf({u * window.width, v * window.height});
    if (!post.allFinite()) {
      return;
    }
    if (!posts.empty() && this->Turn_ > 0.0) {
      post.x() -= this->Turn_ * std::round((post.x() - posts.front().x()) / this->Turn_);
    }
    posts.push_back(post);
  };
  take(0.5, 0.5);
  constexpr int Edge = 64;
  for (int i = 0; i <= Edge; ++i) {
    const double s = double(i) / Edge;
    take(s, 0.0);
    take(s, 1.0);
    take(0.0, s);
    take(1.0, s);
  }
  constexpr int Within = 12;
  for (int j = 1; j < Within; ++j) {
    for (int i = 1; i < Within; ++i) {
      take(double(i) / Within, double(j) / Within);
    }
  }
  this->Inside_ = !posts.empty();
  if (posts.empty()) {
    return;
  }
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& post : posts) {
    box.extend(post);
  }
  const Eigen::Vector2d more = 0.02 * box.sizes() + Eigen::Vector2d::Ones(); // between the places
  this->Columns_ = {box.min().x() - more.x(), box.max().x() + more.x(), false};
  this->Rows_ = {box.min().y() - more.y(), box.max().y() + more.y(), false};
  this->Columns_.all = this->Turn_ > 0.0 && box.sizes().x() > 0.4 * this->Turn_;
  this->InitPoles();
  const auto& lattice = this->Lattice_;
  this->Inside_ = this->Rows_.to >= 0.0 && this->Rows_.from <= double(lattice.rows - 1);
  if (!lattice.periodic && !this->Columns_.all) { // the first post was nearest to the middle
    this->Inside_ &= this->Columns_.to >= 0.0 && this->Columns_.from <= double(lattice.columns - 1);
  }
}

// About a pole a patch reaches all longitudes, and all rows as far as the pole.
void PatchPlace::InitPoles() {
  const Crs& crs = this->Base_.crs;
  if (!(this->Turn_ > 0.0) || !crs.HasGeographic()) {
    return;
  }
  const Crs geographic = crs.Geographic();
  const CrsTransform toBase(geographic, crs);
  const Eigen::Vector2d size(this->Patch_.window.width, this->Patch_.window.height);
  for (const double latitude : {-90.0, 90.0}) {
    const Eigen::Vector2d map = Applied(&toBase, {0.0, latitude / geographic.GetUnit()}, false);
    const Eigen::Vector2d pixel = this->PixelOf(map);
    if (pixel.allFinite() && pixel.minCoeff() >= -1.0 && pixel.x() <= size.x() + 1.0 &&
        pixel.y() <= size.y() + 1.0) {
      const double row = (this->PostToBaseMap_.inverse() * map).y();
      this->Columns_.all = true;
      this->Rows_.from = std::min(this->Rows_.from, row);
      this->Rows_.to = std::max(this->Rows_.to, row);
    }
  }
}

bool PatchPlace::Reaches(const Eigen::Vector2d& post, int level, double sides) const {
  const Eigen::Vector2d widened = std::ldexp(0.5 * sides, level) * this->Widening_;
  return this->Inside_ && this->Columns_.Has(this->Unwrapped(post.x()), widened.x()) &&
         this->Rows_.Has(post.y(), widened.y());
}

bool PatchPlace::Touches(const Eigen::AlignedBox2d& posts) const {
  const auto meets = [](const Reach& reach, double from, double to, double widened) {
    return reach.all || (to >= reach.from - widened && from <= reach.to + widened);
  };
  const Eigen::Vector2d half = 0.5 * posts.sizes();
  const double column = this->Unwrapped(posts.center().x()); // the nearest turn
  return this->Inside_ &&
         meets(this->Columns_, column - half.x(), column + half.x(), this->Widening_.x()) &&
         meets(this->Rows_, posts.min().y(), posts.max().y(), this->Widening_.y());
}

// Posts k..k+size-1, j..j+size-1 of a level, of which those of the block are wanted.
struct PatchPlace::Square {
  int level = 0;
  std::int64_t k = 0;
  std::int64_t j = 0;
  std::int64_t size = 0;
  std::int64_t kFrom = 0, kTo = 0, jFrom = 0, jTo = 0; // wanted
  std::int64_t kToColumn = 0, jToRow = 0;              // to places in the block
};

// Finds the pixels at the corners; false where places between them depart by more than `tolerance`.
bool PatchPlace::Interpolates(Corners& square, double tolerance) const {
  if (square.size == 1) {
    square.pixels[0] =
        this->PixelOfPost({double(this->Lattice_.ColumnPlace(square.level, square.column)),
                           double(this->Lattice_.RowPlace(square.level, square.row))});
    return true;
  }
  const double step = std::ldexp(1.0, square.level);
  const Eigen::Vector2d first(double(square.column) * step, double(square.row) * step);
  const double side = double(square.size) * step;
  const auto exact = [&](double u, double v) {
    return this->PixelOfPost(first + Eigen::Vector2d(u, v) * side);
  };
  square.pixels = {exact(0, 0), exact(1, 0), exact(0, 1), exact(1, 1)};
  if (!this->Transform_ && this->PatchTurn_ == 0.0) {
    return true; // the map from posts to pixels is affine
  }
  bool good = true;
  for (const auto& [u, v] : {std::pair(0.5, 0.5),
                             {0.5, 0.0},
                             {0.5, 1.0},
                             {0.0, 0.5},
                             {1.0, 0.5},
                             {0.25, 0.25},
                             {0.75, 0.25},
                             {0.25, 0.75},
                             {0.75, 0.75}}) {
    // Written so that what is not finite fails.
    good = good && (square.At(u, v) - exact(u, v)).norm() <= tolerance;
  }
  return good;
}

void PatchPlace::Fill(const Square& s, double tolerance, const PostBlock& block,
                      std::vector<Eigen::Vector2d>& pixels) const {
  const std::int64_t k0 = std::max(s.k, s.kFrom);
  const std::int64_t k1 = std::min(s.k + s.size, s.kTo);
  const std::int64_t j0 = std::max(s.j, s.jFrom);
  const std::int64_t j1 = std::min(s.j + s.size, s.jTo);
  const Eigen::Vector2d widened = std::ldexp(1.0, s.level) * this->Widening_;
  const PostLattice& lattice = this->Lattice_;
  const auto reachesColumn = [&](std::int64_t k) {
    return this->Columns_.Has(this->Unwrapped(double(lattice.ColumnPlace(s.level, k))),
                              widened.x());
  };
  const auto reachesRow = [&](std::int64_t j) {
    return this->Rows_.Has(double(lattice.RowPlace(s.level, j)), widened.y());
  };
  bool any = false;
  for (std::int64_t k = k0; k < k1 && !any; ++k) {
    any = reachesColumn(k);
  }
  bool anyRow = false;
  for (std::int64_t j = j0; j < j1 && any && !anyRow; ++j) {
    anyRow = reachesRow(j);
  }
  if (!any || !anyRow) {
    return;
  }
  const auto put = [&](std::int64_t k, std::int64_t j, const Eigen::Vector2d& pixel) {
    pixels[std::size_t(j + s.jToRow) * block.width + std::size_t(k + s.kToColumn)] = pixel;
  };
  if (s.size == 1) {
    put(s.k, s.j,
        this->PixelOfPost(
            {double(lattice.ColumnPlace(s.level, s.k)), double(lattice.RowPlace(s.level, s.j))}));
    return;
  }
  const double step = std::ldexp(1.0, s.level);
  const Eigen::Vector2d first(double(s.k) * step, double(s.j) * step);
  const double side = double(s.size) * step;
  Corners corners{s.level, s.k, s.j, s.size, {}};
  if (!this->Interpolates(corners, tolerance)) {
    Square quarter = s;
    quarter.size = s.size / 2;
    for (const int y : {0, 1}) {
      for (const int x : {0, 1}) {
        quarter.k = s.k + x * quarter.size;
        quarter.j = s.j + y * quarter.size;
        this->Fill(quarter, tolerance, block, pixels);
      }
    }
    return;
  }
  for (std::int64_t j = j0; j < j1; ++j) {
    const double v = (double(lattice.RowPlace(s.level, j)) - first.y()) / side;
    for (std::int64_t k = k0; reachesRow(j) && k < k1; ++k) {
      if (reachesColumn(k)) {
        put(k, j, corners.At((double(lattice.ColumnPlace(s.level, k)) - first.x()) / side, v));
      }
    }
  }
}

bool PatchPlace::PixelsOf(const PostBlock& block, double tolerance,
                          std::vector<Eigen::Vector2d>& pixels) const {
  const PostLattice& lattice = this->Lattice_;
  const std::int64_t columns = lattice.ColumnsAt(block.level);
  const std::int64_t rows = lattice.RowsAt(block.level);
  const Eigen::Vector2d widened = std::ldexp(1.0, block.level) * this->Widening_;
  bool reached = false;
  for (int i = 0; i < block.width && !reached; ++i) {
    const std::int64_t k = lattice.Wrapped(block.level, block.column + i);
    reached = this->Columns_.Has(this->Unwrapped(double(lattice.ColumnPlace(block.level, k))),
                                 widened.x());
  }
  const auto rowPlace = [&](std::int64_t j) { return double(lattice.RowPlace(block.level, j)); };
  if (!this->Inside_ || !reached ||
      (rowPlace(block.row) > this->Rows_.to + widened.y() ||
       rowPlace(block.row + block.height - 1) < this->Rows_.from - widened.y())) {
    return false;
  }
  pixels.assign(std::size_t(block.width) * block.height, Nowhere);
  Square square;
  square.level = block.level;
  square.size = SquareSize;
  for (int i = 0; i < block.width;) { // runs of columns within one square
    const std::int64_t k = lattice.Wrapped(block.level, block.column + i);
    square.k = FloorDiv(k, SquareSize) * SquareSize;
    std::int64_t run = std::min<std::int64_t>(square.k + SquareSize - k, block.width - i);
    if (lattice.periodic) {
      run = std::min(run, columns - k);
    }
    square.kFrom = std::max<std::int64_t>(k, 0);
    square.kTo = std::min(k + run, columns);
    square.kToColumn = i - k;
    const std::int64_t last = std::min(block.row + block.height, rows);
    square.jToRow = -block.row;
    for (std::int64_t j = std::max<std::int64_t>(block.row, 0); j < last;) {
      square.j = FloorDiv(j, SquareSize) * SquareSize;
      square.jFrom = j;
      square.jTo = std::min(square.j + SquareSize, last);
      this->Fill(square, tolerance, block, pixels);
      j = square.jTo;
    }
    i += int(run);
  }
  for (const std::int64_t j : {std::int64_t(0), rows - 1}) { // one place, one height
    if (this->Poles_ && j >= block.row && j < block.row + block.height) {
      std::fill_n(pixels.begin() + std::ptrdiff_t(j - block.row) * block.width, block.width,
                  this->Columns_.all ? this->PixelOfPost({0.0, rowPlace(j)}) : Nowhere);
    }
  }
  return true;
}

Eigen::AlignedBox2d PatchPlace::PixelBox(const Eigen::AlignedBox2d& posts) const {
  constexpr int Parts = 4;
  const Eigen::Vector2d endless =
      Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  std::array<Eigen::Vector2d, (Parts + 1) * (Parts + 1)> places;
  const auto at = [&places](int i, int j) -> Eigen::Vector2d& {
    return places[std::size_t(j) * (Parts + 1) + i];
  };
  Eigen::AlignedBox2d box;
  for (int j = 0; j <= Parts; ++j) {
    for (int i = 0; i <= Parts; ++i) {
      const Eigen::Vector2d share(double(i) / Parts, double(j) / Parts);
      at(i, j) = this->PixelOfPost(posts.min() + share.cwiseProduct(posts.sizes()));
      if (!at(i, j).allFinite()) {
        return {-endless, endless};
      }
      box.extend(at(i, j));
    }
  }
  // Between places a distance h apart straight lines are off by at most h^2 / 8 of the second
  // derivatives, of which the second differences are h^2: taken eightfold they are safe.
  double bend = 0.0;
  for (int j = 0; j <= Parts; ++j) {
    for (int i = 1; i < Parts; ++i) {
      bend = std::max(bend, (at(i - 1, j) - 2.0 * at(i, j) + at(i + 1, j)).norm());
      bend = std::max(bend, (at(j, i - 1) - 2.0 * at(j, i) + at(j, i + 1)).norm());
    }
  }
  if (bend > 0.25 * box.sizes().norm() + 1.0) {
    return {-endless, endless};
  }
  const Eigen::Vector2d more = Eigen::Vector2d::Constant(bend);
  return {box.min() - more, box.max() + more};
}

} // namespace dspace
