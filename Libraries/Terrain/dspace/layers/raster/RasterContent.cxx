#include <dspace/layers/raster/RasterContent.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <dspace/Error.h>
#include <dspace/Utf8.h>

namespace dspace {
namespace {

// The greatest value of a colour channel.
double GreatestColor(GDALRasterBand& band) {
  const int bits = band.GetRasterDataType() == GDT_Byte ? 8 : 16;
  const char* fewer = band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE");
  const int used = fewer ? std::clamp(std::atoi(fewer), 1, bits) : bits;
  return std::ldexp(1.0, used) - 1.0;
}

} // namespace

RasterContent RasterContent::Of(GDALDataset& file, int band, RasterShown shown,
                                const std::string& object, std::vector<std::string>& warnings) {
  RasterContent content;
  content.band = band;
  GdalErrors errors;
  content.width = file.GetRasterXSize();
  content.height = file.GetRasterYSize();
  content.bands = file.GetRasterCount();
  if (content.bands < 1) {
    throw Error(Error::Kind::Unsupported, object,
                "it holds no band itself; name one of its subdatasets (gdalinfo lists them)");
  }
  if (shown == RasterShown::Vectors) {
    content.InspectVectors(file, object);
  } else if (content.band > 0) {
    if (content.band > content.bands) {
      throw Error(Error::Kind::InvalidArgument, object,
                  "band " + std::to_string(content.band) + " asked for; accepted are 1 to " +
                      std::to_string(content.bands));
    }
    content.InspectBand(*file.GetRasterBand(content.band), object);
  } else {
    content.InspectImage(file, object, warnings);
  }
  double g[6];
  if (file.GetGeoTransform(g) == CE_None) {
    content.place.placed = true;
    content.place.pixelToMap.linear() << g[1], g[2], g[4], g[5];
    content.place.pixelToMap.translation() << g[0], g[3];
  } else if (file.GetGCPCount() > 0) {
    warnings.push_back(object + " has ground control points, which are not used: "
                                "warp it first (gdalwarp)");
  }
  if (const OGRSpatialReference* srs = file.GetSpatialRef()) {
    content.place.crs = Crs::FromOgr(*srs);
  }
  errors.Check(Error::Kind::Corrupt, object);
  warnings.insert(warnings.end(), errors.Warnings().begin(), errors.Warnings().end());
  return content;
}

void RasterContent::InspectBand(GDALRasterBand& first, const std::string& object) {
  this->type = first.GetRasterDataType();
  if (GDALDataTypeIsComplex(this->type)) {
    throw Error(Error::Kind::Unsupported, object,
                std::string("complex values (") + GDALGetDataTypeName(this->type) +
                    ") cannot be mapped to a colour ramp");
  }
  this->channels = 1;
  int stated = 0;
  const double statedScale = first.GetScale(&stated);
  this->scale = stated ? statedScale : 1.0;
  const double statedOffset = first.GetOffset(&stated);
  this->offset = stated ? statedOffset : 0.0;
  if (!std::isfinite(this->scale) || this->scale == 0.0 || !std::isfinite(this->offset)) {
    throw Error(Error::Kind::Corrupt, object,
                "its scale of " + std::to_string(this->scale) + " and offset of " +
                    std::to_string(this->offset) + " are not usable");
  }
  this->alphaScale = 1.0 / 255.0;
  this->unit = ToUtf8(first.GetUnitType() ? first.GetUnitType() : "");
}

// 8 and 16 bits without a scale are coded from -1 to 1.
void RasterContent::InspectVectors(GDALDataset& file, const std::string& object) {
  this->vectors = true;
  this->channels = 3;
  if (this->bands != this->channels) {
    throw Error(Error::Kind::Unsupported, object,
                "it has " + std::to_string(this->bands) + (this->bands == 1 ? " band" : " bands") +
                    "; accepted are 3: x, y and z of a normal");
  }
  const auto inspect = [&](int number) {
    GDALRasterBand& band = *file.GetRasterBand(number);
    RasterContent one;
    one.InspectBand(band, object);
    int stated[2] = {0, 0};
    band.GetScale(&stated[0]);
    band.GetOffset(&stated[1]);
    const bool coded = one.type == GDT_Byte || one.type == GDT_UInt16;
    if (coded && !(stated[0] && one.scale != 1.0) && !(stated[1] && one.offset != 0.0)) {
      one.scale = 2.0 / GreatestColor(band);
      one.offset = -1.0;
    }
    return one;
  };
  const RasterContent first = inspect(1);
  this->type = first.type;
  this->scale = first.scale;
  this->offset = first.offset;
  this->alphaScale = first.alphaScale;
  for (int k = 2; k <= this->channels; ++k) {
    const RasterContent other = inspect(k);
    if (other.type != this->type || other.scale != this->scale || other.offset != this->offset) {
      throw Error(Error::Kind::Unsupported, object,
                  "its bands 1 and " + std::to_string(k) +
                      " have different types, scales or offsets; accepted are 3 bands alike");
    }
  }
}

void RasterContent::InspectImage(GDALDataset& file, const std::string& object,
                                 std::vector<std::string>& warnings) {
  if (this->bands > 4) {
    throw Error(Error::Kind::Unsupported, object,
                "it has " + std::to_string(this->bands) +
                    " bands; accepted are 1 (grey) to 4 (RGBA), or one of them in false colour");
  }
  GDALRasterBand& first = *file.GetRasterBand(1);
  this->type = first.GetRasterDataType();
  for (int k = 1; k <= this->bands; ++k) {
    const GDALDataType other = file.GetRasterBand(k)->GetRasterDataType();
    if (other != this->type || (other != GDT_Byte && other != GDT_UInt16)) {
      throw Error(Error::Kind::Unsupported, object,
                  std::string("its values are ") + GDALGetDataTypeName(other) +
                      "; accepted are Byte or UInt16 in all bands, 8 or 16 bits a channel; other "
                      "values show in false colour");
    }
  }
  this->channels = this->bands < 3 ? 1 : 3;
  this->alpha = this->bands == 2 || this->bands == 4;
  this->scale = 255.0 / GreatestColor(first);
  if (this->alpha) {
    GDALRasterBand& last = *file.GetRasterBand(this->bands);
    this->alphaScale = 1.0 / GreatestColor(last);
    if (last.GetColorInterpretation() != GCI_AlphaBand) {
      warnings.push_back(object + " has " + std::to_string(this->bands) +
                         " bands: the last is used as opacity");
    }
  }
  const GDALColorTable* table = this->bands == 1 ? first.GetColorTable() : nullptr;
  if (table && table->GetColorEntryCount() > 0) {
    this->channels = 3;
    for (int i = 0; i < table->GetColorEntryCount(); ++i) {
      GDALColorEntry rgb = {};
      table->GetColorEntryAsRGB(i, &rgb);
      this->palette.push_back({float(rgb.c1), float(rgb.c2), float(rgb.c3),
                               float(table->GetColorEntry(i)->c4) / 255.0f});
    }
  }
}

bool RasterContent::Matches(GDALDataset& file) const {
  return file.GetRasterXSize() == this->width && file.GetRasterYSize() == this->height &&
         file.GetRasterCount() == this->bands &&
         file.GetRasterBand(std::max(1, this->band))->GetRasterDataType() == this->type;
}

std::vector<RasterLevel> RasterContent::LevelsOf(GDALDataset& file) const {
  std::vector<RasterLevel> levels;
  const int first = this->band > 0 ? this->band : 1;
  const int colors = this->band > 0 ? 1 : this->bands - (this->alpha ? 1 : 0);
  const int overviews = file.GetRasterBand(first)->GetOverviewCount();
  for (int i = -1; i < overviews; ++i) {
    const auto bandOf = [&](int number) {
      GDALRasterBand* whole = file.GetRasterBand(number);
      return i < 0 ? whole : i < whole->GetOverviewCount() ? whole->GetOverview(i) : nullptr;
    };
    RasterLevel level;
    bool complete = true;
    const auto add = [&](int number) {
      GDALRasterBand* added = bandOf(number);
      complete = complete && added &&
                 (level.width == 0 ||
                  (added->GetXSize() == level.width && added->GetYSize() == level.height));
      if (complete) {
        level.width = added->GetXSize();
        level.height = added->GetYSize();
      }
      return added;
    };
    for (int k = 0; k < colors; ++k) {
      level.colors.push_back(add(first + k));
    }
    level.alpha = this->alpha ? add(this->bands) : nullptr;
    const int flags = file.GetRasterBand(first)->GetMaskFlags();
    complete = complete && (this->alpha || level.colors[0]->GetMaskFlags() == flags);
    complete =
        complete &&
        (i < 0 || (level.width < levels.back().width && level.height <= levels.back().height));
    if (!complete) {
      continue;
    }
    if (!level.alpha) {
      level.gaps = GivesZerosForGaps(*level.colors[0]);
      const auto masks = level.gaps                ? level.colors.begin()
                         : flags & GMF_PER_DATASET ? level.colors.begin() + 1
                                                   : level.colors.end();
      level.masks.assign(level.colors.begin(), masks);
    }
    levels.push_back(std::move(level));
  }
  return levels;
}

} // namespace dspace
