#include <dspace/import/files/ImageCodec.h>

#include <atomic>
#include <filesystem>

#include <dlfcn.h>

#include <dspace/Error.h>

namespace dspace {
namespace {

std::atomic<bool> IsLoaded = false;

// Beside the library that contains this function.
std::string CodecPath() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&LoadImageCodec), &info) == 0 || !info.dli_fname) {
    return "libDspaceImageCodec.so";
  }
  return (std::filesystem::path(info.dli_fname).parent_path() / "libDspaceImageCodec.so").string();
}

const ImageCodec& Load() {
  const std::string path = CodecPath();
  // It stays loaded: the libraries that it brings cannot be unloaded safely.
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  using Get = const ImageCodec* (*)();
  const auto get = library ? reinterpret_cast<Get>(dlsym(library, "DspaceImageCodec")) : nullptr;
  if (!get) {
    const char* reason = dlerror();
    throw Error(Error::Kind::Internal, "library '" + path + "'",
                "cannot be loaded: " + std::string(reason ? reason : "unknown reason") +
                    "; accepted: the library beside Dspace's others, and OpenImageIO");
  }
  IsLoaded = true;
  return *get();
}

} // namespace

bool ImageCodecIsLoaded() {
  return IsLoaded;
}

const ImageCodec& LoadImageCodec() {
  static const ImageCodec& codec = Load();
  return codec;
}

} // namespace dspace
