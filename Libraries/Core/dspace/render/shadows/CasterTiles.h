// Where a shadow map may hold casters.
#ifndef DSPACE_RENDER_SHADOWS_CASTER_TILES_H
#define DSPACE_RENDER_SHADOWS_CASTER_TILES_H

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/render/shadows/CascadeFit.h>
#include <dspace/render/shadows/LightPlace.h>

namespace dspace {

// A coarse grid over one map. Each tile knows how high things reach towards the Sun that may be in
// it, or up to Margin texels beside it, and how low. A place above all casters of its tile is lit
// by this map, so that no texel need be read; texels without casters need be neither cleared nor
// drawn; a caster below all that may take its shadow need not be drawn. Conservative: a tile may
// hold nothing, but what is drawn has a tile.
class CasterTiles {
public:
  static constexpr int Side = 64;            // tiles along each side of a map
  static constexpr int Margin = 8;           // texels; the shader searches 7 beside a place
  static constexpr float Nothing = -3.0e38f; // the top of a tile without casters
  static constexpr float Everything = 3.0e38f;

  CasterTiles(const CascadeFit& fit, const CascadeFit::Cascade& cascade);

  void Add(const LightPlace& place);
  void Add(const LightHull& hull) { this->Add(this->PlaceOf(hull)); }
  void Add(const LightPlace::Extent& extent);
  void Add(const Eigen::AlignedBox3d& box); // along U, V and S [m]
  void AddEverywhere();                     // of what has no known bounds
  // Whether something lies in so many tiles that its parts, if it has any, are taken one by one.
  bool InParts(const LightPlace& place) const;

  // Whether casters of these tiles may throw shadows on the place.
  bool Shade(const LightPlace& place) const;
  bool Shade(const LightHull& place) const { return this->Shade(this->PlaceOf(place)); }
  // Whether a caster may throw shadows on what is in these tiles and at least `above` [m] lower
  // along the light.
  bool TakeShadows(const LightPlace& caster, double above) const;
  bool TakeShadows(const LightHull& caster, double above) const {
    return this->TakeShadows(this->PlaceOf(caster), above);
  }

  // Row by row from the least V, each from the least U: the highest point along S, from the camera
  // [m]; Nothing where nothing is.
  const std::vector<float>& Tops() const { return this->Tops_; }
  bool Empty() const;
  // Texels [first, last) along U and V that hold everything and the margin about it, within the
  // map: {first U, first V, last U, last V}. Zeros for an empty grid.
  std::array<int, 4> Texels() const;

private:
  using Extent = LightPlace::Extent;
  // A bound over the tiles of a row: start + step times the tile's number along U, and no more (of
  // the highest) or less (of the lowest) than `bound`.
  struct Line {
    double bound;
    double start;
    double step;
  };
  LightPlace PlaceOf(const LightHull& hull) const { return LightPlace(this->Axes_, hull); }
  void Hold(const std::array<int, 4>& tiles); // something is in these now
  bool TakeShadows(const Extent& caster, double above) const;
  bool TakeShadows(const Eigen::AlignedBox3d& caster, double above) const;
  // Of tiles, with `room` [m] beside the range: first U, first V, last U, last V, the last not
  // among them; none: beside the map.
  std::optional<std::array<int, 4>> TilesOf(const Eigen::AlignedBox3d& box, double room) const;
  // Of a row's tiles [left, right), those about which, with `room` [m], the sides leave something:
  // first and past the last.
  std::array<int, 2> SpanOf(const Extent& extent, int row, int left, int right, double room) const;
  // `taken(row, first, end, high, low)` for each row of tiles of an extent, with the greatest and
  // the least S over them and `room` [m] about them, until it returns true; `row`: the place of its
  // first tile. Returns whether it did.
  template<class Taken>
  bool AnyRow(const Extent& extent, const std::array<int, 4>& tiles, double room,
              const Taken& taken) const;
  // The least (-1) or greatest (1) S of a plane over the tiles of row j and `room` [m] about them.
  Line LineOf(const std::optional<Eigen::Vector3d>& plane, double bound, int j, double room,
              double sign) const;

  Eigen::Matrix3d Axes_;   // rows U, V, S, from view axes
  Eigen::Vector2d Corner_; // the map's least U and V [m]
  double Texel_;           // [m]
  double Tile_;            // [m]
  int Size_;
  std::vector<float> Tops_;
  std::vector<float> Lows_;
  std::array<int, 4> Tiles_ = {Side, Side, 0, 0}; // first and past the last that hold something
};

// Whether any map of the fit may hold blockers of the place. `tiles`: casters of the fit's
// cascades.
bool MayBeShaded(const CascadeFit& fit, const std::vector<CasterTiles>& tiles,
                 const LightPlace& place);

} // namespace dspace

#endif
