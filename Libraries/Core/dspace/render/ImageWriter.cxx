#include <dspace/render/ImageWriter.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <utility>

#include <dspace/AtomicFile.h>
#include <dspace/Error.h>
#include <dspace/import/files/ImageCodec.h>
#include <dspace/import/files/PngBytes.h>

namespace dspace {
namespace {

std::string Label(const std::string& path) {
  return "file '" + path + "'";
}

[[noreturn]] void Reject(const std::string& path, const std::string& message) {
  throw Error(Error::Kind::InvalidArgument, Label(path), message);
}

enum class Type { Png, Jpeg, Tiff, Exr };

Type TypeOf(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  if (extension == ".png") {
    return Type::Png;
  }
  if (extension == ".jpg" || extension == ".jpeg") {
    return Type::Jpeg;
  }
  if (extension == ".tif" || extension == ".tiff") {
    return Type::Tiff;
  }
  if (extension == ".exr") {
    return Type::Exr;
  }
  Reject(path, "its extension is '" + extension + "'; accepted: .png .jpg .jpeg .tif .tiff .exr");
}

using Sample = PictureFile::Sample;

// With libpng, since most pictures are PNG files and need no other library: it writes no date.
void WritePng(const std::string& path, int width, int height,
              const std::vector<std::uint8_t>& rgba) {
  Image image;
  image.name = path;
  image.width = width;
  image.height = height;
  image.channels = 3;
  image.pixels.resize(rgba.size() / 4 * 3);
  for (std::size_t from = 0, to = 0; from < rgba.size(); from += 4, to += 3) {
    std::copy_n(rgba.data() + from, 3, image.pixels.data() + to);
  }
  const std::vector<std::uint8_t> bytes = PngBytes(image);
  AtomicFile::Save(path, bytes.data(), bytes.size());
}

void RequireSize(const std::string& path, int width, int height, int channels, std::size_t values) {
  if (width <= 0 || height <= 0 ||
      values != std::size_t(width) * std::size_t(height) * std::size_t(channels)) {
    Reject(path, std::to_string(values) + " values for a picture of " + std::to_string(width) +
                     " x " + std::to_string(height) + " pixels with " + std::to_string(channels) +
                     " channels");
  }
}

std::array<float, 256> LinearFromSrgb() {
  std::array<float, 256> table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double s = double(i) / 255.0;
    table[i] = float(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
  }
  return table;
}

// The channels of a plane of floats, and what it is called; none for others.
std::pair<std::vector<std::string>, const char*> FloatsOf(ImagePlane plane) {
  switch (plane) {
  case ImagePlane::Depth:
    return {{"Z"}, "depth"};
  case ImagePlane::Range:
    return {{"R"}, "range"};
  case ImagePlane::Radiance:
    return {{"R", "G", "B"}, "radiance"};
  case ImagePlane::LitFraction:
    return {{"lit"}, "lit fraction"};
  case ImagePlane::Incidence:
    return {{"incidence"}, "incidence"};
  case ImagePlane::Emission:
    return {{"emission"}, "emission"};
  case ImagePlane::Phase:
    return {{"phase"}, "phase"};
  default:
    return {};
  }
}

} // namespace

void CheckImageFile(const std::string& path, ImagePlane plane, const ImageFileOptions& options) {
  const Type type = TypeOf(path);
  if (const char* floats = FloatsOf(plane).second;
      floats && type != Type::Tiff && type != Type::Exr) {
    Reject(path, std::string("its type holds no 32-bit floats; accepted for ") + floats +
                     ": .tif .tiff .exr");
  }
  if (plane == ImagePlane::Label && type == Type::Jpeg) {
    Reject(path, "its type loses values; accepted for labels: .png .tif .tiff .exr");
  }
  if (options.jpegQuality < 1 || options.jpegQuality > 100) {
    Reject(path, "the quality is " + std::to_string(options.jpegQuality) + "; accepted: 1 to 100");
  }
  AtomicFile::Check(path);
}

void WriteColor(const std::string& path, int width, int height,
                const std::vector<std::uint8_t>& rgba, const ImageFileOptions& options) {
  CheckImageFile(path, ImagePlane::Color, options);
  RequireSize(path, width, height, 4, rgba.size());
  const Type type = TypeOf(path);
  if (type == Type::Exr) {
    const std::array<float, 256> linear = LinearFromSrgb();
    std::vector<float> rgb;
    rgb.reserve(rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
      rgb.insert(rgb.end(), {linear[rgba[i]], linear[rgba[i + 1]], linear[rgba[i + 2]]});
    }
    PictureFile picture = {path, width, height, 3, Sample::HalfFromFloat, rgb.data(), 12};
    picture.zip = true;
    LoadImageCodec().write(picture);
    return;
  }
  if (type == Type::Png) {
    WritePng(path, width, height, rgba);
    return;
  }
  PictureFile picture = {path, width, height, 3, Sample::UInt8, rgba.data(), 4};
  picture.srgb = true;
  picture.zip = type == Type::Tiff;
  picture.jpegQuality = type == Type::Jpeg ? options.jpegQuality : 0;
  LoadImageCodec().write(picture);
}

void WriteFloats(const std::string& path, ImagePlane plane, int width, int height,
                 const std::vector<float>& values) {
  CheckImageFile(path, plane);
  const std::vector<std::string> channels = FloatsOf(plane).first;
  const int count = int(channels.size());
  RequireSize(path, width, height, count, values.size());
  PictureFile picture = {path,
                         width,
                         height,
                         count,
                         Sample::Float,
                         values.data(),
                         std::ptrdiff_t(sizeof(float)) * count};
  picture.channelNames = channels;
  picture.zip = true;
  LoadImageCodec().write(picture);
}

void WriteLabel(const std::string& path, int width, int height,
                const std::vector<std::uint32_t>& label) {
  CheckImageFile(path, ImagePlane::Label);
  RequireSize(path, width, height, 1, label.size());
  if (TypeOf(path) == Type::Exr) {
    PictureFile picture = {
        path, width, height, 1, Sample::UInt32, label.data(), sizeof(std::uint32_t)};
    picture.channelNames = {"id"};
    picture.zip = true;
    LoadImageCodec().write(picture);
    return;
  }
  const std::uint32_t largest = *std::max_element(label.begin(), label.end());
  if (largest > 65535) {
    Reject(path, "object id " + std::to_string(largest) +
                     " needs more than its 16 bits; "
                     "accepted for it: .exr");
  }
  const std::vector<std::uint16_t> narrow(label.begin(), label.end());
  LoadImageCodec().write(
      {path, width, height, 1, Sample::UInt16, narrow.data(), sizeof(std::uint16_t)});
}

} // namespace dspace
