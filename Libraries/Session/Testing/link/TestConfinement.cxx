// The files that commands may name.
#include <filesystem>
#include <fstream>

#include <sys/stat.h>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/messages/Confinement.h>

namespace dspace::session {
namespace {

namespace fs = std::filesystem;

class ConfinementTest : public ::testing::Test {
protected:
  void SetUp() override {
    char name[] = "/tmp/dspace-confinement-XXXXXX";
    this->Folder = fs::canonical(mkdtemp(name));
    fs::create_directories(this->Folder / "root/inner");
    fs::create_directories(this->Folder / "rooted");
    std::ofstream(this->Folder / "root/model.obj") << "x";
    std::ofstream(this->Folder / "secret") << "x";
    fs::create_symlink(this->Folder / "secret", this->Folder / "root/out");
    fs::create_symlink(this->Folder, this->Folder / "root/up");
    fs::create_symlink(this->Folder / "root/model.obj", this->Folder / "root/in");
  }
  void TearDown() override { fs::remove_all(this->Folder); }
  fs::path Folder;
};

TEST_F(ConfinementTest, OnlyWhatLiesInARootIsAccepted) {
  const std::string root = this->Folder / "root";
  const Confinement confinement({root});
  const auto import = [&](const std::string& path) {
    v1::Command command;
    command.mutable_import_object()->add_level()->set_path(path);
    confinement.Apply(command);
    return command.import_object().level(0).path();
  };
  EXPECT_EQ(import(root + "/model.obj"), root + "/model.obj");
  EXPECT_EQ(import(root + "/inner/../model.obj"), root + "/model.obj");
  EXPECT_EQ(import(root + "/in"), root + "/in");
  EXPECT_EQ(import(""), "");
  for (const std::string& path :
       {root + "/../secret", root + "/inner/../../secret", root + "/out", root + "/up/secret",
        root + "/up/root/../secret", root + "ed/file", std::string("/etc/passwd"),
        std::string("../../etc/passwd"), std::string("/vsicurl/http://host/file"),
        "/vsizip/" + root + "/a.zip", std::string("http://host/file"), root + std::string("\0", 1),
        std::string("NETCDF:/etc/passwd:x"), std::string("<VRTDataset/>")}) {
    EXPECT_THROW(import(path), Error) << path;
  }
}

TEST_F(ConfinementTest, WhatIsReadIsThereAndAFile) {
  const std::string root = this->Folder / "root";
  const Confinement confinement({root});
  const auto open = [&](const std::string& path) -> std::string {
    v1::Command command;
    command.mutable_open_terrain()->set_path(path);
    try {
      confinement.Apply(command);
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind() == Error::Kind::NotFound, path == root + "/absent") << path;
      return error.what();
    }
    return {};
  };
  EXPECT_EQ(open(root + "/model.obj"), "");
  EXPECT_EQ(open(root + "/inner"), ""); // some rasters are folders
  EXPECT_NE(open(root + "/absent").find("names no existing file"), std::string::npos);
  // Whether a file outside is there is nobody's business.
  EXPECT_NE(open("/etc/absent").find("outside of the folders that the server allows"),
            std::string::npos);
  EXPECT_NE(open("/etc/passwd").find("outside of the folders that the server allows"),
            std::string::npos);
  ASSERT_EQ(mkfifo((root + "/fifo").c_str(), 0600), 0);
  EXPECT_NE(open(root + "/fifo").find("neither a file nor a folder"), std::string::npos);
  // What is written need not be there.
  v1::Command save;
  save.mutable_save_image()->set_path(root + "/absent");
  EXPECT_NO_THROW(confinement.Apply(save));
}

TEST_F(ConfinementTest, ADocumentIsNoName) {
  const std::string root = this->Folder / "root";
  const Confinement confinement({root});
  // GDAL takes it for a mosaic wherever it begins, also where a file has that very name.
  const std::string name = root + "/<VRTDataset rasterXSize=\"1\" rasterYSize=\"1\"><VRTRasterBand "
                                  "subClass=\"VRTRawRasterBand\"><SourceFilename>..";
  fs::create_directories(fs::path(name).parent_path());
  std::ofstream(root + "/<VRTDataset>") << "x";
  for (const std::string& path : {name + "/secret", root + "/<VRTDataset>"}) {
    for (const bool save : {false, true}) {
      v1::Command command;
      if (save) {
        command.mutable_save_image()->set_path(path);
      } else {
        command.mutable_open_terrain()->add_patch()->set_path(path);
      }
      try {
        confinement.Apply(command);
        ADD_FAILURE() << path << " was accepted";
      } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("contains '<' or '>'"), std::string::npos);
      }
    }
  }
}

TEST_F(ConfinementTest, WithoutRootsNoPathIsAccepted) {
  v1::Command command;
  command.mutable_save_image()->set_path("/tmp/a.png");
  EXPECT_THROW(Confinement({}).Apply(command), Error);
  EXPECT_THROW(Confinement({this->Folder / "nowhere"}), Error);
  EXPECT_THROW(Confinement({this->Folder / "secret"}), Error);
}

TEST_F(ConfinementTest, NestedAndRepeatedPathsAreFoundAndOtherTextsLeftAlone) {
  const Confinement confinement({this->Folder / "root"});
  v1::Command command;
  command.mutable_create_primitive()->mutable_object()->mutable_material()->set_texture("/etc/x");
  EXPECT_THROW(confinement.Apply(command), Error);
  command.mutable_open_terrain()->set_path(this->Folder / "root/model.obj");
  command.mutable_open_terrain()->add_patch()->set_path("/etc/x");
  EXPECT_THROW(confinement.Apply(command), Error);
  command.mutable_find_frame()->set_path("../../rover");
  EXPECT_NO_THROW(confinement.Apply(command));
  EXPECT_EQ(command.find_frame().path(), "../../rover");
}

TEST_F(ConfinementTest, ACoordinateSystemIsNoFile) {
  const Confinement confinement({this->Folder / "root"});
  const auto open = [&](const std::string& crs) {
    v1::Command command;
    command.mutable_open_terrain()->set_path(this->Folder / "root/model.obj");
    command.mutable_open_terrain()->set_crs(crs);
    confinement.Apply(command);
  };
  for (const char* crs : {"EPSG:32633", "+proj=stere +lat_0=90 +R=1737400", "IAU_2015:30100",
                          "PROJCRS[\"WGS 84 / UTM zone 33N\"]", "+proj=utm +zone=33 +datum=WGS84",
                          "WGS 84 / UTM zone 33N", "urn:ogc:def:crs:EPSG::4326"}) {
    EXPECT_NO_THROW(open(crs)) << crs;
  }
  for (const std::string& crs :
       {(this->Folder / "secret").string(), std::string("http://host/crs"),
        std::string("/vsicurl/http://host/crs"), std::string("../secret"),
        std::string("+proj=longlat +nadgrids=/etc/passwd"),
        std::string("+proj=longlat +nadgrids=passwd"),
        std::string("+proj=longlat +NADGRIDS = passwd"),
        std::string("+proj=longlat +geoidgrids=passwd"),
        std::string(" proj=longlat ellps=/etc/passwd"), std::string("+init=passwd:1"),
        std::string(" init=passwd:1"), " " + (this->Folder / "secret").string(),
        "\n" + (this->Folder / "secret").string(),
        "DICT:" + (this->Folder / "secret").string() + ",1",
        std::string("CONVERSION[METHOD[\"NTv2\"],PARAMETERFILE[\"Latitude "
                    "difference file\",\"/etc/passwd\"]]"),
        std::string("GEOGCS[\"x\",Extension [\"PROJ4\",\"+proj=longlat "
                    "+nadgrids=@x\"]]"),
        std::string("GEOGCS(\"x\",EXTENSION(\"PROJ4\",\"+proj=longlat\"))")}) {
    try {
      open(crs);
      ADD_FAILURE() << crs << " was accepted";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("names a file"), std::string::npos) << crs;
    }
  }
}

} // namespace
} // namespace dspace::session
