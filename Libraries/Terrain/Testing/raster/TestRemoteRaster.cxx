// Rasters that a server sends, and servers that stall, reject, cut and lie: no read hangs, none
// gives a wrong height, and all recover.
#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/posts/RasterPosts.h>
#include <dspace/pyramid/ElevationPyramid.h>
#include <dspace/raster/ElevationSource.h>

#include "MisbehavingServer.h"
#include "RasterFile.h"

namespace {

using namespace dspace;
using dspace::testing::MisbehavingServer;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;
using Mode = MisbehavingServer::Mode;

constexpr int Size = 1024;

// Hardly compressible, so that a read asks for a range of its own.
double HeightAt(int c, int r) {
  return ((c * 7919 + r * 104729 + c * r % 977) % 100003) / 64.0;
}

// A Cloud-Optimized GeoTIFF by GDAL's own driver.
std::string WriteCog(const std::string& path, const char* compression) {
  RasterFile plain;
  plain.width = Size;
  plain.height = Size;
  plain.type = GDT_Float32;
  plain.geotransform = std::array<double, 6>{0, 1, 0, 0, 0, -1};
  plain.value = [](int c, int r, int) { return HeightAt(c, r); };
  auto* source = GDALDataset::Open(plain.Write(path + ".plain.tif").c_str(), GDAL_OF_RASTER);
  const std::string compress = std::string("COMPRESS=") + compression;
  const char* options[] = {compress.c_str(), "BLOCKSIZE=128", "OVERVIEWS=AUTO",
                           "RESAMPLING=AVERAGE", nullptr};
  auto* driver = GetGDALDriverManager()->GetDriverByName("COG");
  GDALClose(
      driver->CreateCopy(path.c_str(), source, 0, const_cast<char**>(options), nullptr, nullptr));
  GDALClose(source);
  return path;
}

// For one request [s]. Where the server keeps one waiting, Short: then a machine that stands still
// for so long breaks off good answers, too.
constexpr double Short = 0.4;
constexpr double Long = 20.0;

bool KeepsWaiting(Mode mode) {
  return mode == Mode::Silent || mode == Mode::Stall;
}

bool Says(const Error& error, const char* words) {
  return std::string(error.what()).find(words) != std::string::npos;
}

// The result of `call`, which asks a good server within limits that may be short: on a busy machine
// an answer that takes longer than they allow is a failed transfer, and the call is made again, up
// to ten times. All else that it throws is an error: a wrong height, a corrupt block, a wrong kind.
template<class Call> auto Within10Attempts(const Call& call) {
  for (int attempt = 1;; ++attempt) {
    try {
      return call();
    } catch (const Error& error) {
      const bool transfer =
          error.GetKind() == Error::Kind::Io || error.GetKind() == Error::Kind::DeadlineExceeded;
      if (attempt == 10 || !transfer) {
        throw;
      }
    }
  }
}

class Remote : public ::testing::Test {
protected:
  static void SetUpTestSuite() {
    Folder = new TemporaryFolder;
    Deflated = WriteCog(*Folder / "deflated.tif", "DEFLATE");
    Uncompressed = WriteCog(*Folder / "uncompressed.tif", "NONE");
  }
  static void TearDownTestSuite() { delete Folder; }

  static ElevationOptions WithoutRetries(double request) {
    ElevationOptions options;
    options.network.connect = std::max(1.0, request);
    options.network.stall = std::max(1.0, request);
    options.network.request = request;
    options.network.retries = 0;
    options.network.retryDelay = 0.05;
    return options;
  }
  // Of a good server, which is to be in this mode later.
  static std::shared_ptr<ElevationSource> Open(const std::string& url, Mode later) {
    const ElevationOptions options = WithoutRetries(KeepsWaiting(later) ? Short : Long);
    return Within10Attempts([&] { return std::make_shared<ElevationSource>(url, options); });
  }

  static TemporaryFolder* Folder;
  static std::string Deflated;
  static std::string Uncompressed;
};
TemporaryFolder* Remote::Folder = nullptr;
std::string Remote::Deflated;
std::string Remote::Uncompressed;

// Expects `call` to throw, names `url`, and gives the message.
template<class Call> Error Rejection(const Call& call, const std::string& url) {
  ::testing::internal::CaptureStderr();
  Error rejection(Error::Kind::Internal, "", "was accepted");
  try {
    call();
  } catch (const Error& error) {
    rejection = error;
    EXPECT_NE(std::string(error.what()).find(url), std::string::npos) << error.what();
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  return rejection;
}

// Read in parts, whose answers come within Short on a busy machine.
void ExpectHeights(const ElevationSource& source, const RasterWindow& w) {
  constexpr int Part = 256;
  int wrong = 0;
  for (int y = 0; y < w.height; y += Part) {
    for (int x = 0; x < w.width; x += Part) {
      const RasterWindow part{w.column + x, w.row + y, std::min(Part, w.width - x),
                              std::min(Part, w.height - y)};
      const std::vector<double> heights = Within10Attempts([&] { return source.Read(part); });
      for (int j = 0; j < part.height; ++j) {
        for (int i = 0; i < part.width; ++i) {
          wrong += heights[std::size_t(j) * std::size_t(part.width) + std::size_t(i)] !=
                   HeightAt(part.column + i, part.row + j);
        }
      }
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST_F(Remote, HeightsComeOverHttp) {
  MisbehavingServer server(Deflated);
  for (const std::string prefix : {"/vsicurl/", ""}) {
    const ElevationSource source(prefix + server.Url("good.tif"), WithoutRetries(Long));
    EXPECT_EQ(source.Info().driver, "GTiff");
    EXPECT_EQ(source.Info().overviews, 3);
    ExpectHeights(source, {300, 500, 200, 150});
  }
  // Parts of the file, never all of it, and nothing that might stand beside it.
  EXPECT_LT(server.requests, 20);
}

TEST_F(Remote, OpeningSaysWhatTheServerAnswered) {
  MisbehavingServer server(Deflated);
  int n = 0;
  for (const auto& [mode, kind, words] :
       {std::tuple(Mode::NotFound, Error::Kind::NotFound, "404"),
        {Mode::Broken, Error::Kind::Io, "500"},
        {Mode::Busy, Error::Kind::Io, "503"},
        {Mode::Silent, Error::Kind::DeadlineExceeded, "timed out"},
        {Mode::Nonsense, Error::Kind::Io, "CURL error"},
        {Mode::Garbage, Error::Kind::Unsupported, "not recognized"},
        {Mode::Page, Error::Kind::Unsupported, "not recognized"}}) {
    const std::string url = server.Url("opening" + std::to_string(++n) + ".tif");
    server.mode = mode;
    const ElevationOptions options = WithoutRetries(KeepsWaiting(mode) ? Short : Long);
    const Error error = Rejection([&] { ElevationSource(url, options); }, url);
    EXPECT_EQ(int(error.GetKind()), int(kind)) << error.what();
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    server.mode = Mode::Good; // GDAL by itself would go on saying that there is no such file
    ExpectHeights(ElevationSource(url, WithoutRetries(Long)), {0, 0, 200, 30});
  }
}

TEST_F(Remote, NobodyListens) {
  // The port is taken, so that no other process listens there.
  const int taken = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof(address);
  auto* any = reinterpret_cast<sockaddr*>(&address);
  ASSERT_EQ(::bind(taken, any, length), 0);
  ASSERT_EQ(::getsockname(taken, any, &length), 0);
  const std::string url =
      "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/gone.tif";
  const Error error = Rejection([&] { ElevationSource(url, WithoutRetries(Long)); }, url);
  EXPECT_EQ(int(error.GetKind()), int(Error::Kind::Io)) << error.what();
  ::close(taken);
}

TEST_F(Remote, OneRejectionIsRetried) {
  MisbehavingServer server(Deflated);
  ElevationOptions options = WithoutRetries(Long);
  options.network.retries = 2;
  server.until = 2;
  server.mode = Mode::Busy;
  ExpectHeights(ElevationSource(server.Url("retried.tif"), options), {0, 0, 100, 100});
  EXPECT_EQ(server.misbehaviours, 2);
}

TEST_F(Remote, NoReadIsWrongAndAllRecover) {
  for (const std::string& file : {Deflated, Uncompressed}) {
    MisbehavingServer server(file);
    for (const Mode mode :
         {Mode::Silent, Mode::Stall, Mode::NotFound, Mode::Broken, Mode::Busy, Mode::Cut,
          Mode::Truncated, Mode::Short, Mode::Garbage, Mode::Nonsense, Mode::Page}) {
      if (mode == Mode::Garbage && file == Uncompressed) {
        continue; // other heights, properly sent: nobody could tell
      }
      SCOPED_TRACE(int(mode));
      const std::string url = server.Url("read" + std::to_string(int(mode)) + ".tif");
      const auto opened = Open(url, mode);
      const ElevationSource& source = *opened;
      server.mode = mode;
      // Pixels, an overview whose header has not been read yet, pixels again.
      for (const int factor : {1, 4, 1}) {
        const Error error = Rejection(
            [&] {
              source.ReadReduced({400, 300, 300, 400}, factor);
            },
            url);
        const bool decoded = mode == Mode::Garbage || mode == Mode::Page;
        EXPECT_TRUE(decoded || error.GetKind() != Error::Kind::Corrupt) << error.what();
        EXPECT_TRUE(error.GetKind() != Error::Kind::InvalidArgument) << error.what();
      }
      server.mode = Mode::Good;
      EXPECT_EQ(Within10Attempts([&] {
                  return source.ReadReduced({400, 300, 300, 400}, 4);
                }),
                ElevationSource(file).ReadReduced({400, 300, 300, 400}, 4));
      ExpectHeights(source, {400, 300, 300, 400});
      ExpectHeights(source, {0, 0, Size, Size});
    }
  }
}

// Each in words of its own at the first read that meets it.
TEST_F(Remote, AReadSaysWhatTheServerAnswered) {
  MisbehavingServer server(Deflated);
  for (const auto& [mode, words] : {std::pair(Mode::NotFound, "=404"),
                                    {Mode::Broken, "=500"},
                                    {Mode::Busy, "=503"},
                                    {Mode::Silent, "no response: the server stalled"},
                                    {Mode::Stall, "incomplete response: the server stalled"},
                                    {Mode::Cut, "incomplete response"},
                                    {Mode::Garbage, "Decoding error"}}) {
    const std::string url = server.Url("words" + std::to_string(int(mode)) + ".tif");
    server.mode = Mode::Good;
    const auto source = Open(url, mode);
    server.mode = mode;
    const auto read = [&] { return Rejection([&] { source->Read({400, 300, 300, 400}); }, url); };
    Error error = read();
    // Unless no byte of it came in time.
    for (int n = 1; n < 3 && mode == Mode::Stall && Says(error, "no response"); ++n) {
      error = read();
    }
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    EXPECT_EQ(int(error.GetKind()),
              int(mode == Mode::Garbage ? Error::Kind::Corrupt : Error::Kind::Io));
  }
}

TEST_F(Remote, AMosaicOfUrlsRecoversToo) {
  MisbehavingServer server(Deflated);
  const std::string vrt = *Folder / "mosaic.vrt";
  std::ofstream(vrt) << "<VRTDataset rasterXSize=\"1024\" rasterYSize=\"1024\">"
                        "<GeoTransform>0, 1, 0, 0, 0, -1</GeoTransform>"
                        "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource>"
                        "<SourceFilename>/vsicurl/"
                     << server.Url("mosaic.tif")
                     << "</SourceFilename><SourceBand>1</SourceBand>"
                        "<SourceProperties RasterXSize=\"1024\" RasterYSize=\"1024\" "
                        "DataType=\"Float32\" BlockXSize=\"128\" BlockYSize=\"128\"/>"
                        "<SrcRect xOff=\"0\" yOff=\"0\" xSize=\"1024\" ySize=\"1024\"/>"
                        "<DstRect xOff=\"0\" yOff=\"0\" xSize=\"1024\" ySize=\"1024\"/>"
                        "</SimpleSource></VRTRasterBand></VRTDataset>";
  const ElevationSource source(vrt, WithoutRetries(Short)); // asks no server yet
  for (const Mode mode : {Mode::NotFound, Mode::Silent, Mode::Cut}) {
    server.mode = mode; // before the mosaic's file is opened, later in the midst
    Rejection([&] { source.Read({500, 100, 200, 200}); }, vrt);
    EXPECT_GT(server.misbehaviours, 0);
    server.misbehaviours = 0;
    server.mode = Mode::Good;
    ExpectHeights(source, {500, 100, 20, 20});
  }
}

// What a user sees who flies about while the server is out of order.
TEST_F(Remote, TheCoarserLevelStaysAndTheFinerComesLater) {
  for (const Mode mode : {Mode::Stall, Mode::Silent, Mode::Busy, Mode::Cut, Mode::Garbage}) {
    SCOPED_TRACE(int(mode));
    MisbehavingServer server(Deflated);
    const std::string url = server.Url("flight.tif");
    const auto source = Open(url, mode);
    ElevationPyramidOptions options;
    options.retryDelay = 0.05;
    ElevationPyramid pyramid(std::make_shared<RasterPosts>(source), options);
    const PostBlock coarse{4, 0, 0, 64, 64}; // from an overview
    const PostBlock fine{0, 700, 700, 50, 50};
    std::vector<float> far(std::size_t(64) * 64);
    std::vector<float> near(std::size_t(50) * 50, -1.0f);
    pyramid.Read(coarse, far.data());
    const std::vector<float> before = far;
    server.mode = mode;
    do { // until it has tried more than once
      ASSERT_FALSE(pyramid.TryRead(fine, near.data()));
      ASSERT_TRUE(pyramid.TryRead(coarse, far.data()));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    } while (pyramid.Statistics().failures < 2);
    EXPECT_EQ(far, before);
    EXPECT_EQ(near, std::vector<float>(std::size_t(50) * 50, -1.0f));
    const std::string told = pyramid.Statistics().lastFailure;
    EXPECT_NE(told.find(url), std::string::npos) << told;
    EXPECT_TRUE(mode != Mode::Busy || told.find("503") != std::string::npos) << told;
    EXPECT_TRUE(mode != Mode::Stall || told.find("stalled") != std::string::npos) << told;
    EXPECT_THROW(pyramid.Read({0, 300, 300, 20, 20}, near.data()), Error); // gives up
    server.mode = Mode::Good;
    while (!pyramid.TryRead(fine, near.data())) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    for (int i = 0; i < 50 * 50; ++i) {
      ASSERT_EQ(near[i], float(HeightAt(700 + i % 50, 700 + i / 50)));
    }
    if (KeepsWaiting(mode)) { // the pyramid ends with reads under way
      server.mode = Mode::Silent;
      EXPECT_FALSE(pyramid.TryRead({0, 100, 800, 20, 20}, near.data()));
    }
  }
}

TEST_F(Remote, LimitsOutOfRangeAreRejected) {
  const auto rejected = [&](const std::function<void(NetworkLimits&)>& change) {
    ElevationOptions options;
    change(options.network);
    const Error error = Rejection([&] { ElevationSource(Deflated, options); }, Deflated);
    EXPECT_EQ(int(error.GetKind()), int(Error::Kind::InvalidArgument)) << error.what();
  };
  rejected([](NetworkLimits& limits) { limits.connect = 0.0; });
  rejected([](NetworkLimits& limits) { limits.stall = -1.0; });
  rejected([](NetworkLimits& limits) { limits.request = std::nan(""); });
  rejected([](NetworkLimits& limits) { limits.retryDelay = 4000.0; });
  rejected([](NetworkLimits& limits) { limits.retries = 11; });
}

} // namespace
