// A layer of a terrain that was opened, and is not in its stack yet.
#ifndef DSPACE_SESSION_OPENED_LAYER_H
#define DSPACE_SESSION_OPENED_LAYER_H

#include <memory>

#include <dspace/layers/LayerStack.h>
#include <dspace/proto/layers.pb.h>
#include <dspace/surface/StreamedTerrain.h>

namespace dspace::session {

struct OpenedLayer {
  std::shared_ptr<const ColorLayer> layer;
  v1::TerrainLayerReply about; // its description
  // Of what was opened before its command is executed: that command with absolute paths, and the
  // ground that the layer was placed on.
  v1::AddTerrainLayer command;
  std::weak_ptr<const StreamedTerrain> ground;
};

} // namespace dspace::session

#endif
