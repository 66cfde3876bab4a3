// USGS ISD, push-broom cameras and SPICE instrument kernels: values of usgscsm's tests, closed
// forms.
#include <cmath>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <dspace/Error.h>
#include <dspace/camera/files/CameraFiles.h>
#include <dspace/camera/files/CameraJson.h>

#include "TemporaryFolder.h"
#include "TestData.h"

namespace dspace {
namespace {

using testing::TemporaryFolder;
using V = Eigen::Vector3d;

CameraModel Read(const std::string& text) {
  const TemporaryFolder folder;
  const std::string path = folder / "camera.json";
  std::ofstream(path, std::ios::binary) << text;
  return ReadCameraModel(path);
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// Repeats a row of a list.
std::string Times(const std::string& row, int count) {
  std::string all = row;
  for (int i = 1; i < count; ++i) {
    all += ", " + row;
  }
  return all;
}

// usgscsm, tests/data/simpleFramerISD.json; its distortion, which has no effect there, is radial.
const std::string Frame = R"({
  "name_model": "USGS_ASTRO_FRAME_SENSOR_MODEL", "name_sensor": "SENSOR",
  "center_ephemeris_time": 50, "image_lines": 15, "image_samples": 15,
  "focal2pixel_lines": [0.0, 0.0, 10.0], "focal2pixel_samples": [0.0, 10.0, 0.0],
  "focal_length_model": {"focal_length": 50}, "detector_center": {"line": 7.5, "sample": 7.5},
  "optical_distortion": {"radial": {"coefficients": [0.0, 0.0, 0.0]}},
  "instrument_position": {"unit": "km", "positions": [[1.0, 0.0, 0.0]], "ephemeris_times": [50]},
  "instrument_pointing": {"quaternions": [[0.0, -0.707106781186547, 0.0, 0.707106781186547]],
    "ephemeris_times": [50]},
  "body_rotation": {"quaternions": [[1, 0, 0, 0]], "ephemeris_times": [50]},
  "starting_detector_line": 0, "starting_detector_sample": 0,
  "detector_sample_summing": 1.0, "detector_line_summing": 1.0})";

// usgscsm, tests/data/constVelocityLineScan.json.
std::string Scan() {
  std::string times, positions;
  for (int i = 0; i < 9; ++i) {
    const std::string comma = i == 0 ? "" : ", ";
    times += comma + std::to_string(999.2 + 0.2 * i);
    positions += comma + "[" + std::to_string(-0.016 + 0.004 * i) + ", 0.0, -1.0]";
  }
  return R"({"name_model": "USGS_ASTRO_LINE_SCANNER_SENSOR_MODEL", "name_sensor": "TEST_SENSOR",
  "center_ephemeris_time": 1000.0, "line_scan_rate": [[0.5, -0.85, 0.1]],
  "detector_sample_summing": 1, "detector_line_summing": 1, "image_lines": 16, "image_samples": 16,
  "focal2pixel_lines": [0.0, -10.0, 0.0], "focal2pixel_samples": [0.0, 0.0, 10.0],
  "focal_length_model": {"focal_length": 50}, "detector_center": {"line": 0.5, "sample": 8.0},
  "optical_distortion": {"radial": {"coefficients": [0.0, 0.0, 0.0]}},
  "instrument_position": {"unit": "km", "positions": [)" +
         positions + "], \"ephemeris_times\": [" + times +
         "]}, \"instrument_pointing\": {\"quaternions\": [" + Times("[0.0, 0.0, 0.0, 1.0]", 9) +
         "], \"ephemeris_times\": [" + times + "]}, \"body_rotation\": {\"quaternions\": [" +
         Times("[0.0, -0.707106781186547, 0.0, 0.707106781186547]", 9) +
         "], \"ephemeris_times\": [" + times +
         "]}, \"starting_detector_line\": 1, \"starting_detector_sample\": 0})";
}

// Where the ray of an ISD's pixel first meets a sphere about the body's centre; without a crossing
// the place of the ray that is nearest to the centre, as usgscsm has it.
V Ground(const CameraModel& model, double line, double sample, double radius) {
  LensRay ray;
  EXPECT_TRUE(model.Unproject({sample - 0.5, line - 0.5}, ray));
  const double b = ray.origin.dot(ray.direction);
  const double root = b * b - ray.origin.squaredNorm() + radius * radius;
  return ray.origin + (-b - (root > 0.0 ? std::sqrt(root) : 0.0)) * ray.direction;
}

void ExpectNear(const V& found, const V& expected, double tolerance) {
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), tolerance)
      << found.transpose() << " in place of " << expected.transpose();
}

TEST(Isd, FrameCamerasHaveUsgscsmsValues) { // usgscsm, tests/FrameCameraTests.cpp
  const CameraModel model = Read(Frame);
  EXPECT_EQ(std::string(model.lens->Type()), "usgs");
  EXPECT_EQ(model.name, "SENSOR");
  EXPECT_EQ(model.width, 15);
  ExpectNear(Ground(model, 7.5, 7.5, 10.0), {10.0, 0.0, 0.0}, 1e-8);
  ExpectNear(Ground(model, 7.5, 6.5, 10.0), {9.80194018, 0.0, 1.98039612}, 1e-8);
  ExpectNear(Ground(model, 15.0, 0.0, 10.0), {0.44979759, -14.99325304, 14.99325304}, 1e-8);
  ExpectNear(Ground(model, 0.0, 15.0, 10.0), {0.44979759, 14.99325304, -14.99325304}, 1e-8);
  ExpectNear(Ground(model, 0.0, 0.0, 10.0), {0.44979759, 14.99325304, 14.99325304}, 1e-8);
  ExpectNear(Ground(model, 15.0, 15.0, 10.0), {0.44979759, -14.99325304, -14.99325304}, 1e-8);
  Eigen::Vector2d pixel;
  ASSERT_TRUE(model.Project({9.80194018, 0.0, 1.98039612}, pixel));
  EXPECT_LT((pixel - Eigen::Vector2d(6.0, 7.0)).norm(), 1e-6);
}

TEST(Isd, AFrameCameraInOrbitHasUsgscsmsValuesAndPartials) { // tests/data/orbitalFramer.json
  std::string text = Replaced(Frame, "[0.0, 0.0, 10.0], \"focal2pixel_samples\": [0.0, 10.0, 0.0]",
                              "[0.0, 10.0, 0.0], \"focal2pixel_samples\": [0.0, 0.0, 10.0]");
  text = Replaced(text, "[[1.0, 0.0, 0.0]]", "[[1050.0, 0.0, 0.0]]");
  text = Replaced(text, "[[0.0, -0.707106781186547, 0.0, 0.707106781186547]]",
                  "[[-0.707106781186547, 0.0, -0.707106781186547, 0]]");
  text = Replaced(text, "{\"line\": 7.5, \"sample\": 7.5}", "{\"line\": 8.0, \"sample\": 8.0}");
  const CameraModel model = Read(text);
  ExpectNear(Ground(model, 8.0, 8.0, 1e6), {1e6, 0.0, 0.0}, 1e-8);
  // Pixels are 100 m: lines grow with z, samples with y.
  Eigen::Vector2d pixel;
  LensModel::Jacobian slopes;
  ASSERT_TRUE(model.Project({1e6, 0.0, 0.0}, pixel, &slopes));
  LensModel::Jacobian expected;
  expected << 0.0, 0.01, 0.0, 0.0, 0.0, 0.01;
  EXPECT_LT((slopes - expected).norm(), 1e-9) << slopes;
}

TEST(Isd, TheRadialPolynomialRemovesDistortion) {
  // (x, y) (1 - k0 - k1 r^2 - k2 r^4): the place (-0.6, 0.3) mm of the pixel (1, 10).
  const CameraModel model = Read(Replaced(Frame, "[0.0, 0.0, 0.0]}}", "[0.03, -0.02, 0.005]}}"));
  LensRay ray;
  ASSERT_TRUE(model.lens->Unproject({1.0, 10.0}, ray));
  const double r2 = 0.36 + 0.09;
  const double factor = 1.0 - 0.03 + 0.02 * r2 - 0.005 * r2 * r2;
  ExpectNear(ray.direction, V(-0.6 * factor, 0.3 * factor, 50.0).normalized(), 1e-13);
  for (const V& p : {V(0.3, -0.2, 40.0), V(0.0, 0.0, 30.0), V(-0.5, 0.5, 45.0)}) {
    Eigen::Vector2d pixel, other;
    LensModel::Jacobian slopes;
    ASSERT_TRUE(model.lens->Project(p, pixel, &slopes));
    for (int k = 0; k < 3; ++k) {
      const double step = 1e-5;
      Eigen::Vector2d less;
      ASSERT_TRUE(model.lens->Project(p + step * V::Unit(k), other));
      ASSERT_TRUE(model.lens->Project(p - step * V::Unit(k), less));
      EXPECT_LT((slopes.col(k) - (other - less) / (2.0 * step)).norm(), 1e-7);
    }
    ASSERT_TRUE(model.lens->Unproject(pixel, ray));
    ExpectNear(ray.direction, p.normalized(), 1e-12);
  }
}

TEST(Isd, LineScannersHaveUsgscsmsValues) { // tests/LineScanCameraTests.cpp
  const CameraModel model = Read(Scan());
  EXPECT_EQ(std::string(model.lens->Type()), "line_scan");
  EXPECT_TRUE(model.lens->MovesPupil());
  ExpectNear(Ground(model, 8.0, 8.0, 10.0), {9.99999500000, 0.0, 0.00999999500}, 1e-8);
  ExpectNear(Ground(model, 0.0, 4.0, 10.0), {0.04799688020, -7.99961602495, 16.00004799688}, 1e-8);
  // The place of (8.5, 8) is seen there.
  Eigen::Vector2d pixel;
  ASSERT_TRUE(model.Project(Ground(model, 8.5, 8.0, 10.0), pixel));
  EXPECT_LT((pixel - Eigen::Vector2d(7.5, 8.0)).norm(), 1e-9);
  LensRay ray;
  EXPECT_FALSE(model.Unproject({8.0, 16.5}, ray));
  EXPECT_FALSE(model.Project({2000.0, 0.0, 0.0}, pixel)); // behind it
}

TEST(Isd, AModelThatWasReadIsWrittenAndReadAsJson) {
  for (const CameraModel& model : {Read(Frame), Read(Scan())}) {
    const CameraModel again = ParseCameraJson(CameraJsonOf(model), "again").front();
    EXPECT_LT(CameraJsonOf(model).size(), 65536u); // as commands accept
    for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(3.0, 4.0), Eigen::Vector2d(11.5, 9.25)}) {
      LensRay one, two;
      ASSERT_TRUE(model.Unproject(pixel, one) && again.Unproject(pixel, two));
      ExpectNear(one.origin, two.origin, 1e-9);
      ExpectNear(one.direction, two.direction, 1e-12);
    }
  }
}

// A row that flies mostly along Y, at 1 m a line, and turns about Z.
LensPtr Turning(double rate_deg) {
  LensValues values = {
      {"focal_length", {50.0}}, {"matrix", {10, 0, 0, 10}}, {"center", {99.5, 0}}, {"row", {2.0}}};
  for (int i = 0; i <= 20; ++i) {
    const double line = 10.0 * i;
    const double half = 0.5 * rate_deg * M_PI / 180.0 * line;
    values["line"].push_back(line);
    values["positions"].insert(values["positions"].end(), {0.3 * line, line, 0.0});
    values["rotations"].insert(values["rotations"].end(), {std::cos(half), 0, 0, std::sin(half)});
  }
  return MakeLens("line_scan", values, "row");
}

TEST(LineScan, ARowThatTurnsSeesWhatTheFormulaSays) {
  const double rate = 0.05 * M_PI / 180.0;
  const LensPtr lens = Turning(0.05);
  for (const Eigen::Vector2d& pixel :
       {Eigen::Vector2d(20.0, 31.7), Eigen::Vector2d(150.0, 155.25)}) {
    LensRay ray;
    ASSERT_TRUE(lens->Unproject(pixel, ray));
    const double angle = rate * pixel.y();
    const V direction((pixel.x() - 99.5) / 10.0, 2.0 / 10.0, 50.0);
    const V turned(std::cos(angle) * direction.x() - std::sin(angle) * direction.y(),
                   std::sin(angle) * direction.x() + std::cos(angle) * direction.y(), 50.0);
    ExpectNear(ray.origin, {0.3 * pixel.y(), pixel.y(), 0.0}, 1e-9);
    ExpectNear(ray.direction, turned.normalized(), 1e-10);
    const V p = ray.origin + 800.0 * ray.direction;
    Eigen::Vector2d back, more, less;
    LensModel::Jacobian slopes;
    ASSERT_TRUE(lens->Project(p, back, &slopes));
    EXPECT_LT((back - pixel).norm(), 1e-8);
    for (int k = 0; k < 3; ++k) {
      const double step = 1e-3;
      ASSERT_TRUE(lens->Project(p + step * V::Unit(k), more));
      ASSERT_TRUE(lens->Project(p - step * V::Unit(k), less));
      EXPECT_LT((slopes.col(k) - (more - less) / (2.0 * step)).norm(), 1e-6) << k;
    }
  }
}

TEST(LineScan, HalfTheSizeSeesTheSame) {
  const LensPtr lens = Turning(0.05);
  const LensPtr half = lens->Scaled(0.5, 0.5);
  LensRay one, two;
  ASSERT_TRUE(lens->Unproject({60.5, 80.5}, one));
  ASSERT_TRUE(half->Unproject({30.0, 40.0}, two));
  ExpectNear(one.origin, two.origin, 1e-9);
  ExpectNear(one.direction, two.direction, 1e-10);
}

TEST(InstrumentKernel, TheCamerasOfCassini) {
  // INS-82360: 0.35 degrees and 1024 pixels a side; INS-82361: 3.5 degrees (the kernel's text).
  DSPACE_REAL_DATA(path, "ephemeris/spice_test_kernels/cas_iss_v10.ti");
  const CameraModel narrow = ReadCameraModel(path, "INS-82360");
  EXPECT_EQ(narrow.frame, "CASSINI_ISS_NAC");
  EXPECT_EQ(narrow.width, 1024);
  EXPECT_EQ(narrow.height, 1024);
  const double half = 0.175 * M_PI / 180.0;
  const double focal = 512.0 / std::tan(half);
  // The published focal length, 2003.44 mm at 12 micrometres a pixel, agrees within 1 %.
  EXPECT_NEAR(focal, 2003.44 / 0.012, 0.01 * focal);
  Eigen::Vector2d pixel;
  ASSERT_TRUE(narrow.Project(V(0.0, 0.0, 1000.0), pixel));
  EXPECT_LT((pixel - Eigen::Vector2d(511.5, 511.5)).norm(), 1e-6);
  ASSERT_TRUE(narrow.Project(V(std::tan(half), -std::tan(half), 1.0), pixel));
  EXPECT_LT((pixel - Eigen::Vector2d(1023.5, -0.5)).norm(), 1e-6);
}

std::string RejectedIsd(const std::string& text, Error::Kind kind) {
  try {
    Read(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), kind) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "accepted";
  return "";
}

TEST(Isd, WhatIsWrongIsNamed) {
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(RejectedIsd(Frame.substr(0, 700), Error::Kind::Corrupt), "it is no JSON object");
  has(RejectedIsd(Replaced(Frame, "FRAME_SENSOR", "SAR_SENSOR"), Error::Kind::Unsupported),
      "USGS_ASTRO_SAR_SENSOR_MODEL");
  has(RejectedIsd(Replaced(Frame, "\"radial\"", "\"kaguyalism\""), Error::Kind::Unsupported),
      "its distortion is 'kaguyalism'; accepted: radial");
  has(RejectedIsd(Replaced(Frame, "\"detector_center\"", "\"center\""), Error::Kind::Corrupt),
      "it has no 'detector_center'");
  has(RejectedIsd(Replaced(Frame, "[0.0, 0.0, 10.0]", "[0.0, 0.0, 0.0]"),
                  Error::Kind::InvalidArgument),
      "determinant");
  has(RejectedIsd(Replaced(Frame, "[1, 0, 0, 0]", "[2, 0, 0, 0]"), Error::Kind::InvalidArgument),
      "the length of a quaternion is 2");
  has(RejectedIsd(Replaced(Scan(), "[[0.5, -0.85, 0.1]]", "[[0.5, -0.85, 0.1], [8, -0.1, 0.2]]"),
                  Error::Kind::Unsupported),
      "the time of a line changes");
  LensValues values = Turning(0.05)->Values();
  values["line"][3] = values["line"][2];
  EXPECT_THROW(MakeLens("line_scan", values, "row"), Error);
  values = Turning(0.05)->Values();
  values["positions"].pop_back();
  EXPECT_THROW(MakeLens("line_scan", values, "row"), Error);
}

} // namespace
} // namespace dspace
