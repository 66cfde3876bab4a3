#include <dspace/camera/sampling/LensTile.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

void LensTile::PutRadiance(std::size_t at, const LensMap::Pixel& pixel,
                           const SourceViews::View& view, const LensPlanes& from) {
  const int taps = std::clamp(int(std::lround(double(pixel.footprint))), 1, MostTaps);
  double sum[3] = {0, 0, 0};
  for (int n = 0; n < taps * taps; ++n) {
    // Evenly over the footprint.
    const double dx = ((n % taps + 0.5) / taps - 0.5) * (taps == 1 ? 0.0 : double(pixel.footprint));
    const double dy = ((n / taps + 0.5) / taps - 0.5) * (taps == 1 ? 0.0 : double(pixel.footprint));
    const double x = std::clamp(pixel.place.x + dx - view.x, 0.0, view.width - 1.001);
    const double y = std::clamp(pixel.place.y + dy - view.y, 0.0, view.height - 1.001);
    const std::size_t i = std::size_t(x), j = std::size_t(y);
    const double fx = x - double(i), fy = y - double(j);
    const float* top = &from.radiance[3 * (j * std::size_t(view.width) + i)];
    const float* bottom = top + 3 * std::size_t(view.width);
    for (int k = 0; k < 3; ++k) {
      sum[k] += (1.0 - fy) * ((1.0 - fx) * double(top[k]) + fx * double(top[k + 3])) +
                fy * ((1.0 - fx) * double(bottom[k]) + fx * double(bottom[k + 3]));
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    this->Planes_.radiance[3 * at + k] = float(sum[k] / (taps * taps));
  }
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
  for (const std::uint32_t at : found->second) {
    LensMap::Pixel pixel = this->Map_->Pixels()[at];
    if (this->Map_->MovesPupil()) {
      this->Follow(pixel, view, from, nearest);
    }
    const std::size_t source =
        std::size_t(std::clamp(int(std::lround(pixel.place.y)) - view.y, 0, view.height - 1)) *
            std::size_t(view.width) +
        std::size_t(std::clamp(int(std::lround(pixel.place.x)) - view.x, 0, view.width - 1));
    if (this->Wishes_.radiance) {
      this->PutRadiance(at, pixel, view, from);
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
