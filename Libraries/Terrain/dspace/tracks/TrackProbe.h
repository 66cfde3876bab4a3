// Reads single posts of level 0 with the ruts of wheels in them. Not for public headers.
#ifndef DSPACE_TERRAIN_TRACKPROBE_H
#define DSPACE_TERRAIN_TRACKPROBE_H

#include <cstdint>
#include <memory>

#include <dspace/posts/PostProbe.h>
#include <dspace/tracks/TrackPosts.h>

namespace dspace {

// Posts of squares that no rut reaches are those of the ground's own probe.
class TrackProbe : public PostProbe {
public:
  TrackProbe(const TrackPosts& posts, std::unique_ptr<PostProbe> bare)
      : Posts_(posts), Bare_(std::move(bare)) {}

  bool HasRows(std::int64_t first, std::int64_t last) const override {
    return this->Bare_->HasRows(first, last);
  }
  float At(std::int64_t column, std::int64_t row) override {
    constexpr int Bits = 4; // of a square's side
    if (column >> Bits != this->Column_ || row >> Bits != this->Row_) {
      this->Column_ = column >> Bits;
      this->Row_ = row >> Bits;
      this->Reached_ = this->Posts_.Reaches(
          {0, this->Column_ << Bits, this->Row_ << Bits, 1 << Bits, 1 << Bits});
    }
    if (!this->Reached_) {
      return this->Bare_->At(column, row);
    }
    float height = 0.0f;
    this->Posts_.Read({0, column, row, 1, 1}, &height);
    return height;
  }

private:
  const TrackPosts& Posts_;
  std::unique_ptr<PostProbe> Bare_;
  std::int64_t Column_ = -1; // of the latest square
  std::int64_t Row_ = -1;
  bool Reached_ = false;
};

} // namespace dspace

#endif
