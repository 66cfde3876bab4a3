// Coordinate systems that name files: as text, as GDAL has read them, and in documents.
#include <string>

#include <cpl_error.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <dspace/crs/CrsFiles.h>

namespace {

using namespace dspace;

TEST(CrsFiles, AreFoundInATextOfACommand) {
  for (const char* text : {"+proj=longlat +nadgrids=@null", "+init=epsg:4326", "/tmp/a.prj",
                           "DICT:a", "", "+proj=longlat +geoidgrids=a.gtx", "http://a/b"}) {
    EXPECT_TRUE(CrsNamesFile(std::string(text))) << text;
  }
  for (const char* text : {"EPSG:4326", "IAU_2015:49900", "+proj=eqc +R=3396190"}) {
    EXPECT_FALSE(CrsNamesFile(std::string(text))) << text;
  }
}

TEST(CrsFiles, AreFoundInADocument) {
  EXPECT_EQ(CrsFileWordIn(R"({"crs": "+init=/a:1"})"), "+init");
  EXPECT_EQ(CrsFileWordIn("<SRS>+proj=longlat +nadgrids=/a</SRS>"), "grids=");
  EXPECT_EQ(CrsFileWordIn("<SRS>+proj=longlat +nadgrids=@null</SRS>"), "");
  EXPECT_EQ(CrsFileWordIn("<SRS>EPSG:4326</SRS>"), "");
}

TEST(CrsFiles, AreFoundInACrsThatWasRead) {
  const auto names = [](const std::string& text) {
    OGRSpatialReference srs;
    CPLPushErrorHandler(CPLQuietErrorHandler);
    EXPECT_EQ(srs.SetFromUserInput(text.c_str()), OGRERR_NONE) << text;
    CPLPopErrorHandler();
    return CrsNamesFile(srs);
  };
  EXPECT_TRUE(names("+proj=longlat +ellps=bessel +nadgrids=/nowhere/a.gsb"));
  EXPECT_TRUE(names("+proj=longlat +datum=WGS84 +geoidgrids=/nowhere/a.gtx +vunits=m"));
  EXPECT_TRUE(names("+proj=longlat +ellps=bessel +nadgrids=@null,/nowhere/a.gsb"));
  EXPECT_FALSE(names("EPSG:3857")); // "+nadgrids=@null" in WKT 1
  EXPECT_FALSE(names("+proj=utm +zone=33 +ellps=GRS80 +nadgrids=@null"));
  EXPECT_FALSE(names("EPSG:32633"));
  EXPECT_FALSE(
      names("+proj=longlat +ellps=bessel +towgs84=598.1,73.7,418.2,0.202,0.045,-2.455,6.7"));
  EXPECT_FALSE(names("+proj=eqc +R=3396190"));
}

} // namespace
