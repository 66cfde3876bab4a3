#include <dspace/groups/Patch.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <dspace/Error.h>

#include <dspace/posts/PostFacets.h>

namespace dspace {
namespace {

// Of the sphere that heights are above.
std::optional<double> ZeroRadius(const VerticalDatum& datum, const BodyAxes& axes) {
  switch (datum.kind) {
  case VerticalDatum::Kind::Sphere:
  case VerticalDatum::Kind::Radius:
    if (datum.radius > 0.0 || axes.semiMajor > 0.0) {
      return datum.radius > 0.0 ? datum.radius : axes.semiMajor;
    }
    return std::nullopt;
  case VerticalDatum::Kind::Ellipsoid:
    if (axes.semiMajor > 0.0 && axes.semiMajor == axes.semiMinor) {
      return axes.semiMajor;
    }
    return std::nullopt;
  default:
    return std::nullopt;
  }
}

std::string NameOf(const TerrainPatch& options) {
  return options.name.empty() ? options.path : options.name;
}

} // namespace

Patch::Patch(const ElevationInfo& base, const TerrainPatch& options,
             std::vector<std::string>& warnings)
    : Object_("patch '" + NameOf(options) + "'"),
      Source_(std::make_shared<const ElevationSource>(options.path, options.elevation)),
      Place_(Object_, base, Source_->Info()) {
  const ElevationInfo& info = this->Source_->Info();
  const Eigen::Vector2d& metres = this->Place_.Metres();
  this->Posts_ = std::make_shared<const RasterPosts>(this->Source_, [] {
    RasterPostsOptions posts;
    posts.coarsest = 2;
    return posts;
  }());
  this->Report_.name = NameOf(options);
  this->Report_.pixel = metres.maxCoeff();
  this->Report_.margin = options.margin.value_or(
      0.1 * std::min(info.window.width * metres.x(), info.window.height * metres.y()));
  if (!(this->Report_.margin > 0.0 && std::isfinite(this->Report_.margin))) {
    throw Error(Error::Kind::InvalidArgument, this->Object_,
                "margin " + std::to_string(this->Report_.margin) +
                    " m given; accepted is a positive, finite number");
  }
  for (const std::string& warning : info.warnings) {
    warnings.push_back(this->Object_ + ": " + warning);
  }
  const VerticalDatum& under = base.verticalDatum;
  const std::optional<double> zero = ZeroRadius(info.verticalDatum, info.crs.GetAxes());
  const std::optional<double> zeroUnder = ZeroRadius(under, base.crs.GetAxes());
  if (zero && zeroUnder) {
    this->Report_.addedTo = *zero - *zeroUnder;
  } else if (info.verticalDatum.Text() != under.Text() ||
             under.kind == VerticalDatum::Kind::Relative) {
    warnings.push_back(this->Object_ + ": its vertical datum is " + info.verticalDatum.Text() +
                       ", that of the raster below " + under.Text() +
                       ": no way between the two is known, and its heights are used as they are");
  }
}

bool Patch::Attach(const PostLattice& lattice, const Eigen::Affine2d& postToMap, bool poles,
                   std::vector<std::string>& warnings) {
  this->Place_.SetLattice(lattice, postToMap, poles);
  if (!this->Place_.Inside()) {
    warnings.push_back(this->Object_ + " lies wholly outside the raster below: it adds nothing");
    return false;
  }
  this->Weight_ = std::make_shared<const PatchWeight>(*this->Source_, this->Place_.Metres(),
                                                      this->Report_.margin);
  if (this->Weight_->Empty()) {
    warnings.push_back(this->Object_ + " is wholly without data: it adds nothing");
    return false;
  }
  if (!(this->Weight_->Greatest() > 0.0)) {
    warnings.push_back(this->Object_ +
                       " has no place that is 3 pixels within its edge and from its holes: it adds "
                       "nothing");
    return false;
  }
  if (this->Weight_->Greatest() < 1.0) {
    warnings.push_back(
        this->Object_ + ": no place in it is its margin of " +
        std::to_string(this->Report_.margin) +
        " m away from its edge and holes: it is blended everywhere; a smaller margin "
        "shows it as it is");
  }
  this->Report_.used = true;
  this->PostPixels_ = this->Place_.PostSize();
  for (int k = 0; k < 2; ++k) {
    this->Report_.heights[k] = this->Weight_->Heights()[k] + this->Report_.addedTo;
  }
  this->Report_.heightsAreExact = this->Weight_->HeightsAreExact();
  return true;
}

Patch::Patch(const Patch& other, const ElevationInfo& on)
    : Object_(other.Object_), Source_(other.Source_), Place_(Object_, on, Source_->Info()),
      Report_(other.Report_), Posts_(other.Posts_), Weight_(other.Weight_) {}

bool Patch::Reattach(const PostLattice& lattice, const Eigen::Affine2d& postToMap) {
  this->Place_.SetLattice(lattice, postToMap, false);
  this->PostPixels_ = this->Place_.PostSize();
  return this->Place_.Inside();
}

PatchPlace::Corners Patch::CornersAbout(std::int64_t column, std::int64_t row) const {
  PatchPlace::Corners square;
  for (square.size = PatchPlace::SquareSize;; square.size /= 2) {
    square.column = FloorDiv(column, square.size) * square.size;
    square.row = FloorDiv(row, square.size) * square.size;
    if (!this->Place_.Projects()) {
      if (this->Place_.Interpolates(square, Tolerance)) {
        return square;
      }
      continue;
    }
    const std::array<std::int64_t, 3> key = {square.size, square.column, square.row};
    {
      const std::lock_guard<std::mutex> lock(this->Mutex_);
      if (const std::optional<PatchPlace::Corners>* kept = this->Corners_.Find(key)) {
        if (*kept) {
          return **kept;
        }
        continue;
      }
    }
    const bool good = this->Place_.Interpolates(square, Tolerance);
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    this->Corners_.Insert(key, good ? std::optional(square) : std::nullopt);
    if (good) {
      return square;
    }
  }
}

int Patch::LevelFor(int level) const {
  return std::max(0, int(std::lround(std::log2(this->PostPixels_) + level)));
}

std::array<double, 2> Patch::HeightsIn(const Eigen::AlignedBox2d& posts) const {
  constexpr double Infinity = std::numeric_limits<double>::infinity();
  if (!this->Place_.Touches(posts)) {
    return {Infinity, -Infinity};
  }
  // Heights come from its posts about a place, and those of a coarser level from pixels about them.
  const double more = 2.0 + 2.0 * std::ldexp(1.0, this->LevelFor(0));
  const Eigen::AlignedBox2d places = this->Place_.PixelBox(posts);
  std::array<double, 2> range =
      this->Weight_->Ranges().Of({places.min() - Eigen::Vector2d::Constant(more),
                                  places.max() + Eigen::Vector2d::Constant(more)});
  for (int k = 0; range[0] <= range[1] && k < 2;
       ++k) { // its posts are floats before the datum is added
    range[k] += (k == 0 ? -1.2e-7 : 1.2e-7) * std::abs(range[k]) + this->Report_.addedTo;
  }
  return range;
}

// Its heights about a number of places: a block of its posts, and the triangles between them.
class Patch::Heights {
public:
  // `posts` are the places, in its level-0 posts.
  Heights(const RasterPosts& source, int level, const Eigen::AlignedBox2d& places)
      : Lattice_(source.GetLattice()), Step_(std::ldexp(1.0, level)) {
    const std::int64_t columns = this->Lattice_.ColumnsAt(level);
    const std::int64_t rows = this->Lattice_.RowsAt(level);
    this->Cells_ = {Of(places.min().x(), columns), Of(places.max().x(), columns),
                    Of(places.min().y(), rows), Of(places.max().y(), rows)};
    this->Block_ = {level, this->Cells_.firstColumn, this->Cells_.firstRow,
                    int(this->Cells_.lastColumn - this->Cells_.firstColumn) + 2,
                    int(this->Cells_.lastRow - this->Cells_.firstRow) + 2};
    this->Posts_.resize(std::size_t(this->Block_.width) * this->Block_.height);
    source.Read(this->Block_, this->Posts_.data());
  }

  // NaN where there is none. Between coarser posts of which some have no data, the mean of those
  // that have, by their nearness.
  double At(const Eigen::Vector2d& place) const {
    const std::int64_t c = std::clamp(std::int64_t(std::floor(place.x() / this->Step_)),
                                      this->Cells_.firstColumn, this->Cells_.lastColumn);
    const std::int64_t r = std::clamp(std::int64_t(std::floor(place.y() / this->Step_)),
                                      this->Cells_.firstRow, this->Cells_.lastRow);
    const int level = this->Block_.level;
    const auto share = [](double at, std::int64_t from, std::int64_t to) {
      return std::clamp((at - double(from)) / double(to - from), 0.0, 1.0);
    };
    const double u = share(place.x(), this->Lattice_.ColumnPlace(level, c),
                           this->Lattice_.ColumnPlace(level, c + 1));
    const double v =
        share(place.y(), this->Lattice_.RowPlace(level, r), this->Lattice_.RowPlace(level, r + 1));
    const auto at = [this](std::int64_t i, std::int64_t j) -> double {
      return this->Posts_[std::size_t(j - this->Block_.row) * this->Block_.width +
                          std::size_t(i - this->Block_.column)];
    };
    const HeightGrid::Facet facet = FacetOfCell(at, c, r, v > u, u, v);
    if (facet.valid) {
      return facet.height;
    }
    double sum = 0.0;
    double weight = 0.0;
    for (int k = 0; level > 0 && k < 4; ++k) {
      const double height = at(c + k % 2, r + k / 2);
      const double near = (k % 2 ? u : 1.0 - u) * (k / 2 ? v : 1.0 - v);
      if (!std::isnan(height)) {
        sum += near * height;
        weight += near;
      }
    }
    return weight > 1e-6 ? sum / weight : std::numeric_limits<double>::quiet_NaN();
  }

private:
  std::int64_t Of(double place, std::int64_t posts) const {
    return std::clamp<std::int64_t>(std::int64_t(std::floor(place / this->Step_)), 0, posts - 2);
  }

  const PostLattice& Lattice_;
  double Step_;
  CellRange Cells_;
  PostBlock Block_;
  std::vector<float> Posts_;
};

void Patch::Blend(const PostBlock& block, float* heights, const FilledMask& filledMask) const {
  const int wanted = this->LevelFor(block.level);
  const int level = std::min(wanted, this->Posts_->GetLattice().levels - 1);
  std::vector<Eigen::Vector2d> pixels;
  if (!this->Place_.PixelsOf(block, std::ldexp(Tolerance, wanted), pixels)) {
    return;
  }
  std::vector<double> weights(pixels.size(), 0.0);
  Eigen::AlignedBox2d places;
  const RasterWindow& window = this->Source_->Info().window;
  const Eigen::Vector2d last(window.width - 1.0, window.height - 1.0);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (pixels[i].allFinite()) {
      weights[i] = this->Weight_->At(pixels[i], wanted);
    }
    if (weights[i] > 0.0) { // means of weights reach beyond the last posts
      pixels[i] = (pixels[i] - Eigen::Vector2d::Constant(0.5)).cwiseMax(0.0).cwiseMin(last);
      places.extend(pixels[i]);
    }
  }
  if (places.isEmpty()) {
    return;
  }
  std::vector<char>* made = filledMask ? &filledMask() : nullptr;
  const Heights own(*this->Posts_, level, places);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!(weights[i] > 0.0)) {
      continue;
    }
    const double height = own.At(pixels[i]) + this->Report_.addedTo;
    const double under = heights[i];
    if (!std::isnan(height)) {
      const bool alone = weights[i] >= Whole || std::isnan(under) || (made && (*made)[i]);
      heights[i] = float(alone ? height : under + weights[i] * (height - under));
      if (made) {
        (*made)[i] = 0;
      }
    }
  }
}

} // namespace dspace
