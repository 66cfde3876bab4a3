#include <dspace/camera/sampling/LensTile.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dspace {
namespace {

constexpr int FollowSteps = 4;
constexpr int MostTaps = 5; // a side of a footprint
constexpr float Nothing = std::numeric_limits<float>::infinity();
constexpr float Unknown = std::numeric_limits<float>::quiet_NaN();

} // namespace

std::size_t LensPlanes::Bytes() const {
  return sizeof(float) * (this->radiance.size() + this->depth.size() + this->range.size() +
                          this->label.size() + this->litFraction.size() + this->incidence.size() +
                          this->emission.size() + this->phase.size());
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
}

bool LensTile::NeedsDepth() const {
  return this->Map_->MovesPupil() || this->Wishes_.depth || this->Wishes_.range;
}

// Moves the place to where the views show what the pixel's ray meets.
void LensTile::Follow(LensMap::Pixel& pixel, const SourceViews::View& view,
                      const LensPlanes& from) {
  const SourceViews::Face& face = this->Views_.Faces()[std::size_t(pixel.place.face)];
  const SourceViews::Place first = pixel.place;
  const Eigen::Matrix3d R_FC = face.R_CF.transpose();
  const Eigen::Vector3d origin = R_FC * (pixel.ray.origin - this->Views_.Eye());
  const Eigen::Vector3d direction = R_FC * pixel.ray.direction;
  bool beyond = false;
  for (int step = 0; step < FollowSteps; ++step) {
    const int i = std::clamp(int(std::lround(pixel.place.x)) - view.x, 0, view.width - 1);
    const int j = std::clamp(int(std::lround(pixel.place.y)) - view.y, 0, view.height - 1);
    const double depth =
        double(from.depth[std::size_t(j) * std::size_t(view.width) + std::size_t(i)]);
    Eigen::Vector3d seen = direction; // infinitely far
    if (std::isfinite(depth)) {
      seen = origin + (depth - origin.z()) / direction.z() * direction;
    }
    SourceViews::Place next = pixel.place;
    next.x = (seen.x() / seen.z() - face.left) * face.scale - 0.5;
    next.y = (seen.y() / seen.z() - face.top) * face.scale - 0.5;
    if (!std::isfinite(next.x) || !std::isfinite(next.y)) {
      break;
    }
    const double left = view.x + 1.0, right = view.x + view.width - 2.0;
    const double top = view.y + 1.0, bottom = view.y + view.height - 2.0;
    beyond = next.x < left || next.x > right || next.y < top || next.y > bottom;
    next.x = std::clamp(next.x, left, right);
    next.y = std::clamp(next.y, top, bottom);
    const double moved = std::hypot(next.x - pixel.place.x, next.y - pixel.place.y);
    pixel.place = next;
    if (moved < 1e-3) {
      break;
    }
  }
  this->Beyond_ += beyond;
  this->PupilPixels_ =
      std::max(this->PupilPixels_, std::hypot(pixel.place.x - first.x, pixel.place.y - first.y));
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
  for (const std::uint32_t at : found->second) {
    LensMap::Pixel pixel = this->Map_->Pixels()[at];
    if (this->Map_->MovesPupil()) {
      this->Follow(pixel, view, from);
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
  }
}

} // namespace dspace
