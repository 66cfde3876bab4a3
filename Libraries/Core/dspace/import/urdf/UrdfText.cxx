#include <dspace/import/urdf/UrdfText.h>

#include <algorithm>
#include <mutex>

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <dspace/Error.h>
#include <dspace/Utf8.h>

#include <dspace/import/files/ImportFile.h>
#include <dspace/import/urdf/UrdfRepair.h>

namespace dspace {

namespace {

// Collects what urdfdom logs, from construction to destruction. console_bridge has one handler a
// process, hence the lock.
class LogCapture : public console_bridge::OutputHandler {
public:
  LogCapture() : Lock_(Mutex()), Previous_(console_bridge::getOutputHandler()) {
    console_bridge::useOutputHandler(this);
  }
  ~LogCapture() override { console_bridge::useOutputHandler(this->Previous_); }

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_WARN && this->Messages.size() < 100) {
      this->Messages.push_back(text);
    }
  }

  std::vector<std::string> Messages;

private:
  static std::mutex& Mutex() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> Lock_;
  console_bridge::OutputHandler* Previous_;
};

// Where a tag that starts at `at` ends: past its '>'.
std::size_t TagEnd(const std::string& text, std::size_t at) {
  char quote = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != 0) {
      quote = c == quote ? '\0' : quote;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return at + 1;
    }
  }
  return text.size();
}

// Deepest nesting of elements, counted as the parser recurses.
int XmlDepth(const std::string& text) {
  int depth = 0, deepest = 0;
  for (std::size_t at = text.find('<'); at < text.size(); at = text.find('<', at)) {
    const auto skip = [&](const char* open, const char* close) {
      const std::string start = open;
      if (text.compare(at, start.size(), start) != 0) {
        return false;
      }
      const std::size_t end = text.find(close, at + start.size());
      at = end == std::string::npos ? text.size() : end + 1;
      return true;
    };
    if (skip("<!--", "-->") || skip("<![CDATA[", "]]>") || skip("<!", ">") || skip("<?", ">")) {
      continue;
    }
    const std::size_t end = TagEnd(text, at);
    if (text.compare(at, 2, "</") == 0) {
      depth = depth > 0 ? depth - 1 : 0;
    } else if (end < 2 || text[end - 1] != '>' || text[end - 2] != '/') {
      deepest = std::max(deepest, ++depth);
    }
    at = end;
  }
  return deepest;
}

urdf::ModelInterfaceSharedPtr Parse(const std::string& text, LogCapture& log) {
  try {
    return urdf::parseURDF(text);
  } catch (const std::exception& e) {
    log.Messages.push_back(e.what());
    return nullptr;
  }
}

} // namespace

urdf::ModelInterfaceSharedPtr ParseUrdfText(const std::string& path, const std::string& text,
                                            std::vector<std::string>& warnings,
                                            GroupedWarnings* repairs) {
  if (text.find('\0') != std::string::npos) {
    throw Error(Error::Kind::Corrupt, FileObject(path), "is not a URDF: it has zero bytes");
  }
  const int depth = XmlDepth(text);
  if (depth > MaximumUrdfDepth) {
    throw Error(Error::Kind::Corrupt, FileObject(path),
                "its XML is nested " + std::to_string(depth) + " deep; at most " +
                    std::to_string(MaximumUrdfDepth) + " is accepted");
  }
  LogCapture log;
  urdf::ModelInterfaceSharedPtr model = Parse(text, log);
  // It drops the rest of a link after something that it cannot read, and only logs that.
  if ((!model || !log.Messages.empty()) && repairs) {
    log.Messages.clear();
    model = Parse(RepairUrdfText(text, *repairs), log);
  }
  if (!model || (!log.Messages.empty() && !repairs)) {
    std::string message = "is not a valid URDF";
    for (std::size_t i = 0; i < log.Messages.size() && i < 4; ++i) {
      message += (i == 0 ? ": " : "; ") + log.Messages[i];
    }
    throw Error(Error::Kind::Corrupt, FileObject(path), message);
  }
  warnings.insert(warnings.end(), log.Messages.begin(), log.Messages.end());
  return model;
}

} // namespace dspace
