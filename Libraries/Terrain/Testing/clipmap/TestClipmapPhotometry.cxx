// Light of ground that is drawn as a clipmap: radiance and angles against the photometric models in
// double precision, and what exposure leaves as it is.
#include <dspace/import/model/Reflectance.h>

#include "ClipmapTestSupport.h"

namespace dspace::testing {
namespace {

using Law = Reflectance::Model;

double Degrees(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / M_PI;
}

// A plane that rises by 0.1 along X and by 0.05 along Y.
TEST_F(ClipmapFixture, AnglesAndRadianceAreThoseOfTheGround) {
  AddPlane(513, [](double c, double r) { return 0.2 * c - 0.1 * r; }, {-60, 110});
  const Eigen::Vector3d normal = Eigen::Vector3d(-0.1, -0.05, 1.0).normalized();
  const Eigen::Vector3d toSun = -Eigen::Vector3d(-0.6, 0.3, -0.5).normalized();
  const Eigen::Vector3d eye(-40, 10, 40);
  LookFrom(eye, {30, -30, 28});
  auto view = View(160, 120);
  const double albedo = 0.318547; // of the display value 0.6, red; IEC 61966-2-1
  for (const Law law :
       {Law::MetallicRoughness, Law::Lambert, Law::LommelSeeliger, Law::LunarLambert, Law::Hapke}) {
    MaterialOverride over;
    over.color = {0.6, 0.6, 0.6};
    over.reflectance.emplace().model = law;
    ViewLook look; // nothing is there that throws a shadow
    look.shadows.shown = law == Law::Hapke || law == Law::Lambert;
    view->SetLook(look);
    scene->SetObjectMaterial(object, over);
    CaptureRequest request;
    request.color = false;
    request.depth = request.radiance = true;
    request.incidence = request.emission = request.phase = true;
    const Capture capture = view->GetCapture(request);
    int compared = 0;
    double worst = 0.0;
    for (int y = 0; y < capture.height; ++y) {
      for (int x = 0; x < capture.width; ++x) {
        const std::size_t at = std::size_t(y) * capture.width + x;
        const Hit hit = HitAt(*scene, capture, x, y);
        if (!hit.hit) {
          EXPECT_TRUE(std::isnan(capture.incidence[at]));
          continue;
        }
        const Eigen::Vector3d toEye = (eye - hit.p).normalized();
        const double emission = Degrees(normal, toEye);
        const double phase = Degrees(toSun, toEye);
        EXPECT_NEAR(capture.incidence[at], Degrees(normal, toSun), 0.01);
        EXPECT_NEAR(capture.emission[at], emission, 0.01);
        EXPECT_NEAR(capture.phase[at], phase, 0.01);
        if (emission > 85.0) {
          continue;
        }
        const double expected = 1361.0 / M_PI * albedo *
                                RadianceFactor(*over.reflectance, normal.dot(toSun),
                                               normal.dot(toEye), phase * M_PI / 180.0);
        worst = std::max(worst, std::abs(capture.radiance[3 * at] / expected - 1.0));
        ++compared;
      }
    }
    EXPECT_GT(compared, 5000);
    EXPECT_LT(worst, 1e-3) << int(law);
  }
}

TEST_F(ClipmapFixture, UnlitGroundKeepsItsDisplayColour) {
  AddPlane(
      513, [](double, double) { return 0.0; }, {0, 0}, false);
  LookFrom({0, 0, 30}, {10, 0, 0});
  auto view = View(80, 60);
  const auto plain = view->GetCapture({}).color;
  for (const bool automatic : {false, true}) {
    ViewLook look;
    look.exposure = 3.0;
    look.automaticExposure = automatic;
    look.tone = ToneCurve::Filmic;
    view->SetLook(look);
    const auto exposed = view->GetCapture({}).color;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      ASSERT_NEAR(exposed[i], plain[i], 1);
    }
  }
  // Without the Sun's light there are no angles but the emission, and without shading none.
  CaptureRequest request;
  request.emission = true;
  EXPECT_TRUE(std::isnan(view->GetCapture(request).emission[0]));
}

} // namespace
} // namespace dspace::testing
