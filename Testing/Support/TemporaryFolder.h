// A folder for the files of a test, which nobody else has.
#ifndef DSPACE_TEST_TEMPORARYFOLDER_H
#define DSPACE_TEST_TEMPORARYFOLDER_H

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

namespace dspace::testing {

// Empty and new: no name of a killed run, or of a process of the same number in another container,
// is met again. Removed with all that is in it.
class TemporaryFolder {
public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "dspace-test-XXXXXX").string();
    if (!::mkdtemp(name.data())) {
      throw std::runtime_error("no folder '" + name + "' can be made for the files of a test");
    }
    this->Path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(this->Path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& Path() const { return this->Path_; }
  std::string operator/(const std::string& name) const { return (this->Path_ / name).string(); }

private:
  std::filesystem::path Path_;
};

} // namespace dspace::testing

#endif
