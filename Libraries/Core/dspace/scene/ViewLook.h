// How a viewport lights and exposes its pictures.
#ifndef DSPACE_SCENE_VIEW_LOOK_H
#define DSPACE_SCENE_VIEW_LOOK_H

namespace dspace {

// Shadows of the Sun. Off: everything that faces the Sun is lit.
struct ShadowLook {
  static constexpr int MaximumCascades = 8;
  static constexpr int MinimumSize = 256;
  static constexpr int MaximumSize = 16384; // or what OpenGL has, if that is less

  bool shown = false;
  int cascades = 4;      // shadow maps, each for a range of distances; 1 to MaximumCascades
  int size = 2048;       // texels a side of each map
  double distance = 0.0; // [m] along the view's axis that the maps reach; 0: as the view requires
  bool cascadeColors = false; // each map's range of distances in a colour of its own, for engineers
  bool litColors = false;     // how much of the Sun's disc is seen, 0 to 1, in false colours
};

// From linear light, exposed, to what sRGB then encodes. Linear: up to 1, which what is brighter
// shows too. Filmic, for each of red, green and blue: x (2.51 x + 0.03) / (x (2.43 x + 0.59) +
// 0.14), up to 1 (K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2015), which darkens shadows and
// keeps detail up to 7 or so.
enum class ToneCurve { Linear, Filmic };

// Lit surfaces are exposed: light that they reflect, of whatever source, and light that they add
// (emissive). Display colours stay as they are: the background, unlit objects with most ornaments
// among them, overlays, and props of VTK, which VTK shades by its own rules: those of a renderer
// never follow the exposure, those of a scene follow a fixed one with the linear curve, which
// multiplies their lights. Translucent surfaces are treated as what is opaque behind them.
// False colour that lets lit ground through is laid over it once that is exposed. Each sample is
// exposed on its own.
struct ViewLook {
  ShadowLook shadows;
  // White light from all directions, for the eye: a fraction of the Sun's, 0 to 1. Physical
  // pictures have none, nor has a scene without a Sun.
  double fill = 0.0;
  double exposure = 1.0; // factor on linear light, > 0; at 1 a white matt surface that faces
                         // the Sun at 1 au shows 1
  // `exposure` then multiplies what the picture itself requires: the factor that takes the 99th
  // percentile of the luminances (ITU-R BT.709) above 0 of lit surfaces to 0.6, before the curve.
  // They are those of a grid of at most 256 x 256 points of the picture. A picture without light
  // has the factor 1.
  bool automaticExposure = false;
  ToneCurve tone = ToneCurve::Linear;
};

// Whether the exposure multiplies the lights, and no more is to do; else the picture is drawn in
// linear light and exposed then, which takes longer.
inline bool ExposedByLights(const ViewLook& look) {
  return !look.automaticExposure && look.tone == ToneCurve::Linear;
}

} // namespace dspace

#endif
