// Names of files within documents, found before GDAL opens the documents.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/FilesRead.h>
#include <dspace/raster/InnerNames.h>

#include "TemporaryFolder.h"

namespace {

using namespace dspace;
using dspace::testing::TemporaryFolder;

std::string WriteText(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

// The files that a label makes the guard be asked for.
std::vector<std::string> Asked(const std::string& path) {
  std::vector<std::string> names;
  const FilesGuard guard([&](const std::string& name) { names.push_back(name); });
  CheckInnerNames(path);
  return names;
}

std::string InnerRejection(const std::string& path) {
  try {
    CheckInnerNames(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::InvalidArgument) << error.what();
    return error.what();
  }
  return "";
}

TEST(InnerNames, FindsThePixelsThatALabelNames) {
  const TemporaryFolder folder;
  const std::string start = "PDS_VERSION_ID = PDS3\r\n";
  const std::string path = folder / "a.lbl";
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
      {"^IMAGE = \"b.img\"", {folder / "b.img"}},
      {"^IMAGE=(\"b.img\", 3)", {folder / "b.img"}},
      {"^image = ( '../c.img' ,5 <BYTES>)", {folder / "../c.img"}},
      {"^QUBE = /outside/d", {"/outside/d"}},
      {"^IMAGE = 12", {}},
      {"^IMAGE = (12 <BYTES>)", {}},
      {"^DATA_SET_MAP_PROJECTION = \"DSMAP.CAT\"", {}},
      {"^IMAGE = \"b.img\"\n^SPECTRAL_QUBE = \"e.qub\"", {folder / "b.img", folder / "e.qub"}},
      {"OBJECT = COMPRESSED_FILE\nFILE_NAME = \"f.jp2\"\nEND_OBJECT", {folder / "f.jp2"}},
      {"OBJECT = UNCOMPRESSED_FILE\nFILE_NAME = \"f.img\"\nEND_OBJECT", {}},
      {"^IMAGE # a comment\n = (\"../b.img\", 1)", {folder / "../b.img"}},
      {"^IMAGE = /* \"c.img\" */ \"b.img\"", {folder / "b.img"}},
      {"/* " + std::string(5 << 20, 'x') + " */\n^IMAGE = \"b.img\"", {folder / "b.img"}},
      {"^IMAGE", {}},
      {"^IMAGE = \"", {}},
  };
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(Asked(WriteText(path, start + text)), expected) << text;
  }
  EXPECT_EQ(Asked(WriteText(path, "Object = IsisCube\n  ^Core = b.cub\n")),
            std::vector<std::string>{folder / "b.cub"});
  EXPECT_EQ(Asked(WriteText(path, "A = 1\nODL_VERSION_ID = ODL3\n^IMAGE = b.img\n")),
            std::vector<std::string>{folder / "b.img"});
  EXPECT_EQ(Asked(WriteText(path, "no label ^IMAGE = b.img")), std::vector<std::string>());
}

TEST(InnerNames, RejectsDocumentsWhoseCrsNamesAFile) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.json";
  const std::string space(5 << 20, ' '); // the name lies on the border of two parts
  for (
      const std::string& text : {
          std::string(R"({"crs": "+init=/outside:1"})"),
          std::string(R"({"crs": "+proj=longlat +nadgrids=/outside"})"),
          std::string(R"({"crs": "+proj=longlat +geoidgrids=g.gtx"})"),
          std::string(R"({"crs": "\u002binit=/outside:1"})"),
          std::string(R"({"crs": "\u002Bin\u0069t=/outside:1"})"),
          std::string("<SRS>&#43;proj=longlat &#x2B;nadg&#114;ids=/outside</SRS>"),
          std::string(
              "<SRS>GEOGCS[&quot;a&quot;,EXTENSION[&quot;PROJ4_GRIDS&quot;,&quot;/o&quot;]]</SRS>"),
          std::string(R"({"crs": "BOUNDCRS[PARAMETERFILE[\"Difference file\",\"/outside\"]]"})"),
          std::string(R"({"crs": "+proj=longlat +nadgrids=@null,/outside"})"),
          std::string(R"({"crs": "+proj=longlat +nadgrids\n=/outside"})"),
          std::string(R"({"crs": "BOUNDCRS[PARAMETERFILE[\"x,@null\",\"/outside\"]]"})"),
          std::string(R"(<SRS>METHOD["PROJ-based operation method: proj=tinshift file=/o"]</SRS>)"),
          std::string("<SRS>+proj=pipeline +step +proj=tinshift +file=/o</SRS>"),
          std::string(
              "<SRS>GEOGCS[&QUOT;a&QUOT;,EXTENSION[&QUOT;PROJ4_GRIDS&QUOT;,&QUOT;/o&QUOT;]]</SRS>"),
          std::string("<SRS>+pro&#x0000000000000000000006A; +nad&#4294967399;rids=/o</SRS>"),
          std::string("<SRS>+init=/outside:1</SRS>\0\0", 29),
          "{" + space.substr(0, (4 << 20) - 3) + "+init=/outside:1",
          "{" + space + "+init=/outside:1",
      }) {
    EXPECT_NE(InnerRejection(WriteText(path, text)).find("a coordinate system in it names a file"),
              std::string::npos)
        << text.substr(0, 200);
  }
  for (const char* text :
       {R"({"url": "http://a/?grids=3", "name": "initial=5"})", R"({"name": "Arts + Initiatives"})",
        R"({"crs": "+proj=merc +a=6378137 +nadgrids=@null +wktext"})",
        R"({"crs": "BOUNDCRS[PARAMETERFILE[\"Difference file\",\"@null\"]]"})",
        "<SRS>EPSG:4326</SRS>"}) {
    EXPECT_EQ(InnerRejection(WriteText(path, text)), "") << text;
  }
}

TEST(InnerNames, LooksBesideTheFile) {
  const TemporaryFolder folder;
  const std::string path = WriteText(folder / "a.asc", "ncols 1");
  EXPECT_EQ(InnerRejection(path), "");
  for (const char* beside :
       {"a.prj", "a.PRJ", "a.asc.aux.xml", "a.aux.xml", "a.hdr", "a.asc.hdr"}) {
    const std::string other = WriteText(folder / beside, "+init=/outside:1");
    EXPECT_NE(InnerRejection(path).find(other), std::string::npos) << beside;
    std::filesystem::remove(other);
  }
  WriteText(folder / "b.prj", "+init=/outside:1"); // of another file
  EXPECT_EQ(InnerRejection(path), "");
  EXPECT_NE(InnerRejection(folder.Path()), ""); // a folder of shapefiles
}

} // namespace
