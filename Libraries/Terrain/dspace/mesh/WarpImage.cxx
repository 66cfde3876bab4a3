#include <dspace/mesh/WarpImage.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <dspace/Error.h>
#include <dspace/crs/CrsTransform.h>
#include <dspace/gdal/GdalErrors.h>
#include <dspace/raster/DatasetFiles.h>
#include <dspace/raster/DatasetGate.h>

namespace dspace {

namespace {

// Empty, in memory, bytes.
DatasetPointer Memory(int width, int height, int bands, const Eigen::Affine2d& pixelToMap,
                      const Crs& crs, const std::string& object) {
  GdalErrors errors;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  DatasetPointer dataset(driver ? driver->Create("", width, height, bands, GDT_Byte, nullptr)
                                : nullptr);
  if (!dataset)
    throw Error(Error::Kind::Resource, object, errors.Message("no memory for its image"));
  const auto& m = pixelToMap.matrix();
  double g[6] = {m(0, 2), m(0, 0), m(0, 1), m(1, 2), m(1, 0), m(1, 1)};
  dataset->SetGeoTransform(g);
  if (crs.Ogr())
    dataset->SetSpatialRef(crs.Ogr());
  return dataset;
}

// An image as bytes: r g b and, last, where it has something (255) or not (0); band by band.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> bands;
  Eigen::Affine2d pixelToMap = Eigen::Affine2d::Identity();
  Crs crs;
  bool placed = false;
};

Picture ReadPicture(const DrapeSource& source, const std::string& object,
                    std::vector<std::string>& warnings) {
  RegisterGdal();
  GdalErrors errors;
  DatasetPointer file = OpenDataset(source.path, DatasetKind::Raster);
  if (!file) {
    VSIStatBufL stat;
    const bool exists = !source.path.empty() && VSIStatL(source.path.c_str(), &stat) == 0;
    throw Error(!exists             ? Error::Kind::NotFound
                : stat.st_size == 0 ? Error::Kind::Corrupt
                                    : Error::Kind::Unsupported,
                object, errors.Message("not an image that GDAL opens"));
  }
  NoteDataset(*file);
  const int count = file->GetRasterCount();
  GDALColorTable* table = count == 1 ? file->GetRasterBand(1)->GetColorTable() : nullptr;
  if (count < 1 || count > 4)
    throw Error(Error::Kind::Unsupported, object,
                "it has " + std::to_string(count) + " bands; accepted: 1 (grey) to 4 (RGBA)");
  if (file->GetRasterBand(1)->GetRasterDataType() != GDT_Byte)
    throw Error(Error::Kind::Unsupported, object,
                std::string("its values are ") +
                    GDALGetDataTypeName(file->GetRasterBand(1)->GetRasterDataType()) +
                    "; accepted is Byte, 8 bits a channel");
  Picture picture;
  picture.width = file->GetRasterXSize();
  picture.height = file->GetRasterYSize();
  const std::size_t size = static_cast<std::size_t>(picture.width) * picture.height;
  if (size > 400000000)
    throw Error(Error::Kind::Resource, object,
                std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                    " pixels are more than the 400 million that are read at once");
  picture.bands.resize(size * 4);
  const auto read = [&](GDALRasterBand* band, int target) {
    if (band->RasterIO(GF_Read, 0, 0, picture.width, picture.height,
                       picture.bands.data() + size * target, picture.width, picture.height,
                       GDT_Byte, 0, 0, nullptr) != CE_None ||
        errors.Failed())
      throw Error(Error::Kind::Corrupt, object,
                  "cannot be read: " + errors.Message("GDAL gave no reason"));
  };
  const bool grey = count < 3;
  for (int k = 0; k < 3; ++k)
    read(file->GetRasterBand(grey ? 1 : k + 1), k);
  // Alpha where there is one, else no-data or a mask.
  read(count == 2   ? file->GetRasterBand(2)
       : count == 4 ? file->GetRasterBand(4)
                    : file->GetRasterBand(1)->GetMaskBand(),
       3);
  if (table)
    for (std::size_t i = 0; i < size; ++i) {
      const GDALColorEntry* entry = table->GetColorEntry(picture.bands[i]);
      const short color[3] = {entry ? entry->c1 : short{0}, entry ? entry->c2 : short{0},
                              entry ? entry->c3 : short{0}};
      for (int k = 0; k < 3; ++k)
        picture.bands[size * k + i] = static_cast<std::uint8_t>(color[k]);
    }
  double g[6];
  if (source.extent) {
    const auto [left, top, right, bottom] = *source.extent;
    if (!std::isfinite(left + top + right + bottom) || left == right || top == bottom)
      throw Error(Error::Kind::InvalidArgument, object,
                  "its extent must be finite and span an area");
    picture.pixelToMap.linear() << (right - left) / picture.width, 0.0, 0.0,
        (bottom - top) / picture.height;
    picture.pixelToMap.translation() << left, top;
    picture.placed = true;
  } else if (file->GetGeoTransform(g) == CE_None) {
    picture.pixelToMap.linear() << g[1], g[2], g[4], g[5];
    picture.pixelToMap.translation() << g[0], g[3];
    picture.placed = true;
  }
  if (source.crs)
    picture.crs = Crs::FromText(*source.crs);
  else if (file->GetSpatialRef())
    picture.crs = Crs::FromOgr(*file->GetSpatialRef());
  warnings.insert(warnings.end(), errors.Warnings().begin(), errors.Warnings().end());
  return picture;
}

// Goes once around the body: its columns may be counted from any of them.
bool GoesAround(const Picture& p) {
  if (p.crs.GetKind() != Crs::Kind::Geographic || p.pixelToMap.linear()(1, 0) != 0.0)
    return false;
  const double turn = 360.0 / p.crs.GetUnit(), pixel = p.pixelToMap.linear()(0, 0);
  return std::abs(std::abs(pixel) * p.width - turn) < 0.5 * std::abs(pixel);
}

// Starts such a picture at `west` and lets it run on a little past a whole turn, both ways.
void Roll(Picture& p, double west) {
  const double pixel = p.pixelToMap.linear()(0, 0);
  const int margin = std::min(p.width, 8);
  const int width = p.width + 2 * margin;
  const double first = std::floor((west - p.pixelToMap.translation().x()) / pixel) - margin;
  std::vector<std::uint8_t> bands(static_cast<std::size_t>(width) * p.height * 4);
  for (std::size_t row = 0; row < static_cast<std::size_t>(p.height) * 4; ++row)
    for (int x = 0; x < width; ++x) {
      const long long from = static_cast<long long>(first) + x;
      const int column = static_cast<int>(((from % p.width) + p.width) % p.width);
      bands[row * width + x] = p.bands[row * p.width + column];
    }
  p.pixelToMap.translation().x() += first * pixel;
  p.width = width;
  p.bands = std::move(bands);
}

DatasetPointer ToDataset(Picture& p, const std::string& object) {
  DatasetPointer dataset = Memory(p.width, p.height, 4, p.pixelToMap, p.crs, object);
  GdalErrors errors;
  for (int k = 0; k < 4; ++k) {
    GDALRasterBand* band = dataset->GetRasterBand(k + 1);
    const std::size_t size = static_cast<std::size_t>(p.width) * p.height;
    if (band->RasterIO(GF_Write, 0, 0, p.width, p.height, p.bands.data() + size * k, p.width,
                       p.height, GDT_Byte, 0, 0, nullptr) != CE_None)
      throw Error(Error::Kind::Resource, object, errors.Message("its image cannot be stored"));
  }
  dataset->GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
  return dataset;
}

// How many of the picture's pixels lie along the side of a terrain's cell; the least of some
// places, since pixels crowd at a pole. Rejects a picture of another body, naming both.
double PixelsAPost(const RasterPlace& place, const Picture& picture) {
  std::unique_ptr<CrsTransform> toPicture;
  if (picture.crs.Ogr() && place.crs.Ogr())
    toPicture = std::make_unique<CrsTransform>(place.crs, picture.crs);
  const auto pixel = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    const Eigen::Vector2d map = place.pixelToMap * p;
    return picture.pixelToMap.inverse() * (toPicture ? toPicture->Apply(map) : map);
  };
  double least = std::numeric_limits<double>::infinity();
  for (double u : {0.2, 0.5, 0.8})
    for (double v : {0.2, 0.5, 0.8}) {
      const Eigen::Vector2d p(u * place.columns, v * place.rows);
      try {
        const Eigen::Vector2d at = pixel(p);
        least = std::min(least, std::max((pixel(p + Eigen::Vector2d::UnitX()) - at).norm(),
                                         (pixel(p + Eigen::Vector2d::UnitY()) - at).norm()));
      } catch (const Error&) {
        continue; // no place in the picture's CRS; others may have one
      }
    }
  return std::isfinite(least) ? least : 1.0;
}

void Warp(GDALDataset& from, GDALDataset& to, const std::string& object) {
  GdalErrors errors;
  // GDAL widens the bilinear kernel where the picture is finer than the result: no aliasing. An
  // error threshold of 0 makes the conversion exact at every pixel.
  char bilinear[] = "bilinear", r[] = "-r", e[] = "-et", zero[] = "0";
  char* arguments[] = {r, bilinear, e, zero, nullptr};
  GDALWarpAppOptions* options = GDALWarpAppOptionsNew(arguments, nullptr);
  GDALDatasetH sources[] = {GDALDataset::ToHandle(&from)};
  int misused = 0;
  const GDALDatasetH done =
      GDALWarp(nullptr, GDALDataset::ToHandle(&to), 1, sources, options, &misused);
  GDALWarpAppOptionsFree(options);
  if (!done || errors.Failed())
    throw Error(Error::Kind::Unsupported, object,
                "cannot be laid on the terrain: " + errors.Message("GDAL's warper gave no reason"));
}

} // namespace

DrapeImage WarpImage(const RasterPlace& place, const DrapeSource& source,
                     const WarpOptions& options) {
  const std::string object = "image '" + source.path + "'";
  DrapeImage image;
  Picture picture = ReadPicture(source, object, image.warnings);
  if (!picture.placed) {
    image.warnings.push_back(object + " has no georeference: it is stretched over the terrain");
    picture.pixelToMap = place.pixelToMap;
    picture.pixelToMap.linear() =
        picture.pixelToMap.linear() *
        Eigen::Vector2d(static_cast<double>(place.columns) / picture.width,
                        static_cast<double>(place.rows) / picture.height)
            .asDiagonal();
    picture.crs = place.crs;
  } else if (picture.crs.GetKind() == Crs::Kind::None && place.crs.GetKind() != Crs::Kind::None) {
    image.warnings.push_back(object + " has no CRS: the terrain's is used");
    picture.crs = place.crs;
  }
  if (GoesAround(picture)) {
    const bool flat = place.crs.GetKind() == Crs::Kind::Geographic;
    const double half = 180.0 / picture.crs.GetUnit();
    const double middle =
        (place.pixelToMap * Eigen::Vector2d(0.5 * place.columns, 0.5 * place.rows)).x() *
        place.crs.GetUnit();
    Roll(picture, flat ? middle / picture.crs.GetUnit() - half : -half);
  }
  const double fineness = PixelsAPost(place, picture);
  const double longer = std::max(place.columns, place.rows);
  const auto most =
      DrapeSize(place.columns, place.rows, options.maximumSize); // rejects a size out of range
  const double factor =
      std::clamp(options.maximumSize / longer, 0.0, std::max(1.0, std::ceil(fineness)));
  image.width = std::max(most[0], static_cast<int>(std::round(place.columns * factor)));
  image.height = std::max(most[1], static_cast<int>(std::round(place.rows * factor)));
  Eigen::Affine2d pixelToMap = place.pixelToMap;
  const Eigen::Vector2d shrink(static_cast<double>(place.columns) / image.width,
                               static_cast<double>(place.rows) / image.height);
  pixelToMap.linear() = pixelToMap.linear() * shrink.asDiagonal();

  DatasetPointer from = ToDataset(picture, object);
  DatasetPointer to = Memory(image.width, image.height, 4, pixelToMap, place.crs, object);
  to->GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
  Warp(*from, *to, object);

  const std::size_t size = static_cast<std::size_t>(image.width) * image.height;
  image.pixels.resize(size * 3);
  image.coverage.assign(size, 0);
  GdalErrors errors;
  bool read = to->GetRasterBand(4)->RasterIO(GF_Read, 0, 0, image.width, image.height,
                                             image.coverage.data(), image.width, image.height,
                                             GDT_Byte, 0, 0, nullptr) == CE_None;
  for (int k = 0; k < 3; ++k)
    read =
        read && to->GetRasterBand(k + 1)->RasterIO(
                    GF_Read, 0, 0, image.width, image.height, image.pixels.data() + k, image.width,
                    image.height, GDT_Byte, 3, GSpacing(3) * image.width, nullptr) == CE_None;
  if (!read)
    throw Error(Error::Kind::Internal, object, errors.Message("the warped image is lost"));
  if (std::none_of(image.coverage.begin(), image.coverage.end(), [](auto v) { return v != 0; }))
    throw Error(Error::Kind::InvalidArgument, object, "it does not overlap " + place.name);
  for (std::size_t i = 0; i < size * 3; ++i)
    if (image.coverage[i / 3] == 0)
      image.pixels[i] = options.background[i % 3];
  return image;
}

} // namespace dspace
