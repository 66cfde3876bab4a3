// The tiles of shadow maps never miss a caster, and leave out what can throw no shadow.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <dspace/render/shadows/CasterTiles.h>

using namespace dspace;

namespace {

// One map of 20 m a side, the Sun at an elevation in the XZ plane; view axes with Z upwards.
CascadeFit FitAt(double elevation_deg) {
  const double e = elevation_deg * M_PI / 180.0;
  CascadeFit fit;
  fit.sun.axes = LightAxes({std::cos(e), 0.0, std::sin(e)});
  fit.sun.radius = 0.00465;
  fit.size = 512;
  CascadeFit::Cascade cascade;
  cascade.end = 1e6;
  cascade.radius = 10.0;
  cascade.center = Eigen::Vector2d::Zero();
  fit.cascades.push_back(cascade);
  return fit;
}

LightHull BoxHull(const Eigen::Vector3d& center, const Eigen::Vector3d& half) {
  LightHull hull;
  for (int i = 0; i < 8; ++i) {
    hull.points.push_back(center + half.cwiseProduct(Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1,
                                                                     i & 4 ? 1 : -1)));
  }
  return hull;
}

// Ground between two heights over a square.
LightHull Ground(double x, double y, double half, double low, double high) {
  LightHull hull = BoxHull({x, y, 0.5 * (low + high)}, {half, half, 0.5 * (high - low)});
  hull.floor = Eigen::Vector4d(0, 0, 1, -low);
  hull.ceiling = Eigen::Vector4d(0, 0, 1, -high);
  return hull;
}

float TopAt(const CasterTiles& tiles, const CascadeFit& fit, const Eigen::Vector3d& p) {
  const Eigen::Vector3d light = fit.sun.axes * p;
  const auto tile = [&](int axis) {
    return int(std::floor((light[axis] + 10.0) / 20.0 * CasterTiles::Side));
  };
  return tiles.Tops()[std::size_t(tile(1)) * CasterTiles::Side + tile(0)];
}

} // namespace

TEST(CasterTiles, EveryPointOfACasterIsBelowTheTopOfItsTile) {
  const CascadeFit fit = FitAt(35.0);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&] { return Eigen::Vector3d(unit(random), unit(random), unit(random)); };
  for (int n = 0; n < 200; ++n) {
    CasterTiles tiles(fit, fit.cascades[0]);
    const Eigen::Vector3d half = vector().cwiseAbs() + Eigen::Vector3d::Constant(0.01);
    const Eigen::Affine3d X_VB = Eigen::Translation3d(5.0 * vector()) *
                                 Eigen::AngleAxisd(3.0 * unit(random), vector().normalized());
    const std::vector<Eigen::AlignedBox3f> box = {{-half.cast<float>(), half.cast<float>()}};
    LightHull hull;
    hull.parts = &box;
    hull.X_VM = X_VB.matrix().topRows<3>();
    tiles.Add(LightPlace(fit.sun.axes, hull).Parts().front().box);
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d p = X_VB * half.cwiseProduct(vector());
      EXPECT_GE(double(TopAt(tiles, fit, p)) + 1e-6, fit.sun.axes.row(2).dot(p));
    }
  }
}

TEST(CasterTiles, EmptyTilesNeedNoTexels) {
  const CascadeFit fit = FitAt(90.0);
  CasterTiles tiles(fit, fit.cascades[0]);
  EXPECT_TRUE(tiles.Empty());
  EXPECT_EQ(tiles.Texels(), (std::array<int, 4>{0, 0, 0, 0}));
  tiles.Add(BoxHull({40, 0, 0}, {1, 1, 1})); // beside the map
  EXPECT_TRUE(tiles.Empty());
  // A square metre in the middle: 26 texels, the margin twice, and what its tiles round.
  tiles.Add(BoxHull({0, 0, 0}, {0.5, 0.5, 0.5}));
  const std::array<int, 4> texels = tiles.Texels();
  for (const int axis : {0, 1}) {
    EXPECT_LE(texels[axis], 256 - 13 - 2 * CasterTiles::Margin);
    EXPECT_GE(texels[axis], 256 - 13 - 2 * CasterTiles::Margin - 8);
    EXPECT_GE(texels[axis + 2], 256 + 13 + 2 * CasterTiles::Margin);
    EXPECT_LE(texels[axis + 2], 256 + 13 + 2 * CasterTiles::Margin + 8);
  }
  tiles.AddEverywhere();
  EXPECT_EQ(tiles.Texels(), (std::array<int, 4>{0, 0, 512, 512}));
}

// A post of 2 m on level ground throws a shadow of 2 / tan(e) away from the Sun, which is at +X.
TEST(CasterTiles, GroundIsShadedWhereTheShadowFalls) {
  const CascadeFit fit = FitAt(30.0);
  CasterTiles tiles(fit, fit.cascades[0]);
  tiles.Add(BoxHull({0, 0, 1}, {0.1, 0.1, 1}));
  const double length = 2.0 / std::tan(30.0 * M_PI / 180.0);
  for (const double x : {-0.5, -1.5, -3.0}) {
    EXPECT_TRUE(tiles.Shade(Ground(x, 0, 0.2, -0.05, 0.05))) << x;
  }
  for (const double x : {2.0, 4.0, -length - 2.0}) { // sunwards, and beyond the tip
    EXPECT_FALSE(tiles.Shade(Ground(x, 0, 0.2, -0.05, 0.05))) << x;
  }
  EXPECT_FALSE(tiles.Shade(Ground(-1.5, 3.0, 0.2, -0.05, 0.05)));
}

// Ground that is askew to the map's axes is shaded where it is, not where the box about it is.
TEST(CasterTiles, BlocksAskewAreNoWiderThanTheyAre) {
  CascadeFit fit = FitAt(30.0);
  fit.sun.axes = LightAxes({0.6, 0.6, 0.5});
  CasterTiles tiles(fit, fit.cascades[0]);
  tiles.Add(BoxHull({0, 0, 0.5}, {0.1, 0.1, 0.5}));
  // The shadow is 1.7 m long, towards -X and -Y.
  EXPECT_TRUE(tiles.Shade(Ground(-3.0, -3.0, 2.9, 0.0, 0.1)));
  EXPECT_TRUE(tiles.Shade(Ground(-2.0, -2.0, 3.0, 0.0, 0.1)));
  EXPECT_FALSE(tiles.Shade(Ground(4.6, 4.6, 3.0, 0.0, 0.1)));
  EXPECT_FALSE(tiles.Shade(Ground(-3.9, 3.9, 3.0, 0.0, 0.1)));
  EXPECT_FALSE(tiles.Shade(Ground(3.9, -3.9, 3.0, 0.0, 0.1)));
}

TEST(CasterTiles, CastersAreDrawnForWhatLiesBelowThem) {
  const CascadeFit fit = FitAt(30.0);
  CasterTiles receivers(fit, fit.cascades[0]);
  receivers.Add(Ground(-3.0, 0, 0.5, 0.0, 0.0));
  const LightHull post = BoxHull({-1.0, 0, 1}, {0.1, 0.1, 1});
  EXPECT_TRUE(receivers.TakeShadows(post, 0.0));   // 1 to 2 m high at 2 m from it
  EXPECT_FALSE(receivers.TakeShadows(post, 10.0)); // nothing is that far below it
  EXPECT_FALSE(receivers.TakeShadows(BoxHull({-5.0, 0, 1}, {0.1, 0.1, 1}), 0.0)); // behind it
  EXPECT_FALSE(receivers.TakeShadows(BoxHull({-1.0, 4, 1}, {0.1, 0.1, 1}), 0.0)); // beside it
  EXPECT_TRUE(receivers.TakeShadows(LightHull(), 0.0));                           // anywhere
}

TEST(CasterTiles, OnlyMapsThatReachThePlaceCount) {
  CascadeFit fit = FitAt(90.0);
  std::vector<CasterTiles> tiles(1, CasterTiles(fit, fit.cascades[0]));
  tiles[0].Add(BoxHull({0, 0, 0}, {0.5, 0.5, 0.5}));
  const LightHull place = BoxHull({0, 0, -6}, {0.1, 0.1, 0.1}); // 6 m deep in the view
  EXPECT_TRUE(MayBeShaded(fit, tiles, LightPlace(fit.sun.axes, place)));
  fit.cascades[0].end = 5.0;
  EXPECT_FALSE(MayBeShaded(fit, tiles, LightPlace(fit.sun.axes, place)));
  EXPECT_TRUE(MayBeShaded(fit, tiles, LightPlace(fit.sun.axes, LightHull())));
}

TEST(CasterTiles, PartsOfAMeshLeaveWhatLiesBetweenThem) {
  const CascadeFit fit = FitAt(60.0);
  // Two towers 12 m apart, which are one mesh.
  const std::vector<Eigen::AlignedBox3f> towers = {
      {Eigen::Vector3f(-6.5f, -0.5f, 0.0f), Eigen::Vector3f(-5.5f, 0.5f, 3.0f)},
      {Eigen::Vector3f(5.5f, -0.5f, 0.0f), Eigen::Vector3f(6.5f, 0.5f, 3.0f)}};
  LightHull mesh = BoxHull({0.0, 0.0, 1.5}, {6.5, 0.5, 1.5});
  CasterTiles whole(fit, fit.cascades[0]);
  whole.Add(mesh);
  mesh.parts = &towers;
  CasterTiles parts(fit, fit.cascades[0]);
  parts.Add(mesh);
  const LightHull between = Ground(1.0, 0.0, 0.5, 0.0, 0.01);
  EXPECT_TRUE(whole.Shade(between));
  EXPECT_FALSE(parts.Shade(between));
  EXPECT_TRUE(parts.Shade(Ground(-7.0, 0.0, 0.5, 0.0, 0.01))); // the shadow falls to -X
  EXPECT_TRUE(parts.Shade(Ground(5.0, 0.0, 0.5, 0.0, 0.01)));
  // Nor does it throw a shadow on what is between them alone.
  CasterTiles receivers(fit, fit.cascades[0]);
  receivers.Add(between);
  EXPECT_FALSE(receivers.TakeShadows(mesh, 0.0));
  mesh.parts = nullptr;
  EXPECT_TRUE(receivers.TakeShadows(mesh, 0.0));
}
