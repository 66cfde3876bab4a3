#include <dspace/camera/sampling/LensTile.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Core>

#include <dspace/RowThreads.h>

namespace dspace {
namespace {

constexpr int FollowSteps = 3;
constexpr int MostSteps = 64;
constexpr int MostTaps = 5; // a side of a footprint
constexpr float Nothing = std::numeric_limits<float>::infinity();
constexpr float Unknown = std::numeric_limits<float>::quiet_NaN();

} // namespace

std::size_t LensPlanes::Bytes() const {
  return sizeof(float) * (this->radiance.size() + this->depth.size() + this->range.size() +
                          this->label.size() + this->litFraction.size() + this->incidence.size() +
                          this->emission.size() + this->phase.size() + this->normal.size());
}

LensTile::LensTile(const SourceViews& views, std::shared_ptr<const LensMap> map,
                   const LensWishes& wishes)
    : Views_(views), Map_(std::move(map)), Wishes_(wishes) {
  const std::size_t count = this->Map_->Pixels().size();
  LensPlanes& planes = this->Planes_;
  planes.width = this->Map_->Width();
  planes.height = this->Map_->Height();
  const auto make = [count](bool wanted, auto& plane, std::size_t channels, auto value) {
    if (wanted) {
      plane.assign(channels * count, value);
    }
  };
  make(wishes.radiance, planes.radiance, 3, 0.0f);
  make(wishes.depth, planes.depth, 1, Nothing);
  make(wishes.range, planes.range, 1, Nothing);
  make(wishes.label, planes.label, 1, std::uint32_t(0));
  make(wishes.litFraction, planes.litFraction, 1, Unknown);
  make(wishes.incidence, planes.incidence, 1, Unknown);
  make(wishes.emission, planes.emission, 1, Unknown);
  make(wishes.phase, planes.phase, 1, Unknown);
  make(wishes.normal, planes.normal, 3, Unknown);
}

bool LensTile::NeedsDepth() const {
  return this->Map_->MovesPupil() || this->Wishes_.depth || this->Wishes_.range;
}

// Moves the place to where the views show what the pixel's own ray meets: from the nearest depth of
// the block on, in steps of at most half a source pixel, to the first depth at which the ray lies
// behind what the views show. A step at which the views change to something nearer is no such: the
// ray passes behind that.
void LensTile::Follow(LensMap::Pixel& pixel, const SourceViews::View& view, const LensPlanes& from,
                      double nearest) {
  const SourceViews::Face& face = this->Views_.Faces()[std::size_t(pixel.place.face)];
  const SourceViews::Place first = pixel.place;
  const Eigen::Matrix3d R_FC = face.R_CF.transpose();
  const Eigen::Vector3d origin = R_FC * (pixel.ray.origin - this->Views_.Eye());
  const Eigen::Vector3d direction = R_FC * pixel.ray.direction;
  bool beyond = false;
  const double left = view.x + 1.0, right = view.x + view.width - 2.0;
  const double top = view.y + 1.0, bottom = view.y + view.height - 2.0;
  // Where the views show the ray's point at an inverse depth; kept within the block.
  const auto placeOf = [&](double inverse) {
    const Eigen::Vector3d p =
        direction + inverse * (direction.z() * origin - origin.z() * direction);
    SourceViews::Place place = first;
    place.x = (p.x() / p.z() - face.left) * face.scale - 0.5;
    place.y = (p.y() / p.z() - face.top) * face.scale - 0.5;
    beyond = !(place.x >= left && place.x <= right && place.y >= top && place.y <= bottom);
    place.x = std::clamp(std::isfinite(place.x) ? place.x : first.x, left, right);
    place.y = std::clamp(std::isfinite(place.y) ? place.y : first.y, top, bottom);
    return place;
  };
  const auto inverseAt = [&](const SourceViews::Place& place) {
    const int i = std::clamp(int(std::lround(place.x)) - view.x, 0, view.width - 1);
    const int j = std::clamp(int(std::lround(place.y)) - view.y, 0, view.height - 1);
    return 1.0 / double(from.depth[std::size_t(j) * std::size_t(view.width) + std::size_t(i)]);
  };
  SourceViews::Place place = placeOf(0.0); // of what is infinitely far
  if (nearest > 0.0) {
    const double begin = std::min(1.02 * nearest, 0.5 / std::max(origin.norm(), 1e-12));
    const SourceViews::Place near = placeOf(begin);
    const double length = std::hypot(near.x - place.x, near.y - place.y);
    const int steps = std::clamp(int(std::ceil(2.0 * length)), 1, MostSteps);
    double before = inverseAt(near);
    for (int k = 1; k <= steps; ++k) {
      const double inverse = begin * (steps - k) / steps;
      const SourceViews::Place next = placeOf(inverse);
      const double shown = inverseAt(next);
      if (inverse <= shown && (shown <= before || shown - before <= begin / steps)) {
        place = placeOf(shown);
        for (int turn = 0; turn < FollowSteps; ++turn) { // to the depth where both agree
          const double again = inverseAt(place);
          if (std::abs(again - shown) > 2.0 * begin / steps) {
            break; // another thing
          }
          place = placeOf(again);
        }
        break;
      }
      before = shown;
    }
  }
  pixel.place = place;
  this->Beyond_ += beyond;
  this->PupilPixels_ =
      std::max(this->PupilPixels_, std::hypot(place.x - first.x, place.y - first.y));
}

void LensTile::PutRadiance(const LensMap::Sample& sample, const SourceViews::View& view,
                           const LensPlanes& from) {
  using Color = Eigen::Array4f; // the fourth is the next pixel's
  const float right = float(view.width) - 1.001f;
  const float bottom = float(view.height) - 1.001f;
  const std::size_t row = 3 * std::size_t(view.width);
  const auto at = [&](float x, float y) -> Color {
    x = std::clamp(x, 0.0f, right);
    y = std::clamp(y, 0.0f, bottom);
    const auto i = std::size_t(x), j = std::size_t(y);
    const float fx = x - float(i), fy = y - float(j);
    const std::size_t begin = j * row + 3 * i;
    const float* top = &from.radiance[begin];
    if (begin + row + 7 > from.radiance.size()) { // the last one has no next pixel
      Color sum = Color::Zero();
      for (int k = 0; k < 3; ++k) {
        sum[k] =
            (1.0f - fy) * ((1.0f - fx) * top[k] + fx * top[k + 3]) +
            fy * ((1.0f - fx) * top[row + std::size_t(k)] + fx * top[row + std::size_t(k) + 3]);
      }
      return sum;
    }
    const auto load = [](const float* p) { return Color(Eigen::Map<const Color>(p)); };
    return (1.0f - fy) * ((1.0f - fx) * load(top) + fx * load(top + 3)) +
           fy * ((1.0f - fx) * load(top + row) + fx * load(top + row + 3));
  };
  const int taps = std::clamp(int(sample.footprint + 0.5f), 1, MostTaps);
  Color sum = Color::Zero();
  if (taps == 1) {
    sum = at(sample.x, sample.y);
  } else {
    for (int n = 0; n < taps * taps; ++n) { // evenly over the footprint
      const float dx = (float(n % taps) + 0.5f) / float(taps) - 0.5f;
      const float dy = (float(n / taps) + 0.5f) / float(taps) - 0.5f;
      sum += at(sample.x + dx * sample.footprint, sample.y + dy * sample.footprint);
    }
    sum /= float(taps * taps);
  }
  std::copy_n(sum.data(), 3, &this->Planes_.radiance[3 * std::size_t(sample.at)]);
}

void LensTile::Take(const SourceViews::Block& block, const LensPlanes& from) {
  const SourceViews::View view = this->Views_.ViewOf(block);
  const Eigen::Matrix3d& R_CF = this->Views_.Faces()[std::size_t(block.face)].R_CF;
  LensPlanes& to = this->Planes_;
  const auto found = this->Map_->Blocks().find(block);
  if (found == this->Map_->Blocks().end()) {
    return;
  }
  double nearest = 0.0; // the greatest inverse depth
  if (this->Map_->MovesPupil()) {
    for (const float depth : from.depth) {
      nearest = depth > 0.0f ? std::max(nearest, 1.0 / double(depth)) : nearest;
    }
  }
  if (this->Wishes_.radiance && !this->Map_->MovesPupil()) {
    constexpr int Work = 2; // of one pixel (ForRows)
    ForRows(int(found->second.size()), Work, [&](int first, int last) {
      for (int i = first; i < last; ++i) {
        this->PutRadiance(found->second[std::size_t(i)], view, from);
      }
    });
  }
  if (this->Wishes_.OnlyRadiance() && !this->Map_->MovesPupil()) {
    return;
  }
  for (const LensMap::Sample& sample : found->second) {
    const std::uint32_t at = sample.at;
    LensMap::Pixel pixel = this->Map_->Pixels()[at];
    if (this->Map_->MovesPupil()) {
      this->Follow(pixel, view, from, nearest);
    }
    const std::size_t source =
        std::size_t(std::clamp(int(std::lround(pixel.place.y)) - view.y, 0, view.height - 1)) *
            std::size_t(view.width) +
        std::size_t(std::clamp(int(std::lround(pixel.place.x)) - view.x, 0, view.width - 1));
    if (this->Wishes_.radiance && this->Map_->MovesPupil()) {
      this->PutRadiance(
          {at, float(pixel.place.x - view.x), float(pixel.place.y - view.y), pixel.footprint}, view,
          from);
    }
    if (this->Wishes_.depth || this->Wishes_.range) {
      const double depth = double(from.depth[source]);
      if (std::isfinite(depth)) {
        // The point of the pixel's own ray at that depth of the view.
        const Eigen::Vector3d F = R_CF.transpose() * pixel.ray.direction;
        const double along =
            (depth - R_CF.col(2).dot(pixel.ray.origin - this->Views_.Eye())) / F.z();
        if (this->Wishes_.range) {
          to.range[at] = float(along);
        }
        if (this->Wishes_.depth) {
          to.depth[at] = float(pixel.ray.origin.z() + along * pixel.ray.direction.z());
        }
      }
    }
    const auto copy = [&](bool wanted, const auto& plane, auto& into) {
      if (wanted) {
        into[at] = plane[source];
      }
    };
    copy(this->Wishes_.label, from.label, to.label);
    copy(this->Wishes_.litFraction, from.litFraction, to.litFraction);
    copy(this->Wishes_.incidence, from.incidence, to.incidence);
    copy(this->Wishes_.emission, from.emission, to.emission);
    copy(this->Wishes_.phase, from.phase, to.phase);
    if (this->Wishes_.normal) {
      std::copy_n(&from.normal[3 * source], 3, &to.normal[3 * at]);
    }
  }
}

} // namespace dspace
