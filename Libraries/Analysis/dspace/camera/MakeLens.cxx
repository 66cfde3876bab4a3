#include <dspace/camera/AngleLens.h>
#include <dspace/camera/BrownLens.h>
#include <dspace/camera/CahvoreLens.h>
#include <dspace/camera/LineScanLens.h>
#include <dspace/camera/OrthographicLens.h>
#include <dspace/camera/OwenLens.h>
#include <dspace/camera/SphereLens.h>
#include <dspace/camera/UsgsLens.h>

#include <functional>

#include <dspace/Error.h>

namespace dspace {
namespace {

using Maker = std::function<LensPtr(LensNumbers&)>;

const std::map<std::string, Maker>& Makers() {
  static const std::map<std::string, Maker> makers = {
      {"pinhole", [](LensNumbers& n) { return std::make_shared<BrownLens>(true, n); }},
      {"brown", [](LensNumbers& n) { return std::make_shared<BrownLens>(false, n); }},
      {"equidistant", [](LensNumbers& n) { return std::make_shared<AngleLens>(true, n); }},
      {"kannala_brandt", [](LensNumbers& n) { return std::make_shared<AngleLens>(false, n); }},
      {"ucm",
       [](LensNumbers& n) { return std::make_shared<SphereLens>(SphereLens::Kind::Unified, n); }},
      {"eucm",
       [](LensNumbers& n) { return std::make_shared<SphereLens>(SphereLens::Kind::Extended, n); }},
      {"double_sphere",
       [](LensNumbers& n) { return std::make_shared<SphereLens>(SphereLens::Kind::Double, n); }},
      {"owen", [](LensNumbers& n) { return std::make_shared<OwenLens>(n); }},
      {"usgs", [](LensNumbers& n) { return std::make_shared<UsgsLens>(n); }},
      {"line_scan", [](LensNumbers& n) { return std::make_shared<LineScanLens>(n); }},
      {"orthographic", [](LensNumbers& n) { return std::make_shared<OrthographicLens>(n); }},
      {"cahv",
       [](LensNumbers& n) { return std::make_shared<CahvoreLens>(CahvoreLens::Kind::Cahv, n); }},
      {"cahvor",
       [](LensNumbers& n) { return std::make_shared<CahvoreLens>(CahvoreLens::Kind::Cahvor, n); }},
      {"cahvore", [](LensNumbers& n) {
         return std::make_shared<CahvoreLens>(CahvoreLens::Kind::Cahvore, n);
       }}};
  return makers;
}

} // namespace

const std::string& LensTypes() {
  static const std::string types = [] {
    std::string all;
    for (const auto& [type, maker] : Makers()) {
      all += (all.empty() ? "" : ", ") + type;
    }
    return all;
  }();
  return types;
}

LensPtr MakeLens(const std::string& type, const LensValues& values, const std::string& label) {
  const auto found = Makers().find(type);
  if (found == Makers().end()) {
    throw Error(Error::Kind::Unsupported, label,
                "its type is '" + type + "'; accepted: " + LensTypes());
  }
  LensNumbers numbers(values, label);
  return found->second(numbers);
}

} // namespace dspace
