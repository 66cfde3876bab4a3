#include <dspace/camera/files/MrcalModel.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/camera/files/ModelText.h>

namespace dspace {
namespace {

// Where the value of 'key' begins; npos: there is none. Comments are gone.
std::size_t MrcalValueAt(const std::string& text, const std::string& key) {
  for (const char* quote : {"'", "\""}) {
    const std::size_t at = text.find(quote + key + quote);
    if (at != std::string::npos) {
      const std::size_t colon = text.find(':', at);
      return colon == std::string::npos ? colon : colon + 1;
    }
  }
  return std::string::npos;
}

std::string WithoutComments(const std::string& text) {
  std::string plain;
  bool comment = false;
  for (const char c : text) {
    comment = (comment || c == '#') && c != '\n';
    if (!comment) {
      plain += c;
    }
  }
  return plain;
}

std::vector<double> MrcalListOf(const std::string& text, const std::string& key,
                                const std::string& label, std::size_t count) {
  const std::size_t at = MrcalValueAt(text, key);
  const std::size_t open = at == std::string::npos ? at : text.find('[', at);
  const std::size_t close = open == std::string::npos ? open : text.find(']', open);
  if (close == std::string::npos) {
    throw Error(Error::Kind::Corrupt, label, "it has no list '" + key + "', or that does not end");
  }
  const std::vector<double> numbers =
      NumbersIn(text.substr(open, close + 1 - open), label + ", " + key);
  if (numbers.size() != count) {
    throw Error(Error::Kind::Corrupt, label,
                "'" + key + "' has " + std::to_string(numbers.size()) +
                    " numbers; accepted: " + std::to_string(count));
  }
  return numbers;
}

constexpr const char* Accepted =
    "LENSMODEL_PINHOLE, LENSMODEL_OPENCV4, 5, 8, 12, LENSMODEL_CAHVOR, "
    "LENSMODEL_CAHVORE_linearity=L";

} // namespace

bool IsMrcalModel(const std::string& text) {
  return MrcalValueAt(WithoutComments(text), "lensmodel") != std::string::npos ||
         MrcalValueAt(WithoutComments(text), "lens_model") != std::string::npos;
}

CameraModel ParseMrcalModel(const std::string& given, const std::string& label) {
  const std::string text = WithoutComments(given);
  const std::size_t at =
      std::min(MrcalValueAt(text, "lensmodel"), MrcalValueAt(text, "lens_model"));
  const std::size_t begin = text.find_first_of("'\"", at);
  const std::size_t end = begin == std::string::npos ? begin : text.find(text[begin], begin + 1);
  if (end == std::string::npos) {
    throw Error(Error::Kind::Corrupt, label, "it has no 'lensmodel', or the text ends in it");
  }
  const std::string name = text.substr(begin + 1, end - begin - 1);
  CameraModel model;
  const std::vector<double> size = MrcalListOf(text, "imagersize", label, 2);
  model.width = ImageSide(size[0], "a side of imagersize", label);
  model.height = ImageSide(size[1], "a side of imagersize", label);
  const auto opencv = [&](std::size_t count) {
    std::vector<double> i = MrcalListOf(text, "intrinsics", label, 4 + count);
    i.resize(16, 0.0);
    LensValues values = {{"focal", {i[0], i[1]}}, {"center", {i[2], i[3]}}};
    if (count == 0) {
      return MakeLens("pinhole", values, label);
    }
    values["radial"] = {i[4], i[5], i[8], i[9], i[10], i[11]};
    values["tangential"] = {i[6], i[7]};
    values["prism"] = {i[12], i[13], i[14], i[15]};
    return MakeLens("brown", values, label);
  };
  const std::string cahvore = "LENSMODEL_CAHVORE_linearity=";
  if (name == "LENSMODEL_PINHOLE") {
    model.lens = opencv(0);
  } else if (name == "LENSMODEL_OPENCV4" || name == "LENSMODEL_OPENCV5" ||
             name == "LENSMODEL_OPENCV8" || name == "LENSMODEL_OPENCV12") {
    model.lens = opencv(std::size_t(std::stoi(name.substr(16))));
  } else if (name == "LENSMODEL_CAHVOR" || name.compare(0, cahvore.size(), cahvore) == 0) {
    const bool e = name != "LENSMODEL_CAHVOR";
    const std::vector<double> i = MrcalListOf(text, "intrinsics", label, e ? 12 : 9);
    const double ca = std::cos(i[4]), sa = std::sin(i[4]), cb = std::cos(i[5]), sb = std::sin(i[5]);
    LensValues values = {{"A", {0, 0, 1}},
                         {"H", {i[0], 0, i[2]}},
                         {"V", {0, i[1], i[3]}},
                         {"O", {sa * cb, sb, ca * cb}},
                         {"R", {i[6], i[7], i[8]}}};
    if (e) {
      values["E"] = {i[9], i[10], i[11]};
      values["linearity"] = {NumberIn(name.substr(cahvore.size()), label)};
    }
    model.lens = MakeLens(e ? "cahvore" : "cahvor", values, label);
  } else {
    throw Error(Error::Kind::Unsupported, label,
                "its lensmodel is '" + name.substr(0, 60) + "'; accepted: " + Accepted);
  }
  if (MrcalValueAt(text, "extrinsics") !=
      std::string::npos) { // camera from reference: turn, then shift
    const std::vector<double> rt = MrcalListOf(text, "extrinsics", label, 6);
    const Eigen::Vector3d r(rt.data()), t(rt.data() + 3);
    const double angle = r.norm();
    const Eigen::Quaterniond q_CM = angle > 0.0
                                        ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, r / angle))
                                        : Eigen::Quaterniond::Identity();
    model.q_MC = q_CM.conjugate();
    model.p_MC = -(model.q_MC * t);
    RequirePosition(label, "its position", model.p_MC);
  }
  return model;
}

std::string MrcalModelOf(const CameraModel& model) {
  const std::string type = model.lens->Type();
  const LensValues v = model.lens->Values();
  const auto refuse = [&](const std::string& what) {
    throw Error(Error::Kind::Unsupported, model.Label(),
                what + ", which mrcal's files cannot hold; accepted: pinhole, brown without tilt, "
                       "cahvor, cahvore without skew");
  };
  if (model.width < 1) {
    refuse("it has no size of its image");
  }
  std::string name = "LENSMODEL_PINHOLE";
  std::vector<double> i;
  if (type == "pinhole" || type == "brown") {
    i = {v.at("focal")[0], v.at("focal")[1], v.at("center")[0], v.at("center")[1]};
    if (type == "brown") {
      const std::vector<double>&k = v.at("radial"), &p = v.at("tangential"), &s = v.at("prism"),
            &t = v.at("tilt_deg");
      if (t[0] != 0.0 || t[1] != 0.0) {
        refuse("it has a tilt");
      }
      const bool prism = std::any_of(s.begin(), s.end(), [](double each) { return each != 0.0; });
      i.insert(i.end(), {k[0], k[1], p[0], p[1], k[2], k[3], k[4], k[5]});
      if (prism) {
        i.insert(i.end(), s.begin(), s.end());
      }
      name = prism ? "LENSMODEL_OPENCV12" : "LENSMODEL_OPENCV8";
    }
  } else if (type == "cahvor" || type == "cahvore") {
    const Eigen::Vector3d A(v.at("A").data()), H(v.at("H").data()), V(v.at("V").data());
    if ((A / A.norm() - Eigen::Vector3d::UnitZ()).norm() > 1e-9 || std::abs(H.y()) > 1e-9 * H.x() ||
        std::abs(V.x()) > 1e-9 * V.y()) {
      refuse("its H and V are not at right angles");
    }
    const double scale = A.norm();
    const std::vector<double>& O = v.at("O");
    i = {H.x() / scale, V.y() / scale,          H.z() / scale,
         V.z() / scale, std::atan2(O[0], O[2]), std::asin(O[1])};
    i.insert(i.end(), v.at("R").begin(), v.at("R").end());
    name = "LENSMODEL_CAHVOR";
    if (type == "cahvore") {
      i.insert(i.end(), v.at("E").begin(), v.at("E").end());
      name = "LENSMODEL_CAHVORE_linearity=" + ExactText(v.at("linearity")[0]);
    }
  } else {
    refuse("its type is " + type);
  }
  const Eigen::AngleAxisd turn(model.q_MC.conjugate());
  const Eigen::Vector3d r = turn.angle() * turn.axis();
  const Eigen::Vector3d t = -(model.q_MC.conjugate() * model.p_MC);
  return "{\n    'lensmodel':  '" + name + "',\n\n    'intrinsics': [ " + ExactTexts(i, ", ") +
         " ],\n\n    # camera from reference: turn [rad], shift [m]\n    'extrinsics': [ " +
         ExactTexts({r[0], r[1], r[2], t[0], t[1], t[2]}, ", ") + " ],\n\n    'imagersize': [ " +
         std::to_string(model.width) + ", " + std::to_string(model.height) + " ]\n}\n";
}

} // namespace dspace
