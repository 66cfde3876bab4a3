#include <dspace/clipmap/gl/GridCaptions.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <optional>
#include <utility>

#include <dspace/overlay/RoundNumbers.h>
#include <dspace/render/RenderTarget.h>

namespace dspace {
namespace {

constexpr double RadianInDegrees = 180.0 / M_PI;
constexpr std::size_t MaximumPerDirection = 20;

// A pixel in which the ground is seen.
struct Seen {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector2d value = Eigen::Vector2d::Zero(); // map x, y; longitude, latitude [deg]
};

// A row or column of the picture, pixel by pixel; none where no ground is seen.
using Strip = std::vector<std::optional<Seen>>;

class Ground {
public:
  Ground(const CustomDrawing& drawing, const RenderTarget& target, const ClipmapTerrain& terrain,
         const PostPlacement& placement, const ClipmapLevels& levels,
         const ClipmapLevels::State& state)
      : Drawing_(drawing), Target_(target), Terrain_(terrain), Placement_(placement),
        Levels_(levels), State_(state), X_SV_(drawing.object.X_VO.inverse()) {}

  int Width() const { return this->Drawing_.view.width / this->Drawing_.samples; }
  int Height() const { return this->Drawing_.view.height / this->Drawing_.samples; }
  Strip Row(int y) const {
    const int samples = this->Drawing_.samples;
    const int row = y * samples + samples / 2;
    const std::vector<float> depths = this->Target_.ReadDepth(0, row, this->Drawing_.view.width, 1);
    Strip strip;
    for (int x = 0; x < this->Width(); ++x) {
      const int column = x * samples + samples / 2;
      strip.push_back(this->At(column, row, depths[std::size_t(column)]));
    }
    return strip;
  }
  Strip Column(int x) const {
    const int samples = this->Drawing_.samples;
    const int column = x * samples + samples / 2;
    const std::vector<float> depths =
        this->Target_.ReadDepth(column, 0, 1, this->Drawing_.view.height);
    Strip strip;
    for (int y = 0; y < this->Height(); ++y) {
      const int row = y * samples + samples / 2;
      strip.push_back(this->At(column, row, depths[std::size_t(row)]));
    }
    return strip;
  }

private:
  // Of a sample and the depth buffer there.
  std::optional<Seen> At(int column, int row, float depth) const {
    if (!(depth > 0.0f)) {
      return std::nullopt;
    }
    const DrawView& view = this->Drawing_.view;
    const double z = view.projection.DepthFromBuffer(depth);
    const Projection::Ray ray = view.projection.PixelRay(column, row, view.width, view.height);
    const Eigen::Vector3d p_C =
        ray.origin + ray.direction * ((z - ray.origin.z()) / ray.direction.z());
    const Eigen::Vector3d post =
        this->Placement_.ToPosts(this->X_SV_ * Eigen::Vector3d(p_C.x(), -p_C.y(), -p_C.z()));
    const double pixel = view.projection.MetresPerPixel(z, this->Height());
    if (!post.allFinite() || !this->OnGround(post, 3.0 * pixel)) {
      return std::nullopt; // something stands before it
    }
    Seen seen;
    const double samples = this->Drawing_.samples;
    seen.pixel = (Eigen::Vector2d(column, row).array() + 0.5) / samples - 0.5;
    seen.value = this->Placement_.OnBody()
                     ? Eigen::Vector2d(this->Placement_.Angles(post.head<2>()) * RadianInDegrees)
                     : Eigen::Vector2d(this->Terrain_.Options().postToMap * post.head<2>());
    return seen;
  }

  // Whether the height is that of the ground that is drawn there, or between those of the two
  // levels that it is blended of.
  bool OnGround(const Eigen::Vector3d& post, double tolerance) const {
    const PostLattice& lattice = this->Levels_.Lattice();
    Eigen::Vector2d place = post.head<2>();
    if (lattice.periodic) {
      const auto turn = double(lattice.columns);
      place.x() += turn * std::round((this->State_.place.x() - place.x()) / turn);
    }
    const double away = (place - this->State_.place).cwiseAbs().maxCoeff();
    int level = this->State_.finest;
    while (level + 1 < this->Levels_.Count() &&
           away > this->Levels_.Geometry().BlendTo() * std::ldexp(1.0, level)) {
      ++level;
    }
    double low = 1e300;
    double high = -1e300;
    for (const int each : {level, level + 1}) {
      if (each < this->Levels_.Count()) {
        this->Extend(each, place, low, high);
      }
    }
    const double rounding = 1e-6 * (std::abs(post.z()) + this->Placement_.Radius());
    return post.z() > low - tolerance - rounding && post.z() < high + tolerance + rounding;
  }

  // Heights at the corners of the level's cell, a cell around it where the ground is steep.
  void Extend(int level, const Eigen::Vector2d& place, double& low, double& high) const {
    const ClipmapWindow& window = this->Levels_.Window(level);
    const std::int64_t cells = this->Levels_.Geometry().Cells();
    const Eigen::Vector2d at = place * std::ldexp(1.0, -level);
    const auto column = static_cast<std::int64_t>(std::floor(at.x()));
    const auto row = static_cast<std::int64_t>(std::floor(at.y()));
    for (std::int64_t c = column; c <= column + 1; ++c) {
      for (std::int64_t r = row; r <= row + 1; ++r) {
        if (c < window.column || r < window.row || c > window.column + cells ||
            r > window.row + cells) {
          continue;
        }
        const ClipmapTexel& texel = this->Levels_.Texel(level, c, r);
        if (texel.hole < 0.75f) {
          low = std::min<double>(low, texel.height);
          high = std::max<double>(high, texel.height);
        }
      }
    }
  }

  const CustomDrawing& Drawing_;
  const RenderTarget& Target_;
  const ClipmapTerrain& Terrain_;
  const PostPlacement& Placement_;
  const ClipmapLevels& Levels_;
  const ClipmapLevels::State& State_;
  Eigen::Affine3d X_SV_;
};

// Lines of one direction, by their multiples of the interval; places in the order of preference.
using Places = std::map<std::int64_t, std::vector<Eigen::Vector2d>>;

// `around`: values are longitudes.
void AddCrossings(const Strip& strip, int family, double interval, bool around, Places& places) {
  for (std::size_t i = 0; i + 1 < strip.size(); ++i) {
    if (!strip[i] || !strip[i + 1]) {
      continue;
    }
    const double from = strip[i]->value[family];
    double step = strip[i + 1]->value[family] - from;
    if (around) {
      step = std::remainder(step, 360.0);
    }
    const double first = std::floor(from / interval);
    const double last = std::floor((from + step) / interval);
    // Closer than two pixels lines are not drawn; more than one a pixel are none of the ground's.
    if (std::abs(last - first) != 1.0 || std::abs(step) > 0.5 * interval) {
      continue;
    }
    const double line = std::max(first, last) * interval;
    const Eigen::Vector2d at =
        strip[i]->pixel + (line - from) / step * (strip[i + 1]->pixel - strip[i]->pixel);
    double value = line;
    if (around) {
      value = std::remainder(line, 360.0);
      value = value <= -180.0 + 1e-9 ? value + 360.0 : value;
    }
    places[std::llround(value / interval)].push_back(at);
  }
}

// Of more lines than there may be, every second, fifth, tenth, ...
void Thin(Places& places) {
  for (std::int64_t ten = 1; places.size() > MaximumPerDirection; ten *= 10) {
    for (const std::int64_t digit : {2, 5, 10}) {
      for (auto it = places.begin(); it != places.end() && places.size() > MaximumPerDirection;) {
        it = it->first % (digit * ten) != 0 ? places.erase(it) : std::next(it);
      }
    }
  }
}

std::string TextOf(double value, double interval, int family, bool degrees) {
  const std::string number = RoundText(degrees ? std::abs(value) : value, interval);
  if (!degrees) {
    return number + (family == 0 ? " E" : " N");
  }
  const bool none = family == 0 && std::abs(value) > 180.0 - 1e-9;
  const char* side = value >= 0.0 ? (family == 0 ? "E" : "N") : (family == 0 ? "W" : "S");
  return number + "°" + (none ? "" : side); // "0°E", "0°N": which of the two it is
}

// Whether the box is within the picture and touches none of the others.
bool Fits(const Caption& caption, const std::vector<Caption>& others, int width, int height) {
  const auto half = HalfSize(caption);
  if (caption.at[0] < half[0] || caption.at[1] < half[1] || caption.at[0] > width - 1 - half[0] ||
      caption.at[1] > height - 1 - half[1]) {
    return false;
  }
  return std::none_of(others.begin(), others.end(), [&](const Caption& other) {
    const auto its = HalfSize(other);
    return std::abs(other.at[0] - caption.at[0]) < half[0] + its[0] &&
           std::abs(other.at[1] - caption.at[1]) < half[1] + its[1];
  });
}

// Meridians and lines of one x cross rows, the others columns: these come first.
Places PlacesOf(const std::vector<Strip>& rows, const std::vector<Strip>& columns, int family,
                double interval, bool around) {
  Places places;
  for (const auto* strips : {family == 0 ? &rows : &columns, family == 0 ? &columns : &rows}) {
    for (const Strip& strip : *strips) {
      AddCrossings(strip, family, interval, around && family == 0, places);
    }
  }
  return places;
}

// Adds the captions for which there is room; those of `places` that have none are left.
void Write(Places& places, int family, double interval, const ClipmapStyle::GridLabels& look,
           int width, int height, std::vector<Caption>& captions) {
  for (auto it = places.begin(); it != places.end();) {
    Caption caption;
    caption.text = TextOf(double(it->first) * interval, interval, family, look.degrees);
    caption.fontSize = look.fontSize;
    caption.color = {look.color[0], look.color[1], look.color[2], 1.0};
    caption.background = {look.background[0], look.background[1], look.background[2],
                          look.backgroundOpacity};
    const auto found =
        std::find_if(it->second.begin(), it->second.end(), [&](const Eigen::Vector2d& at) {
          caption.at = {at.x(), at.y()};
          return Fits(caption, captions, width, height);
        });
    if (found == it->second.end()) {
      ++it;
      continue;
    }
    captions.push_back(caption);
    it = places.erase(it);
  }
}

} // namespace

std::vector<Caption> GridCaptions(const CustomDrawing& drawing, const RenderTarget& target,
                                  const ClipmapTerrain& terrain, const ClipmapStyle& style,
                                  const PostPlacement& placement, const ClipmapLevels& levels,
                                  const ClipmapLevels::State& state) {
  const ClipmapStyle::GridLabels& look = *style.gridLabels;
  const double interval = style.grid->interval;
  const Ground ground(drawing, target, terrain, placement, levels, state);
  const int width = ground.Width();
  const int height = ground.Height();
  // Inwards by a line of text, and by some characters.
  const double below = std::min(2 * look.fontSize, height / 2);
  const double beside = std::min(4 * look.fontSize, width / 2);
  const auto rows = [&](std::initializer_list<double> at) {
    std::vector<Strip> strips;
    for (const double y : at) {
      strips.push_back(ground.Row(std::clamp(int(y), 0, height - 1)));
    }
    return strips;
  };
  const auto columns = [&](std::initializer_list<double> at) {
    std::vector<Strip> strips;
    for (const double x : at) {
      strips.push_back(ground.Column(std::clamp(int(x), 0, width - 1)));
    }
    return strips;
  };
  // Odd parts of the picture: lines of a globe that fills it lie along its halves and quarters.
  const double w = width;
  const double h = height;
  const auto strips = std::pair(rows({h - 1 - below, below, 0.71 * h, 0.29 * h, 0.55 * h}),
                                columns({beside, w - 1 - beside, 0.27 * w, 0.73 * w, 0.46 * w}));
  const bool around = placement.OnBody();
  std::vector<Caption> captions;
  Places left[2];
  for (const int family : {0, 1}) {
    left[family] = PlacesOf(strips.first, strips.second, family, interval, around);
    Thin(left[family]);
    Write(left[family], family, interval, look, width, height, captions);
  }
  if (!left[0].empty() || !left[1].empty()) { // those that others are in the way of
    const auto more = std::pair(rows({0.83 * h, 0.62 * h, 0.38 * h, 0.17 * h}),
                                columns({0.14 * w, 0.86 * w, 0.62 * w, 0.37 * w}));
    for (const int family : {0, 1}) {
      Places others = PlacesOf(more.first, more.second, family, interval, around);
      for (auto it = others.begin(); it != others.end();) {
        it = left[family].count(it->first) ? std::next(it) : others.erase(it);
      }
      Write(others, family, interval, look, width, height, captions);
    }
  }
  return captions;
}

} // namespace dspace
