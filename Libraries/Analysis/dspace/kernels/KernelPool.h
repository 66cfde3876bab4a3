// The variables of all text kernels that are loaded.
#ifndef DSPACE_KERNELS_KERNEL_POOL_H
#define DSPACE_KERNELS_KERNEL_POOL_H

#include <map>
#include <string>
#include <vector>

#include <dspace/kernels/TextKernel.h>

namespace dspace {

// A variable and where its present value was assigned.
struct KernelVariable {
  bool isText = false;
  std::vector<double> numbers;
  std::vector<std::string> texts;
  std::string file; // the last that assigned or appended to it
  int line = 0;

  std::size_t Size() const { return this->isText ? this->texts.size() : this->numbers.size(); }
};

// Where a later kernel replaced the value of an earlier one by a different value.
struct KernelConflict {
  std::string name;
  std::string winner; // file
  std::string loser;  // file
};

// The pool of variables (NAIF, "Kernel Required Reading"): a later assignment replaces an earlier
// one, "+=" appends to it. Loading is atomic: a kernel that is rejected changes nothing.
class KernelPool {
public:
  // Adds the assignments of a kernel. Throws Error(Corrupt), naming file, line and variable, where
  // "+=" appends numbers to texts or the reverse.
  void Add(const TextKernel& kernel);

  bool Empty() const { return this->Variables_.empty(); }
  const std::map<std::string, KernelVariable>& Variables() const { return this->Variables_; }
  // Null: there is no such variable.
  const KernelVariable* Find(const std::string& name) const;
  bool Has(const std::string& name) const { return this->Find(name) != nullptr; }

  // The numbers of a variable. Throws Error(NotFound) where there is none of this name, and
  // Error(Corrupt), naming the file and line, where it holds texts or another count than `count`
  // (0: any).
  const std::vector<double>& Numbers(const std::string& name, std::size_t count = 0) const;
  const std::vector<std::string>& Texts(const std::string& name) const;
  double Number(const std::string& name) const { return this->Numbers(name, 1)[0]; }
  // A whole number within int. Throws as Numbers, also for a fraction.
  int Integer(const std::string& name) const;
  const std::string& Text(const std::string& name) const;

  // Which kernel won where two gave a variable different values, in the order of loading. The
  // variables that every kernel of a kind has (TEXT_KERNEL_ID, KERNELS_TO_LOAD, ...) are left out.
  const std::vector<KernelConflict>& Conflicts() const { return this->Conflicts_; }

private:
  const KernelVariable& Get(const std::string& name) const;

  std::map<std::string, KernelVariable> Variables_;
  std::vector<KernelConflict> Conflicts_;
};

// The names among `names` that are closest to `wanted`, best first, for errors: "'MARS', 'MARS
// BARYCENTER'". Empty: none is close.
std::string NearMatches(const std::string& wanted, const std::vector<std::string>& names);

} // namespace dspace

#endif
