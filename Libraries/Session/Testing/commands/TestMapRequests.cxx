// Maps by commands: work that goes on between requests, and what is rejected.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gdal_priv.h>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

// Hills of 200 x 200 posts, 2 m apart.
std::string Hills(double more) {
  std::ostringstream text;
  text << "ncols 200\nnrows 200\nxllcorner 1000\nyllcorner 2000\ncellsize 2\n";
  for (int r = 0; r < 200; ++r) {
    for (int c = 0; c < 200; ++c) {
      text << 20.0 * std::sin(0.11 * c) * std::cos(0.07 * r) + more * ((c * 7 + r * 13) % 5) << " ";
    }
    text << "\n";
  }
  return text.str();
}

class MapRequests : public CommandTest {
protected:
  MapRequests() {
    this->Open("ground", 0.3);
    this->Open("other", 0.31);
  }
  void Open(const std::string& name, double more) {
    const std::string path = this->Path(name + ".asc");
    std::ofstream(path) << Hills(more);
    v1::Command command;
    command.mutable_open_terrain()->set_path(path);
    command.mutable_open_terrain()->set_name(name);
    this->Accept(command);
  }
  std::string Path(const std::string& name) const { return (this->Folder_.Path() / name).string(); }
  v1::Command Horizons(const std::string& name) const {
    v1::Command command;
    v1::HorizonMap* map = command.mutable_horizon_map();
    map->set_terrain("ground");
    map->set_azimuths(24);
    map->set_height(1.5);
    map->mutable_file()->set_path(this->Path(name));
    return command;
  }
  v1::Command Illumination(const std::string& name) const {
    v1::Command command;
    v1::IlluminationMap* map = command.mutable_illumination_map();
    map->set_horizon_path(this->Path("horizon.tif"));
    map->set_step_s(3600.0);
    for (const double value : {1.4e11, 0.0, 2.5e10}) {
      map->add_sun_position(value);
    }
    map->mutable_file()->set_path(this->Path(name));
    return command;
  }

  TemporaryFolder Folder_;
};

std::vector<float> BandOf(const std::string& path, int band) {
  GDALAllRegister();
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(path.c_str(), GA_ReadOnly));
  std::vector<float> values(200 * 200);
  EXPECT_EQ(dataset->GetRasterBand(band)->RasterIO(GF_Read, 0, 0, 200, 200, values.data(), 200, 200,
                                                   GDT_Float32, 0, 0, nullptr),
            CE_None);
  GDALClose(dataset);
  return values;
}

TEST_F(MapRequests, AHorizonMapAgreesWithHorizons) {
  v1::Command command = this->Horizons("horizon.tif");
  const v1::MapReply reply = this->Accept(command).map();
  EXPECT_TRUE(reply.complete());
  EXPECT_EQ(reply.path(), this->Path("horizon.tif"));
  EXPECT_EQ(reply.columns(), 200u);
  EXPECT_EQ(reply.bands(), 24u);
  EXPECT_EQ(reply.cell_size(), 2.0);
  v1::Command one;
  v1::Horizon* horizon = one.mutable_horizon();
  horizon->set_azimuths(24);
  horizon->mutable_measuring()->set_no_objects(true);
  horizon->mutable_site()->set_terrain("ground");
  horizon->mutable_site()->set_map_x(1000 + 2 * 80 + 1);
  horizon->mutable_site()->set_map_y(2400 - 2 * 60 - 1);
  horizon->mutable_site()->set_height(1.5);
  v1::Command remove; // the other terrain is no obstacle of the map
  remove.mutable_remove_terrain()->set_terrain("other");
  this->Accept(remove);
  const v1::HorizonReply exact = this->Accept(one).horizon();
  for (int k = 0; k < 24; ++k) {
    const double mapped = BandOf(reply.path(), k + 1)[60 * 200 + 80];
    EXPECT_NEAR(mapped, exact.elevation_deg(k), 1e-3) << k;
  }
}

TEST_F(MapRequests, WorkGoesOnBetweenRequests) {
  v1::Command command = this->Horizons("horizon.tif");
  command.mutable_horizon_map()->set_azimuths(120);
  v1::MapFile* file = command.mutable_horizon_map()->mutable_file();
  file->set_wait_s(0.0);
  file->set_threads(1);
  v1::MapReply reply = this->Accept(command).map();
  EXPECT_FALSE(reply.complete());
  v1::Command other = command;
  other.mutable_horizon_map()->set_height(2.0);
  this->Reject(other, Kind::ALREADY_EXISTS, "another map is being written");
  v1::Command stop = command;
  stop.mutable_horizon_map()->mutable_file()->set_cancel(true);
  EXPECT_FALSE(this->Accept(stop).map().complete());
  EXPECT_FALSE(std::filesystem::exists(this->Path("horizon.tif")));
  if (std::filesystem::exists(this->Path("horizon.tif.part.done"))) {
    other.mutable_horizon_map()->mutable_file()->clear_wait_s();
    this->Reject(other, Kind::ALREADY_EXISTS, "other inputs");
  }
  file->set_wait_s(0.5);
  int waits = 0;
  for (; !reply.complete() && waits < 600; ++waits) {
    reply = this->Accept(command).map();
  }
  EXPECT_TRUE(std::filesystem::exists(this->Path("horizon.tif")));
  EXPECT_EQ(reply.fraction(), 1.0);
}

TEST_F(MapRequests, ViewshedsAgreeWithLines) {
  v1::Command command;
  v1::Viewshed* view = command.mutable_viewshed();
  v1::Site* site = view->add_site();
  site->set_terrain("ground");
  site->set_map_x(1203.4);
  site->set_map_y(2187.7);
  site->set_height(3.0);
  view->set_target_height(1.0);
  view->add_quantity(v1::Viewshed::VISIBLE);
  view->add_quantity(v1::Viewshed::LEAST_HEIGHT);
  view->mutable_file()->set_path(this->Path("view.tif"));
  const v1::MapReply reply = this->Accept(command).map();
  const std::vector<float> seen = BandOf(reply.path(), 1);
  const std::vector<float> least = BandOf(reply.path(), 2);
  v1::Command lines;
  lines.mutable_line_of_sight()->set_no_clearance(true);
  lines.mutable_line_of_sight()->mutable_measuring()->set_no_objects(true);
  std::vector<int> cells;
  for (int i = 0; i < 200 * 200; i += 37) {
    if (std::abs(least[std::size_t(i)] - 1.0f) > 1e-3f) {
      v1::LineOfSight::Pair* pair = lines.mutable_line_of_sight()->add_pair();
      *pair->mutable_from_site() = *site;
      pair->mutable_to_site()->set_terrain("ground");
      pair->mutable_to_site()->set_map_x(1001 + 2 * (i % 200));
      pair->mutable_to_site()->set_map_y(2399 - 2 * (i / 200));
      pair->mutable_to_site()->set_height(1.0);
      cells.push_back(i);
    }
  }
  v1::Command remove;
  remove.mutable_remove_terrain()->set_terrain("other");
  this->Accept(remove);
  const v1::LineOfSightReply sights = this->Accept(lines).line_of_sight();
  int visible = 0;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    EXPECT_EQ(seen[std::size_t(cells[k])] == 1.0f, sights.sight(int(k)).clear()) << cells[k];
    visible += sights.sight(int(k)).clear();
  }
  EXPECT_GT(visible, 20);
  EXPECT_LT(visible, int(cells.size()) - 20);
}

TEST_F(MapRequests, BadInputIsRejected) {
  v1::Command command = this->Horizons("horizon.tif");
  command.mutable_horizon_map()->set_terrain("none");
  this->Reject(command, Kind::NOT_FOUND, "terrain 'none'");
  command = this->Horizons("");
  command.mutable_horizon_map()->mutable_file()->clear_path();
  this->Reject(command, Kind::INVALID_ARGUMENT, "names no file");
  command = this->Horizons("none/horizon.tif");
  this->Reject(command, Kind::IO, "none");
  command = this->Horizons("horizon.tif");
  command.mutable_horizon_map()->mutable_area()->add_extent(1.0);
  this->Reject(command, Kind::INVALID_ARGUMENT, "accepted: 4");
  command = this->Horizons("horizon.tif");
  command.mutable_horizon_map()->mutable_area()->set_cell_size(1000.0);
  this->Reject(command, Kind::INVALID_ARGUMENT, "spacing");

  this->Reject(this->Illumination("lit.tif"), Kind::NOT_FOUND, "horizon.tif");
  command = this->Horizons("horizon.tif");
  this->Accept(command);
  this->Reject(command, Kind::ALREADY_EXISTS, "it exists");
  command = this->Illumination("lit.tif");
  command.mutable_illumination_map()->set_terrain("other");
  this->Reject(command, Kind::INVALID_ARGUMENT, "other ground");
  command.mutable_illumination_map()->set_terrain("ground");
  this->Accept(command);
  command = this->Illumination("times.tif");
  command.mutable_illumination_map()->clear_sun_position();
  this->Reject(command, Kind::INVALID_ARGUMENT, "span"); // of zero
  command.mutable_illumination_map()->set_end_s(7200.0);
  command.mutable_illumination_map()->set_body("moon");
  this->Reject(command, Kind::UNSUPPORTED, "no longitudes");
  command = this->Illumination("lit.tif");
  command.mutable_illumination_map()->set_horizon_path(this->Path("lit.tif"));
  this->Reject(command, Kind::CORRUPT, "no horizon map");

  command = v1::Command();
  v1::Viewshed* view = command.mutable_viewshed();
  view->mutable_file()->set_path(this->Path("view.tif"));
  this->Reject(command, Kind::INVALID_ARGUMENT, "0 sites");
  v1::Site* site = view->add_site();
  site->set_terrain("ground");
  this->Reject(command, Kind::INVALID_ARGUMENT, "no data there");
  site->set_map_x(1100.0);
  site->set_map_y(2100.0);
  site->set_height(-1.0);
  this->Reject(command, Kind::INVALID_ARGUMENT, "above the ground");
  site->set_height(1.0);
  *view->add_site() = *site;
  view->mutable_site(1)->set_terrain("other");
  this->Reject(command, Kind::INVALID_ARGUMENT, "of one terrain");
}

} // namespace
} // namespace dspace::testing
