#include <dspace/clipmap/ClipmapStyle.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>

namespace dspace {
namespace {

void CheckOpacity(const std::string& terrain, const std::string& what, double opacity) {
  Require(opacity >= 0.0 && opacity <= 1.0, terrain, ("the opacity of " + what).c_str(), opacity,
          "0 to 1");
}

void CheckLines(const std::string& terrain, const std::string& what,
                const ClipmapStyle::Lines& lines) {
  Require(lines.interval > 0.0 && std::isfinite(lines.interval), terrain,
          ("the interval of " + what).c_str(), lines.interval, "more than 0, finite");
  Require(lines.width > 0.0 && lines.width <= 64.0, terrain, ("the width of " + what).c_str(),
          lines.width, "more than 0, up to 64 pixels");
  for (const double c : lines.color) {
    Require(c >= 0.0 && c <= 1.0, terrain, ("a colour component of " + what).c_str(), c, "0 to 1");
  }
  CheckOpacity(terrain, what, lines.opacity);
}

} // namespace

std::vector<CustomGeometry::Member> ClipmapStyle::Members() const {
  std::vector<CustomGeometry::Member> members;
  for (const Detail& detail : this->details) {
    members.push_back({"a detail", detail.member});
  }
  if (this->tracks.member.fragment != Membership::Physical().fragment) {
    members.push_back({"tracks", this->tracks.member});
  }
  if (this->ramp) {
    members.push_back({"the ramp", this->ramp->member});
  }
  if (this->levels) {
    members.push_back({"levels", this->levelsMember});
  }
  if (this->contours) {
    members.push_back({"contours", this->contours->member});
  }
  if (this->grid) {
    members.push_back({"the grid", this->grid->member});
  }
  return members;
}

ClipmapStyle ClipmapStyle::ShownBy(const std::function<bool(const Membership&)>& shown) const {
  ClipmapStyle style = *this;
  style.details.erase(std::remove_if(style.details.begin(), style.details.end(),
                                     [&](const Detail& detail) { return !shown(detail.member); }),
                      style.details.end());
  style.tracks.hidden = !shown(style.tracks.member);
  const auto drop = [&](auto& element) {
    if (element && !shown(element->member)) {
      element.reset();
    }
  };
  drop(style.ramp);
  drop(style.contours);
  drop(style.grid);
  if (style.levels && !shown(style.levelsMember)) {
    style.levels.reset();
  }
  if (!style.grid) {
    style.gridLabels.reset();
  }
  return style;
}

void ClipmapStyle::Check(const std::string& terrain) const {
  if (this->details.size() > Detail::Most) {
    Reject(terrain, std::to_string(this->details.size()) + " details are given; accepted: up to " +
                        std::to_string(Detail::Most));
  }
  for (const Detail& detail : this->details) {
    if (!detail.image || detail.image->width < 1 || detail.image->height < 1) {
      Reject(terrain, "a detail has no image");
    }
    Require(detail.size >= 1e-3 && detail.size <= 1e6, terrain, "the size of a detail", detail.size,
            "1e-3 to 1e6 m");
    for (const auto& [low, high] : {detail.slopes, detail.heights}) {
      if (!(low < high) || !std::isfinite(low) || !std::isfinite(high)) {
        Reject(terrain, "a detail's range is " + NumberText(low) + " to " + NumberText(high) +
                            "; accepted: finite, the first the lesser");
      }
    }
    CheckOpacity(terrain, "a detail", detail.opacity);
  }
  for (const double c : this->tracks.color) {
    Require(c >= 0.0 && c <= 1.0, terrain, "a colour component of its tracks", c, "0 to 1");
  }
  CheckOpacity(terrain, "its tracks", this->tracks.opacity);
  if (this->ramp) {
    if (!this->ramp->image && this->ramp->by != Ramp::By::Normal) {
      Reject(terrain, "its ramp has no colours");
    }
    const auto [low, high] = this->ramp->range;
    if (!std::isfinite(low) || !std::isfinite(high) || low == high) {
      Reject(terrain, "its ramp goes from " + NumberText(low) + " to " + NumberText(high) +
                          "; accepted: two finite values that differ");
    }
    CheckOpacity(terrain, "its ramp", this->ramp->opacity);
  }
  if (this->levels) {
    CheckOpacity(terrain, "its levels", *this->levels);
  }
  if (this->contours) {
    CheckLines(terrain, "its contours", *this->contours);
  }
  if (this->grid) {
    CheckLines(terrain, "its grid", *this->grid);
  }
  if (this->gridLabels) {
    const GridLabels& labels = *this->gridLabels;
    if (!this->grid) {
      Reject(terrain, "its grid's labels need a grid; accepted: both, or a grid alone");
    }
    Require(labels.fontSize >= 4 && labels.fontSize <= 200, terrain,
            "the font size of its grid's labels", labels.fontSize, "4 to 200 pixels");
    for (const auto& color : {labels.color, labels.background}) {
      for (const double c : color) {
        Require(c >= 0.0 && c <= 1.0, terrain, "a colour component of its grid's labels", c,
                "0 to 1");
      }
    }
    CheckOpacity(terrain, "its grid's labels' background", labels.backgroundOpacity);
  }
  if (this->noise) {
    this->noise->options.Check(terrain);
    Require(this->noise->amplitude > 0.0 && this->noise->amplitude <= 1e6, terrain,
            "the amplitude of its noise", this->noise->amplitude, "more than 0, up to 1e6 m");
  }
}

} // namespace dspace
