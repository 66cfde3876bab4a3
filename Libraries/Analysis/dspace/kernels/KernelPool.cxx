#include <dspace/kernels/KernelPool.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/Error.h>

namespace dspace {
namespace {

std::string Place(const std::string& file, int line) {
  return "text kernel '" + file + "', line " + std::to_string(line);
}

bool IsBookkeeping(const std::string& name) {
  return name == "TEXT_KERNEL_ID" || name == "SCLK_KERNEL_ID" || name == "KERNELS_TO_LOAD" ||
         name == "PATH_SYMBOLS" || name == "PATH_VALUES";
}

// Levenshtein's distance of the upper-case texts.
std::size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) {
    row[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      const bool same = std::toupper(static_cast<unsigned char>(a[i - 1])) ==
                        std::toupper(static_cast<unsigned char>(b[j - 1]));
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (same ? 0 : 1)});
      diagonal = above;
    }
  }
  return row.back();
}

} // namespace

void KernelPool::Add(const TextKernel& kernel) {
  std::map<std::string, KernelVariable> changed; // applied when all are checked
  std::vector<KernelConflict> conflicts;
  for (const KernelAssignment& assignment : kernel.Assignments()) {
    auto found = changed.find(assignment.name);
    if (found == changed.end()) {
      const KernelVariable* present = this->Find(assignment.name);
      found = changed.emplace(assignment.name, present ? *present : KernelVariable()).first;
    }
    KernelVariable& variable = found->second;
    const bool exists = variable.Size() > 0;
    if (assignment.append && exists) {
      if (variable.isText != assignment.isText) {
        throw Error(Error::Kind::Corrupt, Place(kernel.Name(), assignment.line),
                    "variable " + assignment.name + " has " +
                        (variable.isText ? "texts" : "numbers") + " from '" + variable.file +
                        "' and += appends " + (assignment.isText ? "texts" : "numbers") +
                        "; accepted: values of one kind");
      }
      variable.numbers.insert(variable.numbers.end(), assignment.numbers.begin(),
                              assignment.numbers.end());
      variable.texts.insert(variable.texts.end(), assignment.texts.begin(), assignment.texts.end());
    } else {
      const bool differs = variable.isText != assignment.isText ||
                           variable.numbers != assignment.numbers ||
                           variable.texts != assignment.texts;
      if (exists && differs && variable.file != kernel.Name() && !IsBookkeeping(assignment.name)) {
        conflicts.push_back({assignment.name, kernel.Name(), variable.file});
      }
      variable.isText = assignment.isText;
      variable.numbers = assignment.numbers;
      variable.texts = assignment.texts;
    }
    variable.file = kernel.Name();
    variable.line = assignment.line;
  }
  for (auto& [name, variable] : changed) {
    this->Variables_[name] = std::move(variable);
  }
  this->Conflicts_.insert(this->Conflicts_.end(), conflicts.begin(), conflicts.end());
}

const KernelVariable* KernelPool::Find(const std::string& name) const {
  const auto found = this->Variables_.find(name);
  return found == this->Variables_.end() ? nullptr : &found->second;
}

const KernelVariable& KernelPool::Get(const std::string& name) const {
  if (const KernelVariable* variable = this->Find(name)) {
    return *variable;
  }
  throw Error(Error::Kind::NotFound, "kernel variable '" + name + "'",
              "no loaded text kernel assigns it");
}

const std::vector<double>& KernelPool::Numbers(const std::string& name, std::size_t count) const {
  const KernelVariable& variable = this->Get(name);
  if (variable.isText || (count != 0 && variable.numbers.size() != count)) {
    throw Error(Error::Kind::Corrupt, Place(variable.file, variable.line),
                "variable " + name + " has " + std::to_string(variable.Size()) +
                    (variable.isText ? " texts" : " numbers") + "; accepted: " +
                    (count == 0 ? std::string("numbers")
                                : std::to_string(count) + (count == 1 ? " number" : " numbers")));
  }
  return variable.numbers;
}

const std::vector<std::string>& KernelPool::Texts(const std::string& name) const {
  const KernelVariable& variable = this->Get(name);
  if (!variable.isText) {
    throw Error(Error::Kind::Corrupt, Place(variable.file, variable.line),
                "variable " + name + " has numbers; accepted: texts");
  }
  return variable.texts;
}

int KernelPool::Integer(const std::string& name) const {
  const double value = this->Number(name);
  if (value != std::floor(value) || std::abs(value) > 2147483647.0) {
    const KernelVariable& variable = this->Get(name);
    throw Error(Error::Kind::Corrupt, Place(variable.file, variable.line),
                "variable " + name + " is " + NumberText(value) +
                    "; accepted: a whole number within 2147483647");
  }
  return int(value);
}

const std::string& KernelPool::Text(const std::string& name) const {
  const std::vector<std::string>& texts = this->Texts(name);
  if (texts.size() != 1) {
    const KernelVariable& variable = this->Get(name);
    throw Error(Error::Kind::Corrupt, Place(variable.file, variable.line),
                "variable " + name + " has " + std::to_string(texts.size()) +
                    " texts; accepted: 1 text");
  }
  return texts[0];
}

std::string NearMatches(const std::string& wanted, const std::vector<std::string>& names) {
  std::vector<std::pair<std::size_t, std::string>> ranked;
  const std::size_t most = std::max<std::size_t>(2, wanted.size() / 3);
  for (const std::string& name : names) {
    const std::size_t distance = EditDistance(wanted.substr(0, 64), name);
    const auto holds = [](const std::string& whole, const std::string& part) {
      return part.size() >= 3 &&
             std::search(whole.begin(), whole.end(), part.begin(), part.end(), [](char a, char b) {
               return std::toupper(static_cast<unsigned char>(a)) ==
                      std::toupper(static_cast<unsigned char>(b));
             }) != whole.end();
    };
    if (distance <= most) {
      ranked.emplace_back(distance, name);
    } else if (holds(name, wanted) || holds(wanted, name)) {
      ranked.emplace_back(most + distance, name);
    }
  }
  std::sort(ranked.begin(), ranked.end());
  std::string out;
  for (std::size_t i = 0; i < ranked.size() && i < 5; ++i) {
    out += (i ? ", '" : "'") + ranked[i].second + "'";
  }
  return out;
}

} // namespace dspace
