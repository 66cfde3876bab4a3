#include <dspace/camera/files/IsdJson.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <json/json.h>

#include <Eigen/LU>

#include <dspace/Checks.h>
#include <dspace/camera/files/ModelText.h>

namespace dspace {
namespace {

constexpr int MostNodes = 129; // of the poses of a line scanner

[[noreturn]] void DamagedIsd(const std::string& label, const std::string& what) {
  throw Error(Error::Kind::Corrupt, label, what);
}

// A member of an object, by a path of names.
const Json::Value& Part(const Json::Value& root, std::initializer_list<const char*> path,
                        const std::string& label) {
  const Json::Value* value = &root;
  std::string name;
  for (const char* each : path) {
    name += (name.empty() ? "" : ".") + std::string(each);
    if (!value->isObject() || !value->isMember(each)) {
      DamagedIsd(label, "it has no '" + name + "'");
    }
    value = &(*value)[each];
  }
  return *value;
}

std::vector<double> ListOf(const Json::Value& value, std::size_t count, const char* name,
                           const std::string& label) {
  std::vector<double> numbers;
  if (!value.isArray() || (count > 0 && value.size() != count) || value.empty()) {
    DamagedIsd(label, std::string("'") + name + "' is no list" +
                          (count > 0 ? " of " + std::to_string(count) + " numbers" : ""));
  }
  for (const Json::Value& each : value) {
    if (!each.isNumeric() || !std::isfinite(each.asDouble())) {
      DamagedIsd(label, std::string("'") + name + "' holds what is no finite number");
    }
    numbers.push_back(each.asDouble());
  }
  return numbers;
}

double NumberOf(const Json::Value& root, std::initializer_list<const char*> path,
                const std::string& label) {
  const Json::Value& value = Part(root, path, label);
  if (!value.isNumeric() || !std::isfinite(value.asDouble())) {
    DamagedIsd(label, "'" + std::string(*(path.end() - 1)) + "' is no finite number");
  }
  return value.asDouble();
}

double NumberOr(const Json::Value& root, const char* name, double standard,
                const std::string& label) {
  return root.isMember(name) ? NumberOf(root, {name}, label) : standard;
}

// Values over time: through up to eight neighbours by Lagrange's polynomials, as usgscsm does.
template<int Size> struct Series {
  using Value = Eigen::Matrix<double, Size, 1>;
  std::vector<double> times; // ascending
  std::vector<Value> values;

  Value At(double time) const {
    const std::size_t points = std::min<std::size_t>(this->times.size(), 8);
    const std::size_t after = std::size_t(
        std::upper_bound(this->times.begin(), this->times.end(), time) - this->times.begin());
    const std::size_t first =
        std::min(after > points / 2 ? after - points / 2 : 0, this->times.size() - points);
    Value sum = Value::Zero();
    for (std::size_t a = first; a < first + points; ++a) {
      double weight = 1.0;
      for (std::size_t b = first; b < first + points; ++b) {
        weight *= b == a ? 1.0 : (time - this->times[b]) / (this->times[a] - this->times[b]);
      }
      sum += weight * this->values[a];
    }
    return sum;
  }
};

template<int Size>
Series<Size> SeriesOf(const Json::Value& part, const char* name, const std::string& label) {
  Series<Size> series;
  series.times = ListOf(Part(part, {"ephemeris_times"}, label), 0, "ephemeris_times", label);
  const Json::Value& rows = Part(part, {name}, label);
  if (!rows.isArray() || rows.size() != series.times.size()) {
    DamagedIsd(label, std::string("'") + name + "' and its 'ephemeris_times' differ in number");
  }
  for (const Json::Value& row : rows) {
    const std::vector<double> numbers = ListOf(row, Size, name, label);
    typename Series<Size>::Value value(numbers.data());
    if (Size == 4) {
      Require(std::abs(value.norm() - 1.0) <= 1e-3, label, "the length of a quaternion",
              value.norm(), "1 within 1e-3");
      value.normalize();
      if (!series.values.empty() && series.values.back().dot(value) < 0.0) {
        value = -value;
      }
    }
    series.values.push_back(value);
  }
  if (!std::is_sorted(series.times.begin(), series.times.end(), std::less_equal<double>())) {
    DamagedIsd(label, std::string("the times of '") + name + "' do not ascend");
  }
  return series;
}

// Turns components in J2000 into those of a frame.
class Turning {
public:
  Turning(const Json::Value& root, const char* name, const std::string& label)
      : Quaternions_(SeriesOf<4>(Part(root, {name}, label), "quaternions", label)) {
    const Json::Value& part = root[name];
    if (part.isMember("constant_rotation")) {
      const std::vector<double> m =
          ListOf(part["constant_rotation"], 9, "constant_rotation", label);
      this->Constant_ = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m.data());
      const double error =
          (this->Constant_ * this->Constant_.transpose() - Eigen::Matrix3d::Identity()).norm();
      Require(error < 1e-6, label, "the error of 'constant_rotation' as a rotation", error,
              "below 1e-6");
    }
  }
  Eigen::Matrix3d At(double time) const {
    const Eigen::Vector4d q = this->Quaternions_.At(time).normalized(); // w first
    return this->Constant_ * Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  }

private:
  Series<4> Quaternions_;
  Eigen::Matrix3d Constant_ = Eigen::Matrix3d::Identity();
};

// Where the instrument is, in the body's fixed axes.
class Flight {
public:
  Flight(const Json::Value& root, const std::string& label)
      : Positions_(SeriesOf<3>(Part(root, {"instrument_position"}, label), "positions", label)),
        Pointing_(root, "instrument_pointing", label), Body_(root, "body_rotation", label) {
    const Json::Value& unit = Part(root, {"instrument_position", "unit"}, label);
    const std::string word = unit.isString() ? UpperText(unit.asString()) : "";
    if (word != "KM" && word != "M") {
      DamagedIsd(label, "the unit of 'instrument_position' is '" + word + "'; accepted: km, m");
    }
    this->Unit_ = word == "KM" ? 1000.0 : 1.0;
  }
  Eigen::Vector3d Position(double time) const {
    return this->Body_.At(time) * this->Positions_.At(time) * this->Unit_;
  }
  Eigen::Quaterniond Rotation(double time) const { // from the instrument's axes
    return Eigen::Quaterniond(
        Eigen::Matrix3d(this->Body_.At(time) * this->Pointing_.At(time).transpose()));
  }
  std::size_t Times() const { return this->Positions_.times.size(); }

private:
  Series<3> Positions_;
  Turning Pointing_;
  Turning Body_;
  double Unit_ = 1.0;
};

// The focal plane: numbers of the type usgs for pixels of the image.
LensValues FocalPlaneOf(const Json::Value& root, const std::string& label) {
  const std::vector<double> samples =
      ListOf(Part(root, {"focal2pixel_samples"}, label), 3, "focal2pixel_samples", label);
  const std::vector<double> lines =
      ListOf(Part(root, {"focal2pixel_lines"}, label), 3, "focal2pixel_lines", label);
  const double bySample = NumberOr(root, "detector_sample_summing", 1.0, label);
  const double byLine = NumberOr(root, "detector_line_summing", 1.0, label);
  Require(bySample > 0.0, label, "detector_sample_summing", bySample, "above 0");
  Require(byLine > 0.0, label, "detector_line_summing", byLine, "above 0");
  const double x = NumberOf(root, {"detector_center", "sample"}, label) + samples[0] -
                   NumberOr(root, "starting_detector_sample", 0.0, label);
  const double y = NumberOf(root, {"detector_center", "line"}, label) + lines[0] -
                   NumberOr(root, "starting_detector_line", 0.0, label);
  LensValues values = {
      {"focal_length", {NumberOf(root, {"focal_length_model", "focal_length"}, label)}},
      {"matrix",
       {samples[1] / bySample, samples[2] / bySample, lines[1] / byLine, lines[2] / byLine}},
      {"center", {x / bySample - 0.5, y / byLine - 0.5}}};
  const Json::Value& distortion = Part(root, {"optical_distortion"}, label);
  if (distortion.isObject() && distortion.isMember("radial")) {
    values["radial"] =
        ListOf(Part(distortion, {"radial", "coefficients"}, label), 0, "coefficients", label);
  } else {
    throw Error(Error::Kind::Unsupported, label,
                "its distortion is '" +
                    (distortion.isObject() && !distortion.empty() ? distortion.getMemberNames()[0]
                                                                  : std::string()) +
                    "'; accepted: radial");
  }
  return values;
}

// The focal plane for an instrument that is turned by half a turn about X: its Z looks backwards.
void TurnOver(LensValues& values) {
  values["matrix"][0] = -values["matrix"][0];
  values["matrix"][2] = -values["matrix"][2];
}

void PutLines(const Json::Value& root, const Flight& flight, LensValues values, bool over,
              CameraModel& model, const std::string& label) {
  const Json::Value& rates = Part(root, {"line_scan_rate"}, label);
  if (!rates.isArray() || rates.empty()) {
    DamagedIsd(label, "'line_scan_rate' is no list");
  }
  const std::vector<double> rate = ListOf(rates[0], 3, "line_scan_rate", label);
  for (const Json::Value& each : rates) {
    if (std::abs(ListOf(each, 3, "line_scan_rate", label)[2] - rate[2]) >
        1e-9 * std::abs(rate[2])) {
      throw Error(Error::Kind::Unsupported, label,
                  "the time of a line changes; accepted: one time for all lines");
    }
  }
  Require(rate[2] > 0.0, label, "the time of a line", rate[2], "above 0");
  const double center = NumberOf(root, {"center_ephemeris_time"}, label);
  // Of a line of our own, whose first one is 0: an ISD's is half more.
  const auto timeOf = [&](double line) {
    return center + rate[1] + rate[2] * (line + 0.5 - rate[0] + 0.5);
  };
  const double middle = 0.5 * (model.height - 1);
  Eigen::Quaterniond q_SC = Eigen::Quaterniond::Identity();
  if (over) {
    q_SC = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
    TurnOver(values);
  }
  model.p_MC = flight.Position(timeOf(middle));
  model.q_MC = flight.Rotation(timeOf(middle)) * q_SC;
  const int nodes = std::clamp(int(2 * flight.Times()), 9, MostNodes);
  for (int i = 0; i < nodes; ++i) {
    const double line = -1.0 + (model.height + 1.0) * i / (nodes - 1);
    const Eigen::Vector3d p = model.q_MC.conjugate() * (flight.Position(timeOf(line)) - model.p_MC);
    const Eigen::Quaterniond q = model.q_MC.conjugate() * flight.Rotation(timeOf(line)) * q_SC;
    values["line"].push_back(line);
    values["positions"].insert(values["positions"].end(), p.data(), p.data() + 3);
    for (const double each : {q.w(), q.x(), q.y(), q.z()}) {
      values["rotations"].push_back(each);
    }
  }
  // The detector's line 0 of usgscsm, whatever the image's line.
  values["row"] = {-0.5};
  model.lens = MakeLens("line_scan", values, label);
}

Json::Value RootOf(const std::string& text, const std::string& label) {
  Json::CharReaderBuilder builder;
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
  if (!good || !root.isObject()) {
    DamagedIsd(label, "it is no JSON object: " + TrimmedText(errors));
  }
  return root;
}

} // namespace

bool IsIsdJson(const std::string& text) {
  return text.find("\"name_model\"") != std::string::npos &&
         text.find("\"focal2pixel_lines\"") != std::string::npos;
}

CameraModel ParseIsdJson(const std::string& text, const std::string& label) {
  const Json::Value root = RootOf(text, label);
  const Json::Value& kind = Part(root, {"name_model"}, label);
  const std::string word = kind.isString() ? kind.asString() : "";
  const bool scan = word == "USGS_ASTRO_LINE_SCANNER_SENSOR_MODEL";
  if (!scan && word != "USGS_ASTRO_FRAME_SENSOR_MODEL") {
    throw Error(Error::Kind::Unsupported, label,
                "its sensor model is '" + word +
                    "'; accepted: USGS_ASTRO_FRAME_SENSOR_MODEL, "
                    "USGS_ASTRO_LINE_SCANNER_SENSOR_MODEL");
  }
  CameraModel model;
  model.name = root["name_sensor"].isString() ? root["name_sensor"].asString() : "";
  model.frame = "body-fixed";
  model.width = ImageSide(NumberOf(root, {"image_samples"}, label), "the width", label);
  model.height = ImageSide(NumberOf(root, {"image_lines"}, label), "the height", label);
  LensValues values = FocalPlaneOf(root, label);
  const Flight flight(root, label);
  // Some instruments' Z looks away from the body, and usgscsm takes either side of the line.
  const double center = NumberOf(root, {"center_ephemeris_time"}, label);
  const Eigen::Vector3d z = flight.Rotation(center) * Eigen::Vector3d::UnitZ();
  const bool over = z.dot(flight.Position(center)) > 0.0;
  if (scan) {
    PutLines(root, flight, values, over, model, label);
    return model;
  }
  model.p_MC = flight.Position(center);
  model.q_MC = flight.Rotation(center);
  if (over) {
    model.q_MC = model.q_MC * Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
    TurnOver(values);
  }
  model.lens = MakeLens("usgs", values, label);
  return model;
}

} // namespace dspace
