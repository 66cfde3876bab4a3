#include <dspace/render/ViewExplanation.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include <dspace/render/DrawList.h>
#include <dspace/scene/Stretch.h>

namespace dspace {
namespace {

using Reason = ObjectVisibility::Reason;

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

bool IsEmpty(const GraphicsObject& object) {
  if (object.custom) {
    return false;
  }
  for (const DetailLevel& level : object.levels) {
    for (const Part& part : level.parts) {
      const auto over = object.parts.find(part.name);
      if (part.mesh->PrimitiveCount() > 0 && (over == object.parts.end() || over->second.visible)) {
        return false;
      }
    }
  }
  return true;
}

bool IsTransparent(const GraphicsObject& object) {
  if (object.custom || object.levels.empty()) {
    return object.material.opacity == 0.0;
  }
  for (const DetailLevel& level : object.levels) {
    for (const Part& part : level.parts) {
      const auto over = object.parts.find(part.name);
      const auto own =
          over == object.parts.end() ? std::optional<double>() : over->second.material.opacity;
      const double opacity = own.value_or(object.material.opacity.value_or(part.material->opacity));
      if (opacity > 0.0) {
        return false;
      }
    }
  }
  return true;
}

// Where an object is, in the camera's axes.
struct Place {
  std::vector<Eigen::Vector3d> corners; // of its box; of a billboard its origin
  double radius = 0.0;                  // about each corner: custom geometry is its sphere
  double low = 0.0, high = 0.0;         // depths
  BoundingSphere sphere;
};

Place PlaceOf(const Scene& scene, const DrawView& view, const GraphicsObject& object) {
  const Pose X_CF =
      view.camera.X_FC.Inverse() * scene.Frames().RelativePose(view.camera.frame, object.frame);
  Eigen::Affine3d X_CO;
  X_CO.matrix() = X_CF.Matrix();
  X_CO = X_CO * object.X_FO;
  const double stretch = LargestStretch(X_CO);
  Place place;
  if (object.billboard) {
    place.sphere.center = X_CO.translation();
    place.corners = {place.sphere.center};
  } else if (object.custom) {
    const BoundingSphere sphere = object.custom->Bounds();
    place.sphere = {X_CO * sphere.center, sphere.radius * stretch};
    place.corners = {place.sphere.center};
    place.radius = place.sphere.radius;
  } else {
    const DetailLevel& level = object.levels.front();
    place.sphere = {X_CO * level.sphere.center, level.sphere.radius * stretch};
    for (int i = 0; i < 8; ++i) {
      place.corners.push_back(X_CO *
                              level.box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
    }
  }
  place.low = std::numeric_limits<double>::infinity();
  place.high = -place.low;
  for (const Eigen::Vector3d& corner : place.corners) {
    place.low = std::min(place.low, corner.z() - place.radius);
    place.high = std::max(place.high, corner.z() + place.radius);
  }
  return place;
}

// The border that all of an object is beyond; null: none.
const char* BorderBeyond(const Place& place, const DrawView& view) {
  const Projection::Ray first = view.projection.PixelRay(-0.5, -0.5, view.width, view.height);
  const Projection::Ray last =
      view.projection.PixelRay(view.width - 0.5, view.height - 0.5, view.width, view.height);
  const char* names[4] = {"left", "top", "right", "bottom"};
  for (int border = 0; border < 4; ++border) {
    const int axis = border % 2;
    const double sign = border < 2 ? 1.0 : -1.0;
    const Projection::Ray& ray = border < 2 ? first : last;
    // Inwards from the border, in the plane of the axis and Z.
    const double slope = ray.direction[axis] / ray.direction.z();
    const double length = std::hypot(1.0, slope);
    const bool beyond =
        std::all_of(place.corners.begin(), place.corners.end(), [&](const Eigen::Vector3d& p) {
          return sign * (p[axis] - ray.origin[axis] - slope * p.z()) / length < -place.radius;
        });
    if (beyond) {
      return names[border];
    }
  }
  return nullptr;
}

std::string PixelText(const Projection::PixelPoint& pixel) {
  return pixel.visible ? "its centre is at pixel (" + Number(pixel.x) + ", " + Number(pixel.y) + ")"
                       : "its centre is " + Number(pixel.depth) + " m along the camera's Z";
}

// The object most often seen where `place` is; 0: none.
ObjectId Occluder(const Place& place, const DrawView& view,
                  const std::vector<std::uint32_t>& labels) {
  double x0 = view.width, x1 = -1, y0 = view.height, y1 = -1;
  for (const Eigen::Vector3d& corner : place.corners) {
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d p =
          corner + place.radius * Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
      const Projection::PixelPoint pixel = view.projection.Project(p, view.width, view.height);
      if (!pixel.visible) { // it reaches behind the camera
        x0 = y0 = 0;
        x1 = view.width;
        y1 = view.height;
        continue;
      }
      x0 = std::min(x0, pixel.x);
      x1 = std::max(x1, pixel.x);
      y0 = std::min(y0, pixel.y);
      y1 = std::max(y1, pixel.y);
    }
  }
  const auto pixelOf = [](double value, int size) {
    return int(std::clamp(std::floor(value + 0.5), 0.0, size - 1.0));
  };
  std::map<ObjectId, std::uint64_t> counts;
  for (int y = pixelOf(y0, view.height); y <= pixelOf(y1, view.height); ++y) {
    for (int x = pixelOf(x0, view.width); x <= pixelOf(x1, view.width); ++x) {
      ++counts[labels[std::size_t(y) * std::size_t(view.width) + std::size_t(x)]];
    }
  }
  counts.erase(0);
  ObjectId most = 0;
  for (const auto& [id, count] : counts) {
    if (most == 0 || count > counts[most]) {
      most = id;
    }
  }
  return most;
}

// Of an object that is drawn but not seen.
void ExplainUnseen(const Scene& scene, const DrawView& view, const GraphicsObject& object,
                   const std::vector<std::uint32_t>& labels, ObjectVisibility& out) {
  const Projection& projection = view.projection;
  const Place place = PlaceOf(scene, view, object);
  const auto depths = [&place] {
    return "from " + Number(place.low) + " to " + Number(place.high) + " m along the camera's Z";
  };
  if (place.high < 0.0 && place.high < projection.Near()) {
    out.reason = Reason::Behind;
    out.text = "It is behind the camera: it reaches " + depths() + ".";
    return;
  }
  if (place.high < projection.Near()) {
    out.reason = Reason::BeforeNear;
    out.text = "It is before the near plane at " + Number(projection.Near()) + " m: it reaches " +
               depths() + ".";
    return;
  }
  if (place.low > projection.Far()) {
    out.reason = Reason::BeyondFar;
    out.text = "It is beyond the far plane at " + Number(projection.Far()) + " m: it reaches " +
               depths() + ".";
    return;
  }
  const Projection::PixelPoint pixel =
      projection.Project(place.sphere.center, view.width, view.height);
  const std::string size =
      std::to_string(view.width) + " x " + std::to_string(view.height) + " pixels";
  if (const char* border = BorderBeyond(place, view)) {
    out.reason = Reason::Outside;
    out.text = std::string("It is beyond the ") + border +
               " border of the picture: " + PixelText(pixel) + " of " + size + ".";
    return;
  }
  if (!object.billboard) {
    const double depth = std::max(place.sphere.center.z(), 1e-9);
    const double pixels = 2.0 * place.sphere.radius / projection.MetresPerPixel(depth, view.height);
    if (object.levels.size() > 0 && LevelFor(object.levels, pixels) < 0) {
      out.reason = Reason::TooSmall;
      out.text = "It is too small: its diameter is " + Number(pixels) +
                 " pixels, and its coarsest level is drawn from " +
                 Number(object.levels.back().minimumPixels) + " pixels on.";
      return;
    }
    if (pixels < 1.5) {
      out.reason = Reason::TooSmall;
      out.text = "It is too small: its diameter is " + Number(pixels) + " pixels, at " +
                 Number(depth) + " m along the camera's Z.";
      return;
    }
  }
  const ObjectId before = Occluder(place, view, labels);
  if (before == 0) {
    out.reason = Reason::Outside;
    out.text = "Its box reaches into the picture, but none of its surface: " + PixelText(pixel) +
               " of " + size + ".";
    return;
  }
  out.reason = Reason::Occluded;
  out.text = "It is hidden by '" + scene.Object(before).name + "': " + PixelText(pixel) + ", at " +
             Number(place.sphere.center.z()) + " m along the camera's Z.";
}

ObjectVisibility Explain(const Scene& scene, const DrawView& view, const DrawFilter& filter,
                         const GraphicsObject& object, const std::vector<std::uint32_t>& labels,
                         std::uint64_t pixels) {
  ObjectVisibility out;
  out.object = object.id;
  const SceneFragment& fragment = scene.Fragments().Get(object.fragment);
  if (!object.visible) {
    out.reason = Reason::Hidden;
    out.text = "The object itself is hidden.";
  } else if (!fragment.visible) {
    out.reason = Reason::FragmentHidden;
    out.text = "Its fragment '" + object.fragment + "' is hidden in all viewports.";
  } else if (filter.hiddenFragments.count(object.fragment)) {
    out.reason = Reason::FragmentHidden;
    out.text = "Its fragment '" + object.fragment + "' is hidden in this viewport.";
  } else if (filter.physicalOnly && object.nature == Nature::Ornamental) {
    out.reason = Reason::OrnamentsHidden;
    out.text = "It is ornamental, and the viewport draws no ornaments.";
  } else if (IsEmpty(object)) {
    out.reason = Reason::Empty;
    out.text = "It has nothing to draw.";
  } else if (IsTransparent(object)) {
    out.reason = Reason::Transparent;
    out.text = "Its opacity is 0.";
  } else if (pixels > 0) {
    out.reason = Reason::Seen;
    out.pixels = pixels;
    out.text = std::to_string(pixels) + (pixels == 1 ? " pixel shows it." : " pixels show it.");
  } else {
    ExplainUnseen(scene, view, object, labels, out);
  }
  return out;
}

} // namespace

std::vector<ObjectVisibility> ExplainView(const Scene& scene, const DrawView& view,
                                          const DrawFilter& filter,
                                          const std::vector<std::uint32_t>& labels) {
  std::map<ObjectId, std::uint64_t> counts;
  for (const std::uint32_t label : labels) {
    ++counts[label];
  }
  std::vector<ObjectVisibility> out;
  out.reserve(scene.Objects().size());
  for (const auto& [id, object] : scene.Objects()) {
    const auto found = counts.find(id);
    out.push_back(
        Explain(scene, view, filter, object, labels, found == counts.end() ? 0 : found->second));
  }
  return out;
}

} // namespace dspace
