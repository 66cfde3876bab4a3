#include <dspace/camera/files/CameraJson.h>

#include <cmath>
#include <memory>

#include <json/json.h>

#include <dspace/Checks.h>
#include <dspace/camera/files/ModelText.h>

namespace dspace {
namespace {

bool IsCahv(const std::string& type) {
  return type == "cahv" || type == "cahvor" || type == "cahvore";
}

[[noreturn]] void Damaged(const std::string& label, const std::string& what) {
  throw Error(Error::Kind::Corrupt, label, what);
}

std::string JsonTextOf(const Json::Value& from, const char* name, const std::string& label) {
  const Json::Value& value = from[name];
  if (!value.isNull() && !value.isString()) {
    Damaged(label, std::string("'") + name + "' is not a text");
  }
  return value.isNull() ? "" : value.asString();
}

std::vector<double> JsonNumbersOf(const Json::Value& value, const std::string& name,
                                  const std::string& label) {
  std::vector<double> numbers;
  if (value.isNumeric()) {
    return {value.asDouble()};
  }
  if (!value.isArray() || value.size() > 4096) {
    Damaged(label, "'" + name + "' is not a number or a list of numbers");
  }
  for (const Json::Value& each : value) {
    if (!each.isNumeric()) {
      Damaged(label, "'" + name + "' holds what is not a number");
    }
    numbers.push_back(each.asDouble());
  }
  return numbers;
}

int JsonSideOf(const Json::Value& model, const char* name, const std::string& label) {
  const Json::Value& value = model[name];
  if (value.isNull()) {
    return 0;
  }
  if (!value.isNumeric() || value.asDouble() != std::floor(value.asDouble()) ||
      value.asDouble() < 1 || value.asDouble() > 1e6) {
    Damaged(label, std::string("'") + name + "' is not an integer from 1 to 1e6");
  }
  return value.asInt();
}

// What is not a number of the lens. A pose in the form of another type counts as one: MakeLens
// rejects it.
bool IsPlace(const std::string& name, bool cahv) {
  const bool pose = cahv ? name == "C" || name == "pupilType" // some files give a type to every one
                         : name == "position" || name == "rotation";
  return pose || name == "type" || name == "width" || name == "height";
}

void PutLinearity(const Json::Value& from, LensValues& values, const std::string& label) {
  const Json::Value& pupil = from["pupilType"];
  const bool given = values.count("linearity") > 0;
  if (pupil.isNull()) {
    if (!given) {
      Damaged(label, "it has neither 'linearity' nor 'pupilType'");
    }
    return;
  }
  const double type = pupil.isNumeric() ? pupil.asDouble() : 0.0;
  if (type == 1.0 || type == 2.0) {
    values["linearity"] = {type == 1.0 ? 1.0 : 0.0};
  } else if (type != 3.0) {
    Damaged(label, "its pupilType is " + NumberText(type) + "; accepted: 1, 2, 3");
  } else if (!given) {
    Damaged(label, "it is of type 3 and has no 'linearity'");
  }
}

CameraModel ModelOf(const Json::Value& from, const std::string& file) {
  if (!from.isObject()) {
    Damaged(file, "it holds what is not a camera model");
  }
  CameraModel model;
  model.name = JsonTextOf(from, "name", file);
  model.frame = JsonTextOf(from, "frame", file);
  const std::string label = model.name.empty() ? file : file + ", camera '" + model.name + "'";
  const Json::Value& lens = from.isMember("model") ? from["model"] : from;
  if (!lens.isObject() || !lens["type"].isString()) {
    Damaged(label, "it has no 'model' with a 'type'");
  }
  const std::string type = lens["type"].asString();
  model.width = JsonSideOf(lens, "width", label);
  model.height = JsonSideOf(lens, "height", label);
  if ((model.width == 0) != (model.height == 0)) {
    Damaged(label, "it has one of 'width' and 'height'; accepted: both or none");
  }
  LensValues values;
  for (const std::string& name : lens.getMemberNames()) {
    const bool outer = &lens == &from && (name == "name" || name == "frame");
    if (!IsPlace(name, IsCahv(type)) && !outer && !lens[name].isNull()) {
      values[name] = JsonNumbersOf(lens[name], name, label);
    }
  }
  if (IsCahv(type)) {
    if (type == "cahvore") {
      PutLinearity(lens, values, label);
    } else {
      values.erase("linearity"); // some files give one to every model
    }
    const std::vector<double> C = JsonNumbersOf(lens["C"], "C", label);
    if (C.size() != 3) {
      Damaged(label, "'C' has " + std::to_string(C.size()) + " numbers; accepted: 3");
    }
    PutCahvore(type, Eigen::Vector3d(C.data()), values, model, label);
    return model;
  }
  model.lens = MakeLens(type, values, label);
  if (lens.isMember("position")) {
    const std::vector<double> p = JsonNumbersOf(lens["position"], "position", label);
    if (p.size() != 3) {
      Damaged(label, "'position' has " + std::to_string(p.size()) + " numbers; accepted: 3");
    }
    model.p_MC = Eigen::Vector3d(p.data());
    RequirePosition(label, "its position", model.p_MC);
  }
  if (lens.isMember("rotation")) {
    const std::vector<double> q = JsonNumbersOf(lens["rotation"], "rotation", label);
    if (q.size() != 4) {
      Damaged(label, "'rotation' has " + std::to_string(q.size()) + " numbers; accepted: 4");
    }
    model.q_MC = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    Require(std::abs(model.q_MC.norm() - 1.0) <= 1e-6, label, "the length of its rotation",
            model.q_MC.norm(), "1 within 1e-6");
    model.q_MC.normalize();
  }
  return model;
}

Json::Value JsonListOf(const std::vector<double>& values) {
  if (values.size() == 1) {
    return values[0];
  }
  Json::Value list(Json::arrayValue);
  for (const double value : values) {
    list.append(value);
  }
  return list;
}

} // namespace

std::vector<CameraModel> ParseCameraJson(const std::string& text, const std::string& label) {
  Json::CharReaderBuilder builder;
  Json::CharReaderBuilder::strictMode(&builder.settings_);
  builder.settings_["strictRoot"] = true;
  builder.settings_["stackLimit"] = 64;
  const std::unique_ptr<Json::CharReader> reader(builder.newCharReader());
  Json::Value root;
  std::string errors;
  bool good = false;
  try {
    good = reader->parse(text.data(), text.data() + text.size(), &root, &errors);
  } catch (const Json::Exception& error) {
    errors = error.what();
  }
  if (!good) {
    Damaged(label, "it is not JSON: " + TrimmedText(errors));
  }
  std::vector<CameraModel> models;
  if (root.isArray()) {
    for (const Json::Value& each : root) {
      models.push_back(ModelOf(each, label));
    }
  } else {
    models.push_back(ModelOf(root, label));
  }
  if (models.empty()) {
    Damaged(label, "it holds no camera model");
  }
  return models;
}

std::string CameraJsonOf(const CameraModel& model) {
  Json::Value root, lens;
  const std::string type = model.lens->Type();
  if (!model.name.empty()) {
    root["name"] = model.name;
  }
  if (!model.frame.empty()) {
    root["frame"] = model.frame;
  }
  lens["type"] = type;
  if (model.width > 0) {
    lens["width"] = model.width;
    lens["height"] = model.height;
  }
  for (const auto& [name, values] : IsCahv(type) ? CahvoreOf(model) : model.lens->Values()) {
    lens[name] = JsonListOf(values);
  }
  if (!IsCahv(type)) {
    lens["position"] = JsonListOf({model.p_MC[0], model.p_MC[1], model.p_MC[2]});
    lens["rotation"] = JsonListOf({model.q_MC.w(), model.q_MC.x(), model.q_MC.y(), model.q_MC.z()});
  }
  root["model"] = lens;
  Json::StreamWriterBuilder builder;
  builder["indentation"] = "  ";
  builder["precision"] = 17;
  return Json::writeString(builder, root) + "\n";
}

} // namespace dspace
