#include <dspace/horizon/EdgeRuns.h>

namespace dspace {

LaneReach GroundBounds::Reach(const HeightSpan& heights) const {
  const float least = this->Away_.least + std::min({this->Spread_.least * heights.least,
                                                    this->Spread_.greatest * heights.least, 0.0f});
  const float most =
      this->Away_.greatest + std::max(this->Spread_.greatest * heights.greatest, 0.0f);
  return {(1.0f + HorizonRounding) / std::max(least, 1e-9f), (1.0f - HorizonRounding) / most};
}

void EdgeRuns::Clear(int count, double s0, double s1) {
  this->Runs_.resize(std::size_t(count));
  for (Run& run : this->Runs_) {
    run.edges.clear();
    run.posts = {};
    run.ground = {};
  }
  this->Begin_ = s0;
  this->PerMetre_ = double(count) / (s1 - s0);
}

void EdgeRuns::Add(double s, const EdgeStep& edge, std::int64_t column, std::int64_t row, int right,
                   int down) {
  const auto last = int(this->Runs_.size()) - 1;
  Run& run =
      this->Runs_[std::size_t(std::clamp(int((s - this->Begin_) * this->PerMetre_), 0, last))];
  run.edges.push_back(edge);
  run.posts.Add(column, row);
  run.posts.Add(column + right, row + down);
  run.ground.Add(edge.ground);
}

void EdgeRuns::Close(const HeightSpan& heights) {
  for (Run& run : this->Runs_) {
    run.reach = run.ground.Reach(heights);
  }
}

} // namespace dspace
