// Writes small rasters for tests, with GDAL itself.
#ifndef DSPACE_TEST_RASTERFILE_H
#define DSPACE_TEST_RASTERFILE_H

#include <array>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <unistd.h>

#include "TemporaryFolder.h"

namespace dspace::testing {

struct RasterFile {
  int width = 0;
  int height = 0;
  int bands = 1;
  GDALDataType type = GDT_Float64;
  std::function<double(int column, int row, int band)> value; // band from 0
  std::optional<std::array<double, 6>> geotransform;
  std::string crs;
  std::optional<double> noData;
  std::optional<double> scale;
  std::optional<double> offset;
  std::string unit;
  std::string verticalDatum; // the metadata item

  std::string Write(const std::string& path) const {
    GDALAllRegister();
    auto* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    auto* dataset =
        driver->Create(path.c_str(), this->width, this->height, this->bands, this->type, nullptr);
    if (this->geotransform) {
      std::array<double, 6> g = *this->geotransform;
      dataset->SetGeoTransform(g.data());
    }
    if (!this->crs.empty()) {
      OGRSpatialReference srs;
      EXPECT_EQ(srs.SetFromUserInput(this->crs.c_str()), OGRERR_NONE) << this->crs;
      dataset->SetSpatialRef(&srs);
    }
    if (!this->verticalDatum.empty())
      dataset->SetMetadataItem("VERTICAL_DATUM", this->verticalDatum.c_str());
    for (int b = 0; b < this->bands; ++b) {
      GDALRasterBand* band = dataset->GetRasterBand(b + 1);
      if (this->noData)
        band->SetNoDataValue(*this->noData);
      if (this->scale)
        band->SetScale(*this->scale);
      if (this->offset)
        band->SetOffset(*this->offset);
      if (!this->unit.empty())
        band->SetUnitType(this->unit.c_str());
      std::vector<double> row(this->width);
      for (int r = 0; r < this->height; ++r) {
        for (int c = 0; c < this->width; ++c)
          row[c] = this->value(c, r, b);
        EXPECT_EQ(band->RasterIO(GF_Write, 0, r, this->width, 1, row.data(), this->width, 1,
                                 GDT_Float64, 0, 0, nullptr),
                  CE_None);
      }
    }
    GDALClose(dataset);
    return path;
  }
};

} // namespace dspace::testing

#endif
