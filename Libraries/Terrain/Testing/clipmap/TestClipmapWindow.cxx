// Clipmap windows against brute force: no OpenGL.
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/clipmap/arithmetic/ClipmapWindow.h>

namespace {

using dspace::ClipmapGeometry;
using dspace::ClipmapUpdate;
using dspace::ClipmapWindow;
using Post = std::pair<std::int64_t, std::int64_t>;

std::set<Post> PostsOf(const ClipmapGeometry& geometry, const ClipmapWindow& window) {
  std::set<Post> posts;
  for (std::int64_t r = window.row - 1; r <= window.row + geometry.Cells() + 1; ++r) {
    for (std::int64_t c = window.column - 1; c <= window.column + geometry.Cells() + 1; ++c) {
      posts.insert({c, r});
    }
  }
  return posts;
}

// A texture that remembers which post each texel shows.
class PaperTexture {
public:
  explicit PaperTexture(int side) : Side_(side), Texels_(std::size_t(side) * side, {1 << 30, 0}) {}
  void Upload(const ClipmapUpdate& u) {
    ASSERT_GE(u.x, 0);
    ASSERT_GE(u.y, 0);
    ASSERT_GT(u.width, 0);
    ASSERT_GT(u.height, 0);
    ASSERT_LE(u.x + u.width, this->Side_);
    ASSERT_LE(u.y + u.height, this->Side_);
    for (int j = 0; j < u.height; ++j) {
      for (int i = 0; i < u.width; ++i) {
        this->Texels_[std::size_t(u.y + j) * this->Side_ + u.x + i] = {u.column + i, u.row + j};
      }
    }
  }
  Post At(std::int64_t c, std::int64_t r) const {
    const auto wrapped = [this](std::int64_t k) { return ((k % Side_) + Side_) % Side_; };
    return this->Texels_[std::size_t(wrapped(r)) * this->Side_ + wrapped(c)];
  }

private:
  int Side_;
  std::vector<Post> Texels_;
};

TEST(ClipmapWindow, EachMoveUploadsWhatIsNewAndNothingElse) {
  std::mt19937 random(7);
  for (const int cells : {12, 28, 60}) {
    const ClipmapGeometry geometry(cells);
    PaperTexture texture(geometry.Texels());
    std::optional<ClipmapWindow> window;
    Eigen::Vector2d place(0.0, 0.0);
    for (int move = 0; move < 500; ++move) {
      // Mostly small steps, now and then a jump past the window, far below zero too.
      const double reach = move % 25 == 24 ? 20.0 * cells : move % 5 == 4 ? 0.7 * cells : 3.0;
      std::uniform_real_distribution<double> step(-reach, reach);
      place += Eigen::Vector2d(step(random), step(random));
      const ClipmapWindow next = geometry.WindowAt(place, 0);
      const std::set<Post> wanted = PostsOf(geometry, next);
      std::set<Post> fresh = wanted;
      if (window) {
        for (const Post& post : PostsOf(geometry, *window)) {
          fresh.erase(post);
        }
      }
      std::size_t uploaded = 0;
      for (const ClipmapUpdate& update : geometry.Updates(window, next)) {
        texture.Upload(update);
        uploaded += std::size_t(update.width) * update.height;
      }
      ASSERT_EQ(uploaded, fresh.size()) << "move " << move;
      for (const Post& post : wanted) {
        ASSERT_EQ(texture.At(post.first, post.second), post) << "move " << move;
        ASSERT_EQ(geometry.Texel(post.first),
                  ((post.first % geometry.Texels()) + geometry.Texels()) % geometry.Texels());
      }
      window = next;
    }
  }
}

TEST(ClipmapWindow, WindowsNestAroundAnyPlace) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> anywhere(-1e6, 1e6);
  for (const int cells : {12, 124, 252}) {
    const ClipmapGeometry geometry(cells);
    for (int i = 0; i < 2000; ++i) {
      Eigen::Vector2d place(anywhere(random), anywhere(random));
      if (i % 4 == 0) {
        place = place.array().round(); // on posts, where rounding changes over
      }
      if (i % 8 == 4) { // or a rounding error beside them
        place =
            place.unaryExpr([](double x) { return std::nextafter(64.0 * std::round(x), -1e9); });
      }
      const int level = i % 11;
      const ClipmapWindow fine = geometry.WindowAt(place, level);
      const ClipmapWindow coarse = geometry.WindowAt(place, level + 1);
      ASSERT_EQ(fine.column % 2, 0);
      ASSERT_EQ(fine.row % 2, 0);
      const Eigen::Vector2i inner = geometry.InnerCell(fine, coarse);
      for (int axis = 0; axis < 2; ++axis) {
        ASSERT_GE(inner[axis], cells / 4);
        ASSERT_LE(inner[axis], cells / 4 + 1);
        ASSERT_LE(inner[axis] + cells / 2, cells - cells / 4 + 1);
      }
    }
  }
}

// The ring is wholly the coarser level's in the two cells at its outline, wherever it is snapped.
TEST(ClipmapWindow, BlendingEndsWithinTheWindow) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> anywhere(-1000.0, 1000.0);
  const ClipmapGeometry geometry(124);
  EXPECT_LT(geometry.BlendFrom(), geometry.BlendTo());
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d place(anywhere(random), anywhere(random));
    const ClipmapWindow window = geometry.WindowAt(place, 0);
    for (const int k : {0, 1, 2, geometry.Cells() - 2, geometry.Cells() - 1, geometry.Cells()}) {
      EXPECT_GE(std::abs(double(window.column + k) - place.x()), geometry.BlendTo());
      EXPECT_GE(std::abs(double(window.row + k) - place.y()), geometry.BlendTo());
    }
  }
}

TEST(ClipmapWindow, SizesThatCannotBeHalvedAreRejected) {
  for (const int cells : {0, 8, 13, 126, 2048}) {
    EXPECT_THROW(ClipmapGeometry{cells}, dspace::Error) << cells;
  }
  EXPECT_EQ(ClipmapGeometry(124).Texels(), 128);
  EXPECT_EQ(ClipmapGeometry(252).Texels(), 256);
  EXPECT_EQ(ClipmapGeometry(128).Texels(), 256);
}

} // namespace
