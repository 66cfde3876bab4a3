// Drawn bodies: places, light and irradiance against closed forms.
#include "RenderingTestSupport.h"

#include <dspace/render/bodies/BodyDrawer.h>
#include <dspace/scene/Light.h>
#include <dspace/scene/bodies/SunDisc.h>

namespace dspace {
namespace {

constexpr double Au = 1.495978707e11;
constexpr double MoonRadius = 1737.4e3;

Reflectance Of(Reflectance::Model model) {
  Reflectance made;
  made.model = model;
  return made;
}

struct BodyTest : RenderingFixture {
  static constexpr int Size = 201;

  BodyTest() {
    Look({});
    RegisterBodyDrawer(context->GetDrawers());
  }

  ObjectId Add(const std::string& name, const BodyShape& shape, const Eigen::Vector3d& place,
               std::array<double, 3> color = {1, 1, 1}) {
    GraphicsObject object;
    object.name = name;
    object.custom = std::make_shared<CelestialBody>(name, shape);
    object.X_FO.translation() = place;
    object.material.color = color;
    object.material.reflectance = Of(Reflectance::Model::Lambert);
    return scene->AddObject(object);
  }
  static BodyShape Sphere(double radius) {
    BodyShape shape;
    shape.radii = Eigen::Vector3d::Constant(radius);
    return shape;
  }
  void Sun(const Eigen::Vector3d& direction) {
    Light sun;
    sun.name = SunName;
    sun.direction = direction;
    scene->SetLight(sun);
  }
  Capture Take(const Projection& projection, int samples = 1) {
    Look(projection);
    CaptureRequest request;
    request.radiance = request.depth = request.label = true;
    return View(Size, Size, samples)->GetCapture(request);
  }
  // Sum of green radiance times solid angle [W/m^2].
  static double Irradiance(const Capture& capture, const Projection& projection) {
    double sum = 0.0;
    const double edge = projection.MetresPerPixel(1.0, Size);
    for (int y = 0; y < Size; ++y) {
      for (int x = 0; x < Size; ++x) {
        const double cosine = projection.PixelRay(x, y, Size, Size).direction.z();
        sum += double(capture.radiance[3 * std::size_t(y * Size + x) + 1]) * edge * edge *
               std::pow(cosine, 3);
      }
    }
    return sum;
  }
  // J. Lambert's sphere of normal albedo 1 at a phase angle, under the Sun at 1 au.
  static double Lambert(double radius, double distance, double phase) {
    const double shape = (std::sin(phase) + (M_PI - phase) * std::cos(phase)) / M_PI;
    return SolarConstant * 2.0 / 3.0 * std::pow(radius / distance, 2) * shape;
  }
};

// From a disc of 150 pixels down to a thousandth of one, full and as a crescent.
TEST_F(BodyTest, ABodyHasItsIrradianceAtAnyDistance) {
  Projection projection;
  projection.verticalFov_deg = 0.2;
  const Eigen::Vector3d away = Eigen::Vector3d(1.0, 0.00006, 0.000042).normalized();
  for (const double phase : {0.0, 1.2, 2.2}) {
    Sun({std::cos(phase), std::sin(phase), 0.0});
    for (const double pixels : {75.0, 12.5, 11.5, 3.2, 2.9, 1.3, 0.4, 0.01, 0.0005}) {
      const double angle = projection.MetresPerPixel(1.0, Size) * pixels;
      const double distance = MoonRadius / angle;
      const ObjectId id = this->Add("moon", Sphere(MoonRadius), away * distance);
      const Capture capture = this->Take(projection);
      const double expected = Lambert(MoonRadius, distance, phase + std::atan2(away.y(), away.x()));
      EXPECT_NEAR(Irradiance(capture, projection) / expected, 1.0, 0.03)
          << pixels << " pixels, phase " << phase;
      const Extent extent = ExtentOf(capture, id);
      EXPECT_NEAR(extent.right - extent.left + 1, std::max(1.0, 2.0 * pixels), 1.6) << pixels;
      scene->RemoveObject(id);
    }
  }
}

// The limb is where the tangent cone is, the depth that of the sphere, from 1 m above it to 1 au.
TEST_F(BodyTest, PlacesAreExactFromTheGroundToAnAstronomicalUnit) {
  Sun({1, 0, 0});
  for (const double height : {1.0, 1e3, 1e6, 1e8, Au}) {
    const double distance = MoonRadius + height;
    const double half = std::asin(MoonRadius / distance);
    Projection projection;
    projection.verticalFov_deg = std::min(100.0, 2.0 * half * 180.0 / M_PI * 1.5);
    const ObjectId id = this->Add("moon", Sphere(MoonRadius), {distance, 0, 0});
    const Capture capture = this->Take(projection);
    const std::size_t middle = std::size_t(Size / 2 * Size + Size / 2);
    EXPECT_NEAR(capture.depth[middle], height, std::max(1e-4, 2e-7 * distance)) << height;
    EXPECT_EQ(capture.label[middle], id) << height;
    // Along the row of the middle: the radius where the row's ray touches or crosses.
    for (int x = 0; x < Size; x += 7) {
      const Eigen::Vector3d d = projection.PixelRay(x, Size / 2, Size, Size).direction;
      const double b = distance * d.z();
      const double square = b * b - height * (2.0 * MoonRadius + height);
      const std::size_t at = std::size_t(Size / 2 * Size + x);
      if (std::abs(std::acos(d.z()) - half) < 1e-4 * half) {
        continue;
      }
      ASSERT_EQ(capture.label[at] == id, square > 0.0) << height << ", column " << x;
      if (square > 0.0) {
        const double depth = height * (2.0 * MoonRadius + height) / (b + std::sqrt(square)) * d.z();
        EXPECT_NEAR(capture.depth[at] / depth, 1.0, 1e-5) << height << ", column " << x;
      }
    }
    scene->RemoveObject(id);
  }
}

// The brightest row is under the Sun; the other side is black.
TEST_F(BodyTest, TheNightSideIsBlackAndTheDayFollowsLambert) {
  Sun({0.0, -1.0, 0.0}); // from the root's Y: the left of the picture
  Projection projection;
  projection.verticalFov_deg = 1.0;
  const double distance = 3e8;
  this->Add("moon", Sphere(MoonRadius), {distance, 0, 0}, {1, 1, 1});
  const Capture capture = this->Take(projection);
  for (int x = 0; x < Size; x += 5) {
    const Eigen::Vector3d ray = projection.PixelRay(x, Size / 2, Size, Size).direction;
    const Eigen::Vector3d d(ray.z(), -ray.x(), -ray.y());
    const Eigen::Vector3d center(distance, 0, 0);
    const double b = d.dot(center);
    const double square = b * b - (distance * distance - MoonRadius * MoonRadius);
    if (square < 1e10) {
      continue; // the limb
    }
    const Eigen::Vector3d normal = ((b - std::sqrt(square)) * d - center) / MoonRadius;
    const double expected = SolarConstant / M_PI * std::max(0.0, normal.y());
    EXPECT_NEAR(capture.radiance[3 * std::size_t(Size / 2 * Size + x) + 1], expected,
                2e-4 * SolarConstant / M_PI)
        << x;
  }
}

// Longitude 0 of a texture whose left edge is at -180 is along the body's X, and east is to the
// right of who looks at it with north up.
TEST_F(BodyTest, TexturesAreWhereTheirLongitudesSay) {
  auto image = std::make_shared<Image>();
  image->name = "longitudes";
  image->width = 360;
  image->height = 180;
  image->channels = 3;
  for (int y = 0; y < 180; ++y) { // red grows with longitude from -180, green with latitude
    for (int x = 0; x < 360; ++x) {
      image->pixels.push_back(std::uint8_t(x * 255 / 359));
      image->pixels.push_back(std::uint8_t((179 - y) * 255 / 179));
      image->pixels.push_back(0);
    }
  }
  Sun({1, 0, 0});
  Projection projection;
  projection.verticalFov_deg = 0.8;
  const auto srgb = [](double value) { // of radiance against full sun
    return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
  };
  for (const double edge : {-180.0, 0.0}) {
    // The camera looks along the root's X; a turn of half a circle shows it the body's longitude 0.
    GraphicsObject object;
    object.name = "moon";
    BodyShape shape = Sphere(MoonRadius);
    shape.leftEdge_deg = edge;
    object.custom = std::make_shared<CelestialBody>("moon", shape);
    object.X_FO =
        Eigen::Translation3d(3e8, 0, 0) * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ());
    object.material.texture = std::shared_ptr<const Image>(image);
    object.material.reflectance = Of(Reflectance::Model::LommelSeeliger); // even: phase 0
    const ObjectId id = scene->AddObject(object);
    const Capture capture = this->Take(projection);
    for (const int offset : {-40, -15, 12, 45}) {
      const int x = Size / 2 + offset;
      const int y = Size / 2 - 20;
      const Eigen::Vector3d ray = projection.PixelRay(x, y, Size, Size).direction;
      const Eigen::Vector3d d(ray.z(), -ray.x(), -ray.y());
      const Eigen::Vector3d center(3e8, 0, 0);
      const double b = d.dot(center);
      const double s = b - std::sqrt(b * b - (9e16 - MoonRadius * MoonRadius));
      const Eigen::Vector3d normal_S = (s * d - center) / MoonRadius;
      const Eigen::Vector3d n(-normal_S.x(), -normal_S.y(), normal_S.z());
      const double longitude = std::atan2(n.y(), n.x()) * 180.0 / M_PI;
      const double latitude = std::asin(n.z()) * 180.0 / M_PI;
      double column = (longitude - edge) / 360.0;
      column -= std::floor(column);
      const std::size_t at = 3 * std::size_t(y * Size + x);
      const double light = SolarConstant / M_PI;
      EXPECT_NEAR(srgb(double(capture.radiance[at]) / light), column, 0.012)
          << edge << " " << offset;
      EXPECT_NEAR(srgb(double(capture.radiance[at + 1]) / light), latitude / 180.0 + 0.5, 0.012);
      EXPECT_EQ(longitude > 0.0, offset > 0);
    }
    scene->RemoveObject(id);
  }
}

// The Sun as a body: its disc, the light from where it is, and an eclipse by the reference of
// doubles.
TEST_F(BodyTest, TheMoonsShadowOnTheEarthIsThatOfTheReference) {
  Sun({1, 0, 0});
  BodyShape sun = Sphere(6.957e8);
  sun.sun = true;
  sun.eclipses = false;
  const Eigen::Vector3d sunPlace(-1.01 * Au, 2e9, 1e9);
  this->Add("sun", sun, sunPlace);
  const Eigen::Vector3d earthPlace(1e8, 0, 0); // the camera looks from the Sun's side
  const Eigen::Vector3d toSun = (sunPlace - earthPlace).normalized();
  BodyShape earth = Sphere(6378e3);
  earth.radii.z() = 6357e3;
  this->Add("earth", earth, earthPlace);
  const Eigen::Vector3d moonPlace =
      earthPlace + toSun * 3.6e8 + Eigen::Vector3d(0, 0.6, 0.8) * 2.0e6;
  this->Add("moon", Sphere(MoonRadius), moonPlace);
  Projection projection;
  projection.verticalFov_deg = 8.0;
  const Capture capture = this->Take(projection);
  int umbra = 0;
  int penumbra = 0;
  for (int y = 20; y < Size - 20; y += 2) {
    for (int x = 20; x < Size - 20; x += 2) {
      const Eigen::Vector3d ray = projection.PixelRay(x, y, Size, Size).direction;
      const Eigen::Vector3d d(ray.z(), -ray.x(), -ray.y());
      const Eigen::Vector3d r = earth.radii.cwiseInverse();
      const Eigen::Vector3d o = r.cwiseProduct(-earthPlace);
      const Eigen::Vector3d e = r.cwiseProduct(d);
      const double square = std::pow(o.dot(e), 2) - e.squaredNorm() * (o.squaredNorm() - 1.0);
      if (square < 0.02 * e.squaredNorm()) {
        continue; // misses, and the limb
      }
      const Eigen::Vector3d p = d * ((-o.dot(e) - std::sqrt(square)) / e.squaredNorm());
      const Eigen::Vector3d n = (p - earthPlace).cwiseProduct(r).cwiseProduct(r).normalized();
      const Eigen::Vector3d s = sunPlace - p;
      const SunBlocker moon = {moonPlace - p, Eigen::Matrix3d::Identity() / MoonRadius};
      const double left = SunLeft(moon, s, 6.957e8);
      const double expected = SolarConstant / M_PI * std::pow(Au / s.norm(), 2) *
                              std::max(0.0, n.dot(s.normalized())) * left;
      umbra += left == 0.0;
      penumbra += left > 0.0 && left < 1.0;
      EXPECT_NEAR(capture.radiance[3 * std::size_t(y * Size + x) + 1], expected,
                  1e-3 * SolarConstant / M_PI)
          << x << ", " << y << ": " << left;
    }
  }
  EXPECT_GT(penumbra, 500);
  EXPECT_GT(umbra, 0);
}

// Ten rays through the Earth's and Mars' air, from space and from the ground, against the integral
// of the same equations in double precision.
TEST_F(BodyTest, AirScattersWhatTheIntegralSays) {
  struct Ray {
    double height; // of the camera [m]
    double pitch;  // of the view's axis above the horizontal [deg]
    double sun;    // elevation of the Sun, in the plane of the view [deg]
  };
  const std::vector<Ray> rays = {{2.0, 2.0, 40.0},     {2.0, 30.0, 60.0},    {2.0, 80.0, 10.0},
                                 {2.0, 10.0, 1.0},     {2.0, 5.0, -3.0},     {10e3, 1.0, 30.0},
                                 {400e3, -15.0, 20.0}, {400e3, -60.0, 45.0}, {400e3, -19.2, 10.0},
                                 {2e7, -73.0, 30.0}};
  for (const bool mars : {false, true}) {
    const Atmosphere air = mars ? MarsAtmosphere() : EarthAtmosphere();
    const double ground = mars ? 3396.19e3 : 6371e3;
    for (const Ray& ray : rays) {
      const double r = ground + ray.height;
      double pitch = ray.pitch * M_PI / 180.0;
      if (ray.height > 1e5) { // past the limb as on the Earth
        const double dip = std::acos(ground / r);
        pitch = pitch < -1.0 && ray.height > 1e7 ? -(M_PI / 2.0 - std::asin(ground / r)) + 0.002
                : ray.pitch > -20.0              ? -dip + (ray.pitch < -18.0 ? 0.008 : 0.018)
                                                 : pitch;
      }
      const double elevation = ray.sun * M_PI / 180.0;
      // The camera looks along the root's X: down is turned by the pitch.
      const Eigen::Vector3d up(std::sin(pitch), 0.0, std::cos(pitch));
      const Eigen::Vector3d level(std::cos(pitch), 0.0, -std::sin(pitch));
      const Eigen::Vector3d toSun = std::cos(elevation) * level + std::sin(elevation) * up;
      this->Sun(-toSun);
      BodyShape shape = Sphere(ground);
      shape.atmosphere = air;
      const ObjectId id = this->Add("planet", shape, -up * r, {0, 0, 0});
      Projection projection;
      projection.verticalFov_deg = 0.5;
      const Capture capture = this->Take(projection);
      const Eigen::Vector3d from = up * r;
      const Eigen::Vector3d d(1, 0, 0);
      // To the ground, or out of the air.
      const double b = from.dot(d);
      const double hit = b * b - (r * r - ground * ground);
      const double out = b * b - (r * r - std::pow(ground + air.top, 2));
      ASSERT_GT(out, 0.0);
      const double end = hit > 0.0 && b < 0.0 ? -b - std::sqrt(hit) : -b + std::sqrt(out);
      const double start = std::max(0.0, -b - std::sqrt(out));
      const AirLight light =
          IntegrateAir(air, ground, from + d * start, from + d * end, toSun, 4000, 400);
      const std::size_t at = 3 * std::size_t(Size / 2 * Size + Size / 2);
      for (int i = 0; i < 3; ++i) {
        const double expected = SolarConstant * light.scattered[i];
        EXPECT_NEAR(capture.radiance[at + std::size_t(i)], expected, 0.02 * expected + 1e-3)
            << (mars ? "mars" : "earth") << ", height " << ray.height << ", pitch " << ray.pitch
            << ", sun " << ray.sun << ", channel " << i;
      }
      scene->RemoveObject(id);
    }
  }
}

} // namespace
} // namespace dspace
