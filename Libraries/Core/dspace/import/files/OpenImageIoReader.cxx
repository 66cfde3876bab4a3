#include <dspace/import/files/OpenImageIoReader.h>

#include <algorithm>
#include <cstring>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <dspace/Budgets.h>
#include <dspace/Error.h>

#include <dspace/import/files/FileNames.h>
#include <dspace/import/files/ImageReader.h>

namespace dspace {

namespace {

// OpenImageIO's name of the type of an image, or "". Only the types that models use are offered:
// each further decoder would be one more that hostile data reaches.
std::string TypeOf(const std::uint8_t* data, std::size_t size, const std::string& name) {
  const auto starts = [&](const char* magic, std::size_t n, std::size_t at = 0) {
    return size >= at + n && std::memcmp(data + at, magic, n) == 0;
  };
  if (starts("\x89PNG\r\n\x1a\n", 8)) {
    return "png";
  }
  if (starts("\xff\xd8\xff", 3)) {
    return "jpeg";
  }
  if (starts("RIFF", 4) && starts("WEBP", 4, 8)) {
    return "webp";
  }
  if (starts("GIF8", 4)) {
    return "gif";
  }
  // NOLINTNEXTLINE(bugprone-string-literal-with-embedded-nul): TIFF's number 42 has a zero byte
  if (starts("II*\0", 4) || starts("MM\0*", 4)) {
    return "tiff";
  }
  if (starts("BM", 2)) {
    return "bmp";
  }
  if (size >= 2 && data[0] == 'P' && data[1] >= '1' && data[1] <= '6') {
    return "pnm";
  }
  return LowerExtension(name) == ".tga" ? "targa" : "";
}

void CheckSize(const OIIO::ImageSpec& spec, const std::string& object) {
  const std::string size = std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                           " x " + std::to_string(spec.nchannels);
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 || spec.depth > 1) {
    throw Error(Error::Kind::Corrupt, object, "is an image of " + size);
  }
  if (spec.width > MaximumImageSide || spec.height > MaximumImageSide) {
    throw Error(Error::Kind::Resource, object,
                "is an image of " + size + "; at most " + std::to_string(MaximumImageSide) +
                    " pixels a side are read");
  }
  // Four channels of 32 bits are the widest pixels that files of models have.
  constexpr std::uint64_t WidestPixel = 16;
  const std::uint64_t most = BudgetOf(Budget::ImagePixels);
  if (spec.image_pixels() > most || spec.image_bytes(true) > WidestPixel * most) {
    throw Error(Error::Kind::Resource, object,
                "is an image of " + size + ": too many pixels; " + BudgetText(Budget::ImagePixels));
  }
}

} // namespace

std::shared_ptr<const Image> ReadWithOpenImageIo(const void* data, std::size_t size,
                                                 const std::string& name) {
  const std::string object = "image '" + name + "'";
  const std::string type = TypeOf(static_cast<const std::uint8_t*>(data), size, name);
  if (size == 0) {
    throw Error(Error::Kind::Corrupt, object, "is empty");
  }
  if (type.empty()) {
    throw Error(Error::Kind::Unsupported, object,
                "is of no known type; PNG, JPEG, WebP, GIF, BMP, TIFF, PNM and TGA are read");
  }
  try {
    // OpenImageIO only reads through the proxy, whose interface is not const.
    OIIO::Filesystem::IOMemReader proxy(const_cast<void*>(data), size);
    const auto input = OIIO::ImageInput::create(type);
    if (!input || !input->supports("ioproxy")) {
      throw Error(Error::Kind::Unsupported, object,
                  "this build of OpenImageIO does not read " + type + ": " + OIIO::geterror());
    }
    input->set_ioproxy(&proxy);
    OIIO::ImageSpec hints, spec;
    hints.attribute("oiio:UnassociatedAlpha", 1);
    if (!input->open(name, spec, hints)) {
      throw Error(Error::Kind::Corrupt, object,
                  "is not a readable " + type + ": " + input->geterror());
    }
    CheckSize(spec, object);
    auto image = std::make_shared<Image>();
    image->name = name;
    image->width = spec.width;
    image->height = spec.height;
    image->channels = std::min(spec.nchannels, 4);
    image->pixels.resize(std::size_t(image->width) * std::size_t(image->height) *
                         std::size_t(image->channels));
    if (!input->read_image(0, 0, 0, image->channels, OIIO::TypeDesc::UINT8, image->pixels.data())) {
      throw Error(Error::Kind::Corrupt, object, "is a damaged " + type + ": " + input->geterror());
    }
    return image;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(Error::Kind::Resource, object, "not enough memory to decode it");
  } catch (const std::exception& e) {
    throw Error(Error::Kind::Corrupt, object,
                std::string("is a damaged ") + type + ": " + e.what());
  }
}

} // namespace dspace
