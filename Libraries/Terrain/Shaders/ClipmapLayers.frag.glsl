// Layers of a terrain, colours and normals: tiles found by a page table of each zoom.
#if defined(DSPACE_LAYERS) || defined(DSPACE_LAYER_NORMALS)
// A set of tiles, and a place in it.
struct Tiling
{
  vec2 at; // texels of the finest zoom, from the corner of a tile near the camera on
  int zoom; // the finest
  ivec2 corner; // the tile near the camera, of the finest zoom
  int around; // root tiles around a body; 0: it has an end
  vec3 scale; // metres of a texel along x, along y, over the greater; samples a pixel
  vec4 nothing; // where it is transparent
};

vec4 tileTexel(sampler2DArray tiles, vec2 at, int slot, vec4 nothing)
{
  vec4 texel = textureLod(tiles, vec3((at * 256.0 + 1.0) / 258.0, float(max(slot, 0))), 0.0);
  return slot < 0 ? nothing : texel;
}

// With the tiles of a plane, by its first page table. A page: the tile's column and row; its slot,
// -1: transparent; that of the tile that it is a part of, -2: not there.
vec4 tiledTexel(sampler2DArray tiles, isampler2DArray pages, Tiling tiling, int plane)
{
  // Texels that a pixel covers, along the way where it covers fewer; what it covers more along the
  // other its samples take care of.
  vec2 dx = dFdx(tiling.at) * tiling.scale.xy;
  vec2 dy = dFdy(tiling.at) * tiling.scale.xy;
  float a = dot(dx, dx);
  float b = dot(dy, dy);
  float covered = max(max(a, b), min(a, b) * tiling.scale.z * tiling.scale.z);
  // A logarithm to a tenth, straight between powers of two: it only chooses the zoom.
  float logarithm = float(floatBitsToInt(covered)) / 8388608.0 - 127.0;
  float wanted = clamp(float(tiling.zoom) - 0.5 * logarithm, 0.0, float(tiling.zoom));
  int finest = int(ceil(wanted));
  float coarser = clamp(2.0 * (float(finest) - wanted) - 0.5, 0.0, 1.0);
  for (int zoom = finest; zoom >= 0; --zoom)
  {
    int up = tiling.zoom - zoom;
    vec2 place = (vec2(tiling.corner & ((1 << up) - 1)) + tiling.at / 256.0) *
      intBitsToFloat((127 - up) << 23);
    vec2 corner = floor(place);
    ivec2 tile = (tiling.corner >> up) + ivec2(corner);
    tile.x = tiling.around > 0 ? tile.x & ((tiling.around << zoom) - 1) : tile.x;
    ivec4 page = texelFetch(pages, ivec3(tile & 63, plane + zoom), 0);
    if (page.xy == tile)
    {
      vec2 at = place - corner;
      return mix(tileTexel(tiles, at, page.z, tiling.nothing),
        tileTexel(tiles, 0.5 * (at + vec2(tile & 1)), page.w, tiling.nothing),
        zoom == finest && page.w > -2 ? coarser : 0.0);
    }
  }
  return tiling.nothing;
}
#endif

#ifdef DSPACE_LAYERS
in vec2 layerAt; // as in Tiling
uniform sampler2DArray layerTiles; // opacity times the root of linear light, opacity
uniform isampler2DArray layerPages;
uniform int layerZoom;
uniform ivec2 layerCorner;
uniform int layerAround;
uniform vec3 layerScale;

vec3 layered(vec3 color, int plane)
{
  vec4 layer = tiledTexel(layerTiles, layerPages,
    Tiling(layerAt, layerZoom, layerCorner, layerAround, layerScale, vec4(0.0)), plane);
  return color * (1.0 - layer.a) + layer.rgb * layer.rgb / max(layer.a, 1e-6);
}
#endif

#ifdef DSPACE_LAYER_NORMALS
in vec2 normalAt; // as in Tiling
in mat3 normalAxesVC; // of what the tiles hold: along the chart, and up
uniform sampler2DArray normalsTiles; // opacity times the normal (0 is 32768 / 65535), opacity
uniform isampler2DArray normalsPages;
uniform int normalsZoom;
uniform ivec2 normalsCorner;
uniform int normalsAround;
uniform vec3 normalsScale;

// N, unit, is the normal of the heights.
vec3 layeredNormal(vec3 N)
{
  vec4 layer = tiledTexel(normalsTiles, normalsPages,
    Tiling(normalAt, normalsZoom, normalsCorner, normalsAround, normalsScale,
      vec4(vec3(32768.0 / 65535.0), 0.0)), DSPACE_LAYER_NORMALS);
  vec3 n = (layer.xyz * 65535.0 - 32768.0) / 32767.0;
  if (dot(n, n) < 1e-7) // nothing, or rounding
  {
    return N;
  }
  return normalize(mix(N, normalize(normalAxesVC * n), layer.a));
}
#endif
