#include <dspace/layers/raster/FalseColorLayer.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include <dspace/Error.h>

#include <dspace/layers/ColorRamp.h>
#include <dspace/layers/raster/BlockSampler.h>
#include <dspace/layers/raster/RasterPlacing.h>

namespace dspace {
namespace {

constexpr double Digits =
    64.0; // ranges further than so many times their length from 0 are found twice

std::string Number(double value) {
  std::ostringstream text;
  text.precision(9);
  text << value;
  return text.str();
}

void Check(const std::string& object, const FalseColorOptions& colors) {
  const auto reject = [&](const std::string& message) {
    throw Error(Error::Kind::InvalidArgument, object, message);
  };
  if (colors.band < 1) {
    reject("band " + std::to_string(colors.band) + " asked for; accepted are 1 and more");
  }
  if (colors.ramp.empty()) {
    reject("the colour ramp is empty; at least one colour is needed");
  }
  for (const auto& color : colors.ramp) {
    for (const double v : color) {
      if (!(v >= 0.0 && v <= 1.0)) {
        reject("a colour of the ramp has " + Number(v) + "; accepted is 0 to 1");
      }
    }
  }
  for (const auto& end : {colors.low, colors.high}) {
    if (end && !std::isfinite(*end)) {
      reject("an end of the range is " + Number(*end) + "; accepted is a finite number");
    }
  }
}

std::array<double, 2> RangeOf(RasterLevels& levels, const FalseColorOptions& colors) {
  bool exact = true;
  std::array<double, 2> range = {colors.low.value_or(0.0), colors.high.value_or(0.0)};
  if (!colors.low || !colors.high) {
    std::array<double, 2> all = levels.FindRange(exact);
    if (std::max(std::abs(all[0]), std::abs(all[1])) > Digits * (all[1] - all[0])) {
      levels.SetBias(all[0]);
      all = levels.FindRange(exact);
    }
    range = {colors.low.value_or(all[0]), colors.high.value_or(all[1])};
    if (!exact) {
      levels.Warnings().push_back(levels.Object() + " is large: its range of " + Number(all[0]) +
                                  " to " + Number(all[1]) +
                                  " is of an overview or of some of its rows; give low and high");
    }
    if (!colors.low && !colors.high && range[0] == range[1]) {
      range = {range[0] - 0.5, range[1] + 0.5};
      levels.Warnings().push_back(levels.Object() + " has one value, " + Number(all[0]) +
                                  ": it has the colour in the middle; give low and high");
    }
  }
  if (!(range[0] < range[1])) {
    throw Error(Error::Kind::InvalidArgument, levels.Object(),
                "a range of " + Number(range[0]) + " to " + Number(range[1]) +
                    " is rejected; accepted is a low end below the high one");
  }
  return range;
}

class BandLayer : public FalseColorLayer {
public:
  BandLayer(std::shared_ptr<RasterLevels> levels, const PlacedRaster& placed, const ColorRamp& ramp,
            const std::array<double, 2>& range)
      : Name_(levels->Object()), PixelSize_(placed.pixelSize), Bias_(levels->Bias()), Ramp_(ramp),
        Range_(range), Unit_(levels->Unit()), Warnings_(levels->Warnings()),
        Sampler_(std::move(levels), placed.position) {}

  const std::string& GetName() const override { return this->Name_; }
  double PixelSize() const override { return this->PixelSize_; }
  const std::vector<std::string>& Warnings() const override { return this->Warnings_; }
  std::size_t KeptBytes() const override { return this->Sampler_.KeptBytes(); }
  const std::array<double, 2>& Range() const override { return this->Range_; }
  const ColorRamp& Ramp() const override { return this->Ramp_; }
  const std::string& Unit() const override { return this->Unit_; }

  bool Read(const ColorGrid& grid, const ColorBlock& block, std::uint8_t* rgba) const override {
    std::vector<float> texels;
    if (!this->Sampler_.Sample(grid, block, texels)) {
      return false;
    }
    for (std::size_t i = 0; i < std::size_t(block.width) * block.height; ++i) {
      const double opacity = texels[2 * i + 1];
      const auto alpha = std::uint8_t(std::clamp(std::lround(255.0 * opacity), 0l, 255l));
      std::array<double, 3> color = {0.0, 0.0, 0.0};
      if (alpha) {
        const double value = texels[2 * i] / opacity + this->Bias_;
        color =
            ColorAt(this->Ramp_, (value - this->Range_[0]) / (this->Range_[1] - this->Range_[0]));
      }
      for (int k = 0; k < 3; ++k) {
        rgba[4 * i + k] = std::uint8_t(std::lround(255.0 * color[k]));
      }
      rgba[4 * i + 3] = alpha;
    }
    return true;
  }

private:
  std::string Name_;
  double PixelSize_;
  double Bias_;
  ColorRamp Ramp_;
  std::array<double, 2> Range_;
  std::string Unit_;
  std::vector<std::string> Warnings_;
  BlockSampler Sampler_;
};

} // namespace

std::shared_ptr<const FalseColorLayer> OpenFalseColorLayer(const std::string& path,
                                                           const RasterPlace& terrain,
                                                           const FalseColorOptions& colors,
                                                           const RasterLayerOptions& options) {
  const std::string object = "raster '" + path + "'";
  Check(object, colors);
  auto levels = std::make_shared<RasterLevels>(object, path, colors.band, options);
  const PlacedRaster placed = PlaceRaster(*levels, terrain, options);
  const std::array<double, 2> range = RangeOf(*levels, colors);
  levels->SetBias(range[0]);
  return std::make_shared<BandLayer>(std::move(levels), placed, colors.ramp, range);
}

} // namespace dspace
