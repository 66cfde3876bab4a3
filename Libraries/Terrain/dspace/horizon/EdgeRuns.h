// The edges that a row's lines of sight cross, in runs whose heights are bounded together.
#ifndef DSPACE_TERRAIN_EDGERUNS_H
#define DSPACE_TERRAIN_EDGERUNS_H

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <dspace/horizon/HorizonKernel.h>

namespace dspace {

// Posts of a level, both ends among them; none: right < left.
struct PostExtent {
  std::int64_t left = std::numeric_limits<std::int64_t>::max();
  std::int64_t top = std::numeric_limits<std::int64_t>::max();
  std::int64_t right = std::numeric_limits<std::int64_t>::min();
  std::int64_t bottom = std::numeric_limits<std::int64_t>::min();

  void Add(std::int64_t column, std::int64_t row) {
    this->left = std::min(this->left, column);
    this->top = std::min(this->top, row);
    this->right = std::max(this->right, column);
    this->bottom = std::max(this->bottom, row);
  }
};

// Bounds of ground at several places of a path.
class GroundBounds {
public:
  void Add(const HorizonStep& ground) {
    this->Fall_ = std::max(this->Fall_, ground.fall);
    this->Rise_.Add(ground.rise);
    this->Away_.Add(ground.away);
    this->Spread_.Add(ground.spread);
  }
  // `heights` [m]: that the terrain lies between.
  LaneReach Reach(const HeightSpan& heights) const;
  // Over the observer's horizontal plane [m], of heights up to `greatest`.
  float Crest(float greatest) const {
    // Ground below a body's surface falls off less than its foot: |z| (1 - cosine).
    const float top =
        this->Fall_ + std::max(this->Rise_.least * greatest, this->Rise_.greatest * greatest);
    return top + HorizonRounding * std::abs(top);
  }

private:
  struct Range {
    float least = std::numeric_limits<float>::infinity();
    float greatest = -std::numeric_limits<float>::infinity();
    void Add(float value) {
      this->least = std::min(this->least, value);
      this->greatest = std::max(this->greatest, value);
    }
  };
  float Fall_ = -std::numeric_limits<float>::infinity(); // the greatest
  Range Rise_;
  Range Away_;
  Range Spread_;
};

// The edges of a band of distance, nearest run first.
class EdgeRuns {
public:
  struct Run {
    std::vector<EdgeStep> edges;
    PostExtent posts; // between which they lie, for lane 0
    GroundBounds ground;
    LaneReach reach;
  };

  // Makes `count` empty runs as long as each other, from s0 to s1 [m].
  void Clear(int count, double s0, double s1);
  // An edge that is crossed at a distance s [m], between a post and one `right` columns and `down`
  // rows from it.
  void Add(double s, const EdgeStep& edge, std::int64_t column, std::int64_t row, int right,
           int down);
  // To be called once all edges are there; `heights` as of GroundBounds::Reach.
  void Close(const HeightSpan& heights);
  const std::vector<Run>& Runs() const { return this->Runs_; }

private:
  std::vector<Run> Runs_;
  double Begin_ = 0.0;
  double PerMetre_ = 0.0; // runs
};

} // namespace dspace

#endif
