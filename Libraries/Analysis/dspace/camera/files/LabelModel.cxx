#include <dspace/camera/files/LabelModel.h>

#include <cctype>
#include <map>

#include <dspace/Checks.h>
#include <dspace/camera/files/ModelText.h>

namespace dspace {
namespace {

using Values = std::map<std::string, std::string>; // the first of each keyword

bool IsWord(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == ':' || c == '^' ||
         c == '.';
}

// "KEYWORD = value" pairs, one after the other, whatever is between them: a value is a quoted text,
// a list in brackets or a word.
class Pairs {
public:
  Pairs(const std::string& text, std::size_t begin, const std::string& label)
      : Text_(text), At_(begin), Label_(label) {}

  // False at the end, and where a NUL byte ends the label.
  bool Next(std::string& keyword, std::string& value) {
    const std::string& text = this->Text_;
    for (;;) {
      while (this->At_ < text.size() && text[this->At_] != '\0' && !IsWord(text[this->At_])) {
        if (text.compare(this->At_, 2, "/*") == 0) {
          const std::size_t end = text.find("*/", this->At_);
          this->At_ = end == std::string::npos ? text.size() : end + 2;
        } else {
          ++this->At_;
        }
      }
      if (this->At_ >= text.size() || text[this->At_] == '\0') {
        return false;
      }
      const std::size_t begin = this->At_;
      while (this->At_ < text.size() && IsWord(text[this->At_])) {
        ++this->At_;
      }
      keyword = text.substr(begin, this->At_ - begin);
      if (keyword == "END_GROUP") {
        value.clear();
        return true;
      }
      this->SkipBlanks();
      if (this->At_ < text.size() && text[this->At_] == '=') {
        ++this->At_;
        this->SkipBlanks();
        value = this->Value();
        return true;
      }
    }
  }

private:
  void SkipBlanks() {
    while (this->At_ < this->Text_.size() &&
           std::isspace(static_cast<unsigned char>(this->Text_[this->At_]))) {
      ++this->At_;
    }
  }
  std::string Value() {
    const std::string& text = this->Text_;
    const char first = this->At_ < text.size() ? text[this->At_] : '\0';
    std::size_t end = std::string::npos;
    if (first == '"' || first == '\'') {
      end = text.find(first, this->At_ + 1);
    } else if (first == '(' || first == '{') {
      end = text.find(first == '(' ? ')' : '}', this->At_);
    } else {
      end = this->At_;
      while (end < text.size() && !std::isspace(static_cast<unsigned char>(text[end])) &&
             text[end] != '\0') {
        ++end;
      }
      const std::string word = text.substr(this->At_, end - this->At_);
      this->At_ = end;
      return word;
    }
    if (end == std::string::npos) {
      throw Error(Error::Kind::Corrupt, this->Label_, "the label ends within a value");
    }
    const std::string value = text.substr(this->At_ + 1, end - this->At_ - 1);
    this->At_ = end + 1;
    return value;
  }

  const std::string& Text_;
  std::size_t At_;
  const std::string& Label_;
};

bool IsVicar(const std::string& text) {
  return text.compare(0, 8, "LBLSIZE=") == 0;
}

// The pairs of the group or property; `size` gets the image's width and height.
Values ModelOf(const std::string& text, const std::string& label, int size[2]) {
  Pairs pairs(text, 0, label);
  const bool vicar = IsVicar(text);
  const char* opens = vicar ? "PROPERTY" : "GROUP";
  std::string keyword, value;
  Values values;
  bool inside = false, found = false, whole = false, image = false;
  const auto side = [&](int at) {
    size[at] = ImageSide(NumberIn(value, label), "a side of its image", label);
  };
  while (pairs.Next(keyword, value)) {
    if (keyword == opens || keyword == "END_GROUP" || (vicar && keyword == "TASK")) {
      whole = whole || inside;
      inside = keyword == opens && !found && value == "GEOMETRIC_CAMERA_MODEL";
      found = found || inside;
    } else if (keyword == "OBJECT") {
      image = value == "IMAGE";
    } else if (keyword == "END_OBJECT") {
      image = false;
    } else if (inside) {
      values.emplace(keyword, value);
    } else if ((vicar && keyword == "NS" && size[0] == 0) || (image && keyword == "LINE_SAMPLES")) {
      side(0);
    } else if ((vicar && keyword == "NL" && size[1] == 0) || (image && keyword == "LINES")) {
      side(1);
    }
  }
  if (!found) {
    throw Error(Error::Kind::Corrupt, label, "its label has no GEOMETRIC_CAMERA_MODEL");
  }
  if (!whole && !(vicar && values.count("MODEL_COMPONENT_4"))) {
    throw Error(Error::Kind::Corrupt, label, "its label ends within GEOMETRIC_CAMERA_MODEL");
  }
  return values;
}

} // namespace

bool IsLabel(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  for (const char* begin : {"PDS_VERSION_ID", "ODL_VERSION_ID", "CCSD", "LBLSIZE="}) {
    if (first != std::string::npos && text.compare(first, std::string(begin).size(), begin) == 0) {
      return true;
    }
  }
  return false;
}

CameraModel ParseLabelModel(const std::string& text, const std::string& label) {
  int size[2] = {0, 0};
  const Values values = ModelOf(text, label, size);
  const auto get = [&](const std::string& name) {
    const auto found = values.find(name);
    if (found == values.end()) {
      throw Error(Error::Kind::Corrupt, label, "its GEOMETRIC_CAMERA_MODEL has no " + name);
    }
    return found->second;
  };
  const std::string type = UpperText(get("MODEL_TYPE"));
  if (type != "CAHV" && type != "CAHVOR" && type != "CAHVORE") {
    throw Error(Error::Kind::Unsupported, label,
                "its MODEL_TYPE is '" + type + "'; accepted: CAHV, CAHVOR, CAHVORE");
  }
  CameraModel model;
  model.width = size[0];
  model.height = size[1];
  if (values.count("REFERENCE_COORD_SYSTEM_NAME")) {
    model.frame = values.at("REFERENCE_COORD_SYSTEM_NAME");
  }
  LensValues lens;
  const std::string order = type == "CAHVORE" ? "CAHVORETP" : type;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::string name = "MODEL_COMPONENT_" + std::to_string(i + 1);
    const std::vector<double> numbers = NumbersIn(get(name), label + ", " + name);
    const std::size_t count = i < 7 ? 3 : 1;
    if (numbers.size() != count) {
      throw Error(Error::Kind::Corrupt, label,
                  name + " has " + std::to_string(numbers.size()) +
                      " numbers; accepted: " + std::to_string(count));
    }
    lens[std::string(1, order[i])] = numbers;
  }
  const Eigen::Vector3d C(lens["C"].data());
  lens.erase("C");
  if (type == "CAHVORE") {
    const double kind = lens["T"][0];
    if (kind != 1.0 && kind != 2.0 && kind != 3.0) {
      throw Error(Error::Kind::Unsupported, label,
                  "its CAHVORE is of type " + NumberText(kind) + "; accepted: 1, 2, 3");
    }
    lens["linearity"] = {kind == 1.0 ? 1.0 : kind == 2.0 ? 0.0 : lens["P"][0]};
    lens.erase("T");
    lens.erase("P");
  }
  std::string lower = type;
  for (char& c : lower) {
    c = char(std::tolower(static_cast<unsigned char>(c)));
  }
  PutCahvore(lower, C, lens, model, label);
  return model;
}

} // namespace dspace
