#include <dspace/camera/files/CahvText.h>

#include <sstream>

#include <dspace/Error.h>
#include <dspace/camera/files/ModelText.h>

namespace dspace {
namespace {

// "NAME = rest", with a name of the model; else an empty name.
std::pair<std::string, std::string> PairOf(const std::string& line) {
  const std::size_t equals = line.find('=');
  if (equals == std::string::npos) {
    return {};
  }
  const std::string name = TrimmedText(line.substr(0, equals));
  for (const char* known : {"C", "A", "H", "V", "O", "R", "E", "Dimensions", "Model"}) {
    if (name == known) {
      return {name, TrimmedText(line.substr(equals + 1))};
    }
  }
  return {};
}

struct Kind {
  std::string type; // empty: not said
  double linearity = 1.0;
};

// Of "CAHVORE3,0.37 = general" and the like.
Kind KindOf(const std::string& text, const std::string& label) {
  const std::string word = UpperText(TrimmedText(text.substr(0, text.find('='))));
  if (word == "CAHV" || word == "CAHVOR") {
    return {word == "CAHV" ? "cahv" : "cahvor", 1.0};
  }
  if (word == "CAHVORE1" || word == "CAHVORE2") {
    return {"cahvore", word == "CAHVORE1" ? 1.0 : 0.0};
  }
  if (word.compare(0, 9, "CAHVORE3,") == 0) {
    return {"cahvore", NumberIn(TrimmedText(word.substr(9)), label)};
  }
  throw Error(Error::Kind::Unsupported, label,
              "its model is '" + word +
                  "'; accepted: CAHV, CAHVOR, CAHVORE1, CAHVORE2, CAHVORE3,LINEARITY");
}

} // namespace

bool IsCahvText(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    if (PairOf(line).first == "C") {
      return true;
    }
  }
  return false;
}

CameraModel ParseCahvText(const std::string& text, const std::string& label) {
  CameraModel model;
  LensValues values;
  Kind kind;
  std::istringstream lines(text);
  std::string line;
  int number = 0;
  while (std::getline(lines, line)) {
    const std::string place = label + ", line " + std::to_string(++number);
    const auto [name, rest] = PairOf(line);
    if (name.empty()) {
      continue;
    }
    if (name == "Model") {
      kind = KindOf(rest, place);
      continue;
    }
    const std::vector<double> numbers = NumbersIn(rest, place);
    const std::size_t count = name == "Dimensions" ? 2 : 3;
    if (numbers.size() != count) {
      throw Error(Error::Kind::Corrupt, place,
                  name + " has " + std::to_string(numbers.size()) +
                      " numbers; accepted: " + std::to_string(count));
    }
    if (name == "Dimensions") {
      model.width = ImageSide(numbers[0], "a dimension", place);
      model.height = ImageSide(numbers[1], "a dimension", place);
    } else if (!values.emplace(name, numbers).second) {
      throw Error(Error::Kind::Corrupt, place, name + " is there twice");
    }
  }
  const std::string held = values.count("E") ? "CAHVORE" : values.count("O") ? "CAHVOR" : "CAHV";
  if (kind.type.empty()) {
    if (held == "CAHVORE") {
      throw Error(Error::Kind::Corrupt, label,
                  "it has E and no line 'Model = CAHVORE1', 'CAHVORE2' or 'CAHVORE3,LINEARITY', "
                  "which says its type");
    }
    kind.type = held == "CAHV" ? "cahv" : "cahvor";
  }
  for (const char letter : UpperText(kind.type)) {
    if (!values.count(std::string(1, letter))) {
      throw Error(Error::Kind::Corrupt, label,
                  std::string("it has no ") + letter + "; accepted: a " + UpperText(kind.type) +
                      " with C, A, H, V" + (kind.type == "cahv" ? "" : ", O, R") +
                      (kind.type == "cahvore" ? ", E" : ""));
    }
  }
  const Eigen::Vector3d C(values["C"].data());
  LensValues lens;
  for (const char letter : UpperText(kind.type)) {
    if (letter != 'C') {
      lens[std::string(1, letter)] = values[std::string(1, letter)];
    }
  }
  if (kind.type == "cahvore") {
    lens["linearity"] = {kind.linearity};
  }
  PutCahvore(kind.type, C, lens, model, label);
  return model;
}

std::string CahvTextOf(const CameraModel& model) {
  const std::string type = model.lens->Type();
  if (type != "cahv" && type != "cahvor" && type != "cahvore") {
    throw Error(Error::Kind::Unsupported, model.Label(),
                "its type is " + type + "; accepted for JPL's text: cahv, cahvor, cahvore");
  }
  const LensValues values = CahvoreOf(model);
  std::string text;
  if (model.width > 0) {
    text +=
        "Dimensions = " + std::to_string(model.width) + " " + std::to_string(model.height) + "\n";
  }
  if (type == "cahv") {
    text += "Model = CAHV = perspective, linear\n";
  } else if (type == "cahvor") {
    text += "Model = CAHVOR = perspective, distorted\n";
  } else {
    const double linearity = values.at("linearity")[0];
    text += linearity == 1.0   ? "Model = CAHVORE1 = perspective\n"
            : linearity == 0.0 ? "Model = CAHVORE2 = fish-eye\n"
                               : "Model = CAHVORE3," + ExactText(linearity) + " = general\n";
  }
  for (const char* name : {"C", "A", "H", "V", "O", "R", "E"}) {
    const auto found = values.find(name);
    if (found != values.end()) {
      text += std::string(name) + " = " + ExactTexts(found->second, " ") + "\n";
    }
  }
  return text;
}

} // namespace dspace
