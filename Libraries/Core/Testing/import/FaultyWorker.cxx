// A worker whose readers fail in every way, by the name of the file: for TestImportWorker.
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include <sys/socket.h>
#include <unistd.h>

#include <dspace/import/files/ImageReader.h>
#include <dspace/import/files/ImportFile.h>
#include <dspace/import/files/ModelReader.h>
#include <dspace/import/worker/WorkerProcess.h>

namespace {

dspace::Model Read(const std::string& path, const dspace::ImportOptions& options) {
  const std::string fault = std::filesystem::path(path).stem().string();
  if (fault == "abort") {
    std::abort();
  }
  if (fault == "memory") {
    std::vector<char*> blocks;
    for (;;) {
      constexpr std::size_t Block = std::size_t(1) << 22;
      blocks.push_back(new char[Block]);
      std::memset(blocks.back(), 1, Block);
    }
  }
  if (fault == "sleep") {
    std::this_thread::sleep_for(std::chrono::hours(1));
  }
  if (fault == "spin") {
    volatile std::uint64_t count = 0;
    for (;;) {
      count = count + 1;
    }
  }
  if (fault == "exit") {
    _exit(3);
  }
  if (fault == "liar") {              // a message of its own instead of a result
    const char bytes[] = "\6nothing"; // a kind, and a size that no message has
    for (int socket = 3; socket < 20; ++socket) {
      send(socket, bytes, sizeof bytes, MSG_NOSIGNAL);
    }
  }
  if (fault == "indices") {
    dspace::Model model = dspace::ReadModel(path, options);
    model.meshes[0].indices[0] = 1000000;
    return model;
  }
  if (fault == "outside") {
    dspace::ReadFileBytes("/etc/hostname");
  }
  return dspace::ReadModel(path, options);
}

} // namespace

int main() {
  return dspace::RunImportWorker({Read, dspace::ReadImage, dspace::ReadUrdf}, nullptr);
}
