#include <dspace/import/files/ImageReader.h>

#include <dspace/import/files/ImageCodec.h>
#include <dspace/import/files/ImportFile.h>
#include <dspace/import/files/PngReader.h>

namespace dspace {

std::shared_ptr<const Image> ReadImageMemory(const void* data, std::size_t size,
                                             const std::string& name) {
  const std::shared_ptr<const Image> png = ReadPlainPng(data, size, name);
  return png ? png : LoadImageCodec().read(data, size, name);
}

std::shared_ptr<const Image> ReadImage(const std::string& path) {
  const std::string bytes = ReadFileBytes(path, MaximumImageBytes);
  return ReadImageMemory(bytes.data(), bytes.size(), path);
}

} // namespace dspace
