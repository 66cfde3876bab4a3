// The planes of a viewport's picture as arrays.
#ifndef DSPACE_RENDER_CAPTURE_H
#define DSPACE_RENDER_CAPTURE_H

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <dspace/FrameTree.h>
#include <dspace/scene/GraphicsObject.h>

namespace dspace {

// Planes of one picture; each is empty unless asked for. Row 0 is the top row.
struct Capture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> color; // RGBA, sRGB display values, alpha 255
  std::vector<float> depth;        // metres along the camera's Z; +infinity where nothing was hit
  std::vector<float> range; // metres from the camera along the pixel's ray; +infinity: nothing
  std::vector<std::uint32_t> label; // ObjectId, 0 where nothing was hit
  // Linear light towards the camera [W/m^2/sr], red, green, blue, before exposure.
  std::vector<float> radiance;
  std::vector<float> litFraction; // part of the Sun's disc that lights the surface, 0 to 1
  // Degrees between the surface's normal and the Sun, the normal and the camera, the Sun and the
  // camera. NaN where nothing was hit; also of litFraction.
  std::vector<float> incidence;
  std::vector<float> emission;
  std::vector<float> phase;
  // Of the surface, as it is lit: x y z, unit, in the root. NaN where nothing was hit.
  std::vector<float> normal;
};

struct CaptureRequest {
  bool color = true;
  bool depth = false;
  bool label = false;
  bool physicalOnly = false;                  // no ornamental object, no overlay
  std::set<std::string> hiddenFragments = {}; // in addition to the viewport's own
  bool range = false;
  bool radiance = false;
  bool litFraction = false;
  bool incidence = false;
  bool emission = false;
  bool phase = false;
  bool normal = false;
};

// Result of picking at a pixel.
struct PickResult {
  ObjectId object = 0; // 0: nothing was hit, and nothing else below is valid
  FrameId frame = 0;   // the frame the object hangs on
  std::string part;    // name of the part that was hit; may be empty
  double depth = 0.0;  // metres along the camera's Z
  FrameId cameraFrame = 0;
  Eigen::Vector3d p_camera = Eigen::Vector3d::Zero(); // in the sensor camera's axes [m]
  Eigen::Vector3d p_frame = Eigen::Vector3d::Zero();  // in `frame` [m]
  Eigen::Vector3d p_root = Eigen::Vector3d::Zero();   // in the scene's root [m]
};

// Counters of a render context since its creation.
struct RenderStatistics {
  std::uint64_t meshBytes = 0;         // vertex and index buffers now on the GPU
  std::uint64_t meshBytesUploaded = 0; // ever
  std::uint64_t textureBytes = 0;
  std::uint64_t textureBytesUploaded = 0;
  std::uint64_t instanceBytesUploaded = 0; // poses and colours
  std::uint64_t framesDrawn = 0;           // viewport renders that reached OpenGL
  std::uint64_t framesSkipped = 0;         // renders of an unchanged viewport
  std::uint64_t trianglesDrawn = 0;        // in the last frame drawn
  std::uint64_t drawCalls = 0;             // in the last frame drawn
  int translucentLayers = 0;               // peeled in the last frame drawn
  int shadowMapsDrawn = 0;                 // in the last frame drawn, those of ground too
  int shadowMapsKept = 0;                  // of an earlier frame, since nothing in them has changed
};

} // namespace dspace

#endif
