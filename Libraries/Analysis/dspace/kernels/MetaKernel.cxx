#include <dspace/kernels/MetaKernel.h>

#include <cctype>
#include <filesystem>
#include <map>

#include <dspace/Error.h>

namespace dspace {
namespace {

// The texts of all assignments of a name, and the line of the last.
struct Collected {
  std::vector<std::string> texts;
  int line = 0;
};

Collected Collect(const TextKernel& kernel, const std::string& name) {
  Collected out;
  std::string open; // a text that '+' continues
  for (const KernelAssignment& assignment : kernel.Assignments()) {
    if (assignment.name != name) {
      continue;
    }
    if (!assignment.isText) {
      throw Error(Error::Kind::Corrupt,
                  "text kernel '" + kernel.Name() + "', line " + std::to_string(assignment.line),
                  name + " has numbers; accepted: texts");
    }
    if (!assignment.append) {
      out.texts.clear();
    }
    out.line = assignment.line;
    for (const std::string& text : assignment.texts) {
      if (!text.empty() && text.back() == '+') {
        open += text.substr(0, text.size() - 1);
      } else {
        out.texts.push_back(open + text);
        open.clear();
      }
    }
  }
  if (!open.empty()) {
    throw Error(Error::Kind::Corrupt,
                "text kernel '" + kernel.Name() + "', line " + std::to_string(out.line),
                name + " ends with '" + open + "+', which nothing continues");
  }
  return out;
}

bool IsSymbolCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

} // namespace

bool IsMetaKernel(const TextKernel& kernel) {
  for (const KernelAssignment& assignment : kernel.Assignments()) {
    if (assignment.name == "KERNELS_TO_LOAD") {
      return true;
    }
  }
  return false;
}

std::vector<std::string> KernelsToLoad(const TextKernel& kernel) {
  const Collected files = Collect(kernel, "KERNELS_TO_LOAD");
  const Collected symbols = Collect(kernel, "PATH_SYMBOLS");
  const Collected values = Collect(kernel, "PATH_VALUES");
  const auto fail = [&](int line, const std::string& what) {
    throw Error(Error::Kind::Corrupt,
                "text kernel '" + kernel.Name() + "', line " + std::to_string(line), what);
  };
  if (symbols.texts.size() != values.texts.size()) {
    fail(symbols.line, "PATH_SYMBOLS has " + std::to_string(symbols.texts.size()) +
                           " texts and PATH_VALUES " + std::to_string(values.texts.size()) +
                           "; accepted: as many values as symbols");
  }
  std::map<std::string, std::string> table;
  for (std::size_t i = 0; i < symbols.texts.size(); ++i) {
    table[symbols.texts[i]] = values.texts[i];
  }
  const std::filesystem::path folder = std::filesystem::path(kernel.Name()).parent_path();
  std::vector<std::string> out;
  for (const std::string& text : files.texts) {
    std::string path;
    for (std::size_t i = 0; i < text.size();) {
      if (text[i] != '$') {
        path += text[i++];
        continue;
      }
      std::size_t end = i + 1;
      while (end < text.size() && IsSymbolCharacter(text[end])) {
        ++end;
      }
      const auto found = table.find(text.substr(i + 1, end - i - 1));
      if (found == table.end()) {
        fail(files.line, "'" + text + "' uses the symbol " + text.substr(i, end - i) +
                             ", which PATH_SYMBOLS does not list");
      }
      path += found->second;
      i = end;
    }
    std::error_code ignored;
    const std::filesystem::path beside = folder / path;
    out.push_back(std::filesystem::path(path).is_relative() &&
                          std::filesystem::exists(beside, ignored)
                      ? beside.lexically_normal().string()
                      : path);
  }
  return out;
}

} // namespace dspace
