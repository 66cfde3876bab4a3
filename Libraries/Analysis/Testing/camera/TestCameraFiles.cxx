// Files of camera models: what is read, written and rejected.
#include <cmath>
#include <fstream>
#include <sstream>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/camera/ConvertModel.h>
#include <dspace/camera/files/CameraFiles.h>
#include <dspace/camera/files/ModelText.h>

#include "TemporaryFolder.h"
#include "TestData.h"

namespace dspace {
namespace {

using testing::TemporaryFolder;

std::string Write(const TemporaryFolder& folder, const std::string& name, const std::string& text) {
  const std::string path = folder / name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

void ExpectEqual(const CameraModel& a, const CameraModel& b, double tolerance) {
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0.1, 0.2, 5.0), Eigen::Vector3d(-1.0, 0.5, 3.0)}) {
    const Eigen::Vector3d p_M = a.q_MC * p + a.p_MC;
    Eigen::Vector2d one, two;
    ASSERT_TRUE(a.Project(p_M, one) && b.Project(p_M, two));
    EXPECT_LT((one - two).norm(), tolerance);
  }
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
}

// The message of the error that reading gives.
std::string Rejected(const std::string& path, Error::Kind kind) {
  try {
    ReadCameraModels(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), kind) << error.what();
    return error.what();
  }
  return "";
}

const char* Cahvore =
    "Dimensions = 1280 960\nModel = CAHVORE3,0.37 = general\nC = 1 2 3\nA = 1 0 0\n"
    "H = 640 -900 0\nV = 480 0 -890\nO = 0.9998 0.02 0\nR = 0.001 -0.01 0.002\n"
    "E = 0.001 0.002 0.003\n";

TEST(CameraFiles, ReadJplText) {
  const TemporaryFolder folder;
  const CameraModel model = ReadCameraModel(Write(folder, "a.cahvore", Cahvore));
  EXPECT_EQ(std::string(model.lens->Type()), "cahvore");
  EXPECT_EQ(model.width, 1280);
  EXPECT_EQ(model.lens->Values().at("linearity")[0], 0.37);
  EXPECT_LT((model.p_MC - Eigen::Vector3d(1, 2, 3)).norm(), 1e-15);
  // Z along A, X along H across A: to the rover's right.
  EXPECT_LT((model.q_MC * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-15);
  EXPECT_LT((model.q_MC * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LT((model.q_MC * Eigen::Vector3d::UnitY() + Eigen::Vector3d::UnitZ()).norm(), 1e-15);
  Eigen::Vector2d pixel;
  ASSERT_TRUE(model.Project(Eigen::Vector3d(2, 2, 3), pixel)); // along A
  EXPECT_NEAR(pixel.y(), 480.0, 1e-9);
}

TEST(CameraFiles, ReadTheFilesOfOthers) {
  DSPACE_REAL_DATA(cahvor, "cameras/vw_cahvor.txt");
  const CameraModel vision = ReadCameraModel(cahvor);
  EXPECT_EQ(std::string(vision.lens->Type()), "cahvor");
  EXPECT_LT((vision.p_MC - Eigen::Vector3d(76, -34, 20)).norm(), 1e-12);
  EXPECT_EQ(vision.width, 0);

  DSPACE_REAL_DATA(cahv, "cameras/mrcal_overpass0_scale0.6.cahv");
  const CameraModel overpass = ReadCameraModel(cahv);
  Eigen::Vector2d pixel;
  ASSERT_TRUE(overpass.Project({0.3, -0.2, 2.0}, pixel));
  EXPECT_NEAR(pixel.x(), 1211.374926 * 0.15 + 3017.639608, 1e-9);
  EXPECT_NEAR(pixel.y(), 1235.386348 * -0.1 + 1957.291928, 1e-9);
  EXPECT_EQ(overpass.height, 4016);

  DSPACE_REAL_DATA(mrcal, "cameras/mrcal_cam0.opencv8.cameramodel");
  const CameraModel cam0 = ReadCameraModel(mrcal);
  EXPECT_EQ(cam0.width, 4000);
  // p_C = R p_M + t.
  const Eigen::Vector3d r(2e-2, -3e-1, -1e-2), t(1, 2, -3);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(r.norm(), r.normalized()).toRotationMatrix();
  const Eigen::Vector3d p_M = R.transpose() * (Eigen::Vector3d(0.4, 0.1, 4.0) - t);
  Eigen::Vector2d direct;
  ASSERT_TRUE(cam0.Project(p_M, pixel) && cam0.lens->Project({0.4, 0.1, 4.0}, direct));
  EXPECT_LT((pixel - direct).norm(), 1e-9);
  EXPECT_NEAR(cam0.lens->Values().at("focal")[0], 1761.181055, 1e-12);
}

TEST(CameraFiles, ReadCuriositysLabel) {
  DSPACE_REAL_DATA(path, "cameras/msl_navcam_right_NRB_701383954RAS_cahvor.IMG");
  const CameraModel model = ReadCameraModel(path);
  EXPECT_EQ(std::string(model.lens->Type()), "cahvor");
  EXPECT_EQ(model.frame, "ROVER_NAV_FRAME");
  EXPECT_EQ(model.width, 1024);
  EXPECT_EQ(model.height, 1024);
  EXPECT_LT((model.p_MC - Eigen::Vector3d(0.953083, 0.737269, -1.83989)).norm(), 1e-15);
  // The label gives the fields of view and the pointing: 45.5161 x 45.5286 deg, azimuth 345.786,
  // elevation -50.0848 in the rover's frame (X forward, Z down).
  LensRay left, right, middle;
  ASSERT_TRUE(model.Unproject({-0.5, 511.5}, left) && model.Unproject({1023.5, 511.5}, right) &&
              model.Unproject({511.5, 511.5}, middle));
  EXPECT_NEAR(std::acos(left.direction.dot(right.direction)) * 180.0 / M_PI, 45.5161, 0.35);
  EXPECT_NEAR(std::atan2(middle.direction.y(), middle.direction.x()) * 180.0 / M_PI,
              345.786 - 360.0, 1.0);
  EXPECT_NEAR(std::asin(-middle.direction.z()) * 180.0 / M_PI, -50.0848, 0.5);
  // By the label's vectors, written apart.
  const Eigen::Vector3d C(0.953083, 0.737269, -1.83989), A(0.61802, -0.158336, 0.770042),
      H(622.069, 1100.35, 388.444), V(-588.816, 157.005, 1176.66), O(0.615108, -0.158211, 0.772395),
      P(2.4, 0.3, 0.1);
  const Eigen::Vector3d d = P - C, across = d - d.dot(O) * O;
  const double tau = across.squaredNorm() / (d.dot(O) * d.dot(O));
  const Eigen::Vector3d q = d + (1.35787e-05 + 0.00183074 * tau - 0.0057552 * tau * tau) * across;
  Eigen::Vector2d pixel;
  ASSERT_TRUE(model.Project(P, pixel));
  EXPECT_NEAR(pixel.x(), q.dot(H) / q.dot(A), 1e-4); // O has six digits
  EXPECT_NEAR(pixel.y(), q.dot(V) / q.dot(A), 1e-4);
}

TEST(CameraFiles, ReadLabelsThatAreCut) {
  const TemporaryFolder folder;
  const std::string head =
      "PDS_VERSION_ID = PDS3\nOBJECT = IMAGE\n LINES = 480\n LINE_SAMPLES = 640\n"
      "END_OBJECT = IMAGE\nGROUP = GEOMETRIC_CAMERA_MODEL\n";
  const std::string body =
      " MODEL_TYPE = CAHV\n MODEL_COMPONENT_1 = (0,0,0)\n MODEL_COMPONENT_2 = (0,0,1)\n"
      " MODEL_COMPONENT_3 = (500,0,320)\n MODEL_COMPONENT_4 = (0,500,\n 240)\n";
  const CameraModel model = ReadCameraModel(
      Write(folder, "a.lbl", head + body + "END_GROUP = GEOMETRIC_CAMERA_MODEL\nEND\n"));
  EXPECT_EQ(model.width, 640);
  EXPECT_EQ(model.height, 480);
  const std::string cut = Rejected(Write(folder, "b.lbl", head + body), Error::Kind::Corrupt);
  EXPECT_NE(cut.find("ends within GEOMETRIC_CAMERA_MODEL"), std::string::npos) << cut;
  Rejected(Write(folder, "c.lbl", head + body.substr(0, body.size() - 6)), Error::Kind::Corrupt);
  Rejected(Write(folder, "d.lbl", "PDS_VERSION_ID = PDS3\nEND\n"), Error::Kind::Corrupt);
  std::string other = head + body + "END_GROUP = GEOMETRIC_CAMERA_MODEL\nEND\n";
  other.replace(other.find("CAHV\n"), 4, "PSPH");
  Rejected(Write(folder, "e.lbl", other), Error::Kind::Unsupported);
  const std::string vicar = "LBLSIZE=2048 FORMAT='HALF' NL=480 NS=640 NB=1  "
                            "PROPERTY='GEOMETRIC_CAMERA_MODEL'  MODEL_TYPE='CAHV'  "
                            "MODEL_COMPONENT_1=(0.0,0.0,0.0)  MODEL_COMPONENT_2=(0.0,0.0,1.0)  "
                            "MODEL_COMPONENT_3=(500.0,0.0,320.0)  "
                            "MODEL_COMPONENT_4=(0.0,500.0,240.0)  "
                            "REFERENCE_COORD_SYSTEM_NAME='SITE_FRAME'  TASK='TASK'  USER='a'  ";
  const CameraModel from = ReadCameraModel(Write(folder, "f.vic", vicar));
  ExpectEqual(model, from, 1e-12);
  EXPECT_EQ(from.frame, "SITE_FRAME");
}

TEST(CameraFiles, ReadOpencvAndRos) {
  const TemporaryFolder folder;
  const CameraModel opencv =
      ReadCameraModel(Write(folder, "a.yml",
                            "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: "
                            "!!opencv-matrix\n   rows: 3\n"
                            "   cols: 3\n   dt: d\n   data: [ 5.0e+02, 0., 3.2e+02, 0., 510., "
                            "240.5,\n       0., 0., 1. ]\n"
                            "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   "
                            "dt: d\n   data: [ -0.1, 0.02, 1e-3, 2e-3, 0.003 ]\n"));
  EXPECT_EQ(std::string(opencv.lens->Type()), "brown");
  const LensValues v = opencv.lens->Values();
  EXPECT_EQ(v.at("radial"), (std::vector<double>{-0.1, 0.02, 0.003, 0, 0, 0}));
  EXPECT_EQ(v.at("tangential"), (std::vector<double>{1e-3, 2e-3}));
  EXPECT_EQ(v.at("focal"), (std::vector<double>{500, 510}));
  const CameraModel ros = ReadCameraModel(
      Write(folder, "b.yaml",
            "image_width: 640\nimage_height: 480\ncamera_name: left\ncamera_matrix:\n  rows: 3\n  "
            "cols: 3\n"
            "  data: [500, 0, 320, 0, 500, 240, 0, 0, 1]\ndistortion_model: equidistant\n"
            "distortion_coefficients:\n  rows: 1\n  cols: 4\n  data: [0.01, 0.002, 0, 0]\n"));
  EXPECT_EQ(std::string(ros.lens->Type()), "kannala_brandt");
  EXPECT_EQ(ros.name, "left");
  Rejected(Write(folder, "c.yml", "camera_matrix: !!opencv-matrix\n   data: [ 500, 0, 320, 0, 5"),
           Error::Kind::Corrupt);
  Rejected(Write(folder, "d.yml", "camera_matrix: [500, 1, 320, 0, 500, 240, 0, 0, 1]\n"),
           Error::Kind::InvalidArgument);
  Rejected(Write(folder, "e.yml",
                 "camera_matrix: [500, 0, 320, 0, 500, 240, 0, 0, 1]\ndistortion_coefficients: [1, "
                 "2, 3]\n"),
           Error::Kind::Corrupt);
  Rejected(Write(folder, "f.yml",
                 "camera_matrix: [500, 0, 320, 0, 500, 240, 0, 0, 1]\ndistortion_model: odd\n"),
           Error::Kind::Unsupported);
  // Cut before the coefficients: not a pinhole.
  const std::string cut = Rejected(
      Write(folder, "g.yml",
            "camera_matrix: [500, 0, 320, 0, 500, 240, 0, 0, 1]\ndistortion_model: plumb_bob\n"),
      Error::Kind::Corrupt);
  EXPECT_NE(cut.find("it has no 'distortion_coefficients'"), std::string::npos) << cut;
}

TEST(CameraFiles, ReadTheTypeOfACahvoreFromALabel) {
  const TemporaryFolder folder;
  const std::string head =
      "PDS_VERSION_ID = PDS3\nOBJECT = IMAGE\n LINES = 480\n LINE_SAMPLES = 640\n"
      "END_OBJECT = IMAGE\nGROUP = GEOMETRIC_CAMERA_MODEL\n MODEL_TYPE = CAHVORE\n"
      " MODEL_COMPONENT_1 = (0,0,0)\n MODEL_COMPONENT_2 = (0,0,1)\n"
      " MODEL_COMPONENT_3 = (500,0,320)\n MODEL_COMPONENT_4 = (0,500,240)\n"
      " MODEL_COMPONENT_5 = (0,0,1)\n MODEL_COMPONENT_6 = (0,-0.02,0)\n"
      " MODEL_COMPONENT_7 = (0,0,0)\n MODEL_COMPONENT_8 = ";
  const std::string tail = "\n MODEL_COMPONENT_9 = 0.37\nEND_GROUP = GEOMETRIC_CAMERA_MODEL\nEND\n";
  const double t = 0.4; // [rad] from the axis
  for (const auto& [kind, chi] : {std::pair("1.0", std::tan(t)), std::pair("2.0", t),
                                  std::pair("3", std::tan(0.37 * t) / 0.37)}) {
    const CameraModel model = ReadCameraModel(Write(folder, "a.lbl", head + kind + tail));
    Eigen::Vector2d pixel;
    ASSERT_TRUE(model.Project({2.0 * std::sin(t), 0.0, 2.0 * std::cos(t)}, pixel)) << kind;
    EXPECT_NEAR(pixel.x(), 320.0 + 500.0 * chi * (1.0 - 0.02 * chi * chi), 1e-9) << kind;
    EXPECT_NEAR(pixel.y(), 240.0, 1e-9) << kind;
  }
  Rejected(Write(folder, "b.lbl", head + "4.0" + tail), Error::Kind::Unsupported);
}

TEST(CameraFiles, ReadMrcalsCahvorAndCahvore) {
  const TemporaryFolder folder;
  const double a = 0.02, b = -0.01; // the direction of O
  const Eigen::Vector3d O(std::sin(a) * std::cos(b), std::sin(b), std::cos(a) * std::cos(b));
  for (const auto& [name, more] :
       {std::pair("CAHVOR", ""), std::pair("CAHVORE_linearity=0.37", ", 0.001, 0.002, 0.003")}) {
    const CameraModel model = ReadCameraModel(Write(
        folder, "a.cameramodel",
        std::string("{ 'lensmodel': 'LENSMODEL_") + name +
            "', # 'imagersize': [ 1, 1 ]\n 'intrinsics': [ 500, 510, 320, 240, 0.02, -0.01, 0, "
            "-0.05, 0.01" +
            more + " ],\n 'extrinsics': [ 0, 0, 0, 1, 2, 3 ],\n 'imagersize': [ 640, 480 ] }\n"));
    EXPECT_EQ(model.width, 640);
    // A point on O is not distorted: p_C = p_M + (1, 2, 3).
    Eigen::Vector2d pixel;
    ASSERT_TRUE(model.Project(2.0 * O - Eigen::Vector3d(1, 2, 3), pixel)) << name;
    EXPECT_NEAR(pixel.x(), 320.0 + 500.0 * std::tan(a), 1e-9) << name;
    EXPECT_NEAR(pixel.y(), 240.0 + 510.0 * std::tan(b) / std::cos(a), 1e-9) << name;
    const LensValues values = model.lens->Values();
    EXPECT_EQ(values.at("R"), (std::vector<double>{0, -0.05, 0.01}));
    if (values.count("E")) {
      EXPECT_EQ(values.at("E"), (std::vector<double>{0.001, 0.002, 0.003}));
      EXPECT_EQ(values.at("linearity")[0], 0.37);
    }
    WriteCameraModel(folder / "b.cameramodel", model);
    ExpectEqual(model, ReadCameraModel(folder / "b.cameramodel"), 1e-9);
  }
}

TEST(CameraFiles, ReadJson) {
  const TemporaryFolder folder;
  const CameraModel mast = ReadCameraModel(
      Write(folder, "a.json",
            "{\"name\": \"mast\", \"frame\": \"body\", \"model\": {\"type\": \"pinhole\", "
            "\"width\": 640, \"height\": 480, \"focal\": [500, 400], \"center\": [320, 240], "
            "\"position\": [1, 2, 3], \"rotation\": [0.5, -0.5, 0.5, -0.5]}}"));
  EXPECT_EQ(mast.name, "mast");
  EXPECT_EQ(mast.frame, "body");
  EXPECT_EQ(mast.height, 480);
  Eigen::Vector2d pixel; // it looks along X; Y is to its left, Z up
  ASSERT_TRUE(mast.Project({11.0, 1.0, 2.5}, pixel));
  EXPECT_NEAR(pixel.x(), 320.0 + 500.0 * 0.1, 1e-9);
  EXPECT_NEAR(pixel.y(), 240.0 + 400.0 * 0.05, 1e-9);

  const std::string vectors = "{\"model\": {\"type\": \"cahvore\", \"C\": [0, 0, 0], "
                              "\"A\": [0, 0, 1], \"H\": [500, 0, 320], \"V\": [0, 500, 240], "
                              "\"O\": [0, 0, 1], \"R\": [0, 0, 0], \"E\": [0, 0, 0]";
  for (const auto& [kind, linearity] : {std::pair(", \"pupilType\": 1", 1.0),
                                        std::pair(", \"pupilType\": 2, \"linearity\": 0.7", 0.0),
                                        std::pair(", \"pupilType\": 3, \"linearity\": 0.37", 0.37),
                                        std::pair(", \"linearity\": -0.2", -0.2)}) {
    const CameraModel model = ReadCameraModel(Write(folder, "b.json", vectors + kind + "}}"));
    EXPECT_EQ(model.lens->Values().at("linearity")[0], linearity) << kind;
  }
  Rejected(Write(folder, "c.json", vectors + "}}"), Error::Kind::Corrupt);
  Rejected(Write(folder, "d.json", vectors + ", \"pupilType\": 4}}"), Error::Kind::Corrupt);
  // C is its position: another would be lost.
  const std::string twice =
      Rejected(Write(folder, "e.json", vectors + ", \"pupilType\": 1, \"position\": [1, 2, 3]}}"),
               Error::Kind::InvalidArgument);
  EXPECT_NE(twice.find("'position' is unknown"), std::string::npos) << twice;
}

TEST(CameraFiles, NumbersOfTextsAreExact) {
  EXPECT_EQ(ExactText(0.1), "0.1");
  EXPECT_EQ(ExactText(-2.5e-7), "-2.5e-07");
  EXPECT_EQ(ExactTexts({1.0, 0.25}, ", "), "1, 0.25");
  EXPECT_EQ(NumberIn(ExactText(1.0 / 3.0), "text"), 1.0 / 3.0);
  EXPECT_EQ(NumbersIn(" (1, -2.5e1)[+3]\r\n{ 4 }", "text"), (std::vector<double>{1, -25, 3, 4}));
  for (const char* word : {"", "1x", "0x10", "inf", "nan", "1e999", "--1"}) {
    EXPECT_THROW(NumberIn(word, "text"), Error) << word;
  }
  EXPECT_EQ(TrimmedText(" \t a b \r\n"), "a b");
  EXPECT_EQ(TrimmedText(" \n"), "");
  EXPECT_EQ(UpperText("Cahvore3_a"), "CAHVORE3_A");
  EXPECT_EQ(ImageSide(1e6, "the width", "text"), 1000000);
  for (const double side : {0.0, 1.5, 1e6 + 1.0, std::nan("")}) {
    EXPECT_THROW(ImageSide(side, "the width", "text"), Error) << side;
  }
}

TEST(CameraFiles, WriteWhatTheyRead) {
  const TemporaryFolder folder;
  const CameraModel cahvore = ReadCameraModel(Write(folder, "a.cahvore", Cahvore));
  for (const char* name : {"b.cahvore", "b.json"}) {
    WriteCameraModel(folder / name, cahvore);
    ExpectEqual(cahvore, ReadCameraModel(folder / name), 1e-9);
  }
  CameraModel brown;
  brown.name = "left";
  brown.width = 1280;
  brown.height = 960;
  brown.lens = MakeLens("brown",
                        {{"focal", {900, 901}},
                         {"center", {640.25, 480}},
                         {"radial", {-0.1, 0.03, 0.1, 0.01, 0.02, 0.03}},
                         {"tangential", {1e-3, 2e-3}},
                         {"prism", {1e-3, 2e-3, 3e-3, 4e-3}}},
                        "left");
  for (const char* name : {"c.json", "c.yaml", "c.cameramodel"}) {
    WriteCameraModel(folder / name, brown);
    ExpectEqual(brown, ReadCameraModel(folder / name), 1e-9);
  }
  brown.p_MC = {1, 2, 3};
  brown.q_MC = Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()));
  for (const char* name : {"d.json", "d.cameramodel"}) {
    WriteCameraModel(folder / name, brown);
    ExpectEqual(brown, ReadCameraModel(folder / name), 1e-8);
  }
  EXPECT_THROW(WriteCameraModel(folder / "d.yaml", brown), Error); // a pose
  EXPECT_THROW(WriteCameraModel(folder / "d.cahv", brown), Error);
  EXPECT_THROW(WriteCameraModel(folder / "d.txt", brown), Error);
  EXPECT_THROW(WriteCameraModel(folder / "none", brown), Error);
}

TEST(CameraFiles, RejectWhatIsDamaged) {
  const TemporaryFolder folder;
  const std::string text = Cahvore;
  Rejected(folder / "absent.cahv", Error::Kind::NotFound);
  Rejected(Write(folder, "a", ""), Error::Kind::Corrupt);
  Rejected(Write(folder, "b", "hello\n"), Error::Kind::Unsupported);
  Rejected(Write(folder, "c", std::string("\0\1\2\3", 4)), Error::Kind::Unsupported);
  // Cut at every line: less than a model, but never a wrong one.
  for (std::size_t at = text.find("C = "); at + 1 < text.size(); at = text.find('\n', at + 1)) {
    EXPECT_NE(Rejected(Write(folder, "d", text.substr(0, at + 5)), Error::Kind::Corrupt), "") << at;
  }
  std::string untyped = text;
  untyped.replace(untyped.find("Model"), 5, "Shape");
  EXPECT_NE(Rejected(Write(folder, "e", untyped), Error::Kind::Corrupt).find("says its type"),
            std::string::npos);
  std::string other = text;
  other.replace(other.find("CAHVORE3,0.37"), 13, "CAHVORQ");
  Rejected(Write(folder, "f", other), Error::Kind::Unsupported);
  Rejected(Write(folder, "g", text + "A = 1 0 0\n"), Error::Kind::Corrupt); // twice
  Rejected(Write(folder, "h", "{\"model\": {\"type\": \"cahv\", \"C\": [0, 0"),
           Error::Kind::Corrupt);
  Rejected(Write(folder, "i", "[]"), Error::Kind::Corrupt);
  Rejected(Write(folder, "j", "{\"model\": {\"type\": \"spiral\"}}"), Error::Kind::Unsupported);
  Rejected(Write(folder, "k",
                 "{\"model\": {\"type\": \"pinhole\", \"focal\": [1, 1], \"center\": [0, 0], "
                 "\"width\": 3}}"),
           Error::Kind::Corrupt);
  Rejected(Write(folder, "l",
                 "{'lensmodel': 'LENSMODEL_SPLINED', 'intrinsics': [1], 'imagersize': [4, 4]}"),
           Error::Kind::Unsupported);
  Rejected(Write(folder, "m",
                 "{'lensmodel': 'LENSMODEL_PINHOLE', 'imagersize': [4, 4], 'intrinsics': [1, 2"),
           Error::Kind::Corrupt);
}

TEST(ConvertModel, FindsTheModelItself) {
  // A fish-eye of type 2 without pupil is equidistant where R is 0.
  CameraModel from;
  from.width = 1000;
  from.height = 800;
  from.lens = MakeLens("equidistant", {{"focal", {400, 410}}, {"center", {510, 395}}}, "from");
  const ConvertedModel kb = ConvertModel(from, "kannala_brandt");
  EXPECT_LT(kb.greatest, 1e-6);
  EXPECT_EQ(kb.covered, 1.0);
  const ConvertedModel jpl = ConvertModel(from, "cahvore");
  EXPECT_LT(jpl.greatest, 1e-4);
  EXPECT_NEAR(jpl.model.lens->Values().at("H")[0], 400, 0.01);
  // A pinhole is straight: CAHV holds it.
  from.lens = MakeLens("pinhole", {{"focal", {900, 910}}, {"center", {510, 395}}}, "from");
  const ConvertedModel cahv = ConvertModel(from, "cahv");
  EXPECT_LT(cahv.greatest, 1e-8);
  EXPECT_NEAR(cahv.model.lens->Values().at("V")[1], 910, 1e-6);
  EXPECT_LT(ConvertModel(from, "owen").greatest, 1e-6);
  EXPECT_EQ(ConvertModel(from, "pinhole").greatest, 0.0);
  EXPECT_THROW(ConvertModel(from, "orthographic"), Error);
}

TEST(ConvertModel, StatesWhatIsLost) {
  CameraModel from;
  from.width = 1000;
  from.height = 800;
  from.lens = MakeLens(
      "brown", {{"focal", {900, 900}}, {"center", {500, 400}}, {"radial", {-0.15, 0.02}}}, "from");
  const ConvertedModel pinhole = ConvertModel(from, "pinhole");
  EXPECT_GT(pinhole.greatest, 1.0);
  // As the projection of a pixel's ray says.
  LensRay ray;
  Eigen::Vector2d pixel;
  ASSERT_TRUE(from.lens->Unproject({0, 0}, ray) &&
              pinhole.model.lens->Project(ray.direction, pixel));
  EXPECT_LE(pixel.norm(), pinhole.greatest + 1e-9);
  const ConvertedModel cahvor = ConvertModel(from, "cahvor");
  EXPECT_LT(cahvor.greatest, 0.02);
  EXPECT_GT(cahvor.greatest, 0.0);
  from.width = 0;
  EXPECT_THROW(ConvertModel(from, "pinhole"), Error);
}

} // namespace
} // namespace dspace
