// What is painted on a terrain: tiles of its colour layers, found by a page table of each zoom.
#ifdef DSPACE_LAYERS
in vec2 layerAt; // texels of the finest zoom, from a tile's corner near the camera on
uniform sampler2DArray layerTiles; // colour times opacity in linear light, opacity
uniform isampler2DArray layerPages; // the tile's column and row, its slot or -1 where transparent
uniform int layerZoom; // the finest
uniform vec2 layerOrigin[31]; // of each zoom: that corner in the tile below
uniform int layerColumn[31]; // that tile
uniform int layerRow[31];
uniform int layerAround; // root tiles around a body; 0: it has an end
uniform vec3 layerScale; // metres of a texel along x, along y, over the greater; samples a pixel

vec4 layersAt(int finest)
{
  for (int zoom = finest; zoom >= 0; --zoom)
  {
    vec2 place = layerOrigin[zoom] + layerAt * exp2(float(zoom - layerZoom)) / 256.0;
    vec2 corner = floor(place);
    ivec2 tile = ivec2(layerColumn[zoom], layerRow[zoom]) + ivec2(corner);
    tile.x = layerAround > 0 ? tile.x & ((layerAround << zoom) - 1) : tile.x;
    ivec4 page = texelFetch(layerPages, ivec3(tile & 63, zoom), 0);
    if (page.xy == tile)
    {
      vec2 at = ((place - corner) * 256.0 + 1.0) / 258.0;
      return page.z < 0 ? vec4(0.0) : textureLod(layerTiles, vec3(at, float(page.z)), 0.0);
    }
  }
  return vec4(0.0);
}

vec3 layered(vec3 color)
{
  // Texels that a pixel covers, along the way where it covers fewer; what it covers more along the
  // other its samples take care of.
  vec2 dx = dFdx(layerAt) * layerScale.xy;
  vec2 dy = dFdy(layerAt) * layerScale.xy;
  float a = dot(dx, dx);
  float b = dot(dy, dy);
  float major = max(a, b);
  float minor = min(a, b) * layerScale.z * layerScale.z;
  float zoom = clamp(float(layerZoom) - 0.5 * log2(max(max(major, minor), 1e-12)), 0.0,
    float(layerZoom));
  // Between zooms only half of the way is mixed: a software renderer pays for every texel.
  int coarse = int(zoom);
  float finer = clamp(2.0 * (zoom - float(coarse)) - 0.5, 0.0, 1.0);
  vec4 layer = layersAt(finer == 1.0 ? coarse + 1 : coarse);
  if (finer > 0.0 && finer < 1.0)
  {
    layer = mix(layer, layersAt(coarse + 1), finer);
  }
  return color * (1.0 - layer.a) + layer.rgb;
}
#endif
