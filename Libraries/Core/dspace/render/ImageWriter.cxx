#include <dspace/render/ImageWriter.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <memory>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <dspace/AtomicFile.h>
#include <dspace/Error.h>

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

// A date of the day would make two equal pictures differ.
constexpr const char* Software = "Dspace";
constexpr const char* DateTime = "2000:01:01 12:00:00";

struct Pixels {
  OIIO::TypeDesc type;
  const void* data;
  OIIO::stride_t pixelBytes;
};

std::unique_ptr<OIIO::ImageOutput> EncoderFor(const std::string& path) {
  std::unique_ptr<OIIO::ImageOutput> encoder =
      OIIO::ImageOutput::create("picture" + std::filesystem::path(path).extension().string());
  if (!encoder) {
    throw Error(Error::Kind::Internal, Label(path), "cannot be encoded: " + OIIO::geterror());
  }
  return encoder;
}

bool Encode(OIIO::ImageOutput& encoder, const std::string& path, const OIIO::ImageSpec& spec,
            const Pixels& pixels) {
  return encoder.open(path, spec) &&
         encoder.write_image(pixels.type, pixels.data, pixels.pixelBytes) && encoder.close();
}

// Reads a TIFF to its end, where its texts are.
bool IsComplete(const std::string& path, const OIIO::ImageSpec& spec) {
  const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::create("tiff");
  OIIO::ImageSpec found;
  const std::string space = spec.get_string_attribute("oiio:ColorSpace");
  if (!in || !in->open(path, found) || found.get_string_attribute("Software") != Software ||
      found.get_string_attribute("DateTime") != DateTime ||
      (!space.empty() && found.get_string_attribute("oiio:ColorSpace") != space) ||
      found.width != spec.width || found.height != spec.height ||
      found.nchannels != spec.nchannels) {
    return false;
  }
  std::vector<unsigned char> pixels(found.image_bytes());
  return in->read_image(0, 0, 0, found.nchannels, found.format, pixels.data());
}

// OpenImageIO 2.4 makes damaged TIFFs in memory, hence a file. It does not report every failure at
// the end of a file either, hence the look at what was written.
void WriteTiff(const std::string& path, const OIIO::ImageSpec& spec, const Pixels& pixels) {
  AtomicFile file(path);
  const std::unique_ptr<OIIO::ImageOutput> encoder = EncoderFor(path);
  if (!Encode(*encoder, file.TemporaryPath(), spec, pixels) ||
      !IsComplete(file.TemporaryPath(), spec)) {
    // The library does not say why. The system does, when the same pixels are written uncompressed.
    file.Write(pixels.data, spec.image_bytes());
    throw Error(Error::Kind::Io, Label(path),
                "cannot be written: it is incomplete " + encoder->geterror());
  }
  file.Commit();
}

void Write(const std::string& path, OIIO::ImageSpec spec, const OIIO::TypeDesc& type,
           const void* data, OIIO::stride_t pixelBytes = OIIO::AutoStride) {
  spec.attribute("Software", Software);
  spec.attribute("DateTime", DateTime);
  const Pixels pixels = {type, data, pixelBytes};
  if (TypeOf(path) == Type::Tiff) {
    WriteTiff(path, spec, pixels);
    return;
  }
  // Into memory: libjpeg ends the process when it cannot write a file.
  OIIO::Filesystem::IOVecOutput memory;
  const std::unique_ptr<OIIO::ImageOutput> encoder = EncoderFor(path);
  if (!encoder->set_ioproxy(&memory) || !Encode(*encoder, "picture", spec, pixels) ||
      memory.buffer().empty()) {
    throw Error(Error::Kind::Internal, Label(path), "cannot be encoded: " + encoder->geterror());
  }
  AtomicFile::Save(path, memory.buffer().data(), memory.buffer().size());
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

} // namespace

void CheckImageFile(const std::string& path, ImagePlane plane, const ImageFileOptions& options) {
  const Type type = TypeOf(path);
  if (plane == ImagePlane::Depth && type != Type::Tiff && type != Type::Exr) {
    Reject(path, "its type holds no 32-bit floats; accepted for depth: .tif .tiff .exr");
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
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::HALF);
    spec.attribute("compression", "zip");
    Write(path, spec, OIIO::TypeDesc::FLOAT, rgb.data());
    return;
  }
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  if (type == Type::Jpeg) {
    spec.attribute("CompressionQuality", options.jpegQuality);
    spec.attribute("jpeg:subsampling", "4:4:4");
  } else if (type == Type::Tiff) {
    spec.attribute("compression", "zip");
  }
  Write(path, spec, OIIO::TypeDesc::UINT8, rgba.data(), 4);
}

void WriteDepth(const std::string& path, int width, int height, const std::vector<float>& depth) {
  CheckImageFile(path, ImagePlane::Depth);
  RequireSize(path, width, height, 1, depth.size());
  OIIO::ImageSpec spec(width, height, 1, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"Z"};
  spec.attribute("compression", "zip");
  Write(path, spec, OIIO::TypeDesc::FLOAT, depth.data());
}

void WriteLabel(const std::string& path, int width, int height,
                const std::vector<std::uint32_t>& label) {
  CheckImageFile(path, ImagePlane::Label);
  RequireSize(path, width, height, 1, label.size());
  if (TypeOf(path) == Type::Exr) {
    OIIO::ImageSpec spec(width, height, 1, OIIO::TypeDesc::UINT);
    spec.channelnames = {"id"};
    spec.attribute("compression", "zip");
    Write(path, spec, OIIO::TypeDesc::UINT, label.data());
    return;
  }
  const std::uint32_t largest = *std::max_element(label.begin(), label.end());
  if (largest > 65535) {
    Reject(path, "object id " + std::to_string(largest) +
                     " needs more than its 16 bits; "
                     "accepted for it: .exr");
  }
  const std::vector<std::uint16_t> narrow(label.begin(), label.end());
  OIIO::ImageSpec spec(width, height, 1, OIIO::TypeDesc::UINT16);
  Write(path, spec, OIIO::TypeDesc::UINT16, narrow.data());
}

} // namespace dspace
