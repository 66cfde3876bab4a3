// A terrain as its widgets show it.
#ifndef DSPACE_WIDGETS_TERRAIN_STATE_H
#define DSPACE_WIDGETS_TERRAIN_STATE_H

#include <dspace/proto/commands.pb.h>
#include <dspace/proto/layers.pb.h>
#include <dspace/proto/terrain.pb.h>

namespace dspace::widgets {

struct TerrainState {
  v1::TerrainReply terrain;
  bool canChange = true; // false: of a recording or a server
  bool layered = false;  // a clipmap: it takes layers of all kinds and a style
  v1::TerrainLayerList layers;
  v1::StyleTerrain style; // as it was given; its ramp is as it is drawn
  v1::TerrainFieldList fields;
};

} // namespace dspace::widgets

#endif
