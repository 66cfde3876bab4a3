// Lenses against published values, formulas written apart, and differences.
#include <cmath>
#include <fstream>
#include <sstream>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <json/json.h>

#include <dspace/Error.h>
#include <dspace/camera/CameraModel.h>
#include <dspace/camera/MonotoneRange.h>
#include <dspace/camera/files/CameraFiles.h>

#include "TestData.h"

namespace dspace {
namespace {

constexpr double Degree = M_PI / 180.0;

Eigen::Vector3d Direction(double angle_deg, double azimuth_deg) {
  const double t = angle_deg * Degree, a = azimuth_deg * Degree;
  return {std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t)};
}

LensPtr Make(const std::string& type, const LensValues& values) {
  return MakeLens(type, values, "lens");
}

const LensValues Plain = {{"focal", {1000.0, 990.0}}, {"center", {639.5, 479.25}}};

LensValues With(LensValues values, const LensValues& more) {
  values.insert(more.begin(), more.end());
  return values;
}

// One of each type, with numbers that leave no term out, and how far from the axis it is tested.
struct Case {
  std::string type;
  LensValues values;
  double widest_deg;
};

std::vector<Case> Cases() {
  const LensValues cahv = {{"A", {0, 0, 1}}, {"H", {1000, 3, 640}}, {"V", {-2, 990, 480}}};
  const LensValues cahvor =
      With(cahv, {{"O", {0.02, -0.01, std::sqrt(1.0 - 0.0005)}}, {"R", {1e-3, -0.08, 0.01}}});
  return {
      {"pinhole", Plain, 80},
      {"brown",
       With(Plain, {{"radial", {-0.2, 0.05, -0.01, 0.02, 0.01, 0.002}},
                    {"tangential", {1e-3, -2e-3}},
                    {"prism", {1e-3, -5e-4, 7e-4, 3e-4}},
                    {"tilt_deg", {2.0, -1.0}}}),
       40},
      {"equidistant", Plain, 170},
      {"kannala_brandt", With(Plain, {{"radial", {0.02, -0.005, 0.001, -0.0001}}}), 100},
      {"ucm", With(Plain, {{"alpha", {0.6}}}), 100},
      {"eucm", With(Plain, {{"alpha", {0.6}}, {"beta", {1.2}}}), 100},
      {"double_sphere", With(Plain, {{"alpha", {0.57}}, {"xi", {-0.2}}}), 95},
      {"owen",
       {{"focal_length", {15.0}},
        {"matrix", {120.0, 0.3, -0.2, 119.0}},
        {"center", {639.5, 479.5}},
        {"radial", {-2e-4, 1e-7}},
        {"tangential", {1e-4, -2e-4}},
        {"pinwheel", {3e-5, -2e-7}}},
       25},
      {"cahv", cahv, 80},
      {"cahvor", cahvor, 40},
      {"cahvore", With(cahvor, {{"E", {2e-3, -1e-3, 5e-4}}, {"linearity", {0.0}}}), 85},
      {"cahvore", With(cahvor, {{"E", {2e-3, -1e-3, 5e-4}}, {"linearity", {1.0}}}), 40},
      {"cahvore", With(cahvor, {{"E", {2e-3, -1e-3, 5e-4}}, {"linearity", {0.37}}}), 75},
      {"cahvore", With(cahvor, {{"E", {2e-3, -1e-3, 5e-4}}, {"linearity", {-0.4}}}), 75},
  };
}

TEST(LensModels, DerivativesAreTheDifferences) {
  for (const Case& each : Cases()) {
    const LensPtr lens = Make(each.type, each.values);
    EXPECT_EQ(lens->Type(), each.type);
    for (double angle = 0.0; angle <= each.widest_deg; angle += each.widest_deg / 7.0) {
      for (double azimuth = 10.0; azimuth < 360.0; azimuth += 70.0) {
        const Eigen::Vector3d p = 2.5 * Direction(angle, azimuth);
        Eigen::Vector2d pixel;
        LensModel::Jacobian jacobian;
        ASSERT_TRUE(lens->Project(p, pixel, &jacobian)) << each.type << " " << angle;
        for (int k = 0; k < 3; ++k) {
          const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(k);
          Eigen::Vector2d ahead, behind;
          ASSERT_TRUE(lens->Project(p + step, ahead) && lens->Project(p - step, behind));
          const Eigen::Vector2d difference = (ahead - behind) / 2e-6;
          EXPECT_LT((difference - jacobian.col(k)).norm(), 1e-5 * (1.0 + jacobian.norm()))
              << each.type << " at " << angle << " deg, " << azimuth << ", axis " << k;
        }
      }
    }
  }
}

TEST(LensModels, RaysArePixelsBackwards) {
  for (const Case& each : Cases()) {
    const LensPtr lens = Make(each.type, each.values);
    for (double angle = 0.0; angle <= each.widest_deg; angle += each.widest_deg / 16.0) {
      for (double azimuth = 0.0; azimuth < 360.0; azimuth += 33.0) {
        const Eigen::Vector3d direction = Direction(angle, azimuth);
        for (const double distance : {0.3, 1000.0}) {
          Eigen::Vector2d pixel;
          LensRay ray;
          ASSERT_TRUE(lens->Project(distance * direction, pixel)) << each.type << " " << angle;
          ASSERT_TRUE(lens->Unproject(pixel, ray)) << each.type << " " << angle;
          EXPECT_NEAR(ray.direction.norm(), 1.0, 1e-14);
          // The point lies on the ray.
          const Eigen::Vector3d to = distance * direction - ray.origin;
          EXPECT_LT(to.cross(ray.direction).norm(), 2e-11 * distance)
              << each.type << " at " << angle << " deg, " << azimuth;
          EXPECT_GT(to.dot(ray.direction), 0.0);
        }
      }
    }
    // An equal lens from its own numbers, and one for an image of twice the size.
    const LensPtr same = Make(each.type, lens->Values());
    const LensPtr large = lens->Scaled(2.0, 2.0);
    const Eigen::Vector3d p = Direction(0.5 * each.widest_deg, 40.0);
    Eigen::Vector2d a, b, c;
    ASSERT_TRUE(lens->Project(p, a) && same->Project(p, b) && large->Project(p, c));
    EXPECT_LT((a - b).norm(), 1e-9) << each.type;
    EXPECT_LT((2.0 * a + Eigen::Vector2d(0.5, 0.5) - c).norm(), 1e-9) << each.type;
  }
}

// The pixel of a vector by H, V and A alone.
Eigen::Vector2d Seen(const LensValues& v, const Eigen::Vector3d& q) {
  const Eigen::Vector3d A(v.at("A").data()), H(v.at("H").data()), V(v.at("V").data());
  return Eigen::Vector2d(q.dot(H), q.dot(V)) / q.dot(A);
}

// The pixel of a point by the published formula of its lens. Its direction is also given by the
// angle from the axis and the azimuth [rad].
Eigen::Vector2d PublishedPixel(const Case& lens, const Eigen::Vector3d& p, double angle,
                               double azimuth) {
  const LensValues& v = lens.values;
  const auto two = [&v](const char* name) { return Eigen::Vector2d(v.at(name).data()); };
  const double x = p.x() / p.z(), y = p.y() / p.z();
  if (lens.type == "cahv") {
    return Seen(v, p);
  }
  if (lens.type == "cahvor") {
    const Eigen::Vector3d O(v.at("O").data());
    const std::vector<double>& R = v.at("R");
    const Eigen::Vector3d across = p - p.dot(O) * O;
    const double tau = across.squaredNorm() / (p.dot(O) * p.dot(O));
    return Seen(v, p + (R[0] + R[1] * tau + R[2] * tau * tau) * across);
  }
  if (lens.type == "orthographic") {
    return two("scale").cwiseProduct(p.head<2>()) + two("center");
  }
  if (lens.type == "owen") { // AAS 11-215: millimetres, then the matrix
    const double f = v.at("focal_length")[0];
    const std::vector<double>&K = v.at("radial"), &T = v.at("tangential"), &W = v.at("pinwheel"),
          &M = v.at("matrix");
    const double X = f * x, Y = f * y, R = std::hypot(X, Y);
    const double along = K[0] * R * R + K[1] * std::pow(R, 4) + T[0] * Y + T[1] * X;
    const double around = W[0] * R + W[1] * std::pow(R, 3);
    const double u = X + along * X - around * Y, w = Y + along * Y + around * X;
    return two("center") + Eigen::Vector2d(M[0] * u + M[1] * w, M[2] * u + M[3] * w);
  }
  Eigen::Vector2d d(x, y);
  if (lens.type == "brown") { // OpenCV's documentation of calib3d
    const std::vector<double>&k = v.at("radial"), &t = v.at("tangential"), &s = v.at("prism"),
          &tilt = v.at("tilt_deg");
    const double r = std::hypot(x, y), r2 = std::pow(r, 2), r4 = std::pow(r, 4),
                 r6 = std::pow(r, 6);
    const double g =
        (1.0 + k[0] * r2 + k[1] * r4 + k[2] * r6) / (1.0 + k[3] * r2 + k[4] * r4 + k[5] * r6);
    const double u = x * g + 2.0 * t[0] * x * y + t[1] * (r2 + 2.0 * x * x) + s[0] * r2 + s[1] * r4;
    const double w = y * g + t[0] * (r2 + 2.0 * y * y) + 2.0 * t[1] * x * y + s[2] * r2 + s[3] * r4;
    const Eigen::Matrix3d R = (Eigen::AngleAxisd(-tilt[1] * Degree, Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(-tilt[0] * Degree, Eigen::Vector3d::UnitX()))
                                  .toRotationMatrix();
    const Eigen::Vector3d q = R * Eigen::Vector3d(u, w, 1.0);
    d << R(2, 2) * q.x() / q.z() - R(0, 2), R(2, 2) * q.y() / q.z() - R(1, 2);
  } else if (lens.type == "equidistant" || lens.type == "kannala_brandt") {
    double radius = angle;
    if (v.count("radial")) {
      for (std::size_t i = 0; i < 4; ++i) {
        radius += v.at("radial")[i] * std::pow(angle, 3.0 + 2.0 * double(i));
      }
    }
    d << radius * std::cos(azimuth), radius * std::sin(azimuth);
  } else if (lens.type == "ucm") { // Mei's mirror
    const double xi = v.at("alpha")[0] / (1.0 - v.at("alpha")[0]);
    const Eigen::Vector3d s = p.normalized();
    d = (1.0 + xi) / (s.z() + xi) * s.head<2>();
  } else if (lens.type == "eucm") {
    const double alpha = v.at("alpha")[0], beta = v.at("beta")[0];
    const double root = std::sqrt(beta * (p.x() * p.x() + p.y() * p.y()) + p.z() * p.z());
    d = p.head<2>() / (alpha * root + (1.0 - alpha) * p.z());
  } else if (lens.type == "double_sphere") { // from one unit sphere to the next, then to the plane
    const double alpha = v.at("alpha")[0];
    Eigen::Vector3d s = p.normalized();
    s.z() += v.at("xi")[0];
    s.normalize();
    d = s.head<2>() / (alpha + (1.0 - alpha) * s.z());
  }
  return two("focal").cwiseProduct(d) + two("center");
}

TEST(LensModels, PixelsAreThoseOfThePublishedFormulas) {
  std::vector<Case> cases = Cases();
  cases.push_back({"orthographic", {{"scale", {50.0, 60.0}}, {"center", {10.0, 20.0}}}, 80});
  int compared = 0;
  for (const Case& each : cases) {
    if (each.type == "cahvore") {
      continue; // CahvoreIsGenneryFromTheRaysSide
    }
    const LensPtr lens = Make(each.type, each.values);
    const LensPtr large = lens->Scaled(2.0, 3.0);
    for (int i = 1; i <= 8; ++i) {
      const double angle = each.widest_deg * i / 8.0;
      for (double azimuth = 10.0; azimuth < 360.0; azimuth += 50.0) {
        const Eigen::Vector3d p = 2.5 * Direction(angle, azimuth);
        const Eigen::Vector2d expected = PublishedPixel(each, p, angle * Degree, azimuth * Degree);
        Eigen::Vector2d pixel, scaled;
        ASSERT_TRUE(lens->Project(p, pixel) && large->Project(p, scaled))
            << each.type << " at " << angle << " deg, " << azimuth;
        EXPECT_LT((pixel - expected).norm(), 1e-9)
            << each.type << " at " << angle << " deg, " << azimuth;
        // Pixel centres are at integers: (e + 0.5) s - 0.5.
        EXPECT_NEAR(scaled.x(), 2.0 * expected.x() + 0.5, 1e-8) << each.type;
        EXPECT_NEAR(scaled.y(), 3.0 * expected.y() + 1.0, 1e-8) << each.type;
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, 11 * 8 * 7);
}

TEST(LensModels, MonotoneRangesAndTheirRootsAreClosedForms) {
  const auto slopeOf = [](double t) { return 1.0 - t * t; }; // of t - t³ / 3
  EXPECT_NEAR(MonotoneRange(3.0, slopeOf), 1.0, 1e-12);
  EXPECT_EQ(MonotoneRange(0.5, slopeOf), 0.5);
  EXPECT_EQ(MonotoneRange(3.0, [](double) { return -1.0; }), 0.0);
  const auto cubic = [](double t, double& slope) {
    slope = 1.0 - t * t;
    return t - t * t * t / 3.0;
  };
  for (const double value : {1e-9, 0.2, 0.5, 0.66}) { // with t = 2 sin a: 2 / 3 sin 3 a
    EXPECT_NEAR(SolveMonotone(value, 1.0, cubic), 2.0 * std::sin(std::asin(1.5 * value) / 3.0),
                1e-13);
  }
  int calls = 0;
  const auto straight = [&calls](double t, double& slope) {
    ++calls;
    slope = 1.0;
    return t;
  };
  EXPECT_EQ(SolveMonotone(0.7, M_PI, straight), 0.7);
  EXPECT_EQ(calls, 1); // every pixel of an equidistant lens is looked up so
}

// A point of the ray that leaves the pupil under an angle from O, and its pixel: Gennery's model
// from the ray's side, which needs no equation to be solved.
void GenneryPair(const LensValues& v, double angle, double azimuth, double distance,
                 Eigen::Vector3d& point, Eigen::Vector3d& pupil, Eigen::Vector2d& pixel) {
  const Eigen::Vector3d C(v.count("C") ? Eigen::Vector3d(v.at("C").data())
                                       : Eigen::Vector3d(0, 0, 0));
  const Eigen::Vector3d O = Eigen::Vector3d(v.at("O").data()).normalized();
  const std::vector<double>&R = v.at("R"), &E = v.at("E");
  const double l = v.at("linearity")[0];
  const Eigen::Vector3d u = O.unitOrthogonal();
  const Eigen::Vector3d n = std::cos(azimuth) * u + std::sin(azimuth) * O.cross(u);
  const double t2 = angle * angle;
  const double shift = (angle / std::sin(angle) - 1.0) * (E[0] + E[1] * t2 + E[2] * t2 * t2);
  pupil = C + shift * O;
  point = pupil + distance * (std::cos(angle) * O + std::sin(angle) * n);
  const double chi = l > 0 ? std::tan(l * angle) / l : l < 0 ? std::sin(l * angle) / l : angle;
  const double c2 = chi * chi;
  pixel = Seen(v, O + chi * (1.0 + R[0] + R[1] * c2 + R[2] * c2 * c2) * n);
}

TEST(LensModels, CahvoreIsGenneryFromTheRaysSide) {
  for (const Case& each : Cases()) {
    if (each.type != "cahvore") {
      continue;
    }
    const LensPtr lens = Make(each.type, each.values);
    for (double angle = 1.0; angle < each.widest_deg - 2.0; angle += 4.0) {
      for (double azimuth = 0.0; azimuth < 6.0; azimuth += 0.7) {
        Eigen::Vector3d point, pupil;
        Eigen::Vector2d expected, pixel;
        GenneryPair(each.values, angle * Degree, azimuth, 0.8, point, pupil, expected);
        ASSERT_TRUE(lens->Project(point, pixel)) << angle;
        EXPECT_LT((pixel - expected).norm(), 1e-8) << angle;
        LensRay ray;
        ASSERT_TRUE(lens->Unproject(expected, ray));
        EXPECT_LT((ray.origin - pupil).norm(), 1e-12);
        EXPECT_LT((ray.direction - (point - pupil).normalized()).norm(), 1e-11);
      }
    }
  }
}

TEST(LensModels, MatchTheValuesOfMrcal) {
  DSPACE_REAL_DATA(path, "cameras/projection_reference.json");
  Json::Value root;
  std::ifstream(path) >> root;
  int compared = 0;
  for (const Json::Value& each : root["cases"]) {
    const Json::Value& model = each["model"];
    const std::string type = model["type"].asString();
    LensPtr lens;
    if (model.isMember("intrinsics")) {
      std::vector<double> i;
      for (const Json::Value& number : model["intrinsics"]) {
        i.push_back(number.asDouble());
      }
      i.resize(12, 0.0);
      const LensValues plain = {{"focal", {i[0], i[1]}}, {"center", {i[2], i[3]}}};
      lens = type == "PINHOLE"
                 ? Make("pinhole", plain)
                 : Make("brown", With(plain, {{"radial", {i[4], i[5], i[8], i[9], i[10], i[11]}},
                                              {"tangential", {i[6], i[7]}}}));
    } else {
      LensValues values;
      for (const char* name : {"A", "H", "V", "O", "R", "E"}) {
        if (model.isMember(name)) {
          for (const Json::Value& number : model[name]) {
            values[name].push_back(number.asDouble());
          }
        }
      }
      if (type == "CAHVORE") {
        values["linearity"] = {model["linearity"].asDouble()};
      }
      lens = Make(type == "CAHVORE" ? "cahvore" : "cahvor", values);
    }
    for (Json::ArrayIndex k = 0; k < each["points"].size(); ++k) {
      const Json::Value &p = each["points"][k], &expected = each["pixels"][k];
      Eigen::Vector2d pixel;
      const Eigen::Vector3d point(p[0].asDouble(), p[1].asDouble(), p[2].asDouble());
      if (!lens->Project(point, pixel)) {
        // mrcal also evaluates its polynomial beyond the fold.
        EXPECT_GT(std::atan2(point.head<2>().norm(), point.z()) / Degree, lens->Field().limit_deg)
            << type << " " << k;
        continue;
      }
      ++compared;
      // The file has five digits behind the point of OPENCV, eight of CAHVOR, thirteen of CAHVORE.
      const double tolerance =
          type == "CAHVORE" || type == "CAHVOR" || type == "PINHOLE" ? 1e-6 : 6e-6;
      EXPECT_NEAR(pixel.x(), expected[0].asDouble(), tolerance) << type << " " << k;
      EXPECT_NEAR(pixel.y(), expected[1].asDouble(), tolerance) << type << " " << k;
    }
  }
  EXPECT_GE(compared, 11);
}

TEST(LensModels, EveryPerseveranceCameraGoesBothWays) {
  DSPACE_REAL_DATA(path, "cameras/m2020_cahvore_cameras.json");
  const std::vector<CameraModel> models = ReadCameraModels(path);
  ASSERT_EQ(models.size(), 27u);
  int pixels = 0;
  for (const CameraModel& model : models) {
    const LensValues vectors = CahvoreOf(model);
    const std::string type = model.lens->Type();
    for (int j = 0; j <= 8; ++j) {
      for (int i = 0; i <= 8; ++i) {
        const Eigen::Vector2d pixel((model.width - 1.0) * i / 8.0, (model.height - 1.0) * j / 8.0);
        LensRay ray;
        ASSERT_TRUE(model.Unproject(pixel, ray)) << model.name << " " << pixel.transpose();
        Eigen::Vector2d back, apart;
        for (const double distance : {0.5, 50.0}) {
          const Eigen::Vector3d point = ray.origin + distance * ray.direction;
          ASSERT_TRUE(model.Project(point, back)) << model.name;
          EXPECT_LT((back - pixel).norm(), 1e-6) << model.name;
          ++pixels;
          if (type == "cahvor" || type == "cahv") { // by the vectors of the file
            const Eigen::Vector3d d = point - Eigen::Vector3d(vectors.at("C").data());
            Eigen::Vector3d q = d;
            if (type == "cahvor") {
              const Eigen::Vector3d O(vectors.at("O").data());
              const std::vector<double>& R = vectors.at("R");
              const Eigen::Vector3d across = d - d.dot(O) * O;
              const double tau = across.squaredNorm() / (d.dot(O) * d.dot(O));
              q += (R[0] + R[1] * tau + R[2] * tau * tau) * across;
            }
            EXPECT_LT((Seen(vectors, q) - pixel).norm(), 1e-6) << model.name;
          }
        }
      }
    }
    if (type == "cahvore") {
      for (double angle = 3.0; angle < 50.0; angle += 6.0) {
        Eigen::Vector3d point, pupil;
        Eigen::Vector2d expected, pixel;
        GenneryPair(vectors, angle * Degree, 0.3 * angle, 1.5, point, pupil, expected);
        ASSERT_TRUE(model.Project(point, pixel)) << model.name << " " << angle;
        EXPECT_LT((pixel - expected).norm(), 1e-6) << model.name << " " << angle;
      }
    }
  }
  EXPECT_EQ(pixels, 27 * 81 * 2);
}

TEST(LensModels, FoldsAreWhereTheSlopeVanishes) {
  // r (1 + k r²) turns at r = 1 / sqrt(-3 k).
  const LensPtr brown = Make("brown", With(Plain, {{"radial", {-0.3}}}));
  const double radius = 1.0 / std::sqrt(0.9);
  EXPECT_NEAR(brown->Field().limit_deg, std::atan(radius) / Degree, 1e-6);
  EXPECT_EQ(brown->Field().end, "a fold");
  Eigen::Vector2d pixel;
  LensRay ray;
  EXPECT_TRUE(brown->Project({0.999 * radius, 0, 1}, pixel));
  EXPECT_FALSE(brown->Project({1.001 * radius, 0, 1}, pixel));
  const double widest = 639.5 + 1000.0 * radius * (1.0 - 0.3 * radius * radius);
  EXPECT_TRUE(brown->Unproject({widest - 0.1, 479.25}, ray));
  EXPECT_LT(ray.direction.x() / ray.direction.z(), radius);
  EXPECT_FALSE(brown->Unproject({widest + 0.1, 479.25}, ray));

  const LensPtr fisheye = Make("kannala_brandt", With(Plain, {{"radial", {-0.2}}}));
  const double angle = 1.0 / std::sqrt(0.6);
  EXPECT_NEAR(fisheye->Field().limit_deg, angle / Degree, 1e-9);
  EXPECT_FALSE(fisheye->Project(Direction(angle / Degree + 0.01, 20), pixel));
  EXPECT_TRUE(fisheye->Project(Direction(angle / Degree - 0.01, 20), pixel));

  const LensValues straight = {{"A", {0, 0, 1}},
                               {"H", {1000, 0, 640}},
                               {"V", {0, 990, 480}},
                               {"O", {0, 0, 1}},
                               {"R", {0, -0.3, 0}}};
  const LensPtr cahvor = Make("cahvor", straight);
  EXPECT_NEAR(cahvor->Field().limit_deg, std::atan(radius) / Degree, 1e-6);
  const LensPtr cahvore = Make("cahvore", With(straight, {{"E", {0, 0, 0}}, {"linearity", {0.0}}}));
  EXPECT_NEAR(cahvore->Field().limit_deg, radius / Degree, 1e-6); // chi is the angle
  EXPECT_EQ(cahvore->Field().end, "a fold");
  // A pole of the rational lens: 1 - 0.5 r² = 0.
  const LensPtr pole = Make("brown", With(Plain, {{"radial", {0, 0, 0, -0.5}}}));
  EXPECT_LE(pole->Field().limit_deg, std::atan(std::sqrt(2.0)) / Degree);
  EXPECT_FALSE(pole->Project({1.5, 0, 1}, pixel));
}

TEST(LensModels, SeeNothingBehind) {
  Eigen::Vector2d pixel;
  EXPECT_FALSE(Make("pinhole", Plain)->Project({0, 0, -1}, pixel));
  EXPECT_FALSE(Make("pinhole", Plain)->Project({0, 0, 0}, pixel));
  EXPECT_TRUE(Make("equidistant", Plain)->Project(Direction(150, 10), pixel));
  EXPECT_NEAR(
      (pixel - Eigen::Vector2d(639.5, 479.25)).cwiseQuotient(Eigen::Vector2d(1000, 990)).norm(),
      150 * Degree, 1e-12);
  EXPECT_FALSE(Make("ucm", With(Plain, {{"alpha", {0.4}}}))->Project({0.1, 0, -1}, pixel));
  for (const Case& each : Cases()) {
    const double nan = std::nan("");
    EXPECT_FALSE(Make(each.type, each.values)->Project({nan, nan, nan}, pixel)) << each.type;
    LensRay ray;
    EXPECT_FALSE(Make(each.type, each.values)->Unproject({nan, nan}, ray)) << each.type;
  }
}

// The message of the error, which must be of the kind.
std::string Rejected(const std::string& type, const LensValues& values,
                     Error::Kind kind = Error::Kind::InvalidArgument) {
  try {
    Make(type, values);
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), kind) << error.what();
    return error.what();
  }
  return "";
}

TEST(LensModels, RejectWhatIsNoLens) {
  const LensValues cahv = {{"A", {0, 0, 1}}, {"H", {1000, 0, 640}}, {"V", {0, 990, 480}}};
  const auto changed = [&](const char* name, std::vector<double> value) {
    LensValues values = cahv;
    values[name] = std::move(value);
    return values;
  };
  const auto has = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << "'" << text << "' lacks " << part;
  };
  has(Rejected("cahv", changed("H", {0, 0, 640})), "H is (0, 0, 640), along A");
  has(Rejected("cahv", changed("V", {0, 0, 480})), "along A");
  has(Rejected("cahv", changed("V", {500, 0, 3})), "one plane");
  has(Rejected("cahv", changed("A", {0, 0, 1.1})), "unit vector");
  has(Rejected("cahv", changed("A", {0, 1})), "2 numbers; accepted: 3");
  has(Rejected("cahv", changed("X", {0, 1})), "'X' is unknown");
  has(Rejected("cahv", changed("H", {1000, std::nan(""), 0})), "finite");
  has(Rejected("pinhole", {{"focal", {0.0, 990.0}}, {"center", {1, 1}}}), "focal length is 0");
  has(Rejected("brown", With(Plain, {{"radial", {1, 2, 3, 4, 5, 6, 7}}})), "1 to 6");
  has(Rejected("brown", With(Plain, {{"tangential", {1}}})), "'tangential' has 1 numbers");
  EXPECT_EQ(Make("brown", With(Plain, {{"radial", {-0.1}}}))->Values().at("radial"),
            (std::vector<double>{-0.1, 0, 0, 0, 0, 0})); // the others are zero
  has(Rejected("ucm", With(Plain, {{"alpha", {1.5}}})), "alpha is 1.5");
  has(Rejected("ucm", Plain), "'alpha' has 0 numbers");
  has(Rejected("lens9", Plain, Error::Kind::Unsupported), "accepted: brown, cahv");
}

TEST(LensModels, ACheckFindsTheImageThatFolds) {
  CameraModel model;
  model.name = "wide";
  model.width = 3000;
  model.height = 2000;
  model.lens =
      Make("brown", {{"focal", {1000, 1000}}, {"center", {1499.5, 999.5}}, {"radial", {-0.3}}});
  const LensCheck check = CheckLens(model);
  // The fold's circle has the radius 1000 · 2/3 / sqrt(0.9) = 702.7 pixels.
  const double circle = M_PI * 702.7 * 702.7 / 6e6;
  EXPECT_NEAR(check.withoutRay, 1.0 - circle, 0.01);
  EXPECT_LT(check.roundTrip, 1e-9);
  model.lens = Make("equidistant", {{"focal", {600, 600}}, {"center", {1499.5, 999.5}}});
  const LensCheck all = CheckLens(model);
  const double widest = std::hypot(1499.5, 999.5) / 600.0; // [rad]
  EXPECT_EQ(all.withoutRay, 0.0);
  EXPECT_NEAR(all.halfAngle_deg, widest / Degree, 1e-6);
  EXPECT_NEAR(all.density[0], 600.0 * Degree, 1e-6);                             // along the radius
  EXPECT_NEAR(all.density[1], 600.0 * Degree * widest / std::sin(widest), 1e-6); // across it
  EXPECT_THROW(model.Scaled(1000, 1000), Error);                                 // another shape
  const CameraModel half = model.Scaled(1500, 1000);
  EXPECT_NEAR(CheckLens(half).halfAngle_deg, all.halfAngle_deg, 0.1);
  model.width = 0;
  EXPECT_THROW(CheckLens(model), Error);
}

} // namespace
} // namespace dspace
