#include <dspace/layers/raster/RasterPixels.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include <dspace/Error.h>
#include <dspace/layers/raster/RasterOverviews.h>

#include <dspace/raster/NetworkScope.h>
#include <dspace/raster/OpeningLimit.h>

namespace dspace {
namespace {

constexpr double MaximumCached = 64e6; // pixels of an image that is kept in memory
constexpr double LargeBlock =
    1 << 20;                  // pixels of a quarter of a file or more, which are decoded together
constexpr int StripRows = 64; // that are decoded at a time
constexpr std::array<const char*, 7> Streams = {"JPEG", "PNG",    "GIF",   "BIGGIF",
                                                "WEBP", "JPEGXL", "JPEGLS"};

} // namespace

RasterPixels::RasterPixels(std::string object, std::string path, const RasterContent& content,
                           RasterShown shown, bool remote, RasterOverviews& overviews)
    : Object_(std::move(object)), Path_(std::move(path)), Content_(content), Shown_(shown),
      Remote_(remote), Overviews_(overviews) {}

// To read any part of such a file, GDAL decodes everything before that part.
void RasterPixels::PlanCaching(GDALDataset& file, std::size_t levels,
                               std::vector<std::string>& warnings) {
  this->Levels_.resize(levels);
  int width = 1;
  int height = 1;
  file.GetRasterBand(1)->GetBlockSize(&width, &height);
  const GDALDriver* driver = file.GetDriver();
  const std::string format = driver ? GDALGetDriverShortName(file.GetDriver()) : "";
  const bool stream = std::find(Streams.begin(), Streams.end(), format) != Streams.end();
  const double pixels = double(this->Content_.width) * this->Content_.height;
  const double block = double(width) * height;
  if (this->Remote_ || !(stream || (block > LargeBlock && 4.0 * block > pixels))) {
    return;
  }
  this->Caches_ = pixels <= MaximumCached;
  if (!this->Caches_) {
    warnings.push_back(this->Object_ + " has " + std::to_string(this->Content_.width) + " x " +
                       std::to_string(this->Content_.height) + " pixels in a format (" + format +
                       ") that cannot be read in parts: each of its tiles " +
                       "takes long; convert it to a tiled TIFF (gdal_translate -co "
                       "TILED=YES)");
  }
}

void RasterPixels::Read(const RasterLevel& level, const RasterWindow& part, int columns, int rows,
                        Raw& raw) {
  const std::size_t count = std::size_t(columns) * rows;
  GdalErrors errors;
  const auto check = [&](CPLErr result) {
    OpeningLimit::Check(this->Object_);
    if (result == CE_None && !errors.Failed()) {
      return;
    }
    const std::string message = errors.Message("GDAL gave no reason");
    if (level.cached) {
      this->Overviews_.Remove();
      throw Error(Error::Kind::Corrupt, this->Object_,
                  "its overviews in the cache are damaged; they are rebuilt: " + message);
    }
    if (this->Remote_) {
      ClearNetworkCache(this->Path_);
      if (IsNetworkFailure(message)) {
        throw Error(Error::Kind::Io, this->Object_,
                    "cannot be read: " + ExplainHttpStatus(message));
      }
    }
    throw Error(Error::Kind::Corrupt, this->Object_, "cannot be read: " + message);
  };
  const GDALDataType type = level.colors[0]->GetRasterDataType();
  const int size = GDALGetDataTypeSizeBytes(type);
  const auto pixel = GSpacing((level.colors.size() + (level.alpha ? 1 : 0)) * size);
  raw.samples.resize(count * std::size_t(pixel));
  std::uint8_t* to = raw.samples.data();
  const auto read = [&](GDALRasterBand* band) {
    GDALRasterIOExtraArg argument = OpeningLimit::Argument();
    check(band->RasterIO(GF_Read, part.column, part.row, part.width, part.height, to, columns, rows,
                         type, pixel, pixel * columns, &argument));
    to += size;
  };
  std::for_each(level.colors.begin(), level.colors.end(), read);
  raw.mask.clear();
  if (level.alpha) {
    read(level.alpha);
  } else if (level.gaps) {
    raw.mask.assign(count, 255);
    MaskGaps(*level.colors[0], part, columns, rows, columns, raw.mask.data());
    check(CE_None);
  }
  std::vector<std::uint8_t> mask(level.masks.empty() ? 0 : count);
  for (GDALRasterBand* band : level.masks) {
    check(band->GetMaskBand()->RasterIO(GF_Read, part.column, part.row, part.width, part.height,
                                        mask.data(), columns, rows, GDT_Byte, 0, 0, nullptr));
    raw.mask.resize(count, 0);
    std::transform(mask.begin(), mask.end(), raw.mask.begin(), raw.mask.begin(),
                   [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
  }
}

// The first caller decodes the level; concurrent callers wait.
std::shared_ptr<const RasterPixels::Raw> RasterPixels::CachedLevel(const RasterLevel& level,
                                                                   std::size_t index) {
  if (!this->Caches_ || level.cached) {
    return nullptr;
  }
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  std::shared_ptr<const Raw>& cached = this->Levels_[index];
  if (!cached) {
    auto whole = std::make_shared<Raw>();
    Raw strip;
    for (int row = 0; row < level.height; row += StripRows) {
      const int rows = std::min(StripRows, level.height - row);
      this->Read(level, {0, row, level.width, rows}, level.width, rows, strip);
      if (row == 0) {
        whole->samples.reserve(strip.samples.size() / rows * level.height);
        whole->mask.reserve(strip.mask.size() / rows * level.height);
      }
      whole->samples.insert(whole->samples.end(), strip.samples.begin(), strip.samples.end());
      whole->mask.insert(whole->mask.end(), strip.mask.begin(), strip.mask.end());
    }
    if (std::all_of(whole->mask.begin(), whole->mask.end(), [](auto m) { return m == 255; })) {
      whole->mask = {};
    }
    const GdalErrors quiet;
    for (GDALRasterBand* band : level.colors) { // GDAL has decoded them a second time
      band->FlushCache(false);
    }
    this->CachedBytes_ += whole->samples.size() + whole->mask.size();
    cached = std::move(whole);
  }
  return cached;
}

void RasterPixels::Values(const RasterLevel& level, const Raw& raw, std::size_t first,
                          std::size_t count, double* values, float* opacities) const {
  const GDALDataType type = level.colors[0]->GetRasterDataType();
  const int samples = int(level.colors.size()) + (level.alpha ? 1 : 0);
  const int size = GDALGetDataTypeSizeBytes(type);
  const std::uint8_t* from = raw.samples.data() + first * std::size_t(samples * size);
  const auto copy = [&](const std::uint8_t* of, double* to) {
    GDALCopyWords64(of, type, samples * size, to, GDT_Float64, sizeof(double), GPtrDiff_t(count));
  };
  copy(from, values);
  std::fill_n(opacities, count, 1.0f);
  if (level.alpha) {
    std::vector<double> alpha(count);
    copy(from + size, alpha.data());
    std::transform(alpha.begin(), alpha.end(), opacities,
                   [](double value) { return float(value) * (1.0f / 255.0f); });
  } else if (!raw.mask.empty()) {
    std::transform(raw.mask.begin() + std::ptrdiff_t(first),
                   raw.mask.begin() + std::ptrdiff_t(first + count), opacities,
                   [](std::uint8_t value) { return value / 255.0f; });
  }
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = level.cached ? values[i] : values[i] * this->Content_.scale + this->Content_.offset;
    opacities[i] = std::isfinite(values[i]) ? opacities[i] : 0.0f;
  }
}

void RasterPixels::ConvertVectors(const RasterLevel& level, const Raw& raw, std::size_t first,
                                  std::size_t count, float* pixels) const {
  const GDALDataType type = level.colors[0]->GetRasterDataType();
  const int samples = level.alpha ? 4 : 3;
  const int size = GDALGetDataTypeSizeBytes(type);
  const std::uint8_t* from = raw.samples.data() + first * std::size_t(samples * size);
  std::vector<double> numbers(count * std::size_t(samples));
  GDALCopyWords64(from, type, size, numbers.data(), GDT_Float64, sizeof(double),
                  GPtrDiff_t(numbers.size()));
  const std::uint8_t* mask = raw.mask.empty() ? nullptr : raw.mask.data() + first;
  // Overviews hold means, which are shorter.
  const bool whole =
      !level.cached && level.width == this->Content_.width && level.height == this->Content_.height;
  for (std::size_t i = 0; i < count; ++i, pixels += 4) {
    const double* number = &numbers[i * std::size_t(samples)];
    double n[3];
    for (int k = 0; k < 3; ++k) {
      n[k] = level.cached ? number[k] : number[k] * this->Content_.scale + this->Content_.offset;
    }
    float opacity = level.alpha ? float(number[3] / 255.0) : mask ? mask[i] / 255.0f : 1.0f;
    opacity = std::isfinite(n[0] + n[1] + n[2]) ? opacity : 0.0f;
    if (whole && opacity > 0.0f) {
      this->CheckNormal(n);
    }
    for (int k = 0; k < 3; ++k) {
      pixels[k] = opacity > 0.0f ? float(n[k]) * opacity : 0.0f;
    }
    pixels[3] = opacity;
  }
}

void RasterPixels::CheckNormal(const double (&n)[3]) const {
  constexpr double Rounding = 0.01; // of 8 bits
  constexpr double Shortest = 0.5;
  const double length = std::hypot(n[0], n[1], n[2]);
  if (length >= Shortest && length <= 1.0 + 10.0 * Rounding && n[2] >= -Rounding) {
    return;
  }
  std::ostringstream text;
  text << "it holds the vector (" << n[0] << ", " << n[1] << ", " << n[2]
       << "), which is no normal of ground; accepted are lengths of " << Shortest << " to "
       << 1.0 + 10.0 * Rounding
       << " with z (the third band) from 0, coded as -1 to 1, or 0 to 255 or 65535 for it";
  throw Error(Error::Kind::Corrupt, this->Object_, text.str());
}

void RasterPixels::Convert(const RasterLevel& level, const Raw& raw, std::size_t first,
                           std::size_t count, float* pixels) const {
  const GDALDataType type = level.colors[0]->GetRasterDataType();
  const int samples = int(level.colors.size()) + (level.alpha ? 1 : 0);
  const int size = GDALGetDataTypeSizeBytes(type);
  const void* from = raw.samples.data() + first * std::size_t(samples * size);
  const std::uint8_t* mask = raw.mask.empty() ? nullptr : raw.mask.data() + first;
  const int step = this->Content_.channels + 1;
  if (this->Content_.band > 0) {
    // A value may need more digits than a float has, until the bias is gone.
    std::vector<double> values(count);
    std::vector<float> opacities(count);
    this->Values(level, raw, first, count, values.data(), opacities.data());
    for (std::size_t i = 0; i < count; ++i) {
      const double value = values[i];
      const float opacity = opacities[i];
      if (this->Shown_ == RasterShown::Holes && !level.cached) {
        pixels[2 * i] = 0.0f;
        pixels[2 * i + 1] = 1.0f - opacity;
        continue;
      }
      pixels[2 * i] = opacity > 0.0f ? float(value - this->Bias_) * opacity : 0.0f;
      pixels[2 * i + 1] = opacity;
    }
    return;
  }
  if (this->Content_.vectors) {
    this->ConvertVectors(level, raw, first, count, pixels);
    return;
  }
  const float scale = level.cached ? 1.0f : float(this->Content_.scale);
  const float alphaScale = level.cached ? 1.0f / 255.0f : float(this->Content_.alphaScale);
  const bool indexed = !this->Content_.palette.empty() && !level.cached;
  const auto convert = [&](auto* p) {
    if (!level.alpha && !mask && !indexed &&
        this->Content_.channels == 3) { // most, and the quickest
      for (std::size_t i = 0; i < count; ++i, p += 3, pixels += 4) {
        pixels[0] = p[0] * scale;
        pixels[1] = p[1] * scale;
        pixels[2] = p[2] * scale;
        pixels[3] = 1.0f;
      }
      return;
    }
    for (std::size_t i = 0; i < count; ++i, p += samples, pixels += step) {
      float opacity = level.alpha ? p[samples - 1] * alphaScale : mask ? mask[i] / 255.0f : 1.0f;
      if (indexed) {
        const std::array<float, 4>& color =
            this->Content_.palette[std::min(std::size_t(p[0]), this->Content_.palette.size() - 1)];
        opacity *= color[3];
        for (int k = 0; k < 3; ++k) {
          pixels[k] = color[std::size_t(k)] * opacity;
        }
      } else {
        for (int k = 0; k < this->Content_.channels; ++k) {
          pixels[k] = opacity > 0.0f ? p[k] * scale * opacity : 0.0f;
        }
      }
      pixels[this->Content_.channels] = opacity;
    }
  };
  if (type == GDT_Byte) {
    convert(static_cast<const std::uint8_t*>(from));
  } else {
    convert(static_cast<const std::uint16_t*>(from));
  }
}

} // namespace dspace
