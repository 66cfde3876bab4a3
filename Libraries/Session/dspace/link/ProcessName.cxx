#include <dspace/link/ProcessName.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include <unistd.h>

namespace dspace::session {
namespace {

std::string Boot() {
  std::string id;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> id;
  return id;
}

std::string Namespace() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/ns/pid", error).string();
}

// What /proc/NUMBER/stat says behind the program's name, which may hold anything: state, ..., the
// 20th is when it began.
std::vector<std::string> Stat(long number) {
  std::ifstream file("/proc/" + std::to_string(number) + "/stat");
  std::string line;
  std::getline(file, line);
  const std::size_t name = line.rfind(')');
  std::istringstream rest(name == std::string::npos ? "" : line.substr(name + 1));
  std::vector<std::string> fields;
  for (std::string field; rest >> field;) {
    fields.push_back(field);
  }
  return fields;
}

constexpr std::size_t Began = 19;

} // namespace

std::string ProcessName() {
  const std::string boot = Boot();
  const std::string space = Namespace();
  const auto stat = Stat(getpid());
  if (boot.empty() || space.empty() || stat.size() <= Began) {
    return {};
  }
  return boot + " " + space + " " + std::to_string(getpid()) + " " + stat[Began];
}

bool HasDied(const std::string& name) {
  std::istringstream text(name);
  std::string boot;
  std::string space;
  std::string began;
  long number = 0;
  if (!(text >> boot >> space >> number >> began) || number < 1 || boot != Boot() ||
      space != Namespace()) {
    return false;
  }
  if (kill(pid_t(number), 0) != 0 && errno == ESRCH) {
    return true;
  }
  const auto stat = Stat(number);
  return stat.size() > Began && (stat[0] == "Z" || stat[0] == "X" || stat[Began] != began);
}

} // namespace dspace::session
