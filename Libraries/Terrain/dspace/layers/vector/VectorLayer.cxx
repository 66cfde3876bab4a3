#include <dspace/layers/vector/VectorLayer.h>

#include <cmath>
#include <limits>
#include <map>
#include <mutex>

#include <dspace/Checks.h>

#include <dspace/layers/vector/VectorTracer.h>

namespace dspace {
namespace {

void CheckOptions(const VectorLayerOptions& options, const std::string& object) {
  for (const std::array<double, 4>& color : {options.line, options.fill}) {
    for (const double component : color) {
      Require(component >= 0.0 && component <= 1.0, object, "a component of a colour", component,
              "0 to 1");
    }
  }
  if (options.width) {
    Require(*options.width > 0.0 && *options.width <= 1e7, object, "its width", *options.width,
            "more than 0, up to 1e7 m");
  }
  Require(options.pixels == 0.0 || (options.pixels >= 0.1 && options.pixels <= 64.0), object,
          "its width in pixels", options.pixels, "0, or 0.1 to 64");
  Require(options.point > 0.0 && options.point <= 256.0, object, "the diameter of its points",
          options.point, "more than 0, up to 256");
}

// Metres a map unit, about.
double MetresOf(const Crs& crs) {
  return crs.GetKind() == Crs::Kind::Geographic
             ? crs.GetUnit() * M_PI / 180.0 * crs.GetAxes().semiMajor
             : crs.GetUnit();
}

double PixelSizeOf(const VectorFile& file, const RasterPlace& terrain,
                   const VectorLayerOptions& options) {
  double whole = 0.0;
  double smallest = std::numeric_limits<double>::infinity();
  for (const VectorGroup& group : file.groups) {
    const double metres = MetresOf(group.crs);
    Eigen::AlignedBox2d all;
    for (const VectorShape& shape : group.shapes) {
      Eigen::AlignedBox2d box;
      for (const Eigen::Vector2d& place : shape.rings.front().places) {
        box.extend(place);
      }
      all.extend(box);
      const double size = metres * box.diagonal().norm();
      if (shape.kind != VectorShape::Kind::Point && size > 0.0) {
        smallest = std::min(smallest, size);
      }
    }
    if (!all.isEmpty()) {
      whole = std::max(whole, metres * all.diagonal().norm());
    }
  }
  const Eigen::Matrix2d& pixel = terrain.pixelToMap.linear();
  double size = MetresOf(terrain.crs) * std::min(pixel.col(0).norm(), pixel.col(1).norm());
  size = std::min(size, smallest / 64.0);
  if (whole > 0.0) {
    size = std::min(size, whole / 1000.0);
  }
  if (options.width) {
    size = std::min(size, *options.width / 4.0);
  }
  return std::max({size, whole * 1e-6, 1e-4});
}

// Whether a box meets the raster, in any turn.
bool Meets(const RasterPlace& terrain, const Eigen::AlignedBox2d& box, double turn) {
  Eigen::AlignedBox2d raster;
  for (const double x : {0.0, double(terrain.columns)}) {
    for (const double y : {0.0, double(terrain.rows)}) {
      raster.extend(terrain.pixelToMap * Eigen::Vector2d(x, y));
    }
  }
  Eigen::AlignedBox2d moved = box;
  if (turn > 0.0) {
    const double back = std::floor((box.max().x() - raster.min().x()) / turn) * turn;
    moved.translate(Eigen::Vector2d(-back, 0.0)); // the first turn that reaches it
  }
  return raster.intersects(moved);
}

class VectorLayer : public ColorLayer {
public:
  VectorLayer(const std::string& path, const RasterPlace& terrain,
              const VectorLayerOptions& options)
      : Name_("shapes '" + path + "'"), Options_(options) {
    CheckOptions(options, this->Name_);
    this->File_ = ReadVectorFile(path, terrain, options);
    this->PixelSize_ = PixelSizeOf(this->File_, terrain, options);
    const std::shared_ptr<const VectorPlaces> places = this->PlacesOn(terrain.crs, std::nullopt);
    if (places->lost > 0) {
      this->File_.warnings.push_back(this->Name_ + ": " + std::to_string(places->lost) +
                                     " shapes lie, at least in part, where the CRS of " +
                                     terrain.name + " has no place; areas of them are left out");
    }
    bool met = false;
    for (const PlacedGroup& group : places->groups) {
      for (const PlacedShape& shape : group.shapes) {
        met = met || Meets(terrain, shape.box, places->turn);
      }
    }
    if (!met) {
      Reject(this->Name_, "none of its features overlaps " + terrain.name);
    }
  }

  const std::string& GetName() const override { return this->Name_; }
  double PixelSize() const override { return this->PixelSize_; }
  const std::vector<std::string>& Warnings() const override { return this->File_.warnings; }

  bool Read(const ColorGrid& grid, const ColorBlock& block, std::uint8_t* rgba) const override {
    const std::shared_ptr<const VectorPlaces> places =
        this->PlacesOn(grid.crs, FarPole(grid.placement));
    const VectorTracer tracer(grid, block, places->turn);
    std::unique_ptr<VectorCanvas> canvas; // most blocks of most layers have nothing
    std::pair<double, double> last = {-1.0, -1.0};
    double reach = 0.0; // of the last width: most shapes have the same
    for (const PlacedGroup& group : places->groups) {
      for (const PlacedShape& shape : group.shapes) {
        const VectorTracer::Width width = this->WidthOf(*shape.shape);
        if (std::pair(width.metres, width.pixels) != last) {
          last = {width.metres, width.pixels};
          reach = tracer.Reach(width);
        }
        const std::vector<Eigen::Vector2d> turns = tracer.Turns(shape.box, reach);
        if (turns.empty()) {
          continue;
        }
        if (!canvas) {
          canvas = std::make_unique<VectorCanvas>(block.width, block.height);
        }
        this->Paint(shape, *group.conversion, tracer, turns, width, *canvas);
      }
    }
    return canvas && canvas->Finish(rgba);
  }

private:
  VectorTracer::Width WidthOf(const VectorShape& shape) const {
    const bool metres = this->Options_.width.has_value();
    if (shape.kind == VectorShape::Kind::Point) {
      return {metres ? this->Options_.point * *this->Options_.width : 0.0, this->Options_.point};
    }
    const std::optional<double>& own = this->File_.looks[shape.look].pixels;
    return {metres && !own ? *this->Options_.width : 0.0, own.value_or(this->Options_.pixels)};
  }

  void Paint(const PlacedShape& shape, const MapConversion& conversion, const VectorTracer& tracer,
             const std::vector<Eigen::Vector2d>& turns, const VectorTracer::Width& width,
             VectorCanvas& canvas) const {
    const VectorStyle& look = this->File_.looks[shape.shape->look];
    if (shape.shape->kind == VectorShape::Kind::Point) {
      for (const Eigen::Vector2d& turn : turns) {
        const Eigen::Vector2d middle = tracer.ToTexel(shape.rings[0].map[0]) + turn;
        canvas.Disc(middle, tracer.PenAt(middle, width), look.point);
      }
      return;
    }
    if (shape.shape->kind == VectorShape::Kind::Area && look.fill[3] > 0.0) {
      std::vector<TexelChain> rings;
      if (shape.outside) { // even-odd: what is not within its rings
        rings.push_back(tracer.Block());
      }
      for (const PlacedRing& ring : shape.rings) {
        for (const Eigen::Vector2d& turn : turns) {
          rings.push_back(tracer.Area(ring, conversion, turn));
        }
      }
      canvas.Fill(rings, look.fill);
    }
    if (look.line[3] > 0.0 && (width.metres > 0.0 || width.pixels > 0.0)) {
      std::vector<TexelStroke> strokes;
      for (const PlacedRing& ring : shape.rings) {
        for (const Eigen::Vector2d& turn : turns) {
          tracer.Path(ring, conversion, turn, width, strokes);
        }
      }
      canvas.Draw(strokes, look.line);
    }
  }

  // Of a pole's chart the other one [deg].
  static std::optional<double> FarPole(const PostPlacement& placement) {
    if (placement.GetKind() != PostPlacement::Kind::Pole) {
      return std::nullopt;
    }
    return placement.South() ? 90.0 : -90.0;
  }

  // Made once for each CRS.
  std::shared_ptr<const VectorPlaces> PlacesOn(const Crs& map, std::optional<double> far) const {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    std::shared_ptr<const VectorPlaces>& places =
        this->Places_[(far ? "pole " : "") + map.GetWkt()];
    if (!places) {
      places = std::make_shared<const VectorPlaces>(this->File_, map, far, this->Name_);
    }
    return places;
  }

  std::string Name_;
  VectorLayerOptions Options_;
  VectorFile File_;
  double PixelSize_ = 0.0;
  mutable std::mutex Mutex_;
  mutable std::map<std::string, std::shared_ptr<const VectorPlaces>> Places_;
};

} // namespace

std::shared_ptr<const ColorLayer> OpenVectorLayer(const std::string& path,
                                                  const RasterPlace& terrain,
                                                  const VectorLayerOptions& options) {
  return std::make_shared<VectorLayer>(path, terrain, options);
}

} // namespace dspace
