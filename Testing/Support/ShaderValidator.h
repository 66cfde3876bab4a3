// Runs glslangValidator, the reference compiler of GLSL, on shader programs.
#ifndef DSPACE_TEST_SHADER_VALIDATOR_H
#define DSPACE_TEST_SHADER_VALIDATOR_H

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace dspace::testing {

class ShaderValidator {
public:
  // The program's files are in a folder of its own, which it removes.
  ShaderValidator() {
    std::string folder = (std::filesystem::temp_directory_path() / "shaders_XXXXXX").string();
    this->Folder_ = mkdtemp(folder.data()) ? folder : "";
  }
  ShaderValidator(const ShaderValidator&) = delete;
  ShaderValidator& operator=(const ShaderValidator&) = delete;
  ~ShaderValidator() {
    if (!this->Folder_.empty()) {
      std::filesystem::remove_all(this->Folder_);
    }
  }

  static bool Installed() {
    return std::system("command -v glslangValidator >/dev/null 2>&1") == 0;
  }

  // A text that was added before is not compiled again. `link`: the two are also linked, which
  // takes a process for each program.
  void Add(const std::string& name, const std::string& vertex, const std::string& fragment,
           bool link) {
    const std::string first = this->FileOf(name, vertex, ".vert");
    const std::string second = this->FileOf(name, fragment, ".frag");
    if (link) {
      this->Links_[first + " " + second] = name;
    }
  }

  // All texts: file by text.
  const std::map<std::string, std::string>& Texts() const { return this->Files_; }
  std::size_t Links() const { return this->Links_.size(); }

  // The errors with the names of the programs; empty: everything is valid.
  std::string Check() const {
    constexpr std::size_t Batch = 200; // files of a command, which has a limit
    std::string errors;
    std::string files;
    std::size_t count = 0;
    for (const auto& file : this->Names_) {
      files += file.first + " ";
      if (++count % Batch == 0 || count == this->Names_.size()) {
        errors += this->Run(files);
        files.clear();
      }
    }
    for (const auto& link : this->Links_) {
      errors += this->Run("-l " + link.first);
    }
    return errors;
  }

private:
  std::string FileOf(const std::string& name, const std::string& text, const char* stage) {
    std::string& file = this->Files_[text];
    if (file.empty()) {
      file = std::to_string(this->Files_.size()) + stage;
      std::ofstream(std::filesystem::path(this->Folder_) / file) << text;
      this->Names_[file] = name;
    }
    return file;
  }

  std::string Run(const std::string& arguments) const {
    const std::string command = "cd '" + this->Folder_ + "' && glslangValidator " + arguments;
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    if (!pipe) {
      return "glslangValidator cannot be started\n";
    }
    std::string shown;
    std::string current; // program
    char line[4096];
    while (std::fgets(line, sizeof line, pipe)) {
      std::string text = line;
      text.erase(text.find_last_not_of("\r\n") + 1);
      const auto named = this->Names_.find(text);
      if (named != this->Names_.end()) {
        current = named->second + " (" + text + ")";
      } else if (!text.empty()) {
        shown += current + ": " + text + "\n";
      }
    }
    const int status = pclose(pipe);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
      return ""; // warnings at most
    }
    return shown.empty() ? "glslangValidator failed: " + arguments + "\n" : shown;
  }

  std::string Folder_;
  std::map<std::string, std::string> Files_; // by text
  std::map<std::string, std::string> Names_; // programs, by file
  std::map<std::string, std::string> Links_; // programs, by their two files
};

} // namespace dspace::testing

#endif
