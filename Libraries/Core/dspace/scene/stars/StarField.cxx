#include <dspace/scene/stars/StarField.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/scene/GraphicsObject.h>

namespace dspace {

StarField::StarField(const std::string& object, std::vector<Star> stars)
    : Stars_(std::move(stars)) {
  if (this->Stars_.empty()) {
    Reject(object, "it has no stars; accepted: 1 or more");
  }
  for (std::size_t i = 0; i < this->Stars_.size(); ++i) {
    Star& star = this->Stars_[i];
    const std::string which = object + ", star " + std::to_string(i);
    const double length = star.direction.cast<double>().norm();
    Require(std::abs(length - 1.0) <= 1e-3, which, "the length of its direction", length,
            "1, to 0.001");
    Require(star.magnitude >= -30.0f && star.magnitude <= 40.0f, which, "magnitude",
            double(star.magnitude), "-30 to 40");
    star.direction = (star.direction.cast<double>() / length).cast<float>();
  }
  std::stable_sort(this->Stars_.begin(), this->Stars_.end(),
                   [](const Star& a, const Star& b) { return a.magnitude < b.magnitude; });
}

void StarField::SetLook(const std::string& object, const StarLook& look) {
  Require(look.gain >= 0.0 && look.gain <= 1e12, object, "gain", look.gain, "0 to 1e12");
  Require(look.spread >= 0.2 && look.spread <= 20.0, object, "point spread", look.spread,
          "0.2 to 20 pixels");
  Require(std::isfinite(look.faintest), object, "faintest magnitude", look.faintest,
          "a finite number");
  this->Look_ = look;
  ++this->Revision_;
}

BoundingSphere StarField::Bounds() const {
  return {};
}

} // namespace dspace
