// What ClipmapColor.frag and its parts need: places in layers, details and grids; the ground's
// height, slope and direction; tracks.
#ifdef DSPACE_LAYERS
uniform vec2 originLayer; // texels of the finest zoom, from a tile's corner near the camera on
uniform vec2 postLayer;
out vec2 layerAt;
#endif
#ifdef DSPACE_LAYER_NORMALS
uniform vec2 originNormal; // as of layers
uniform vec2 postNormal;
out vec2 normalAt;
out mat3 normalAxesVC;
#endif
#ifdef DSPACE_MIXED
uniform vec2 originGrid; // of the first post, from a line near the camera on; 1 from line to line
uniform mat2 postGrid;
out vec4 styleAt;
#endif
#ifdef DSPACE_LEVELS
out vec2 awayAt; // from the camera [posts]
#endif
#ifdef DSPACE_FACING
out vec3 facingAt;
#endif
#ifdef DSPACE_TRACKS
out float trackAt;
#endif
#ifdef DSPACE_DETAILS
uniform vec4 originDetail; // of two textures: tiles from one near the camera on
uniform mat2 postDetail0;
uniform mat2 postDetail1;
out vec4 detailAt;
#endif

// At a post of the window, which stands at a place.
void putStyle(Standing standing, Ground ground, vec2 at, vec2 place)
{
#ifdef DSPACE_LAYERS
  layerAt = originLayer + postLayer * place;
#endif
#ifdef DSPACE_LAYER_NORMALS
  normalAt = originNormal + postNormal * place;
  normalAxesVC = standing.axesVC;
#endif
#ifdef DSPACE_MIXED
  styleAt = vec4(ground.here.x, degrees(acos(clamp(standing.cosSlope, -1.0, 1.0))), 0.0, 0.0);
#if defined(DSPACE_GRID) && !defined(DSPACE_POLE)
  styleAt.zw = originGrid + postGrid * place;
#endif
#endif
#ifdef DSPACE_LEVELS
  awayAt = at - cameraPost;
#endif
#ifdef DSPACE_FACING
  facingAt = standing.facing;
#endif
#ifdef DSPACE_TRACKS
  trackAt = ground.missing ? 0.0 : 2.0 * ground.here.w;
#endif
#ifdef DSPACE_DETAILS
  detailAt = originDetail + vec4(postDetail0 * place, postDetail1 * place);
#endif
}
