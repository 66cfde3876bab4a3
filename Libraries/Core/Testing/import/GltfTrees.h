// glTF's JSON as a tree that tests change: every mutant is JSON.
#ifndef DSPACE_TESTING_GLTF_TREES_H
#define DSPACE_TESTING_GLTF_TREES_H

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <json/json.h>

#include "FuzzMutator.h"

namespace dspace::testing {

class GltfTreeMutator {
public:
  explicit GltfTreeMutator(FuzzMutator& random) : Random_(random) {}

  std::string Mutate(const std::string& text) {
    Json::Value root;
    std::istringstream in(text);
    in >> root;
    const std::size_t changes = 1 + this->Random_.Below(4);
    for (std::size_t i = 0; i < changes; ++i) {
      this->Change(root);
    }
    Json::StreamWriterBuilder writer;
    writer["indentation"] = "";
    return Json::writeString(writer, root);
  }

private:
  static bool IsWhole(double number) {
    return std::abs(number) < 1e15 && number == std::floor(number);
  }

  static void Values(Json::Value& value, std::vector<Json::Value*>& into) {
    into.push_back(&value);
    if (value.isArray() || value.isObject()) {
      for (Json::Value& each : value) {
        Values(each, into);
      }
    }
  }

  Json::Value AnyValue() {
    static const double numbers[] = {0,    1,          -1,  2,    3,   4,     5120, 5123, 5125,
                                     5126, 2147483647, 1e9, 1e18, 0.5, 1e-30, 1e38, 255};
    switch (this->Random_.Below(8)) {
    case 0:
      return Json::Value(Json::arrayValue);
    case 1:
      return Json::Value(Json::objectValue);
    case 2:
      return Json::Value("SCALAR");
    case 3:
      return Json::Value(true);
    default: {
      const double number = numbers[this->Random_.Below(sizeof numbers / sizeof *numbers)];
      return IsWhole(number) ? Json::Value(static_cast<Json::Int64>(number)) : Json::Value(number);
    }
    }
  }

  void Change(Json::Value& root) {
    std::vector<Json::Value*> values;
    Values(root, values);
    Json::Value& value = *values[this->Random_.Below(values.size())];
    const Json::Value other = *values[this->Random_.Below(values.size())];
    switch (this->Random_.Below(6)) {
    case 0: // what stands elsewhere
      value = other;
      break;
    case 1: // an item or member less
      if (value.isArray() && !value.empty()) {
        Json::Value removed;
        value.removeIndex(static_cast<Json::ArrayIndex>(this->Random_.Below(value.size())),
                          &removed);
      } else if (value.isObject() && !value.empty()) {
        const auto names = value.getMemberNames();
        value.removeMember(names[this->Random_.Below(names.size())]);
      }
      break;
    case 2: // an item more, or many
      if (value.isArray() && values.size() < 20000) {
        const Json::Value item =
            value.empty() ? other
                          : value[static_cast<Json::ArrayIndex>(this->Random_.Below(value.size()))];
        for (std::size_t i = this->Random_.Below(4) ? 1 : 100; i > 0; --i) {
          value.append(item);
        }
      }
      break;
    case 3: // a name of another object
      if (value.isObject()) {
        static const char* const names[] = {
            "byteOffset", "byteStride", "count", "sparse",     "children", "mesh",    "skin",
            "indices",    "material",   "mode",  "extensions", "matrix",   "targets", "normalized"};
        value[names[this->Random_.Below(sizeof names / sizeof *names)]] =
            this->Random_.Below(2) ? other : this->AnyValue();
      }
      break;
    case 4: // a little more or less
      if (value.isNumeric() && IsWhole(value.asDouble())) {
        value = Json::Value(static_cast<Json::Int64>(value.asDouble()) +
                            (this->Random_.Below(2) ? 1 : -1));
      }
      break;
    default:
      value = this->AnyValue();
    }
  }

  FuzzMutator& Random_;
};

} // namespace dspace::testing

#endif
