#include <dspace/clipmap/ClipmapLevels.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <dspace/Error.h>
#include <dspace/clipmap/ClipmapNoise.h>

namespace dspace {

double ClipmapLevels::InPosts(double distance, double cellSize, int level) {
  return std::ldexp(distance / cellSize, -level);
}

ClipmapLevels::ClipmapLevels(std::shared_ptr<ElevationPyramid> pyramid, int cells)
    : Pyramid_(std::move(pyramid)), Geometry_(cells), Levels_(this->Pyramid_->Lattice().levels) {
  const PostLattice& lattice = this->Lattice();
  const int top = lattice.levels - 1;
  // Around a body half of the columns lie to either side.
  const std::int64_t columns =
      lattice.periodic ? (lattice.ColumnsAt(top) + 1) / 2 : lattice.ColumnsAt(top) - 1;
  const std::int64_t most = std::max(columns, lattice.RowsAt(top) - 1);
  if (most > CoarsestFor(cells)) {
    throw Error(Error::Kind::InvalidArgument, this->Pyramid_->Source().GetName(),
                "its coarsest level has " + std::to_string(most) +
                    " cells to one side; a clipmap of level size " + std::to_string(cells) +
                    " shows " + std::to_string(CoarsestFor(cells)));
  }
}

ClipmapLevels::~ClipmapLevels() = default;

void ClipmapLevels::SetNoise(const std::optional<ClipmapStyle::Noise>& noise,
                             const PostPlacement& placement) {
  if (noise ? this->Noise_ && this->Noise_->Noise() == *noise : !this->Noise_) {
    return;
  }
  this->Noise_ = noise ? std::make_unique<const ClipmapNoise>(*noise, placement) : nullptr;
  for (Level& level : this->Levels_) {
    level.window.reset();
  }
}

const ClipmapTexel& ClipmapLevels::Texel(int level, std::int64_t column, std::int64_t row) const {
  const std::size_t at = std::size_t(this->Geometry_.Texel(row)) * this->Geometry_.Texels() +
                         std::size_t(this->Geometry_.Texel(column));
  return this->Levels_[level].texels[at];
}

// `heights` has one post of border around the update.
bool ClipmapLevels::ToTexels(int level, const ClipmapUpdate& update,
                             const std::vector<float>& heights,
                             std::vector<ClipmapTexel>& texels) const {
  const PostLattice& lattice = this->Lattice();
  const int stride = update.width + 2;
  // Difference of neighbours over their distance in level-0 posts; one-sided at an edge.
  const auto slope = [](float before, float here, float after, std::int64_t back,
                        std::int64_t ahead) {
    const bool hasBefore = !std::isnan(before) && back > 0;
    const bool hasAfter = !std::isnan(after) && ahead > 0;
    if (!hasBefore && !hasAfter) {
      return 0.0f;
    }
    const double from = hasBefore ? before : here;
    const double to = hasAfter ? after : here;
    return float((to - from) / double((hasBefore ? back : 0) + (hasAfter ? ahead : 0)));
  };
  bool holes = false;
  texels.assign(std::size_t(update.width) * update.height, ClipmapTexel());
  for (int j = 0; j < update.height; ++j) {
    const std::int64_t r = update.row + j;
    const std::int64_t up = lattice.RowPlace(level, r) - lattice.RowPlace(level, r - 1);
    const std::int64_t down = lattice.RowPlace(level, r + 1) - lattice.RowPlace(level, r);
    for (int i = 0; i < update.width; ++i) {
      const std::int64_t c = update.column + i;
      const float* at = heights.data() + std::size_t(j + 1) * stride + i + 1;
      ClipmapTexel& texel = texels[std::size_t(j) * update.width + i];
      if (std::isnan(*at)) {
        texel.hole = 1.0f;
        holes |= r >= 0 && r < lattice.RowsAt(level) &&
                 (lattice.periodic || (c >= 0 && c < lattice.ColumnsAt(level)));
        continue;
      }
      texel.height = *at;
      texel.slopeColumn = slope(at[-1], *at, at[1],
                                lattice.ColumnPlace(level, c) - lattice.ColumnPlace(level, c - 1),
                                lattice.ColumnPlace(level, c + 1) - lattice.ColumnPlace(level, c));
      texel.slopeRow = slope(at[-stride], *at, at[stride], up, down);
    }
  }
  return holes;
}

// What changed in the pyramid since the last time, in posts of each level that holds something.
void ClipmapLevels::NoteChanges() {
  constexpr std::size_t Most = 256; // rectangles; then one that holds them all
  const PyramidChanges changes = this->Pyramid_->Changes(this->Seen_);
  this->Seen_ = changes.stamp;
  for (int index = 0; index < this->Count(); ++index) {
    Level& level = this->Levels_[index];
    if (!level.window) {
      level.changed.clear();
      continue;
    }
    for (const PostRectangle& base : changes.rectangles) {
      if (index >= base.from && index < base.levels) { // and the neighbours, whose slopes change
        const PostRectangle posts = PostsTouched(base, index);
        level.changed.push_back(
            {posts.column - 1, posts.row - 1, posts.width + 2, posts.height + 2});
      }
    }
    if (level.changed.size() > Most) {
      PostRectangle all = level.changed.front();
      for (const PostRectangle& one : level.changed) {
        const std::int64_t right = std::max(all.column + all.width, one.column + one.width);
        const std::int64_t bottom = std::max(all.row + all.height, one.row + one.height);
        all.column = std::min(all.column, one.column);
        all.row = std::min(all.row, one.row);
        all.width = right - all.column;
        all.height = bottom - all.row;
      }
      level.changed = {all};
    }
  }
}

// What changed of the posts that a level holds and goes on to hold in `window`.
std::vector<ClipmapUpdate> ClipmapLevels::ChangesIn(int index, const ClipmapWindow& window) const {
  const Level& level = this->Levels_[index];
  const PostLattice& lattice = this->Lattice();
  const std::int64_t posts = this->Geometry_.Cells() + 3; // with the border
  const std::int64_t left = std::max(level.window->column, window.column) - 1;
  const std::int64_t right = std::min(level.window->column, window.column) - 1 + posts;
  const std::int64_t top = std::max(level.window->row, window.row) - 1;
  const std::int64_t bottom = std::min(level.window->row, window.row) - 1 + posts;
  std::vector<ClipmapUpdate> updates;
  for (const PostRectangle& changed : level.changed) {
    // Around a body the window may be in another turn; in two when it is as wide.
    const std::int64_t around = lattice.periodic ? lattice.ColumnsAt(index) : 0;
    std::int64_t column = changed.column;
    if (lattice.periodic) {
      column -= (column + changed.width - left) / around * around;
      while (column + changed.width > left) {
        column -= around;
      }
      column += around;
    }
    const std::int64_t r0 = std::max(changed.row, top);
    const std::int64_t r1 = std::min(changed.row + changed.height, bottom);
    for (; r0 < r1; column += around) {
      const std::int64_t c0 = std::max(column, left);
      const std::int64_t c1 = std::min(column + changed.width, right);
      if (c0 < c1) {
        this->Geometry_.Cut(c0, r0, c1 - c0, r1 - r0, updates);
      }
      if (!lattice.periodic || column >= right) {
        break;
      }
    }
  }
  return updates;
}

bool ClipmapLevels::Fill(int index, const std::vector<ClipmapUpdate>& updates,
                         const std::optional<double>& wait, const Upload& upload) {
  Level& level = this->Levels_[index];
  // All of it is there before any of it goes up: the level stays what it was otherwise.
  std::vector<std::vector<float>> heights(updates.size());
  std::vector<std::vector<float>> tracks(updates.size());
  bool complete = true;
  for (std::size_t i = 0; i < updates.size(); ++i) {
    const ClipmapUpdate& u = updates[i];
    const PostBlock block{index, u.column - 1, u.row - 1, u.width + 2, u.height + 2};
    heights[i].resize(std::size_t(block.width) * block.height);
    tracks[i].resize(heights[i].size());
    if (wait) {
      this->Pyramid_->Read(block, heights[i].data(), tracks[i].data(), *wait);
    } else { // go on after the first that is missing: all of them are then asked for
      complete &= this->Pyramid_->TryRead(block, heights[i].data(), tracks[i].data());
    }
  }
  if (!complete) {
    return false;
  }
  for (std::size_t i = 0; this->Noise_ && i < updates.size(); ++i) {
    const ClipmapUpdate& u = updates[i];
    this->Noise_->Roughen(this->Lattice(),
                          {index, u.column - 1, u.row - 1, u.width + 2, u.height + 2}, heights[i]);
  }
  const int side = this->Geometry_.Texels();
  level.texels.resize(std::size_t(side) * side);
  std::vector<ClipmapTexel> texels;
  for (std::size_t i = 0; i < updates.size(); ++i) {
    const ClipmapUpdate& u = updates[i];
    level.holes |= this->ToTexels(index, u, heights[i], texels);
    for (std::size_t k = 0; k < texels.size(); ++k) {
      const std::size_t row = k / std::size_t(u.width) + 1; // within the border
      const float track = tracks[i][row * std::size_t(u.width + 2) + k % std::size_t(u.width) + 1];
      if (track > 0.0f && texels[k].hole == 0.0f) {
        texels[k].hole = 0.5f * track;
        level.tracks = true;
      }
    }
    for (int j = 0; j < u.height; ++j) {
      std::copy_n(texels.begin() + std::ptrdiff_t(j) * u.width, u.width,
                  level.texels.begin() + std::ptrdiff_t(u.y + j) * side + u.x);
    }
    upload(index, u, texels.data());
  }
  return true;
}

ClipmapLevels::Filled ClipmapLevels::Fill(int index, const ClipmapWindow& window,
                                          const std::optional<double>& wait, const Upload& upload) {
  Level& level = this->Levels_[index];
  const bool current =
      level.changed.empty() || this->Fill(index, this->ChangesIn(index, window), wait, upload);
  if (level.window != window) {
    if (!this->Fill(index, this->Geometry_.Updates(level.window, window), wait, upload)) {
      return Filled::Not; // what changed outside the new window is still what it was
    }
    level.window = window;
  }
  if (current) {
    level.changed.clear();
  }
  return current ? Filled::Wholly : Filled::Before;
}

std::optional<double> ClipmapLevels::GroundAt(int level, const Eigen::Vector2d& place) const {
  const double x = std::ldexp(place.x(), -level);
  const double y = std::ldexp(place.y(), -level);
  const auto c = static_cast<std::int64_t>(std::floor(x));
  const auto r = static_cast<std::int64_t>(std::floor(y));
  double sum = 0.0;
  double weight = 0.0;
  for (const int j : {0, 1}) {
    for (const int i : {0, 1}) {
      const ClipmapTexel& texel = this->Texel(level, c + i, r + j);
      const double w = (1.0 - std::abs(x - double(c + i))) * (1.0 - std::abs(y - double(r + j)));
      if (texel.hole < 1.0f) {
        sum += w * texel.height;
        weight += w;
      }
    }
  }
  return weight > 0.0 ? std::optional<double>(sum / weight) : std::nullopt;
}

std::optional<double> ClipmapLevels::HeightNear(const Eigen::Vector2d& place, int finest) const {
  const PostLattice& lattice = this->Lattice();
  Eigen::Vector2d near = place;
  if (lattice.periodic) { // windows are about the last column that the camera was at
    const auto turn = double(lattice.columns);
    near.x() += turn * std::round((this->LastColumn_ - place.x()) / turn);
  }
  const double cells = this->Geometry_.Cells();
  for (int level = finest; level < this->Count(); ++level) {
    const std::optional<ClipmapWindow>& window = this->Levels_[level].window;
    if (!window) {
      continue;
    }
    const Eigen::Vector2d at = near * std::ldexp(1.0, -level) -
                               Eigen::Vector2d(double(window->column), double(window->row));
    if (at.minCoeff() >= 0.0 && at.maxCoeff() <= cells) {
      if (const std::optional<double> height = this->GroundAt(level, near)) {
        return height;
      }
    }
  }
  return std::nullopt;
}

ClipmapLevels::State ClipmapLevels::Update(const View& view, const Upload& upload) {
  const PostLattice& lattice = this->Lattice();
  State state;
  state.place = view.place;
  state.cellSize = view.cellSize;
  if (lattice.periodic) {
    const auto turn = double(lattice.columns);
    state.place.x() += turn * std::round((this->LastColumn_ - view.place.x()) / turn);
    this->LastColumn_ = state.place.x();
  } else {
    state.place.x() = std::clamp(view.place.x(), 0.0, double(lattice.columns - 1));
  }
  state.place.y() = std::clamp(view.place.y(), 0.0, double(lattice.rows - 1));
  // What lies between the camera and the lattice's nearest place counts as height.
  const double outside = lattice.periodic
                             ? std::abs(view.place.y() - state.place.y()) * view.cellSize
                             : (view.place - state.place).norm() * view.cellSize;
  this->NoteChanges();
  state.finest = this->Count();
  state.distance = outside;
  for (int level = this->Count() - 1; level >= 0; --level) {
    const double posts = InPosts(state.distance, view.cellSize, level);
    if (level < this->Count() - 1 && posts >= this->Geometry_.BlendTo()) {
      break; // too far away to tell it from the coarser one
    }
    const ClipmapWindow window = this->Geometry_.WindowAt(state.place, level);
    const Filled filled = this->Fill(level, window, view.wait, upload);
    state.complete &= filled == Filled::Wholly;
    if (filled == Filled::Not) {
      break;
    }
    state.finest = level;
    // Over a hole what the coarser level knows of the ground around it holds.
    if (const std::optional<double> ground = this->GroundAt(level, state.place)) {
      state.groundHeight = *ground;
      state.distance = std::max(std::abs(view.height - state.groundHeight), outside);
    }
  }
  return state;
}

} // namespace dspace
