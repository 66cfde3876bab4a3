// dspace-confine: gives up rights for good, then becomes another program.
#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <sys/prctl.h>
#include <unistd.h>

#include <dspace/confine/CallFilter.h>
#include <dspace/confine/FileRules.h>
#include <dspace/confine/TemporaryFolder.h>

namespace {

using dspace::confine::FileAccess;
using dspace::confine::FileRules;

constexpr int Failed = 126; // as a shell's, where a program cannot be executed

constexpr const char* Usage =
    R"(dspace-confine [RULE ...] -- PROGRAM [ARGUMENT ...]

Gives up all rights but those that the rules name, for good, then becomes the program. Files: Landlock;
system calls: seccomp.

  --read PATH      read a file, or a folder with all below
  --program PATH   the same, and execute what is there
  --write PATH     read, write, create and remove
  --socket FOLDER  create and remove Unix sockets in the folder
  --device PATH    read and write a device, with its ioctl calls
  --temporary PATH make a folder below PATH, which the program may write, for its temporary files
                   (TMPDIR); it is removed when the program has ended
  --listen         bind sockets and accept connections
  --listen-unix    the same, of Unix sockets alone
  --connect        connect to others
  --rules FD       more rules: words, each ended by a zero byte, from this descriptor
  --abi N          use Landlock as of version N, at most the kernel's; 0: do without it (for tests)

The program's environment variable DSPACE_CONFINED is "landlock N", or "no landlock" where the kernel
has none: then no rule restricts files. Exit code: the program's; 126 where it was not executed.
)";

struct Options {
  std::vector<std::pair<FileAccess, std::string>> files;
  dspace::confine::CallRules calls;
  int abi = FileRules::KernelAbi();
  std::string temporary; // empty: no folder
  std::vector<std::string> program;
};

[[noreturn]] void Reject(const std::string& why) {
  throw std::invalid_argument(why + "; see dspace-confine --help");
}

int NumberOf(const std::string& word, const std::string& text) {
  std::size_t used = 0;
  int number = -1;
  try {
    number = std::stoi(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != text.size() || number < 0) {
    Reject(word + " '" + text + "'; accepted: an integer of 0 or more");
  }
  return number;
}

std::vector<std::string> WordsOf(int descriptor) {
  std::vector<std::string> words(1);
  char block[65536];
  ssize_t size = 0;
  while ((size = read(descriptor, block, sizeof(block))) > 0) {
    for (const char c : std::string(block, std::size_t(size))) {
      if (c == '\0') {
        words.emplace_back();
      } else {
        words.back().push_back(c);
      }
    }
  }
  if (size < 0 || !words.back().empty()) {
    Reject("--rules " + std::to_string(descriptor) +
           ": it cannot be read, or its last word has no end");
  }
  words.pop_back();
  return words;
}

void Read(const std::vector<std::string>& words, Options& options) {
  const std::vector<std::pair<std::string, FileAccess>> kinds = {
      {"--read", FileAccess::Read},     {"--program", FileAccess::Program},
      {"--write", FileAccess::Write},   {"--socket", FileAccess::Socket},
      {"--device", FileAccess::Device},
  };
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "--") {
      options.program.assign(words.begin() + std::ptrdiff_t(i) + 1, words.end());
      return;
    }
    if (word == "--listen") {
      options.calls.listen = true;
      continue;
    }
    if (word == "--listen-unix") {
      options.calls.listenUnix = true;
      continue;
    }
    if (word == "--connect") {
      options.calls.connect = true;
      continue;
    }
    if (i + 1 == words.size()) {
      Reject("'" + word + "' is no rule, or its value is missing");
    }
    const std::string& value = words[++i];
    bool known = false;
    for (const auto& [name, access] : kinds) {
      if (word == name) {
        options.files.emplace_back(access, value);
        known = true;
      }
    }
    if (word == "--temporary") {
      options.temporary = value;
    } else if (word == "--rules") {
      Read(WordsOf(NumberOf(word, value)), options);
    } else if (word == "--abi") {
      options.abi = std::min(options.abi, NumberOf(word, value));
    } else if (!known) {
      Reject("'" + word + "' is no rule");
    }
  }
}

[[noreturn]] void Become(Options& options) {
  if (!options.temporary.empty()) {
    const std::string folder = dspace::confine::MakeTemporaryFolder(options.temporary);
    options.files.emplace_back(FileAccess::Write, folder);
    setenv("TMPDIR", folder.c_str(), 1);
  }
  FileRules rules(options.abi, options.calls.listen, options.calls.connect);
  for (const auto& [access, path] : options.files) {
    rules.Allow(path, access);
  }
  options.calls.truncate = options.abi >= 3;
  const std::string state =
      options.abi > 0 ? "landlock " + std::to_string(options.abi) : "no landlock";
  setenv("DSPACE_CONFINED", state.c_str(), 1);
  std::vector<char*> words;
  for (std::string& word : options.program) {
    words.push_back(word.data());
  }
  words.push_back(nullptr);
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) {
    throw std::system_error(errno, std::generic_category(), "no-new-privileges");
  }
  rules.Enforce();
  dspace::confine::FilterCalls(options.calls);
  closefrom(STDERR_FILENO + 1); // descriptors of the caller would reach files that no rule allows
  execvp(words[0], words.data());
  throw std::system_error(errno, std::generic_category(), "'" + options.program[0] + "'");
}

} // namespace

int main(int count, char** texts) {
  try {
    Options options;
    const std::vector<std::string> words(texts + 1, texts + count);
    if (!words.empty() && (words[0] == "--help" || words[0] == "-h")) {
      std::cout << Usage;
      return 0;
    }
    Read(words, options);
    if (options.program.empty()) {
      Reject("no program is given");
    }
    Become(options);
  } catch (const std::exception& error) {
    std::cerr << "dspace-confine: " << error.what() << "\n";
  }
  return Failed;
}
