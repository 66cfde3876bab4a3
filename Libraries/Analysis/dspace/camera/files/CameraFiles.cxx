#include <dspace/camera/files/CameraFiles.h>

#include <filesystem>

#include <dspace/AtomicFile.h>
#include <dspace/Error.h>
#include <dspace/camera/files/CahvText.h>
#include <dspace/camera/files/CameraJson.h>
#include <dspace/camera/files/InstrumentKernel.h>
#include <dspace/camera/files/IsdJson.h>
#include <dspace/camera/files/LabelModel.h>
#include <dspace/camera/files/ModelText.h>
#include <dspace/camera/files/MrcalModel.h>
#include <dspace/camera/files/OpencvYaml.h>

namespace dspace {

std::vector<CameraModel> ReadCameraModels(const std::string& path) {
  const std::string label = "file '" + path + "'";
  const std::string text = ReadModelText(path);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (IsLabel(text)) {
    return {ParseLabelModel(text, label)};
  }
  if (text.find('\0') != std::string::npos) {
    throw Error(
        Error::Kind::Unsupported, label,
        "it is no text; accepted: JSON, JPL's CAHV, CAHVOR and CAHVORE text, PDS3 and VICAR "
        "labels, OpenCV's YAML, mrcal's .cameramodel, USGS ISD, SPICE instrument kernels");
  }
  if (IsMrcalModel(text)) {
    return {ParseMrcalModel(text, label)};
  }
  if (IsInstrumentKernel(text)) {
    return ParseInstrumentKernel(text, label);
  }
  if (IsIsdJson(text)) {
    return {ParseIsdJson(text, label)};
  }
  if (text[first] == '{' || text[first] == '[') {
    return ParseCameraJson(text, label);
  }
  if (IsOpencvYaml(text)) {
    return {ParseOpencvYaml(text, label)};
  }
  if (IsCahvText(text)) {
    return {ParseCahvText(text, label)};
  }
  throw Error(Error::Kind::Unsupported, label,
              "it holds no camera model; accepted: JSON, JPL's CAHV, CAHVOR and CAHVORE text, PDS3 "
              "and VICAR labels, OpenCV's YAML, mrcal's .cameramodel, USGS ISD, SPICE instrument "
              "kernels");
}

CameraModel ReadCameraModel(const std::string& path, const std::string& name) {
  std::vector<CameraModel> models = ReadCameraModels(path);
  std::string names;
  for (CameraModel& model : models) {
    if (name.empty() ? models.size() == 1 : model.name == name) {
      return model;
    }
    names += (names.empty() ? "" : ", ") + model.name;
  }
  throw Error(Error::Kind::NotFound, "file '" + path + "'",
              (name.empty() ? "it holds " + std::to_string(models.size()) + " cameras"
                            : "it has no camera '" + name + "'") +
                  "; accepted: one of " + (names.empty() ? "none, they have no names" : names));
}

void WriteCameraModel(const std::string& path, const CameraModel& model) {
  const std::string ending = UpperText(std::filesystem::path(path).extension().string());
  std::string text;
  if (ending == ".JSON") {
    text = CameraJsonOf(model);
  } else if (ending == ".CAHV" || ending == ".CAHVOR" || ending == ".CAHVORE") {
    if (UpperText(model.lens->Type()) != ending.substr(1)) {
      throw Error(Error::Kind::Unsupported, "file '" + path + "'",
                  std::string("the model is of type ") + model.lens->Type() +
                      "; accepted: " + ending.substr(1));
    }
    text = CahvTextOf(model);
  } else if (ending == ".YAML" || ending == ".YML") {
    text = OpencvYamlOf(model);
  } else if (ending == ".CAMERAMODEL") {
    text = MrcalModelOf(model);
  } else {
    throw Error(
        Error::Kind::Unsupported, "file '" + path + "'",
        "its name has another ending; accepted: .json, .cahv, .cahvor, .cahvore, .yaml, .yml, "
        ".cameramodel");
  }
  AtomicFile::Save(path, text.data(), text.size());
}

} // namespace dspace
