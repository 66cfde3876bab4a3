// Colour layers of a terrain: tiles found by a page table of each zoom.
#ifdef DSPACE_LAYERS
in vec2 layerAt; // texels of the finest zoom, from the corner of a tile near the camera on
uniform sampler2DArray layerTiles; // opacity times the root of linear light, opacity
// The tile's column and row; its slot, -1: transparent; that of the tile that it is a part of, -2:
// not there.
uniform isampler2DArray layerPages;
uniform int layerZoom; // the finest
uniform ivec2 layerCorner; // the tile near the camera, of the finest zoom
uniform int layerAround; // root tiles around a body; 0: it has an end
uniform vec3 layerScale; // metres of a texel along x, along y, over the greater; samples a pixel

vec4 layerTexel(vec2 at, int slot)
{
  vec4 texel = textureLod(layerTiles, vec3((at * 256.0 + 1.0) / 258.0, float(max(slot, 0))), 0.0);
  return slot < 0 ? vec4(0.0) : texel;
}

vec3 layered(vec3 color)
{
  // Texels that a pixel covers, along the way where it covers fewer; what it covers more along the
  // other its samples take care of.
  vec2 dx = dFdx(layerAt) * layerScale.xy;
  vec2 dy = dFdy(layerAt) * layerScale.xy;
  float a = dot(dx, dx);
  float b = dot(dy, dy);
  float covered = max(max(a, b), min(a, b) * layerScale.z * layerScale.z);
  // A logarithm to a tenth, straight between powers of two: it only chooses the zoom.
  float logarithm = float(floatBitsToInt(covered)) / 8388608.0 - 127.0;
  float wanted = clamp(float(layerZoom) - 0.5 * logarithm, 0.0, float(layerZoom));
  int finest = int(ceil(wanted));
  float coarser = clamp(2.0 * (float(finest) - wanted) - 0.5, 0.0, 1.0);
  for (int zoom = finest; zoom >= 0; --zoom)
  {
    int up = layerZoom - zoom;
    vec2 place = (vec2(layerCorner & ((1 << up) - 1)) + layerAt / 256.0) * intBitsToFloat((127 - up) << 23);
    vec2 corner = floor(place);
    ivec2 tile = (layerCorner >> up) + ivec2(corner);
    tile.x = layerAround > 0 ? tile.x & ((layerAround << zoom) - 1) : tile.x;
    ivec4 page = texelFetch(layerPages, ivec3(tile & 63, zoom), 0);
    if (page.xy == tile)
    {
      vec2 at = place - corner;
      vec4 layer = mix(layerTexel(at, page.z), layerTexel(0.5 * (at + vec2(tile & 1)), page.w),
        zoom == finest && page.w > -2 ? coarser : 0.0);
      return color * (1.0 - layer.a) + layer.rgb * layer.rgb / max(layer.a, 1e-6);
    }
  }
  return color;
}
#endif
