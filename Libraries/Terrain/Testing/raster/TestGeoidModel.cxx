// Geoid heights: against published values of EGM96 and made grids.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/crs/GeoidModel.h>

#include "TemporaryFolder.h"

namespace {

using namespace dspace;
using dspace::testing::TemporaryFolder;

std::string MessageOf(const std::string& name, Error::Kind kind) {
  try {
    GeoidModel(name).Height({0.0, 0.0});
  } catch (const Error& error) {
    EXPECT_EQ(int(error.GetKind()), int(kind)) << error.what();
    return error.what();
  }
  return "accepted";
}

// NGA's test values of EGM96 (OUTPUT.DAT of the program F477), by splines in a grid of 15 minutes;
// bilinear values differ by 4 cm on average.
TEST(GeoidModel, HeightsAreThoseThatNgaPublishes) {
  GeoidModel geoid(GeoidModel::Standard);
  constexpr double Published[][3] = {
      {38.6281550, 269.7791550, -31.628}, {-14.6212170, 305.0211140, -2.969},
      {46.8743190, 102.4487290, -43.575}, {-23.6174460, 133.8747120, 15.871},
      {38.6254730, 359.9995000, 50.066},  {-0.4667440, 0.0023000, 17.329}};
  for (const auto& row : Published) {
    EXPECT_NEAR(geoid.Height({row[1], row[0]}), row[2], 0.15) << row[0] << ", " << row[1];
    EXPECT_NEAR(geoid.Height({row[1] - 720.0, row[0]}), geoid.Height({row[1], row[0]}), 1e-9);
  }
  EXPECT_NEAR(geoid.Height({10.0, 90.0}), 13.606, 1e-3); // the north pole of EGM96
  EXPECT_NEAR(geoid.Height({180.0, 0.5}), geoid.Height({-180.0, 0.5}), 1e-9);
  EXPECT_THROW(geoid.Height({0.0, 90.5}), Error);
  EXPECT_THROW(geoid.Height({NAN, 0.0}), Error);
}

// A file of GeographicLib's: 10 degrees a pixel, N = 2 + latitude / 10.
void WriteGeoid(const std::string& path, std::size_t bytes = 36 * 19 * 2) {
  std::string data;
  for (int row = 0; row < 19; ++row) {
    for (int column = 0; column < 36; ++column) {
      const auto value =
          std::uint16_t(std::lround((2.0 + (90.0 - 10.0 * row) / 10.0 + 100.0) / 0.01));
      data += char(value >> 8);
      data += char(value & 255);
    }
  }
  std::ofstream(path, std::ios::binary)
      << "P5\n# Geoid file in PGM format for the GeographicLib::Geoid class\n# Description made\n"
         "# Offset -100\n# Scale 0.01\n# Origin 90N 0E\n36 19\n65535\n"
      << data.substr(0, bytes);
}

TEST(GeoidModel, ReadsGeographicLibsData) {
  const TemporaryFolder folder;
  ASSERT_EQ(setenv("GEOGRAPHICLIB_GEOID_PATH", folder.Path().c_str(), 1), 0);
  WriteGeoid(folder / "made.pgm");
  GeoidModel geoid("made");
  for (const double latitude : {-60.0, -33.0, 0.0, 12.5, 45.0}) {
    EXPECT_NEAR(geoid.Height({77.7, latitude}), 2.0 + latitude / 10.0, 1e-6);
  }
  const std::string absent = MessageOf("egm96-5", Error::Kind::NotFound);
  EXPECT_NE(absent.find((folder / "egm96-5.pgm")), std::string::npos) << absent;
  EXPECT_NE(absent.find("geographiclib-tools"), std::string::npos);
  WriteGeoid(folder / "short.pgm", 100);
  EXPECT_NE(MessageOf("short", Error::Kind::Corrupt).find("short.pgm"), std::string::npos);
  std::ofstream(folder / "text.pgm") << "no grid";
  EXPECT_NE(MessageOf("text", Error::Kind::Corrupt).find("text.pgm"), std::string::npos);
  unsetenv("GEOGRAPHICLIB_GEOID_PATH");
}

TEST(GeoidModel, RejectsPathsAndNamesWhatIsAbsent) {
  const std::string absent = MessageOf("no-such-grid.gtx", Error::Kind::NotFound);
  EXPECT_NE(absent.find("'no-such-grid.gtx' in "), std::string::npos) << absent;
  EXPECT_NE(absent.find("proj"), std::string::npos) << absent;
  EXPECT_NE(MessageOf("no-such-geoid", Error::Kind::NotFound).find("no-such-geoid.pgm"),
            std::string::npos);
  for (const char* name : {"", "../secret", "/etc/passwd", "a b", ".", "a.gtx +proj=x", "@null.gtx",
                           "a,b.gtx", "-a"}) {
    EXPECT_NE(MessageOf(name, Error::Kind::InvalidArgument).find("no name of a geoid"),
              std::string::npos)
        << name;
  }
}

} // namespace
