#include <dspace/camera/files/OpencvYaml.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/camera/files/ModelText.h>

namespace dspace {
namespace {

// Where the value of a key at the beginning of a line begins; npos: there is none.
std::size_t YamlValueAt(const std::string& text, const std::string& key) {
  std::size_t at = 0;
  while ((at = text.find(key + ":", at)) != std::string::npos) {
    const std::size_t line = text.find_last_of('\n', at);
    const std::size_t begin = line == std::string::npos ? 0 : line + 1;
    const std::string before = text.substr(begin, at - begin);
    if (before.find_first_not_of(" \t\"") == std::string::npos) {
      return at + key.size() + 1;
    }
    at += key.size();
  }
  return std::string::npos;
}

std::string YamlWordOf(const std::string& text, const std::string& key) {
  const std::size_t at = YamlValueAt(text, key);
  if (at == std::string::npos) {
    return "";
  }
  std::string word = TrimmedText(text.substr(at, text.find('\n', at) - at));
  word.erase(std::remove_if(word.begin(), word.end(), [](char c) { return c == '"' || c == '\''; }),
             word.end());
  return word;
}

// The list after a key: its own, or that of `data:` below it.
std::vector<double> YamlListOf(const std::string& text, const std::vector<std::string>& keys,
                               const std::string& label, bool needed) {
  for (const std::string& key : keys) {
    const std::size_t at = YamlValueAt(text, key);
    if (at == std::string::npos) {
      continue;
    }
    const std::size_t open = text.find('[', at);
    const std::size_t close = open == std::string::npos ? open : text.find(']', open);
    if (close == std::string::npos) {
      throw Error(Error::Kind::Corrupt, label, "the numbers of '" + key + "' do not end");
    }
    const std::string between = text.substr(at, open - at);
    if (between.find_first_not_of(" \t\r\n!") != std::string::npos &&
        between.find("data:") == std::string::npos) {
      throw Error(Error::Kind::Corrupt, label, "'" + key + "' has no data");
    }
    return NumbersIn(text.substr(open, close + 1 - open), label + ", " + key);
  }
  if (needed) {
    throw Error(Error::Kind::Corrupt, label, "it has no '" + keys.front() + "'");
  }
  return {};
}

int YamlSideOf(const std::string& text, const std::string& key, const std::string& label) {
  const std::string word = YamlWordOf(text, key);
  return word.empty() ? 0 : ImageSide(NumberIn(word, label + ", " + key), key.c_str(), label);
}

// OpenCV's order: k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tau_x tau_y [rad].
LensValues FromOpencv(const std::vector<double>& given, const std::string& label) {
  const std::size_t n = given.size();
  if (n != 4 && n != 5 && n != 8 && n != 12 && n != 14) {
    throw Error(Error::Kind::Corrupt, label,
                "it has " + std::to_string(n) +
                    " distortion coefficients; accepted: 4, 5, 8, 12, 14");
  }
  std::vector<double> d = given;
  d.resize(14, 0.0);
  const double degree = 180.0 / M_PI;
  return {{"radial", {d[0], d[1], d[4], d[5], d[6], d[7]}},
          {"tangential", {d[2], d[3]}},
          {"prism", {d[8], d[9], d[10], d[11]}},
          {"tilt_deg", {d[12] * degree, d[13] * degree}}};
}

} // namespace

bool IsOpencvYaml(const std::string& text) {
  return YamlValueAt(text, "camera_matrix") != std::string::npos ||
         YamlValueAt(text, "cameraMatrix") != std::string::npos ||
         YamlValueAt(text, "Camera_Matrix") != std::string::npos;
}

CameraModel ParseOpencvYaml(const std::string& text, const std::string& label) {
  CameraModel model;
  const std::vector<double> matrix =
      YamlListOf(text, {"camera_matrix", "cameraMatrix", "Camera_Matrix"}, label, true);
  if (matrix.size() != 9) {
    throw Error(Error::Kind::Corrupt, label,
                "its camera_matrix has " + std::to_string(matrix.size()) + " numbers; accepted: 9");
  }
  if (matrix[1] != 0.0 || matrix[3] != 0.0 || matrix[6] != 0.0 || matrix[7] != 0.0 ||
      matrix[8] != 1.0) {
    Reject(label, "its camera_matrix is not [fx 0 cx; 0 fy cy; 0 0 1]; accepted: one without skew");
  }
  model.name = YamlWordOf(text, "camera_name");
  model.width = YamlSideOf(text, "image_width", label);
  model.height = YamlSideOf(text, "image_height", label);
  if ((model.width == 0) != (model.height == 0)) {
    throw Error(Error::Kind::Corrupt, label,
                "it has one of image_width and image_height; accepted: both or none");
  }
  const std::string kind = YamlWordOf(text, "distortion_model");
  const bool fisheye = kind == "equidistant" || kind == "fisheye";
  if (!fisheye && !kind.empty() && kind != "plumb_bob" && kind != "rational_polynomial") {
    throw Error(Error::Kind::Unsupported, label,
                "its distortion_model is '" + kind +
                    "'; accepted: plumb_bob, rational_polynomial, equidistant, fisheye");
  }
  // A model without its coefficients is a file that was cut short, not a pinhole.
  const std::vector<double> d = YamlListOf(text,
                                           {"distortion_coefficients", "dist_coeffs", "distCoeffs",
                                            "Distortion_Coefficients", "dist_coeff"},
                                           label, !kind.empty());
  LensValues values;
  std::string type = "pinhole";
  if (fisheye) {
    if (d.size() != 4) {
      throw Error(Error::Kind::Corrupt, label,
                  "it has " + std::to_string(d.size()) +
                      " distortion coefficients; accepted for a fish-eye: 4");
    }
    type = "kannala_brandt";
    values["radial"] = d;
  } else if (!std::all_of(d.begin(), d.end(), [](double v) { return v == 0.0; })) {
    type = "brown";
    values = FromOpencv(d, label);
  }
  values["focal"] = {matrix[0], matrix[4]};
  values["center"] = {matrix[2], matrix[5]};
  model.lens = MakeLens(type, values, label);
  return model;
}

std::string OpencvYamlOf(const CameraModel& model) {
  const std::string type = model.lens->Type();
  if (type != "pinhole" && type != "brown" && type != "kannala_brandt" && type != "equidistant") {
    throw Error(Error::Kind::Unsupported, model.Label(),
                "its type is " + type +
                    "; accepted for OpenCV's YAML: pinhole, brown, kannala_brandt, equidistant");
  }
  if (model.p_MC.norm() > 0.0 || model.q_MC.vec().norm() > 0.0) {
    throw Error(
        Error::Kind::Unsupported, model.Label(),
        "it has a pose in its frame, which OpenCV's YAML cannot hold; accepted: .json, or a "
        "model without a pose");
  }
  const LensValues v = model.lens->Values();
  const bool fisheye = type == "kannala_brandt" || type == "equidistant";
  std::vector<double> d = {0, 0, 0, 0};
  if (type == "kannala_brandt") {
    d = v.at("radial");
  } else if (type == "brown") {
    const std::vector<double>&k = v.at("radial"), &p = v.at("tangential"), &s = v.at("prism"),
          &t = v.at("tilt_deg");
    const double radian = M_PI / 180.0;
    d = {k[0], k[1], p[0], p[1], k[2], k[3],          k[4],
         k[5], s[0], s[1], s[2], s[3], t[0] * radian, t[1] * radian};
    const auto zero = [&](std::size_t from) {
      return std::all_of(d.begin() + std::ptrdiff_t(from), d.end(),
                         [](double each) { return each == 0.0; });
    };
    d.resize(zero(4) ? 4 : zero(5) ? 5 : zero(8) ? 8 : zero(12) ? 12 : 14);
  }
  std::string text = "%YAML:1.0\n---\n";
  if (!model.name.empty()) {
    text += "camera_name: \"" + model.name + "\"\n";
  }
  if (model.width > 0) {
    text += "image_width: " + std::to_string(model.width) +
            "\nimage_height: " + std::to_string(model.height) + "\n";
  }
  const auto matrix = [](const char* name, std::size_t rows, std::size_t columns,
                         const std::vector<double>& data) {
    return std::string(name) + ": !!opencv-matrix\n   rows: " + std::to_string(rows) +
           "\n   cols: " + std::to_string(columns) + "\n   dt: d\n   data: [ " +
           ExactTexts(data, ", ") + " ]\n";
  };
  const std::vector<double>&f = v.at("focal"), &c = v.at("center");
  text += matrix("camera_matrix", 3, 3, {f[0], 0, c[0], 0, f[1], c[1], 0, 0, 1});
  text += std::string("distortion_model: ") +
          (fisheye        ? "equidistant"
           : d.size() > 5 ? "rational_polynomial"
                          : "plumb_bob") +
          "\n";
  text += matrix("distortion_coefficients", 1, d.size(), d);
  return text;
}

} // namespace dspace
