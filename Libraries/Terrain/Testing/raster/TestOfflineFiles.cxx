// Local files of tracks and shapes that name servers and other files for their CRS: nobody is
// asked.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <fstream>
#include <string>
#include <thread>

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/tracks/TrackFile.h>

#include <dspace/layers/vector/VectorShapes.h>

#include "TemporaryFolder.h"

namespace dspace::testing {
namespace {

const char* const Lunar = "+proj=eqc +R=1737400 +units=m +no_defs";

// Gives every caller a CRS, and counts them.
class CrsServer {
public:
  CrsServer() : Socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(bind(this->Socket_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(listen(this->Socket_, 8), 0);
    getsockname(this->Socket_, reinterpret_cast<sockaddr*>(&address), &size);
    this->Url = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/crs";
    this->Thread_ = std::thread([this] {
      for (int caller; (caller = accept(this->Socket_, nullptr, nullptr)) >= 0; close(caller)) {
        ++this->Calls;
        char asked[4096];
        if (read(caller, asked, sizeof asked) > 0) {
          const std::string wkt = "GEOGCS[\"x\",DATUM[\"d\",SPHEROID[\"s\",1737400,0]],"
                                  "PRIMEM[\"g\",0],UNIT[\"degree\",0.0174532925199433]]";
          const std::string answer =
              "HTTP/1.0 200 OK\r\nContent-Length: " + std::to_string(wkt.size()) + "\r\n\r\n" + wkt;
          EXPECT_EQ(write(caller, answer.data(), answer.size()), ssize_t(answer.size()));
        }
      }
    });
  }
  ~CrsServer() {
    shutdown(this->Socket_, SHUT_RDWR);
    this->Thread_.join();
    close(this->Socket_);
  }
  std::string Url;
  std::atomic<int> Calls{0};

private:
  const int Socket_;
  std::thread Thread_;
};

class OfflineFiles : public ::testing::Test {
protected:
  // A file with a line, with this member of the collection and this property of the line.
  void Write(const std::string& member, const std::string& crs) const {
    std::ofstream(this->Path_)
        << "{\"type\":\"FeatureCollection\"," << member << "\"features\":[{\"type\":\"Feature\","
        << "\"properties\":{\"wheel\":\"left\",\"sinkage\":0.1,\"crs\":\"" << crs
        << "\"},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[0,0],[1,1]]}}]}";
  }

  std::string TracksSay() const {
    try {
      const auto strokes = ReadTracks(this->Path_, Crs::FromText(Lunar),
                                      [](const Eigen::Vector2d& map) { return map; });
      return std::to_string(strokes.size());
    } catch (const Error& error) {
      return error.what();
    }
  }

  std::string ShapesSay() const {
    try {
      RasterPlace terrain;
      terrain.crs = Crs::FromText("+proj=longlat +R=1737400 +no_defs");
      return std::to_string(ReadVectorFile(this->Path_, terrain, {}).groups.size());
    } catch (const Error& error) {
      return error.what();
    }
  }

  const TemporaryFolder Folder_;
  const std::string Path_ = this->Folder_ / "offline";
};

TEST_F(OfflineFiles, NoServerIsAskedForACrs) {
  CrsServer server;
  for (const std::string& member :
       {R"("crs":{"type":"link","properties":{"href":")" + server.Url + R"("}},)",
        R"("crs":{"type":"url","properties":{"url":")" + server.Url + R"("}},)"}) {
    this->Write(member, "");
    for (const std::string& said : {this->TracksSay(), this->ShapesSay()}) {
      EXPECT_NE(said.find("'" + server.Url + "' is not fetched"), std::string::npos) << said;
      EXPECT_NE(said.find(this->Path_), std::string::npos) << said;
    }
  }
  EXPECT_EQ(server.Calls, 0);
  // GDAL by itself asks: else this would test nothing.
  GDALAllRegister();
  GDALClose(GDALDataset::Open(this->Path_.c_str(), GDAL_OF_VECTOR));
  EXPECT_EQ(server.Calls, 1);
}

TEST_F(OfflineFiles, ATracksCrsIsNoFileAndNoUrl) {
  CrsServer server;
  std::ofstream(this->Path_ + ".wkt") << Crs::FromText(Lunar).GetWkt();
  this->Write("", this->Path_ + ".wkt");
  EXPECT_NE(this->TracksSay().find("its map coordinates are of"), std::string::npos);
  this->Write("", server.Url);
  EXPECT_NE(this->TracksSay().find("its map coordinates are of"), std::string::npos);
  EXPECT_EQ(server.Calls, 0);
  this->Write("", Lunar);
  EXPECT_EQ(this->TracksSay(), "1");
}

} // namespace
} // namespace dspace::testing
