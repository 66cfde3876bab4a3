#include <dspace/clipmap/gl/ClipmapShaders.h>

#include <string>

#include "ClipmapColor_frag.h"
#include "ClipmapDetails_frag.h"
#include "ClipmapHead_vert.h"
#include "ClipmapHorizon_frag.h"
#include "ClipmapLayers_frag.h"
#include "ClipmapLevels_frag.h"
#include "ClipmapLines_frag.h"
#include "ClipmapLook_vert.h"
#include "ClipmapPlane_vert.h"
#include "ClipmapPole_frag.h"
#include "ClipmapPole_vert.h"
#include "ClipmapPosts_vert.h"
#include "ClipmapRamp_frag.h"
#include "ClipmapSphere_vert.h"
#include "ClipmapStanding_vert.h"
#include "ClipmapStyle_frag.h"
#include "ClipmapStyle_vert.h"
#include "ClipmapTexels.h"
#include "Clipmap_vert.h"

namespace dspace {
namespace {

// `standing` says where posts stand.
std::string ComposeVertexShader(const char* standing) {
  return std::string(ClipmapHead_vert) + ClipmapTexels + ClipmapPosts_vert + ClipmapStanding_vert +
         standing + ClipmapLook_vert + ClipmapStyle_vert + Clipmap_vert;
}

} // namespace

const char* ClipmapVertexShader(PostPlacement::Kind kind) {
  static const std::string plane = ComposeVertexShader(ClipmapPlane_vert);
  static const std::string sphere = ComposeVertexShader(ClipmapSphere_vert);
  static const std::string pole = ComposeVertexShader(ClipmapPole_vert);
  switch (kind) {
  case PostPlacement::Kind::Sphere:
    return sphere.c_str();
  case PostPlacement::Kind::Pole:
    return pole.c_str();
  case PostPlacement::Kind::Plane:
    break;
  }
  return plane.c_str();
}

const char* ClipmapFragmentFunctions() {
  static const std::string functions = std::string(ClipmapTexels) + ClipmapStyle_frag +
                                       ClipmapPole_frag + ClipmapLayers_frag + ClipmapDetails_frag +
                                       ClipmapRamp_frag + ClipmapLevels_frag + ClipmapLines_frag +
                                       ClipmapHorizon_frag + ClipmapColor_frag;
  return functions.c_str();
}

} // namespace dspace
