#include <dspace/messages/NearMatches.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace dspace::session {
namespace {

constexpr std::size_t Most = 3;
constexpr std::size_t Longest = 255; // bytes that are compared

// The last part of a path, in lower case.
std::string LastPart(const std::string& path) {
  std::string part = path.substr(path.rfind('/') + 1).substr(0, Longest);
  std::transform(part.begin(), part.end(), part.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return part;
}

std::size_t Distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t corner = i;
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = corner + (a[i] == b[j] ? 0 : 1);
      corner = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row[b.size()];
}

} // namespace

std::vector<std::string> NearMatches(const std::string& wanted,
                                     const std::vector<std::string>& names) {
  const std::string part = LastPart(wanted);
  std::vector<std::pair<std::size_t, std::string>> found;
  for (const std::string& name : names) {
    const std::string other = LastPart(name);
    const std::size_t shorter = std::min(part.size(), other.size());
    const std::size_t longer = std::max(part.size(), other.size());
    if (shorter == 0) {
      continue;
    }
    const std::size_t allowed = (part.size() + 2) / 3;
    const bool contains = shorter >= 3 && (part.find(other) != std::string::npos ||
                                           other.find(part) != std::string::npos);
    const std::size_t distance = longer - shorter > allowed ? allowed + 1 : Distance(part, other);
    if (distance <= allowed && distance < part.size()) {
      found.emplace_back(distance, name);
    } else if (contains) {
      found.emplace_back(Longest + longer - shorter, name);
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> nearest;
  for (const auto& [distance, name] : found) {
    if (nearest.size() == Most) {
      break;
    }
    nearest.push_back(name);
  }
  return nearest;
}

std::string NearMatchesText(const std::string& wanted, const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : NearMatches(wanted, names)) {
    text += (text.empty() ? "; near matches: '" : ", '") + name + "'";
  }
  return text;
}

} // namespace dspace::session
