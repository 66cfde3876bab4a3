#include <dspace/scene/Trail.h>

#include <cmath>

#include <dspace/Checks.h>

namespace dspace {

Trail::Trail(std::size_t capacity, double minimumSpacing, bool fade)
    : MinimumSpacing_(minimumSpacing), Fade_(fade) {
  Require(capacity >= 2 && capacity <= 10000000, "trail", "capacity", double(capacity),
          "2 to 10000000 positions");
  Require(minimumSpacing >= 0.0 && std::isfinite(minimumSpacing), "trail", "minimum spacing",
          minimumSpacing, "0 metres and more");
  this->Ring_.resize(capacity);
}

bool Trail::Add(const Eigen::Vector3d& p_F) {
  RequirePosition("trail", "position", p_F);
  this->End_ = p_F;
  this->EndKept_ =
      this->Size_ == 0 || (p_F - this->Position(this->Size_ - 1)).norm() >= this->MinimumSpacing_;
  if (!this->EndKept_) {
    return false;
  }
  this->Ring_[(this->First_ + this->Size_) % this->Ring_.size()] = p_F;
  if (this->Size_ < this->Ring_.size()) {
    ++this->Size_;
  } else {
    this->First_ = (this->First_ + 1) % this->Ring_.size();
  }
  return true;
}

void Trail::Clear() {
  this->First_ = 0;
  this->Size_ = 0;
  this->EndKept_ = true;
  this->End_.setZero();
}

const Eigen::Vector3d& Trail::Position(std::size_t i) const {
  Require(i < this->Size_, "trail", "index", double(i),
          ("less than its size of " + std::to_string(this->Size_)).c_str());
  return this->Ring_[(this->First_ + i) % this->Ring_.size()];
}

Mesh Trail::LineMesh(const Eigen::Vector3d& origin_F) const {
  RequirePosition("trail", "origin", origin_F);
  const std::size_t n = this->Size_ + (this->EndKept_ ? 0 : 1);
  Mesh mesh;
  mesh.name = "trail";
  mesh.primitive = Mesh::Primitive::Lines;
  mesh.positions.reserve(3 * n);
  mesh.indices.reserve(2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d p = (i < this->Size_ ? this->Position(i) : this->End_) - origin_F;
    for (int k = 0; k < 3; ++k) {
      mesh.positions.push_back(static_cast<float>(p[k]));
    }
    if (this->Fade_) {
      const double share = n < 2 ? 1.0 : double(i) / double(n - 1);
      const auto alpha = static_cast<std::uint8_t>(std::lround(255.0 * share));
      mesh.colors.insert(mesh.colors.end(), {255, 255, 255, alpha});
    }
    if (i > 0) {
      const auto index = static_cast<std::uint32_t>(i);
      mesh.indices.insert(mesh.indices.end(), {index - 1, index});
    }
  }
  return mesh;
}

} // namespace dspace
