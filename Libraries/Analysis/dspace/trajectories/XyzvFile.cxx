#include <dspace/trajectories/XyzvFile.h>

#include <utility>

#include <dspace/time/Days.h>
#include <dspace/trajectories/TextLines.h>

namespace dspace {
namespace {

// What follows `key` in a comment, without the id in parentheses.
bool Find(const std::string& line, const char* key, std::string& value) {
  const std::size_t at = line.find(key);
  if (at == std::string::npos || line.find_first_not_of("# \t") != at) {
    return false;
  }
  std::string rest = line.substr(at + std::string(key).size());
  rest = rest.substr(0, rest.find('('));
  const std::size_t first = rest.find_first_not_of(" \t");
  value = first == std::string::npos ? std::string()
                                     : rest.substr(first, rest.find_last_not_of(" \t") + 1 - first);
  return true;
}

} // namespace

XyzvFile::XyzvFile(const std::string& path) {
  TextLines lines(path);
  StateTable::Content content;
  content.interpolation = {Interpolation::Kind::Hermite, 3};
  while (lines.Next()) {
    if (lines.Line()[0] == '#') {
      Find(lines.Line(), "Observer:", this->Center_) ||
          Find(lines.Line(), "Target:", this->Target_) ||
          Find(lines.Line(), "Frame:", this->Frame_);
      continue;
    }
    const std::vector<std::string> words = lines.Words();
    if (words.size() != 7) {
      lines.Damaged("it has " + std::to_string(words.size()) +
                    " words; accepted: a Julian date, x, y, z [km], vx, vy, vz [km/s]");
    }
    double numbers[7];
    for (std::size_t i = 0; i < 7; ++i) {
      numbers[i] = lines.Number(words[i], i == 0 ? "the Julian date" : "a number of the state");
    }
    const double time = (numbers[0] - J2000Julian) * DaySeconds;
    if (!content.times.empty() && time <= content.times.back()) {
      if (time < content.times.back()) {
        lines.Damaged("its time " + words[0] + " is before that of the state before it");
      }
      content.times.pop_back();
      content.positions.pop_back();
      content.velocities.pop_back();
      ++this->Merged_;
    }
    content.times.push_back(time);
    content.positions.push_back(1000.0 * Eigen::Vector3d(numbers + 1));
    content.velocities.push_back(1000.0 * Eigen::Vector3d(numbers + 4));
  }
  this->Table_ = std::make_shared<StateTable>(lines.Label(), std::move(content));
}

} // namespace dspace
