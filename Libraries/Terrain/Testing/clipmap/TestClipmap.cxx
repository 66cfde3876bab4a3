// Pictures of clipmaps on a plane: depth against the surface, gaps, jumps, and what is uploaded.
#include <cstring>
#include <random>

#include <dspace/posts/HeightGrid.h>

#include "ClipmapTestSupport.h"
#include "Gate.h"

namespace dspace::testing {
namespace {

// HeightGrid evaluates the triangles by other code in double precision.
TEST_F(ClipmapFixture, TheFinestRingIsTheStatedSurfaceToAMillimetre) {
  AddPlane(513, Hills, {-51, 51}, false);
  std::vector<double> heights;
  for (int r = 0; r < 513; ++r) {
    for (int c = 0; c < 513; ++c) {
      heights.push_back(Hills(c, r));
    }
  }
  const HeightGrid grid("hills", 513, 513, heights, terrain->Placement().PostToScene());
  const double tolerance = 1e-3 + 1e-6 * 102.0;
  auto view = View(320, 240);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> anywhere(-350.0, 350.0);
  const ClipmapGeometry geometry(124);
  int compared = 0;
  for (int n = 0; n < 8; ++n) {
    const Eigen::Vector2d xy(anywhere(random), anywhere(random));
    const double ground = grid.FacetAt(grid.ToGrid(xy)).height;
    const Eigen::Vector3d eye(xy.x(), xy.y(), ground + (n % 2 == 0 ? 0.3 : 12.0));
    LookFrom(eye, eye + Eigen::Vector3d(anywhere(random), anywhere(random), -90.0));
    const Capture capture = Shoot(view);
    for (int y = 0; y < capture.height; ++y) {
      for (int x = 0; x < capture.width; ++x) {
        const Hit hit = HitAt(*scene, capture, x, y);
        const double away = (hit.p - eye).cwiseAbs().head<2>().maxCoeff() / Post;
        if (!hit.hit || away > geometry.BlendFrom() - 1.0) { // its triangle's posts, too
          continue;
        }
        const HeightGrid::Facet facet = grid.FacetAt(grid.ToGrid(hit.p.head<2>()));
        if (!facet.valid) {
          continue;
        }
        // OpenGL places vertices on a grid of 1/256 pixel: the surface is drawn as if moved
        // across the ray by up to half of that along both axes.
        const double pixel = 2.0 * std::tan(30.0 * M_PI / 180.0) / 240.0 * (hit.p - eye).norm();
        const double moved = std::sqrt(2.0) / 512.0 * pixel / grid.Normal(facet).z();
        ASSERT_NEAR(hit.p.z(), facet.height, tolerance + moved)
            << "view " << n << ", pixel " << x << ", " << y;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 100000);
}

// A smooth surface's chords depart from it by at most an eighth of its second derivatives times the
// squared distance of the posts.
TEST_F(ClipmapFixture, CoarserRingsStayWithinTheirChords) {
  const auto smooth = [](double c, double r) {
    return 40.0 * std::sin(0.013 * c) * std::cos(0.017 * r);
  };
  const double bend = 40.0 * (0.013 * 0.013 + 2.0 * 0.013 * 0.017 + 0.017 * 0.017) / 8.0;
  AddPlane(8193, smooth, {-41, 41}, false);
  const Eigen::Affine2d toPosts = terrain->Placement().PostToScene().inverse();
  auto view = View(320, 240);
  const ClipmapGeometry geometry(124);
  int coarse = 0;
  for (const double height : {60.0, 400.0, 3000.0}) {
    const Eigen::Vector3d eye(137.0, -211.0, height);
    LookFrom(eye, eye + Eigen::Vector3d(1.0, 0.4, -0.5));
    const Capture capture = Shoot(view);
    for (int y = 0; y < capture.height; ++y) {
      for (int x = 0; x < capture.width; ++x) {
        const Hit hit = HitAt(*scene, capture, x, y);
        if (!hit.hit) {
          continue;
        }
        const Eigen::Vector2d post = toPosts * Eigen::Vector2d(hit.p.head<2>());
        const double ground = smooth(post.x(), post.y());
        double away = (hit.p - eye).cwiseAbs().head<2>().maxCoeff() / Post;
        away = std::max(away, (height + 41.0) / Post);
        int level = 0;
        while (std::ldexp(away, -level) > geometry.BlendFrom()) {
          ++level;
        }
        const double range = (hit.p - eye).norm();
        ASSERT_NEAR(hit.p.z(), ground, std::ldexp(bend, 2 * level) + 1e-3 + 1e-6 * range)
            << "height " << height << ", pixel " << x << ", " << y;
        coarse += level > 0;
      }
    }
  }
  EXPECT_GT(coarse, 50000);
}

// Nothing but ground is below the horizon: each pixel of another colour is a gap.
TEST_F(ClipmapFixture, NoGapOpensOnAFlight) {
  AddPlane(4097, Hills, {-51, 51}, false);
  auto view = View(240, 180);
  view->SetBackground({1, 0, 0}, {1, 0, 0});
  for (int step = 0; step < 150; ++step) {
    const double t = step / 150.0;
    const Eigen::Vector3d eye(-600.0 + 3.0 * step, 250.0 * std::sin(5.0 * t),
                              step < 100 ? 60.0 : 60.0 * std::pow(1.06, step - 100));
    LookFrom(eye, eye + Eigen::Vector3d(1.0, 0.2, -1.2), 50.0);
    const Capture capture = Shoot(view);
    for (std::size_t i = 0; i < capture.color.size(); i += 4) {
      if (i == 0 && step % 30 == 0) {
        Keep(capture, "flight" + std::to_string(step));
      }
      ASSERT_FALSE(capture.color[i] == 255 && capture.color[i + 1] == 0)
          << "step " << step << ", pixel " << i / 4 % 240 << ", " << i / 4 / 240;
    }
  }
}

// A window that snaps on, and a level that comes or goes with the camera's height, change nothing
// that is seen: the two pictures a hair's breadth apart on either side are alike.
TEST_F(ClipmapFixture, NoPixelJumpsWhereWindowsSnapAndLevelsCome) {
  AddPlane(4097, Hills, {-51, 51}, true);
  auto view = View(320, 240);
  const ClipmapGeometry geometry(124);
  const auto shoot = [&](const Eigen::Vector3d& eye) {
    LookFrom(eye, eye + Eigen::Vector3d(1.0, 0.3, -0.5));
    return view->GetCapture({});
  };
  const auto compare = [&](const Eigen::Vector3d& before, const Eigen::Vector3d& after,
                           const std::string& where) {
    const Capture a = shoot(before);
    const Capture b = shoot(after);
    int changed = 0;
    for (std::size_t i = 0; i < a.color.size(); ++i) {
      changed += std::abs(a.color[i] - b.color[i]) > 6;
    }
    EXPECT_LE(changed, 12) << where; // of 307200: ridges move by a part of a pixel
  };
  const double hair = 1e-4; // [m]
  const double west = -0.5 * Post * 4097;
  for (const int level : {0, 1, 2, 4, 6}) {
    // A post on which windows of this and all finer levels snap.
    const double x = west + Post * (1 << level) * 2.0 * std::round(1000.0 / (1 << level));
    for (const double height : {70.0, 260.0}) {
      compare({x - hair, 3.0, height}, {x + hair, 3.0, height},
              "level " + std::to_string(level) + " snaps at height " + std::to_string(height));
    }
  }
  const auto ground = [&](double x, double y) {
    const Eigen::Vector3d post = terrain->Placement().ToPosts({x, y, 0.0});
    return Hills(std::round(post.x()), std::round(post.y()));
  };
  const Eigen::Vector2d post = // where the ground's height is a post's, in all levels
      terrain->Placement().ToScene({2048.0, 2048.0}, 0.0).head<2>();
  for (const int level : {0, 1, 2, 3}) {
    const double height = ground(post.x(), post.y()) + geometry.BlendTo() * Post * (1 << level);
    compare({post.x(), post.y(), height - hair}, {post.x(), post.y(), height + hair},
            "level " + std::to_string(level) + " goes");
  }
}

// After any number of moves the texture is what a first upload would have been, byte for byte.
TEST_F(ClipmapFixture, TexturesAreThoseOfAFullUploadAndOnlyNewsGoesUp) {
  posts = std::make_shared<FormulaPosts>(3000, 3000, false, Hills, 28);
  const auto pyramid = std::make_shared<ElevationPyramid>(posts);
  ClipmapLevels levels(pyramid, 28);
  const ClipmapGeometry geometry(28);
  const std::size_t side = geometry.Texels();
  // What OpenGL would hold.
  std::vector<std::vector<ClipmapTexel>> textures(levels.Count(),
                                                  std::vector<ClipmapTexel>(side * side));
  std::size_t uploaded = 0;
  const auto upload = [&](int level, const ClipmapUpdate& u, const ClipmapTexel* texels) {
    for (int j = 0; j < u.height; ++j) {
      std::copy_n(texels + std::size_t(j) * u.width, u.width,
                  textures[level].begin() + std::ptrdiff_t(u.y + j) * std::ptrdiff_t(side) + u.x);
    }
    uploaded += std::size_t(u.width) * u.height;
  };
  std::mt19937 random(9);
  Eigen::Vector2d place(1500.0, 1500.0);
  for (int move = 0; move < 500; ++move) {
    const double reach = move % 20 == 19 ? 900.0 : move % 4 == 3 ? 30.0 : 4.0;
    std::uniform_real_distribution<double> step(-reach, reach);
    place = (place + Eigen::Vector2d(step(random), step(random))).cwiseMax(0.0).cwiseMin(2999.0);
    ClipmapLevels::View where;
    where.place = place;
    where.height = 52.0;
    where.cellSize = 2.0;
    where.wait = 60.0;
    std::vector<std::optional<ClipmapWindow>> windows(levels.Count());
    if (move > 0) {
      for (int level = 0; level < levels.Count(); ++level) {
        windows[level] = levels.Window(level);
      }
    }
    uploaded = 0;
    const ClipmapLevels::State state = levels.Update(where, upload);
    ASSERT_TRUE(state.complete);
    std::size_t news = 0;
    ClipmapLevels fresh(pyramid, 28);
    fresh.Update(where, [](int, const ClipmapUpdate&, const ClipmapTexel*) {});
    for (int level = state.finest; level < levels.Count(); ++level) {
      const ClipmapWindow& window = levels.Window(level);
      ASSERT_EQ(window, fresh.Window(level));
      for (std::int64_t r = window.row - 1; r <= window.row + 29; ++r) {
        for (std::int64_t c = window.column - 1; c <= window.column + 29; ++c) {
          const std::size_t at = std::size_t(geometry.Texel(r)) * side + geometry.Texel(c);
          ASSERT_EQ(
              std::memcmp(&textures[level][at], &fresh.Texel(level, c, r), sizeof(ClipmapTexel)), 0)
              << "move " << move << ", level " << level << ", post " << c << ", " << r;
        }
      }
      const auto inside = [&](std::int64_t c, std::int64_t r) {
        return windows[level] && c >= windows[level]->column - 1 &&
               c <= windows[level]->column + 29 && r >= windows[level]->row - 1 &&
               r <= windows[level]->row + 29;
      };
      for (std::int64_t r = window.row - 1; r <= window.row + 29; ++r) {
        for (std::int64_t c = window.column - 1; c <= window.column + 29; ++c) {
          news += !inside(c, r);
        }
      }
    }
    ASSERT_EQ(uploaded, news) << "move " << move;
  }
}

// A range of heights that was guessed too narrow hides nothing.
TEST_F(ClipmapFixture, GroundBeyondTheGuessedHeightsIsDrawn) {
  const auto spire = [](double c, double r) {
    return std::abs(c - 256.0) < 4.0 && std::abs(r - 256.0) < 4.0 ? 300.0 : 0.0;
  };
  AddPlane(513, spire, {0.0, 0.0}, false);
  const Eigen::Vector3d foot = terrain->Placement().ToScene({256.0, 256.0}, 0.0);
  LookFrom(foot + Eigen::Vector3d(-60.0, 3.0, 240.0), foot + Eigen::Vector3d(0.0, 0.0, 270.0),
           20.0);
  auto view = View(64, 48);
  const Capture capture = Shoot(view);
  const Hit hit = HitAt(*scene, capture, 32, 24);
  ASSERT_TRUE(hit.hit);
  EXPECT_LT((hit.p - foot).head<2>().norm(), 9.0);
  EXPECT_GT(hit.p.z(), 200.0);
}

// Bytes are counted at the OpenGL call, and the texture read back.
TEST_F(ClipmapFixture, WhatOpenGLHoldsIsWhatWasCounted) {
  AddPlane(4097, Hills, {-51, 51}, false);
  LookFrom({0, 0, 60}, {100, 40, 20});
  auto view = View(64, 48);
  Shoot(view);
  const std::uint64_t first = context->GetStatistics().textureBytesUploaded;
  LookFrom({0, 0, 60}, {90, 40, 20}); // turned only
  Shoot(view);
  EXPECT_EQ(context->GetStatistics().textureBytesUploaded, first);
  LookFrom({4 * Post, 0, 60}, {90, 40, 20}); // four posts on
  Shoot(view);
  const std::uint64_t moved = context->GetStatistics().textureBytesUploaded - first;
  // 4 columns of level 0, 2 to 4 of level 1, ...: of 127 rows, in the colour and the label picture.
  EXPECT_GE(moved, 2u * 127u * 4u * sizeof(ClipmapTexel));
  EXPECT_LE(moved, 2u * 127u * (4u + 4u + 2u * 6u) * sizeof(ClipmapTexel));
}

TEST_F(ClipmapFixture, ADeadlineIsAnErrorAndAnInteractivePictureIsNot) {
  const auto gate = std::make_shared<Gate>();
  posts = std::make_shared<FormulaPosts>(4097, 4097, false, [gate](double c, double r) {
    gate->Wait();
    return Hills(c, r);
  });
  ClipmapOptions options;
  options.heights = {-51, 51};
  options.deadline = 0.05;
  terrain = std::make_shared<ClipmapTerrain>(
      std::make_shared<ElevationPyramid>(posts),
      PostPlacement::OnPlane(Eigen::Affine2d(Eigen::Scaling(Post, -Post))), options);
  GraphicsObject ground;
  ground.name = "ground";
  ground.custom = terrain;
  scene->AddObject(ground);
  LookFrom({100, -100, 60}, {200, -140, 20});
  auto view = View(64, 48);
  view->ForceRender(); // what is there: nothing
  try {
    Shoot(view);
    ADD_FAILURE() << "the picture was taken without its data";
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::DeadlineExceeded) << error.what();
  }
  gate->Open();
}

} // namespace
} // namespace dspace::testing
