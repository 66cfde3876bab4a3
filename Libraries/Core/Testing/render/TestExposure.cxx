// Exposure and tone curves of pictures against their formulas.
#include "RenderingTestSupport.h"

#include <algorithm>
#include <functional>

#include "vtkActor.h"
#include "vtkCellArray.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"

#include <dspace/render/props/VtkPropDrawer.h>
#include <dspace/render/props/VtkPropGeometry.h>
#include <dspace/scene/LinearLight.h>

namespace dspace {
namespace {

// sRGB (IEC 61966-2-1) of a linear value.
double Display(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return 255.0 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055);
}

double Filmic(double x) {
  return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

// A matt white wall, 10 m ahead and lit by the Sun straight on, that ends at the picture's middle.
// To the right of it an unlit wall of one colour, with the background around it.
struct ExposureTest : RenderingFixture {
  static constexpr int Size = 40;
  std::shared_ptr<Material> matt = std::make_shared<Material>();
  vtkSmartPointer<vtkDspaceViewport> viewport;
  ViewLook look;

  ExposureTest() {
    Look({});
    matt->color = {1, 1, 1};
    matt->roughness = 1.0;
    Add("wall", PlaneTowardsCamera(20, 20), {10, 10, 0}, matt);
    Add("sign", PlaneTowardsCamera(2, 2), {10, -2, 0}, Unlit({0.3, 0.6, 0.9}));
  }
  ObjectId Add(const std::string& name, Mesh mesh, const Eigen::Vector3d& at,
               std::shared_ptr<const Material> material) {
    GraphicsObject object = Object(name, RootFrame, std::move(mesh), std::move(material));
    object.X_FO.translation() = at;
    return scene->AddObject(object);
  }
  void SetSun(double intensity) {
    Light sun;
    sun.name = SunName;
    sun.direction = {1, 0, 0};
    sun.intensity = intensity;
    scene->SetLight(sun);
  }
  std::vector<std::uint8_t> Take(int samples = 1) {
    if (!viewport) {
      viewport = View(Size, Size, samples);
      viewport->SetBackground({0.1, 0.2, 0.3}, {0.5, 0.4, 0.3});
    }
    viewport->SetLook(look);
    return viewport->GetCapture({}).color;
  }
  static const std::uint8_t* At(const std::vector<std::uint8_t>& picture, int x, int y) {
    return picture.data() + std::size_t(4) * (y * Size + x);
  }
  using dspace::RenderingFixture::Look;
};

const int Wall[2] = {5, 20};
const int Sign[2] = {29, 20};
const int Sky[2] = {35, 3};

} // namespace

TEST_F(ExposureTest, AFixedExposureMultipliesLightAndLeavesDisplayColours) {
  SetSun(0.25);
  const auto plain = Take();
  EXPECT_NEAR(At(plain, Wall[0], Wall[1])[0], Display(0.25), 1);
  look.exposure = 2.0;
  const auto exposed = Take();
  EXPECT_NEAR(At(exposed, Wall[0], Wall[1])[0], Display(0.5), 1);
  for (const auto& place : {Sign, Sky}) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(At(exposed, place[0], place[1])[k], At(plain, place[0], place[1])[k]);
    }
  }
  // Twice the light gives the same picture.
  look.exposure = 1.0;
  SetSun(0.5);
  EXPECT_EQ(Take(), exposed);
}

TEST_F(ExposureTest, EmissiveLightIsExposed) {
  SetSun(0.0);
  matt->emissive = {0.5, 0.5, 0.5};
  for (const double exposure : {1.0, 2.5}) {
    look.exposure = exposure;
    EXPECT_NEAR(At(Take(), Wall[0], Wall[1])[0], Display(exposure * LinearFromSrgb(0.5)), 1);
    look.tone = ToneCurve::Filmic;
    EXPECT_NEAR(At(Take(), Wall[0], Wall[1])[0], Display(Filmic(exposure * LinearFromSrgb(0.5))),
                1);
    look.tone = ToneCurve::Linear;
  }
}

TEST_F(ExposureTest, TheFilmicCurveIsItsFormulaAndRises) {
  look.tone = ToneCurve::Filmic;
  int last = -1;
  for (const double light : {0.0, 0.002, 0.01, 0.05, 0.2, 0.5, 1.0, 2.0, 4.0, 7.0, 100.0, 1e12}) {
    SetSun(light);
    const auto picture = Take();
    const int shown = At(picture, Wall[0], Wall[1])[0];
    EXPECT_NEAR(shown, Display(Filmic(light)), 1) << light;
    EXPECT_GE(shown, last);
    last = shown;
  }
  EXPECT_EQ(last, 255);
}

TEST_F(ExposureTest, DisplayColoursStayThroughEveryCurve) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  const vtkIdType corners[4] = {0, 1, 2, 3};
  for (const auto& [y, z] : {std::pair(-0.5, -0.5), {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
    points->InsertNextPoint(0.0, y, z);
  }
  cells->InsertNextCell(4, corners);
  vtkNew<vtkPolyData> square;
  square->SetPoints(points);
  square->SetPolys(cells);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(square);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetColor(0.2, 0.7, 0.4);
  RegisterVtkPropDrawer(context->GetDrawers());
  GraphicsObject prop;
  prop.name = "prop";
  prop.frame = RootFrame;
  prop.X_FO.translation() = Eigen::Vector3d(10, -2, 2.5);
  prop.custom = std::make_shared<VtkPropGeometry>(actor, "prop");
  scene->AddObject(prop);
  const int Prop[2] = {29, 8};
  SetSun(0.5);
  for (const int samples : {1, 2}) {
    viewport = nullptr;
    look = {};
    const auto plain = Take(samples);
    EXPECT_NEAR(At(plain, Prop[0], Prop[1])[1], 0.7 * 255, 1);
    look.tone = ToneCurve::Filmic;
    look.automaticExposure = true;
    look.exposure = 0.3;
    const auto filmic = Take(samples);
    EXPECT_NE(At(filmic, Wall[0], Wall[1])[0], At(plain, Wall[0], Wall[1])[0]);
    for (const auto& place : {Sign, Sky, Prop}) {
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(At(filmic, place[0], place[1])[k], At(plain, place[0], place[1])[k], 1)
            << place[0] << " " << k;
      }
    }
  }
}

TEST_F(ExposureTest, AutomaticExposureTakesTheBrightestHundredthToSixTenths) {
  SetSun(0.8);
  Add("ball", MakeSphere(3.0, 128), {8, 3, 0}, matt);
  // The percentile by way of the radiance plane, of what is lit.
  viewport = View(Size, Size, 1);
  CaptureRequest request;
  request.radiance = request.label = true;
  const Capture capture = viewport->GetCapture(request);
  std::vector<double> lit;
  const ObjectId sign = scene->FindObject("sign");
  for (std::size_t i = 0; i < capture.label.size(); ++i) {
    const float* light = &capture.radiance[3 * i];
    const double luminance = 0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2];
    if (capture.label[i] != sign && capture.label[i] != 0 && luminance > 0.0) {
      lit.push_back(luminance * M_PI / SolarConstant);
    }
  }
  std::sort(lit.begin(), lit.end());
  const double percentile = lit[std::size_t(0.99 * double(lit.size() - 1))];
  look.automaticExposure = true;
  const auto automatic = Take();
  const double factor = viewport->GetUsedExposure();
  EXPECT_NEAR(factor * percentile, 0.6, 1e-4);
  // It is the picture of a fixed exposure with this factor.
  look.automaticExposure = false;
  look.exposure = factor;
  const auto fixed = Take();
  ASSERT_EQ(fixed.size(), automatic.size());
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    ASSERT_NEAR(fixed[i], automatic[i], 1) << i;
  }
  // Byte-identical when repeated, by another viewport too; the amount of light does not count.
  look.automaticExposure = true;
  look.exposure = 1.0;
  EXPECT_EQ(Take(), automatic);
  SetSun(0.8 * 1024);
  EXPECT_EQ(Take(), automatic);
  viewport = nullptr;
  EXPECT_NE(Take(), fixed); // another background
  EXPECT_NEAR(viewport->GetUsedExposure() * 1024, factor, 1e-6 * factor);
  // The viewport's own factor multiplies.
  look.exposure = 0.5;
  Take();
  EXPECT_NEAR(viewport->GetUsedExposure() * 2048, factor, 1e-6 * factor);
}

TEST_F(ExposureTest, APictureWithoutLightIsShownAsItIs) {
  SetSun(0.0);
  look.automaticExposure = true;
  const auto night = Take();
  EXPECT_EQ(viewport->GetUsedExposure(), 1.0);
  EXPECT_EQ(At(night, Wall[0], Wall[1])[0], 0);
  look.automaticExposure = false;
  EXPECT_EQ(Take(), night);
}

TEST_F(ExposureTest, GlassBeforeAWallIsExposedWithIt) {
  SetSun(0.5);
  Add("glass", PlaneTowardsCamera(1, 1), {8, 3, 0}, Unlit({0, 0, 0}, 0.5));
  look.tone = ToneCurve::Filmic;
  look.exposure = 2.0;
  // 3 m to the left at 8 m; the wall behind it shows half.
  const auto picture = Take();
  const int x = int(0.5 * Size * (1.0 - 3.0 / 8.0 / std::tan(M_PI / 8)));
  EXPECT_NEAR(At(picture, x, 20)[0], Display(Filmic(2.0 * 0.25)), 1);
}

TEST_F(ExposureTest, ExposuresOutOfRangeChangeNothing) {
  SetSun(0.5);
  const auto before = Take();
  for (const double exposure : {0.0, -1.0, 1e13, std::nan("")}) {
    ViewLook bad;
    bad.exposure = exposure;
    EXPECT_THROW(viewport->SetLook(bad), Error);
  }
  EXPECT_EQ(viewport->GetLook().exposure, 1.0);
  EXPECT_EQ(viewport->GetCapture({}).color, before);
}

} // namespace dspace
