#include <dspace/trajectories/OemFile.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include <dspace/Checks.h>
#include <dspace/time/UtcText.h>
#include <dspace/trajectories/TextLines.h>

namespace dspace {
namespace {

constexpr double TaiMinusGps = 19.0; // [s]

std::string Upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return char(std::toupper(c)); });
  return text;
}

std::string Trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

bool IsComment(const std::string& line) {
  return line.compare(0, 7, "COMMENT") == 0;
}

// One pass over a file.
class Reader {
public:
  Reader(const std::string& path, const TimeScales& scales) : Lines_(path), Scales_(scales) {}

  struct Metadata {
    std::map<std::string, std::string> values;
    const std::string& Get(const std::string& key) const {
      static const std::string none;
      const auto found = this->values.find(key);
      return found == this->values.end() ? none : found->second;
    }
  };

  TextLines& Lines() { return this->Lines_; }

  // "KEY = VALUE" of the present line.
  std::pair<std::string, std::string> Pair() const {
    const std::string& line = this->Lines_.Line();
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos) {
      this->Lines_.Damaged("it reads '" + line.substr(0, 60) + "'; accepted: KEYWORD = value");
    }
    const std::pair<std::string, std::string> pair = {Trimmed(line.substr(0, equals)),
                                                      Trimmed(line.substr(equals + 1))};
    if (pair.second.empty()) {
      this->Lines_.Damaged("the keyword " + pair.first + " has no value");
    }
    return pair;
  }

  Metadata ReadMetadata() {
    Metadata data;
    while (this->Lines_.Next()) {
      const std::string& line = this->Lines_.Line();
      if (line == "META_STOP") {
        for (const char* key : {"OBJECT_NAME", "OBJECT_ID", "CENTER_NAME", "REF_FRAME",
                                "TIME_SYSTEM", "START_TIME", "STOP_TIME"}) {
          if (data.Get(key).empty()) {
            this->Lines_.Damaged(std::string("the metadata before it has no ") + key);
          }
        }
        return data;
      }
      if (!IsComment(line)) {
        const auto [key, value] = this->Pair();
        static const std::set<std::string> known = {
            "OBJECT_NAME",       "OBJECT_ID",   "CENTER_NAME",   "REF_FRAME",
            "REF_FRAME_EPOCH",   "TIME_SYSTEM", "START_TIME",    "USEABLE_START_TIME",
            "USEABLE_STOP_TIME", "STOP_TIME",   "INTERPOLATION", "INTERPOLATION_DEGREE"};
        if (!known.count(key)) {
          this->Lines_.Damaged("the keyword " + key + " is unknown in metadata");
        }
        if (!data.values.emplace(key, value).second) {
          this->Lines_.Damaged("the keyword " + key + " is there twice");
        }
      }
    }
    this->Lines_.Damaged("the file ends within metadata");
  }

  double Time(const std::string& text, const std::string& system) const {
    try {
      std::string plain = text;
      if (!plain.empty() && plain.back() == 'Z') {
        plain.pop_back();
      }
      if (system == "GPS") {
        return TdbFromText(plain + " TAI", this->Scales_) + TaiMinusGps;
      }
      return TdbFromText(plain + " " + system, this->Scales_);
    } catch (const Error& error) {
      this->Lines_.Damaged(error.what());
    }
  }

  // The states up to the next META_START or the end; whether there is one.
  bool ReadStates(const std::string& system, StateTable::Content& content) {
    while (this->Lines_.Next()) {
      const std::string& line = this->Lines_.Line();
      if (line == "META_START") {
        return true;
      }
      if (line == "COVARIANCE_START") {
        this->SkipCovariance();
        continue;
      }
      if (IsComment(line)) {
        continue;
      }
      const std::vector<std::string> words = this->Lines_.Words();
      if (words.size() != 7 && words.size() != 10) {
        this->Lines_.Damaged(
            "it has " + std::to_string(words.size()) +
            " words; accepted: a time, x, y, z, vx, vy, vz, and three accelerations "
            "or none");
      }
      double numbers[9];
      for (std::size_t i = 1; i < words.size(); ++i) {
        numbers[i - 1] = this->Lines_.Number(words[i], "a number of the state");
      }
      const double time = this->Time(words[0], system);
      if (!content.times.empty() && time <= content.times.back()) {
        this->Lines_.Damaged("its time " + words[0] + " is not after that of the state before it");
      }
      content.times.push_back(time);
      content.positions.push_back(1000.0 * Eigen::Vector3d(numbers));
      content.velocities.push_back(1000.0 * Eigen::Vector3d(numbers + 3));
    }
    return false;
  }

private:
  void SkipCovariance() {
    while (this->Lines_.Next()) {
      const std::string& line = this->Lines_.Line();
      if (line == "COVARIANCE_STOP") {
        return;
      }
      if (IsComment(line)) {
        continue;
      }
      if (line.find('=') != std::string::npos) {
        this->Pair();
        continue;
      }
      for (const std::string& word : this->Lines_.Words()) {
        this->Lines_.Number(word, "a number of the covariance");
      }
    }
    this->Lines_.Damaged("the file ends within a covariance block");
  }

  TextLines Lines_;
  const TimeScales& Scales_;
};

Interpolation InterpolationOf(const Reader::Metadata& data, std::size_t states, TextLines& lines) {
  Interpolation by;
  const std::string kind = Upper(data.Get("INTERPOLATION"));
  const std::string degree = data.Get("INTERPOLATION_DEGREE");
  if (kind.empty()) {
    if (!degree.empty()) {
      lines.Damaged("the block before it has an INTERPOLATION_DEGREE without an INTERPOLATION");
    }
    by.degree = int(std::min<std::size_t>(7, 2 * states - 1));
    return by;
  }
  if (kind == "LINEAR") {
    by.kind = Interpolation::Kind::Linear;
    by.degree = 1;
  } else if (kind == "LAGRANGE") {
    by.kind = Interpolation::Kind::Lagrange;
  } else if (kind != "HERMITE") {
    lines.Damaged("the block before it has the INTERPOLATION " + kind +
                  "; accepted: LINEAR, LAGRANGE, HERMITE");
  }
  if (degree.empty()) {
    if (by.kind != Interpolation::Kind::Linear) {
      lines.Damaged("the block before it has an INTERPOLATION without an INTERPOLATION_DEGREE");
    }
    return by;
  }
  const double number = lines.Number(degree, "the INTERPOLATION_DEGREE");
  if (number < 1.0 || number > 31.0 || number != std::floor(number)) {
    lines.Damaged("the INTERPOLATION_DEGREE is " + degree + "; accepted: 1 to 31");
  }
  by.degree = int(number);
  if (by.kind == Interpolation::Kind::Linear && by.degree != 1) {
    lines.Damaged("the INTERPOLATION_DEGREE is " + degree + "; accepted for LINEAR: 1");
  }
  return by;
}

} // namespace

OemFile::OemFile(const std::string& path, const TimeScales& scales) {
  Reader reader(path, scales);
  TextLines& lines = reader.Lines();
  this->Label_ = lines.Label();
  bool version = false;
  bool metadata = false;
  while (!metadata && lines.Next()) {
    if (IsComment(lines.Line())) {
      continue;
    }
    if (lines.Line() == "META_START") {
      metadata = true;
      break;
    }
    if (!version && lines.Line().compare(0, 5, "<?xml") == 0) {
      throw Error(Error::Kind::Unsupported, this->Label_,
                  "it is XML; accepted: keyword-value notation");
    }
    const auto [key, value] = reader.Pair();
    if (!version && key != "CCSDS_OEM_VERS") {
      lines.Damaged("it begins with " + key +
                    "; accepted: an OEM, which begins with CCSDS_OEM_VERS");
    }
    if (!version && value != "1.0" && value != "2.0" && value != "3.0") {
      throw Error(Error::Kind::Unsupported, this->Label_,
                  "its version is " + value + "; accepted: 1.0, 2.0, 3.0");
    }
    version = true;
    if (key == "ORIGINATOR") {
      this->Originator_ = value;
    }
  }
  if (!version || !metadata) {
    lines.Damaged("it is the last line; accepted: an OEM with CCSDS_OEM_VERS and metadata");
  }
  std::vector<std::shared_ptr<const StateTable>> tables;
  while (metadata) {
    const Reader::Metadata data = reader.ReadMetadata();
    Block block;
    block.center = data.Get("CENTER_NAME");
    block.frame = data.Get("REF_FRAME");
    block.timeSystem = Upper(data.Get("TIME_SYSTEM"));
    static const std::set<std::string> systems = {"UTC", "TAI", "TT", "TDB", "GPS"};
    if (!systems.count(block.timeSystem)) {
      throw Error(Error::Kind::Unsupported, this->Label_,
                  "its TIME_SYSTEM is " + block.timeSystem + "; accepted: UTC, TAI, TT, TDB, GPS");
    }
    if (this->Blocks_.empty()) {
      this->ObjectName_ = data.Get("OBJECT_NAME");
      this->ObjectId_ = data.Get("OBJECT_ID");
    } else if (data.Get("OBJECT_ID") != this->ObjectId_) {
      Reject(this->Label_, "it has blocks of the objects " + this->ObjectId_ + " and " +
                               data.Get("OBJECT_ID") + "; accepted: of one");
    }
    StateTable::Content content;
    const std::string& useable = data.Get("USEABLE_START_TIME");
    const std::string& last = data.Get("USEABLE_STOP_TIME");
    const double start = reader.Time(data.Get("START_TIME"), block.timeSystem);
    const double stop = reader.Time(data.Get("STOP_TIME"), block.timeSystem);
    if (stop < start) {
      lines.Damaged("the STOP_TIME before it is earlier than the START_TIME");
    }
    content.useable.begin = useable.empty() ? start : reader.Time(useable, block.timeSystem);
    content.useable.end = last.empty() ? stop : reader.Time(last, block.timeSystem);
    metadata = reader.ReadStates(block.timeSystem, content);
    if (content.times.empty()) {
      lines.Damaged("the block before it has no states");
    }
    content.interpolation = InterpolationOf(data, content.times.size(), lines);
    block.interpolationStated = !data.Get("INTERPOLATION").empty();
    block.table = std::make_shared<StateTable>(
        this->Label_ + ", block " + std::to_string(this->Blocks_.size() + 1), std::move(content));
    tables.push_back(block.table);
    this->Blocks_.push_back(std::move(block));
  }
  this->Joined_ = std::make_shared<JoinedTables>(this->Label_, std::move(tables));
}

TrajectoryPtr OemFile::GetTrajectory() const {
  const Block& first = this->Blocks_.front();
  for (const Block& block : this->Blocks_) {
    if (block.center != first.center || block.frame != first.frame) {
      throw Error(Error::Kind::Unsupported, this->Label_,
                  "it has blocks about " + first.center + " in " + first.frame + " and about " +
                      block.center + " in " + block.frame + "; accepted: one centre and frame");
    }
  }
  return this->Joined_;
}

std::string OemFile::Frame() const {
  const std::string frame = Upper(this->Blocks_.front().frame);
  return frame == "EME2000" || frame == "ICRF" || frame == "GCRF" || frame == "J2000" ? "J2000"
                                                                                      : frame;
}

} // namespace dspace
