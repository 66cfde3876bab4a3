#include <dspace/import/files/OpenImageIoWriter.h>

#include <filesystem>
#include <memory>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <dspace/AtomicFile.h>
#include <dspace/Error.h>

namespace dspace {
namespace {

std::string Label(const std::string& path) {
  return "file '" + path + "'";
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

bool IsTiff(const PictureFile& picture) {
  return std::filesystem::path(picture.path).extension().string()[1] == 't' ||
         std::filesystem::path(picture.path).extension().string()[1] == 'T';
}

OIIO::TypeDesc TypeOf(PictureFile::Sample sample) {
  switch (sample) {
  case PictureFile::Sample::UInt8:
    return OIIO::TypeDesc::UINT8;
  case PictureFile::Sample::UInt16:
    return OIIO::TypeDesc::UINT16;
  case PictureFile::Sample::UInt32:
    return OIIO::TypeDesc::UINT;
  case PictureFile::Sample::Float:
  case PictureFile::Sample::HalfFromFloat:
    break;
  }
  return OIIO::TypeDesc::FLOAT;
}

OIIO::ImageSpec SpecOf(const PictureFile& picture) {
  OIIO::ImageSpec spec(picture.width, picture.height, picture.channels,
                       picture.sample == PictureFile::Sample::HalfFromFloat
                           ? OIIO::TypeDesc(OIIO::TypeDesc::HALF)
                           : TypeOf(picture.sample));
  if (!picture.channelNames.empty()) {
    spec.channelnames = picture.channelNames;
  }
  if (picture.srgb) {
    spec.attribute("oiio:ColorSpace", "sRGB");
  }
  if (picture.zip) {
    spec.attribute("compression", "zip");
  }
  if (picture.jpegQuality > 0) {
    spec.attribute("CompressionQuality", picture.jpegQuality);
    spec.attribute("jpeg:subsampling", "4:4:4");
  }
  spec.attribute("Software", Software);
  spec.attribute("DateTime", DateTime);
  return spec;
}

} // namespace

void WriteWithOpenImageIo(const PictureFile& picture) {
  const OIIO::ImageSpec spec = SpecOf(picture);
  const Pixels pixels = {TypeOf(picture.sample), picture.pixels, picture.pixelBytes};
  if (IsTiff(picture)) {
    WriteTiff(picture.path, spec, pixels);
    return;
  }
  // Into memory: libjpeg ends the process when it cannot write a file.
  OIIO::Filesystem::IOVecOutput memory;
  const std::unique_ptr<OIIO::ImageOutput> encoder = EncoderFor(picture.path);
  if (!encoder->set_ioproxy(&memory) || !Encode(*encoder, "picture", spec, pixels) ||
      memory.buffer().empty()) {
    throw Error(Error::Kind::Internal, Label(picture.path),
                "cannot be encoded: " + encoder->geterror());
  }
  AtomicFile::Save(picture.path, memory.buffer().data(), memory.buffer().size());
}

} // namespace dspace
