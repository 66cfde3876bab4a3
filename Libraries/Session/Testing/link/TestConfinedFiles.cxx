// Files that allowed files lead to: what lies outside of the roots is not read.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <utility>

#include <unistd.h>

#include <gtest/gtest.h>

#include <dspace/Budgets.h>
#include <dspace/FilesRead.h>
#include <dspace/interpreter/Interpreter.h>
#include <dspace/messages/Confinement.h>

namespace dspace::testing {
namespace {

class ConfinedFiles : public ::testing::Test {
protected:
  void SetUp() override {
    char name[] = "/tmp/dspace-confined-XXXXXX";
    this->Folder = mkdtemp(name);
    std::filesystem::create_directory(this->Folder + "/root");
    for (const char* place : {"/root/inside.asc", "/secret.asc"}) { // an Esri grid of 2 x 2
      this->Write(place, "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n");
    }
    v1::Command scene;
    scene.mutable_create_scene();
    ASSERT_FALSE(this->Interpreter.Execute(scene).has_error());
  }
  void TearDown() override { std::filesystem::remove_all(this->Folder); }

  void Write(const std::string& place, const std::string& text) const {
    std::ofstream(this->Folder + place) << text;
  }
  // A mosaic of 2 x 2 posts with this band, below the allowed root.
  void WriteMosaic(const std::string& band, const std::string& name = "mosaic.vrt") const {
    this->Write("/root/" + name,
                "<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"><SRS>LOCAL_CS[\"grid\"]</SRS>"
                "<GeoTransform>0, 1, 0, 2, 0, -1</GeoTransform>" +
                    band + "</VRTDataset>");
  }
  static std::string Band(const std::string& source, const std::string& attributes = "") {
    return "<VRTRasterBand dataType=\"Float32\" band=\"1\"" + attributes +
           "><SimpleSource><SourceFilename relativeToVRT=\"1\">" + source +
           "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand>";
  }
  // As a server does.
  v1::Reply Execute(v1::Command command) {
    const session::Confinement confinement({this->Folder + "/root"});
    confinement.Apply(command);
    const FilesGuard guard([&](const std::string& path) { confinement.RequireWithin(path); });
    return this->Interpreter.Execute(command);
  }
  v1::Reply OpenTerrain(const std::string& name = "mosaic.vrt") {
    v1::Command command;
    command.mutable_open_terrain()->set_path(this->Folder + "/root/" + name);
    return this->Execute(command);
  }
  v1::Reply Import(const std::string& name) {
    v1::Command command;
    command.mutable_import_object()->add_level()->set_path(this->Folder + "/root/" + name);
    return this->Execute(command);
  }
  v1::Reply AddShapes(const std::string& name) {
    v1::Command command;
    command.mutable_open_terrain()->set_path(this->Folder + "/root/inside.asc");
    command.mutable_open_terrain()->set_name("ground");
    command.mutable_open_terrain()->set_mode(v1::OpenTerrain::CLIPMAP);
    command.mutable_open_terrain()->set_crs("LOCAL_CS[\"grid\",UNIT[\"metre\",1]]");
    const v1::Reply ground = this->Execute(command);
    EXPECT_FALSE(ground.has_error()) << ground.error().message();
    command.Clear();
    command.mutable_add_terrain_layer()->set_terrain("ground");
    command.mutable_add_terrain_layer()->mutable_shapes()->set_path(this->Folder + "/root/" + name);
    const v1::Reply reply = this->Execute(command);
    v1::Command remove;
    remove.mutable_remove_terrain()->set_terrain("ground");
    EXPECT_FALSE(this->Execute(remove).has_error());
    return reply;
  }
  // Of a file in a format that refers to others: named, with the formats that are accepted.
  void ExpectUnsupported(const v1::Reply& reply, const std::string& name) const {
    EXPECT_EQ(reply.error().kind(), v1::Error::UNSUPPORTED) << reply.ShortDebugString();
    EXPECT_NE(reply.error().message().find(this->Folder + "/root/" + name), std::string::npos)
        << reply.error().message();
    EXPECT_NE(reply.error().message().find("; accepted here: "), std::string::npos)
        << reply.error().message();
  }
  static void ExpectRejected(const v1::Reply& reply) {
    EXPECT_EQ(reply.error().kind(), v1::Error::INVALID_ARGUMENT) << reply.ShortDebugString();
    EXPECT_TRUE(reply.error().message().find("outside of the folders that the server allows") !=
                    std::string::npos ||
                reply.error().message().find("mosaic (VRT) of plain files") != std::string::npos)
        << reply.error().message();
  }

  std::string Folder;
  session::Interpreter Interpreter;
};

TEST_F(ConfinedFiles, AMosaicOfAllowedFilesIsOpened) {
  this->WriteMosaic(Band("inside.asc"));
  const v1::Reply reply = this->OpenTerrain();
  EXPECT_FALSE(reply.has_error()) << reply.error().message();
}

TEST_F(ConfinedFiles, AMosaicOfOtherFilesIsNot) {
  std::filesystem::create_symlink(this->Folder + "/secret.asc", this->Folder + "/root/link.asc");
  for (const std::string& band : std::initializer_list<std::string>{
           Band("../secret.asc"), Band("link.asc"), Band("../nowhere.asc"),
           Band("GTIFF_DIR:1:../secret.asc"), Band("/vsizip/../secret.zip/x"),
           Band("/vsicurl/http://127.0.0.1:9/x.tif"), Band("&lt;VRTDataset/&gt;"),
           "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource><sourceFILENAME>" +
               this->Folder + "/secret.asc</sourceFILENAME></SimpleSource></VRTRasterBand>",
           "<VRTRasterBand dataType=\"Float32\" band=\"1\" subClass=\"VRTRawRasterBand\">"
           "<SourceFilename relativetoVRT=\"1\">inside.asc</SourceFilename></VRTRasterBand>",
           Band("inside.asc", " SUBCLASS=\"VRTDerivedRasterBand\"")}) {
    this->WriteMosaic(band);
    ExpectRejected(this->OpenTerrain());
  }
  // Nor one of mosaics, however deep.
  this->WriteMosaic(Band("../secret.asc"), "inner.vrt");
  this->WriteMosaic(Band("inner.vrt"));
  ExpectRejected(this->OpenTerrain());
  this->WriteMosaic(Band("mosaic.vrt")); // of itself
  ExpectRejected(this->OpenTerrain());
}

// Each names the same `count` times the one before, the first one a plain file: count + count^2 +
// ... files in all.
TEST_F(ConfinedFiles, MosaicsOfMosaicsAreCountedBeforeOneIsOpened) {
  const auto write = [&](int depth, int count) {
    for (int level = 1; level <= depth; ++level) {
      const std::string source =
          level == 1 ? "inside.asc" : "m" + std::to_string(level - 1) + ".vrt";
      std::string sources;
      for (int i = 0; i < count; ++i) {
        sources += "<SimpleSource><SourceFilename relativeToVRT=\"1\">" + source +
                   "</SourceFilename><SourceBand>1</SourceBand></SimpleSource>";
      }
      this->WriteMosaic("<VRTRasterBand dataType=\"Float32\" band=\"1\">" + sources +
                            "</VRTRasterBand>",
                        "m" + std::to_string(level) + ".vrt");
    }
  };
  write(5, 10); // 111,110
  const v1::Reply deep = this->OpenTerrain("m5.vrt");
  EXPECT_EQ(deep.error().kind(), v1::Error::RESOURCE) << deep.ShortDebugString();
  EXPECT_NE(deep.error().message().find("makes more files be opened, counting the sources of its "
                                        "sources; the limit mosaic_files is 20000"),
            std::string::npos)
      << deep.error().message();
  write(12, 10);
  EXPECT_EQ(this->OpenTerrain("m12.vrt").error().kind(), v1::Error::RESOURCE);
  write(20, 1); // longer than a chain may be
  EXPECT_EQ(this->OpenTerrain("m20.vrt").error().kind(), v1::Error::INVALID_ARGUMENT);
  write(3, 3); // 3 + 9 + 27
  SetBudget("mosaic_files", 39);
  EXPECT_FALSE(this->OpenTerrain("m3.vrt").has_error());
  SetBudget("mosaic_files", 38);
  EXPECT_EQ(this->OpenTerrain("m3.vrt").error().kind(), v1::Error::RESOURCE);
  SetBudget("mosaic_files", 20000);
  SetBudget("mosaic_bytes", 100);
  EXPECT_EQ(this->OpenTerrain("m3.vrt").error().kind(), v1::Error::RESOURCE);
  SetBudget("mosaic_bytes", 64 << 20);
}

TEST_F(ConfinedFiles, ARasterOfTooManyPixelsIsRejected) {
  const auto write = [&](const std::string& columns, const std::string& rows) {
    this->Write(
        "/root/large.vrt",
        "<VRTDataset rasterXSize=\"" + columns + "\" rasterYSize=\"" + rows +
            "\"><SRS>LOCAL_CS[\"grid\"]</SRS><GeoTransform>0, 1, 0, 2, 0, -1</GeoTransform>" +
            Band("inside.asc") + "</VRTDataset>");
  };
  write("2147483647", "2147483647");
  const v1::Reply large = this->OpenTerrain("large.vrt");
  EXPECT_EQ(large.error().kind(), v1::Error::RESOURCE) << large.ShortDebugString();
  EXPECT_NE(large.error().message().find("2147483647 x 2147483647 pixels; the limit "
                                         "raster_pixels is 1125899906842624"),
            std::string::npos)
      << large.error().message();
  write("2", "2");
  SetBudget("raster_pixels", 4);
  EXPECT_FALSE(this->OpenTerrain("large.vrt").has_error());
  SetBudget("raster_pixels", 3);
  EXPECT_EQ(this->OpenTerrain("large.vrt").error().kind(), v1::Error::RESOURCE);
  SetBudget("raster_pixels", std::uint64_t(1) << 50);
}

TEST_F(ConfinedFiles, AMosaicHasKnownElementsOnly) {
  const std::string band = Band("inside.asc");
  this->WriteMosaic(
      "<Metadata domain=\"xml:XMP\" format=\"xml\"><x:any xmlns:x=\"x\"/></Metadata>" + band);
  EXPECT_FALSE(this->OpenTerrain().has_error());
  for (const char* element : {"ProcessingSteps", "Input", "Argument", "SourceDataset", "Group"}) {
    this->WriteMosaic("<" + std::string(element) + "/>" + band);
    const v1::Reply reply = this->OpenTerrain();
    ExpectRejected(reply);
    EXPECT_NE(reply.error().message().find("has the element '" + std::string(element) + "'"),
              std::string::npos);
  }
}

TEST_F(ConfinedFiles, FormatsThatReferToOtherFilesAreRejected) {
  const std::string size = "<Size x=\"2\" y=\"2\" c=\"1\"/><PageSize x=\"2\" y=\"2\" c=\"1\"/>";
  this->Write("/victim", "untouched");
  const std::string cache = "<MRF_META><CachedSource><Source>" + this->Folder +
                            "/secret.asc</Source></CachedSource><Raster>" + size + "<DataFile>" +
                            this->Folder + "/victim</DataFile></Raster></MRF_META>";
  for (const std::string& document :
       {cache, std::string("<GDAL_WMS><Service name=\"TMS\"/></GDAL_WMS>"),
        std::string(" \n<gdal_wms><service name=\"TMS\"/></gdal_wms>"),
        std::string("<OGRVRTDataSource></OGRVRTDataSource>"),
        std::string("<GDAL_WMTS></GDAL_WMTS>"),
        std::string("\x89HDF\r\n\x1a\n") + std::string(64, 'x')}) {
    this->Write("/root/other", document);
    ExpectUnsupported(this->OpenTerrain("other"), "other");
    // Nor as a source of a mosaic, nor as overviews.
    this->WriteMosaic(Band("other"));
    ExpectUnsupported(this->OpenTerrain(), "other");
    this->Write("/root/inside.asc.ovr", document);
    ExpectUnsupported(this->OpenTerrain("inside.asc"), "inside.asc.ovr");
    std::filesystem::remove(this->Folder + "/root/inside.asc.ovr");
  }
  std::ifstream victim(this->Folder + "/victim");
  std::string left;
  EXPECT_TRUE(std::getline(victim, left) && left == "untouched");
  EXPECT_FALSE(this->OpenTerrain("inside.asc").has_error());
}

TEST_F(ConfinedFiles, ShapesReferToNoOtherFiles) {
  const std::string line =
      R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":)"
      R"({},"geometry":{"type":"LineString","coordinates":[[0,0],[1,1]]}}]})";
  this->Write("/secret.json", line);
  this->Write("/root/line.json", line);
  const v1::Reply good = this->AddShapes("line.json");
  EXPECT_FALSE(good.has_error()) << good.error().message();
  const std::string layer = "<OGRVRTDataSource><OGRVRTLayer name=\"secret\"><SrcDataSource>" +
                            this->Folder +
                            "/secret.json</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>";
  this->Write("/root/a.vrt", layer);
  ExpectUnsupported(this->AddShapes("a.vrt"), "a.vrt");
  this->Write("/root/a.vrt",
              "<!-- Product_Observational " + std::string(1200, ' ') + "-->" + layer);
  ExpectUnsupported(this->AddShapes("a.vrt"), "a.vrt");
}

TEST_F(ConfinedFiles, SideFilesDoNotLeadOut) {
  const std::string open = "<PAMDataset><Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">";
  for (const std::string& place :
       {this->Folder + "/secret.asc", this->Folder + "/root/inside.asc"}) {
    this->Write("/root/other.asc",
                "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n");
    this->Write("/root/other.asc.aux.xml", open + place + "</MDI></Metadata></PAMDataset>");
    const v1::Reply reply = this->OpenTerrain("other.asc");
    EXPECT_EQ(reply.error().kind(), v1::Error::INVALID_ARGUMENT) << reply.ShortDebugString();
    EXPECT_NE(reply.error().message().find(this->Folder + "/root/other.asc'"), std::string::npos);
    EXPECT_NE(reply.error().message().find("OVERVIEW_FILE"), std::string::npos);
    // Nor those of a mosaic's sources.
    this->WriteMosaic(Band("other.asc"));
    EXPECT_NE(this->OpenTerrain().error().message().find("OVERVIEW_FILE"), std::string::npos);
    std::filesystem::remove(this->Folder + "/root/other.asc.aux.xml");
    EXPECT_FALSE(this->OpenTerrain("other.asc").has_error());
  }
  for (const char* side : {".ovr", ".msk", ".aux.xml"}) {
    const std::string link = this->Folder + "/root/other.asc" + side;
    std::filesystem::create_symlink(this->Folder + "/secret.asc", link);
    ExpectRejected(this->OpenTerrain("other.asc"));
    std::filesystem::remove(link);
  }
  // Files that a driver looks for by their ending; also another one's, whose name goes on.
  for (const auto& [side, accepted] :
       {std::pair("other.prj", false), std::pair("OTHER_rpc.txt", false),
        std::pair("others.asc", true)}) {
    const std::string link = this->Folder + "/root/" + side;
    std::filesystem::create_symlink(this->Folder + "/secret.asc", link);
    EXPECT_EQ(!this->OpenTerrain("other.asc").has_error(), accepted) << side;
    std::filesystem::remove(link);
  }
  // Overviews that are a mosaic of a file out there.
  this->WriteMosaic(Band("../secret.asc"), "other.asc.ovr");
  ExpectRejected(this->OpenTerrain("other.asc"));
}

// GDAL finds a link's relative sources beside what it points to.
TEST_F(ConfinedFiles, ALinkToAMosaicHasItsSourcesBesideTheMosaic) {
  std::filesystem::create_directories(this->Folder + "/root/deep");
  std::filesystem::rename(this->Folder + "/root/inside.asc",
                          this->Folder + "/root/deep/inside.asc");
  this->WriteMosaic(Band("inside.asc"), "deep/a.vrt");
  std::filesystem::create_symlink("deep/a.vrt", this->Folder + "/root/link.vrt");
  const v1::Reply reply = this->OpenTerrain("link.vrt");
  EXPECT_FALSE(reply.has_error()) << reply.error().message();
  this->WriteMosaic(Band("../secret.asc"), "deep/a.vrt"); // which is not root/../secret.asc
  EXPECT_EQ(this->OpenTerrain("link.vrt").error().kind(), v1::Error::INVALID_ARGUMENT);
}

TEST_F(ConfinedFiles, AModelsOwnFilesAreConfinedToo) {
  const std::string gltf =
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,)"
      R"("componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"NAME"}]})";
  const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  for (const char* place : {"/root/inside.bin", "/secret.bin"}) {
    std::ofstream(this->Folder + place, std::ios::binary)
        .write(reinterpret_cast<const char*>(corners), sizeof(corners));
  }
  std::filesystem::create_symlink(this->Folder + "/secret.bin", this->Folder + "/root/link.bin");
  const auto import = [&](const std::string& name) {
    std::string text = gltf;
    text.replace(text.find("NAME"), 4, name);
    this->Write("/root/" + name + ".gltf", text);
    return this->Import(name + ".gltf");
  };
  const v1::Reply inside = import("inside.bin");
  EXPECT_FALSE(inside.has_error()) << inside.error().message();
  ExpectRejected(import("link.bin"));
  this->Write("/root/urdf.urdf",
              R"(<robot name="r"><link name="a"><visual><geometry><mesh filename=")" +
                  this->Folder + R"(/secret.stl"/></geometry></visual></link></robot>)");
  this->Write("/secret.stl", "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                             "vertex 0 1 0\nendloop\nendfacet\nendsolid s\n");
  v1::Command command;
  command.mutable_load_robot()->set_path(this->Folder + "/root/urdf.urdf");
  const v1::Reply robot = this->Execute(command);
  // A mesh that is not there has a stand-in; of this one nothing is told either.
  EXPECT_TRUE(robot.has_error() || robot.warning_size() > 0) << robot.ShortDebugString();
}

} // namespace
} // namespace dspace::testing
