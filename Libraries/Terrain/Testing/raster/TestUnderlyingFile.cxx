#include <dspace/raster/UnderlyingFile.h>

#include <gtest/gtest.h>

#include "TemporaryFolder.h"

#include <fstream>
#include <string>

namespace dspace {
namespace {

class UnderlyingFileTest : public ::testing::Test {
protected:
  UnderlyingFileTest() : Archive_(this->Folder_ / "a.zip") {
    std::ofstream(this->Archive_) << "content";
  }
  testing::TemporaryFolder Folder_;
  std::string Archive_;
};

TEST_F(UnderlyingFileTest, AFileIsItself) {
  EXPECT_EQ(UnderlyingFile(this->Archive_), this->Archive_);
}

TEST_F(UnderlyingFileTest, AFileInAnArchiveLiesInTheArchive) {
  EXPECT_EQ(UnderlyingFile("/vsizip/" + this->Archive_ + "/folder/c.tif"), this->Archive_);
  EXPECT_EQ(UnderlyingFile("/vsizip/{" + this->Archive_ + "}/c.tif"), this->Archive_);
  EXPECT_EQ(UnderlyingFile("/vsizip//vsigzip/" + this->Archive_ + "/c.tif"), this->Archive_);
}

TEST_F(UnderlyingFileTest, APartOfAFileLiesInTheFile) {
  EXPECT_EQ(UnderlyingFile("/vsisubfile/0_100," + this->Archive_), this->Archive_);
  EXPECT_EQ(UnderlyingFile("/vsisubfile/0_100"), "/vsisubfile/0_100");
}

TEST_F(UnderlyingFileTest, NamesWithoutAFileOnDiskAreUnchanged) {
  for (const std::string name :
       {"/vsicurl/https://host/a.tif", "https://host/a.tif", "/vsimem/a.tif",
        "/vsizip//nowhere/b.zip/c.tif", "/nowhere/a.tif", ""}) {
    EXPECT_EQ(UnderlyingFile(name), name);
  }
}

} // namespace
} // namespace dspace
