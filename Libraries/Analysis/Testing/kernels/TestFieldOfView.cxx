// Fields of view of instrument kernels.
#include <TestData.h>

#include <dspace/Error.h>
#include <dspace/kernels/FieldOfView.h>

namespace {

using namespace dspace;

KernelPool InstrumentOf(const std::string& data) {
  KernelPool pool;
  pool.Add(TextKernel::Parse("\\begindata\n" + data + "\n", "k.ti"));
  return pool;
}

const std::string Start = "INS-1_FOV_FRAME = 'F' INS-1_BORESIGHT = ( 0 0 2 )\n";

TEST(FieldOfView, CassinisCameras) {
  DSPACE_REAL_DATA(path, "ephemeris/spice_test_kernels/cas_iss_v10.ti");
  KernelPool pool;
  pool.Add(TextKernel::Read(path));
  EXPECT_EQ(Instruments(pool), std::vector<int>({-82369, -82368, -82361, -82360}));
  // The kernel's text: squares of 0.35 and 3.48 degrees, circles of 90 degrees half-angle.
  for (const auto& [id, half] : {std::pair(-82360, 0.175), std::pair(-82361, 1.74)}) {
    const FieldOfView field = FieldOfViewOf(pool, id);
    EXPECT_EQ(field.shape, FieldShape::Rectangle);
    EXPECT_EQ(field.frame, id == -82360 ? "CASSINI_ISS_NAC" : "CASSINI_ISS_WAC");
    EXPECT_EQ(field.boresight, Eigen::Vector3d::UnitZ());
    ASSERT_EQ(field.boundary.size(), 4u);
    const double tangent = std::tan(half * M_PI / 180.0);
    for (const Eigen::Vector3d& v : field.boundary) {
      EXPECT_NEAR(v.norm(), 1.0, 1e-15);
      EXPECT_NEAR(std::abs(v.x() / v.z()), tangent, 1e-15);
      EXPECT_NEAR(std::abs(v.y() / v.z()), tangent, 1e-15);
    }
    for (int i = 0; i < 4; ++i) { // around, not across
      EXPECT_GT(field.boundary[i].dot(field.boundary[(i + 1) % 4]),
                field.boundary[i].dot(field.boundary[(i + 2) % 4]));
    }
    EXPECT_NEAR(field.RadiusDeg(), std::atan(std::sqrt(2.0) * tangent) * 180.0 / M_PI, 1e-12);
  }
  const FieldOfView radiator = FieldOfViewOf(pool, -82368);
  EXPECT_EQ(radiator.shape, FieldShape::Circle);
  ASSERT_EQ(radiator.boundary.size(), 1u);
  EXPECT_NEAR(radiator.RadiusDeg(), 90.0, 1e-9);
}

TEST(FieldOfView, CornersAndEllipses) {
  const FieldOfView polygon = FieldOfViewOf(
      InstrumentOf(Start +
                   "INS-1_FOV_SHAPE = 'polygon' INS-1_FOV_BOUNDARY = ( 1 0 1  0 1 1  -1 -1 1 )"),
      -1);
  EXPECT_EQ(polygon.shape, FieldShape::Polygon);
  EXPECT_NEAR(polygon.boundary[0].x(), std::sqrt(0.5), 1e-15);
  const FieldOfView ellipse = FieldOfViewOf(
      InstrumentOf(Start + "INS-1_FOV_SHAPE = 'ELLIPSE' INS-1_FOV_CLASS_SPEC = 'ANGLES' "
                           "INS-1_FOV_REF_VECTOR = ( 1 0 1 ) INS-1_FOV_REF_ANGLE = 0.2 "
                           "INS-1_FOV_CROSS_ANGLE = 0.1 INS-1_FOV_ANGLE_UNITS = 'RADIANS'"),
      -1);
  EXPECT_TRUE(
      ellipse.boundary[0].isApprox(Eigen::Vector3d(std::sin(0.2), 0, std::cos(0.2)), 1e-15));
  EXPECT_TRUE(
      ellipse.boundary[1].isApprox(Eigen::Vector3d(0, std::sin(0.1), std::cos(0.1)), 1e-15));
}

TEST(FieldOfView, RejectsIncompleteOnes) {
  const std::string angles = "INS-1_FOV_SHAPE = 'RECTANGLE' INS-1_FOV_CLASS_SPEC = 'ANGLES' ";
  for (const std::string& bad :
       {std::string("INS-1_FOV_SHAPE = 'HEXAGON'"), std::string("INS-1_FOV_SHAPE = 'CIRCLE'"),
        angles,
        angles +
            "INS-1_FOV_REF_VECTOR = ( 0 0 1 ) INS-1_FOV_REF_ANGLE = 1 INS-1_FOV_CROSS_ANGLE = 1 "
            "INS-1_FOV_ANGLE_UNITS = 'DEGREES'",
        angles +
            "INS-1_FOV_REF_VECTOR = ( 1 0 0 ) INS-1_FOV_REF_ANGLE = 90 INS-1_FOV_CROSS_ANGLE = 1 "
            "INS-1_FOV_ANGLE_UNITS = 'DEGREES'",
        angles +
            "INS-1_FOV_REF_VECTOR = ( 1 0 0 ) INS-1_FOV_REF_ANGLE = 1 INS-1_FOV_CROSS_ANGLE = 1 "
            "INS-1_FOV_ANGLE_UNITS = 'GONS'",
        std::string("INS-1_FOV_SHAPE = 'RECTANGLE' INS-1_FOV_BOUNDARY = ( 1 0 1 0 1 1 )"),
        std::string("INS-1_FOV_SHAPE = 'POLYGON' INS-1_FOV_BOUNDARY = ( 1 0 1 0 1 1 0 1 -1 )"),
        std::string("INS-1_FOV_SHAPE = 'POLYGON' INS-1_FOV_BOUNDARY = ( 1 0 1 0 1 1 0 0 0 )")}) {
    EXPECT_THROW(FieldOfViewOf(InstrumentOf(Start + bad), -1), Error) << bad;
  }
  EXPECT_THROW(FieldOfViewOf(InstrumentOf(Start), -1), Error);
}

} // namespace
