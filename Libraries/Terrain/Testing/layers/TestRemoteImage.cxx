// Colour layers of images over HTTP and of mosaics, read by several threads.
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/layers/ColorTiles.h>
#include <dspace/layers/raster/ImageLayer.h>

#include "ColorBlocks.h"
#include "MisbehavingServer.h"
#include "RasterFile.h"

namespace {

using namespace dspace;
using dspace::testing::GridAt;
using dspace::testing::MisbehavingServer;
using dspace::testing::RasterFile;
using dspace::testing::ReadTexels;
using dspace::testing::Texels;
using Mode = MisbehavingServer::Mode;

constexpr int Size = 1024;

int Color(int c, int r, int b) {
  return (c * 7919 + r * 104729 + c * r % 977 + b * 31) % 251;
}

class RemoteImage : public ::testing::Test {
protected:
  RemoteImage() : Grid(GridAt(Crs(), {0.0, 0.0}, {4.0, -4.0})) {
    this->Place.name = "terrain 'ground'";
    this->Place.pixelToMap.linear() << 1.0, 0.0, 0.0, -1.0;
    this->Place.columns = this->Place.rows = Size;
    RasterFile file;
    file.width = file.height = Size;
    file.bands = 3;
    file.type = GDT_Byte;
    file.geotransform = {{0.0, 1.0, 0.0, 0.0, 0.0, -1.0}};
    file.value = [](int c, int r, int b) { return Color(c, r, b); };
    this->Plain = file.Write(this->Folder / "plain.tif");
  }
  std::string Cog() {
    auto* source = GDALDataset::Open(this->Plain.c_str(), GDAL_OF_RASTER);
    const char* options[] = {"COMPRESS=DEFLATE", "BLOCKSIZE=128", "OVERVIEWS=AUTO",
                             "RESAMPLING=AVERAGE", nullptr};
    const std::string path = this->Folder / "cog.tif";
    GDALClose(GetGDALDriverManager()->GetDriverByName("COG")->CreateCopy(
        path.c_str(), source, 0, const_cast<char**>(options), nullptr, nullptr));
    GDALClose(source);
    return path;
  }
  // No server here keeps anybody waiting.
  static RasterLayerOptions WithoutRetries() {
    RasterLayerOptions options;
    options.network.retries = 0;
    options.network.retryDelay = 0.05;
    return options;
  }
  // How many texels of zoom 2, which are pixels, differ from them.
  static int Wrong(const Texels& texels) {
    int wrong = 0;
    for (int y = 0; y < texels.block.height; ++y)
      for (int x = 0; x < texels.block.width; ++x)
        for (int b = 0; b < 3; ++b)
          wrong += texels.At(x, y)[b] !=
                   Color(int(texels.block.column) + x, int(texels.block.row) + y, b);
    return wrong;
  }

  dspace::testing::TemporaryFolder Folder;
  RasterPlace Place;
  ColorGrid Grid;
  std::string Plain;
};

} // namespace

TEST_F(RemoteImage, NoTileIsWrongAndAllCome) {
  const std::string cog = this->Cog();
  const auto local = OpenImageLayer(cog, this->Place);
  const Texels coarse = ReadTexels(*local, this->Grid, {0, 0, 0, 256, 256});
  MisbehavingServer server(cog);
  for (const Mode mode : {Mode::Broken, Mode::Cut, Mode::Short, Mode::Garbage}) {
    SCOPED_TRACE(int(mode));
    server.mode = Mode::Good;
    const std::string url = server.Url("image" + std::to_string(int(mode)) + ".tif");
    const auto layer = OpenImageLayer(url, this->Place, WithoutRetries());
    server.mode = mode;
    ::testing::internal::CaptureStderr();
    for (int zoom : {2, 0}) { // pixels, and an overview
      try {
        // What is sent in ever smaller halves may be there in the end.
        const Texels texels = ReadTexels(*layer, this->Grid, {zoom, 100, 50, 100, 100});
        EXPECT_TRUE(mode == Mode::Short && zoom == 0) << zoom;
        for (int y = 0; y < 100; ++y)
          ASSERT_TRUE(std::equal(texels.At(0, y), texels.At(0, y) + 400, coarse.At(100, 50 + y)));
      } catch (const Error& error) {
        EXPECT_TRUE(error.GetKind() == Error::Kind::Io || mode == Mode::Garbage) << error.what();
        EXPECT_NE(std::string(error.what()).find(url), std::string::npos) << error.what();
      }
    }
    auto stack = std::make_shared<LayerStack>("terrain 'ground'");
    stack->Add({"image", layer, 1.0, true});
    ColorTilesOptions options;
    options.retryDelay = 0.01;
    ColorTiles tiles(stack, {this->Grid}, options);
    EXPECT_THROW(tiles.Get({{0, 2, 1, 1}}, 60.0), Error);
    EXPECT_GE(tiles.Statistics().failures, 3u);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    server.mode = Mode::Good;
    EXPECT_FALSE(tiles.Get({{0, 2, 1, 1}}, 60.0)[0]->texels.empty());
    EXPECT_EQ(Wrong(ReadTexels(*layer, this->Grid, {2, 100, 50, 100, 100})), 0);
    EXPECT_EQ(ReadTexels(*layer, this->Grid, {0, 0, 0, 256, 256}).rgba, coarse.rgba);
  }
}

TEST_F(RemoteImage, MosaicsOpenedTogetherAreReadAtOnce) {
  const std::string vrt = this->Folder / "mosaic.vrt";
  auto* source = GDALDataset::Open(this->Plain.c_str(), GDAL_OF_RASTER);
  GDALClose(GetGDALDriverManager()->GetDriverByName("VRT")->CreateCopy(vrt.c_str(), source, 0,
                                                                       nullptr, nullptr, nullptr));
  GDALClose(source);
  // Both of one thread, their sources one file.
  const std::array<std::shared_ptr<const ColorLayer>, 2> layers = {
      OpenImageLayer(vrt, this->Place), OpenImageLayer(vrt, this->Place)};
  for (const auto& layer : layers)
    EXPECT_EQ(Wrong(ReadTexels(*layer, this->Grid, {2, 0, 0, 8, 8})), 0);
  std::array<int, 6> wrong = {};
  std::vector<std::thread> threads;
  for (int k = 0; k < 6; ++k)
    threads.emplace_back([&, k] {
      try {
        for (int i = 0; i < 40; ++i)
          wrong[k] +=
              Wrong(ReadTexels(*layers[k % 2], this->Grid,
                               {2, (i * 37 + k * 91) % 900, (i * 53 + k * 17) % 900, 90, 90}));
      } catch (const std::exception& error) {
        ADD_FAILURE() << error.what();
      }
    });
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(wrong, (std::array<int, 6>{}));
}
