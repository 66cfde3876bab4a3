#include <dspace/layers/vector/VectorCanvas.h>

#include <algorithm>
#include <cmath>

#include <cairo.h>

#include <dspace/Error.h>

namespace dspace {
namespace {

// IEC 61966-2-1.
double Linear(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

double Encoded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

std::uint8_t Byte(double value) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
}

void Trace(cairo_t* cairo, const TexelChain& chain) {
  cairo_new_sub_path(cairo);
  for (const Eigen::Vector2d& place : chain) {
    cairo_line_to(cairo, place.x(), place.y());
  }
}

} // namespace

VectorCanvas::VectorCanvas(int width, int height)
    : Width_(width), Height_(height),
      Surface_(cairo_image_surface_create(CAIRO_FORMAT_A8, width, height), cairo_surface_destroy),
      Cairo_(cairo_create(Surface_.get()), cairo_destroy), Cover_(std::size_t(width) * height, 0),
      Light_(std::size_t(width) * height, {0.0f, 0.0f, 0.0f, 0.0f}) {
  cairo_t* cairo = this->Cairo_.get();
  if (cairo_surface_status(this->Surface_.get()) != CAIRO_STATUS_SUCCESS ||
      cairo_status(cairo) != CAIRO_STATUS_SUCCESS) {
    throw Error(Error::Kind::Resource, "shapes",
                "no memory for " + std::to_string(width) + " x " + std::to_string(height) +
                    " texels");
  }
  cairo_set_antialias(cairo, CAIRO_ANTIALIAS_BEST);
  cairo_set_tolerance(cairo, 0.02);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
  cairo_set_fill_rule(cairo, CAIRO_FILL_RULE_EVEN_ODD);
  cairo_set_source_rgba(cairo, 0.0, 0.0, 0.0, 1.0);
}

VectorCanvas::~VectorCanvas() = default;

void VectorCanvas::Fill(const std::vector<TexelChain>& rings, const Color& color) {
  cairo_t* cairo = this->Cairo_.get();
  Box box;
  cairo_new_path(cairo);
  for (const TexelChain& ring : rings) {
    Trace(cairo, ring);
    cairo_close_path(cairo);
    for (const Eigen::Vector2d& place : ring) {
      box.extend(place);
    }
  }
  if (!box.isEmpty()) {
    cairo_fill(cairo);
    this->Gather(box);
    this->Paint(box, color);
  }
}

void VectorCanvas::Draw(const std::vector<TexelStroke>& strokes, const Color& color) {
  cairo_t* cairo = this->Cairo_.get();
  Box all, box; // of all of them, of those of one pen
  cairo_new_path(cairo);
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const TexelStroke& stroke = strokes[i];
    Trace(cairo, stroke.chain);
    for (const Eigen::Vector2d& place : stroke.chain) {
      box.extend(Eigen::Vector2d(place - stroke.pen));
      box.extend(Eigen::Vector2d(place + stroke.pen));
    }
    if (i + 1 < strokes.size() && strokes[i + 1].pen == stroke.pen) {
      continue;
    }
    cairo_save(cairo);
    cairo_scale(cairo, stroke.pen.x(), stroke.pen.y());
    cairo_set_line_width(cairo, 2.0);
    cairo_stroke(cairo);
    cairo_restore(cairo);
    this->Gather(box);
    all.extend(box);
    box.setEmpty();
  }
  if (!all.isEmpty()) {
    this->Paint(all, color);
  }
}

void VectorCanvas::Disc(const Eigen::Vector2d& middle, const Eigen::Vector2d& half,
                        const Color& color) {
  cairo_t* cairo = this->Cairo_.get();
  cairo_new_path(cairo);
  cairo_save(cairo);
  cairo_translate(cairo, middle.x(), middle.y());
  cairo_scale(cairo, half.x(), half.y());
  cairo_arc(cairo, 0.0, 0.0, 1.0, 0.0, 2.0 * M_PI);
  cairo_restore(cairo);
  cairo_fill(cairo);
  const Box box(Eigen::Vector2d(middle - half), Eigen::Vector2d(middle + half));
  this->Gather(box);
  this->Paint(box, color);
}

VectorCanvas::Texels VectorCanvas::TexelsOf(const Box& box) const {
  const auto index = [](double texel, int most) {
    return static_cast<int>(std::clamp(texel, 0.0, double(most)));
  };
  return {index(std::floor(box.min().x()) - 1.0, this->Width_),
          index(std::ceil(box.max().x()) + 1.0, this->Width_),
          index(std::floor(box.min().y()) - 1.0, this->Height_),
          index(std::ceil(box.max().y()) + 1.0, this->Height_)};
}

// From cairo's surface, which is empty again. Parts that overlap are no darker at their edges.
void VectorCanvas::Gather(const Box& box) {
  cairo_surface_t* surface = this->Surface_.get();
  cairo_surface_flush(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  unsigned char* coverage = cairo_image_surface_get_data(surface);
  const Texels texels = this->TexelsOf(box);
  for (int y = texels.top; y < texels.bottom; ++y) {
    unsigned char* row = coverage + std::ptrdiff_t(y) * stride;
    std::uint8_t* cover = this->Cover_.data() + std::size_t(y) * this->Width_;
    for (int x = texels.left; x < texels.right; ++x) {
      cover[x] = std::max(cover[x], row[x]);
      row[x] = 0;
    }
  }
  cairo_surface_mark_dirty(surface);
}

// What was gathered goes over what is there, and the coverage is 0 again.
void VectorCanvas::Paint(const Box& box, const Color& color) {
  const std::array<double, 3> light = {Linear(color[0]), Linear(color[1]), Linear(color[2])};
  const Texels texels = this->TexelsOf(box);
  for (int y = texels.top; y < texels.bottom; ++y) {
    for (int x = texels.left; x < texels.right; ++x) {
      const std::size_t at = std::size_t(y) * this->Width_ + x;
      if (this->Cover_[at] == 0) {
        continue;
      }
      const double opacity = color[3] * this->Cover_[at] / 255.0;
      std::array<float, 4>& texel = this->Light_[at];
      for (std::size_t k = 0; k < 3; ++k) {
        texel[k] = float(texel[k] * (1.0 - opacity) + light[k] * opacity);
      }
      texel[3] = float(texel[3] * (1.0 - opacity) + opacity);
      this->Cover_[at] = 0;
    }
  }
}

bool VectorCanvas::Finish(std::uint8_t* rgba) const {
  const auto seen = [](const std::array<float, 4>& texel) { return Byte(texel[3]) > 0; };
  if (std::none_of(this->Light_.begin(), this->Light_.end(), seen)) {
    return false;
  }
  for (std::size_t i = 0; i < this->Light_.size(); ++i) {
    const std::array<float, 4>& texel = this->Light_[i];
    const bool some = seen(texel);
    for (std::size_t k = 0; k < 3; ++k) {
      rgba[4 * i + k] = some ? Byte(Encoded(double(texel[k]) / texel[3])) : std::uint8_t(0);
    }
    rgba[4 * i + 3] = some ? Byte(texel[3]) : std::uint8_t(0);
  }
  return true;
}

} // namespace dspace
