#include <dspace/overlay/ColorBar.h>

#include <algorithm>
#include <cmath>

#include <dspace/overlay/RoundNumbers.h>
#include <dspace/overlay/TextCharacters.h>
#include <dspace/overlay/TextLimits.h>

namespace dspace {
namespace {

constexpr std::size_t MaximumColors = 1024;
constexpr std::size_t MaximumTicks = 100;
constexpr double CharacterWidth = 0.61; // of the font size: the font is monospaced

void RequirePixels(const std::string& object, const char* what, int value, int low, int high) {
  if (value < low || value > high) {
    Reject(object, std::string(what) + " is " + std::to_string(value) + "; accepted: " +
                       std::to_string(low) + " to " + std::to_string(high) + " pixels");
  }
}

bool Angles(const ColorBar& bar) {
  return bar.unit == "deg" || bar.unit == "°";
}

int WidthOf(const ColorBar& bar, const std::string& text) {
  return int(std::ceil(CharacterWidth * bar.fontSize * double(CharacterCount(text))));
}

} // namespace

bool ColorBar::operator==(const ColorBar& o) const {
  return this->name == o.name && this->title == o.title && this->unit == o.unit &&
         this->low == o.low && this->high == o.high && this->colors == o.colors &&
         this->ticks == o.ticks && this->values == o.values && this->horizontal == o.horizontal &&
         this->anchor == o.anchor && this->margin == o.margin && this->length == o.length &&
         this->thickness == o.thickness && this->fontSize == o.fontSize &&
         this->textColor == o.textColor && this->backgroundColor == o.backgroundColor &&
         this->terrain == o.terrain && this->layer == o.layer;
}

void ColorBar::Check() const {
  RequireName("colour bar", this->name);
  const std::string object = "colour bar '" + this->name + "'";
  if (!(this->low < this->high) || !std::isfinite(this->high - this->low)) {
    Reject(object, "it goes from " + NumberText(this->low) + " to " + NumberText(this->high) +
                       "; accepted: finite values, the first the lesser");
  }
  // Neighbouring ticks must differ as numbers.
  const double size = std::max(std::abs(this->low), std::abs(this->high));
  if (!(this->high - this->low > 1e-9 * size) || size > 1e100 || this->high - this->low < 1e-100) {
    Reject(object, "its values " + NumberText(this->low) + " and " + NumberText(this->high) +
                       " are too close, too small or too large for ticks; accepted: up to 1e100, "
                       "at least 1e-100 and a billionth of the greater one apart");
  }
  if (this->colors.empty() || this->colors.size() > MaximumColors) {
    Reject(object, "it has " + std::to_string(this->colors.size()) + " colours; accepted: 1 to " +
                       std::to_string(MaximumColors));
  }
  for (const auto& color : this->colors) {
    for (const double c : color) {
      RequireFraction(object, "a component of its colours", c);
    }
  }
  if (this->ticks < 0 || std::size_t(this->ticks) > MaximumTicks ||
      this->values.size() > MaximumTicks) {
    const long count = this->values.empty() ? this->ticks : long(this->values.size());
    Reject(object, "it has " + std::to_string(count) + " ticks; accepted: 0 to " +
                       std::to_string(MaximumTicks));
  }
  for (const double value : this->values) {
    if (!(value >= this->low && value <= this->high)) {
      Reject(object, "a tick is at " + NumberText(value) + "; accepted: " + NumberText(this->low) +
                         " to " + NumberText(this->high));
    }
  }
  RequirePixels(object, "margin", this->margin, 0, 16384);
  RequirePixels(object, "length", this->length, 16, 8192);
  RequirePixels(object, "thickness", this->thickness, 2, 1024);
  RequirePixels(object, "font size", this->fontSize, 4, 200);
  for (const auto& [what, text] :
       {std::pair<const char*, const std::string&>("its title", this->title),
        {"its unit", this->unit}}) {
    RequireTextLength(object, what, text);
    RequirePlainText(object, what, text, false);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    RequireFraction(object, "text colour", this->textColor[i]);
    RequireFraction(object, "background colour", this->backgroundColor[i]);
  }
  const ColorBarLayout layout = LayOut(*this);
  RequireTextPicture(object, layout.width, layout.height);
}

std::string ColorBar::Heading() const {
  const std::string unit = this->unit.empty() ? "" : "[" + this->unit + "]";
  return this->title + (this->title.empty() || unit.empty() ? "" : " ") + unit;
}

std::vector<std::pair<double, std::string>> ColorBar::Ticks() const {
  std::vector<std::pair<double, std::string>> ticks;
  if (!this->values.empty()) {
    for (const double value : this->values) {
      ticks.emplace_back(value, NumberText(value));
    }
    std::sort(ticks.begin(), ticks.end());
    return ticks;
  }
  // Fewer where their texts would touch.
  for (int count = this->ticks; count > 0; --count) {
    const double step = RoundStep(this->low, this->high, count, Angles(*this));
    ticks.clear();
    int widest = 0;
    for (const double value : Multiples(step, this->low, this->high)) {
      ticks.emplace_back(value, RoundText(value, step));
      widest = std::max(widest, WidthOf(*this, ticks.back().second + " "));
    }
    const double apart = this->length * step / (this->high - this->low);
    if (ticks.size() < 2 || apart >= (this->horizontal ? widest : 1.2 * this->fontSize)) {
      return ticks;
    }
  }
  return {};
}

std::array<double, 3> ColorBar::ColorAt(double value) const {
  const double share = std::clamp((value - this->low) / (this->high - this->low), 0.0, 1.0);
  const double at = share * double(this->colors.size() - 1);
  const std::size_t i = std::min(std::size_t(at), this->colors.size() - 1);
  const std::size_t j = std::min(i + 1, this->colors.size() - 1);
  std::array<double, 3> color;
  for (std::size_t k = 0; k < 3; ++k) {
    color[k] = this->colors[i][k] + (at - double(i)) * (this->colors[j][k] - this->colors[i][k]);
  }
  return color;
}

ColorBarLayout LayOut(const ColorBar& bar) {
  ColorBarLayout layout;
  const auto ticks = bar.Ticks();
  const std::string heading = bar.Heading();
  const int pad = std::max(bar.fontSize * 2 / 3, 2); // half a line: ticks' texts rise over the ends
  const int line = bar.fontSize * 5 / 4;
  const int mark = std::max(bar.fontSize / 3, 3);
  int widest = 0;
  for (const auto& tick : ticks) {
    widest = std::max(widest, WidthOf(bar, tick.second));
  }
  const int across = bar.thickness + 1 + (ticks.empty() ? 0 : mark); // its frame is a pixel wide
  int sides = pad;
  if (bar.horizontal) {
    sides += widest / 2;
    layout.bar = {sides, pad + (ticks.empty() ? 0 : line) + across - bar.thickness, bar.length,
                  bar.thickness};
    layout.width = bar.length + 2 * sides;
    layout.height = layout.bar.y + bar.thickness + pad;
  } else {
    layout.bar = {sides, pad, bar.thickness, bar.length};
    layout.width = 2 * sides + across + (ticks.empty() ? 0 : mark + widest);
    layout.height = bar.length + 2 * pad;
  }
  for (const auto& [value, text] : ticks) {
    // The pixel that the value falls into.
    const double share = (value - bar.low) / (bar.high - bar.low);
    const int at = std::min(int(share * bar.length), bar.length - 1);
    if (bar.horizontal) {
      layout.marks.push_back({layout.bar.x + at, layout.bar.y - 1 - mark, 1, mark});
      layout.texts.push_back({text, layout.bar.x + at, layout.marks.back().y - line / 2, true});
    } else {
      layout.marks.push_back({layout.bar.x + bar.thickness + 1, layout.bar.y + at, mark, 1});
      layout.texts.push_back({text, layout.marks.back().x + 2 * mark, layout.bar.y + at, false});
    }
  }
  if (!heading.empty()) {
    layout.texts.push_back({heading, pad, layout.height + line / 2, false});
    layout.height += line + pad / 2;
    layout.width = std::max(layout.width, WidthOf(bar, heading) + 2 * pad);
  }
  return layout;
}

} // namespace dspace
