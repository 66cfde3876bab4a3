#version 330 core
//DSPACE::Defines
// A body by the crossing of each pixel's ray with its ellipsoid, in axes in which that is a unit
// sphere. Rays are linear in the window's coordinates, about a pivot, and lengths along them count from
// the camera, or from the plane of the body's centre where that is far: digits are lost nowhere.
// DSPACE_LABEL: labels. DSPACE_ANGLES: photometric angles. DSPACE_DISC: the light of a disc that is
// only pixels wide, over what is behind it; DSPACE_SPREAD: spread by a Gaussian.
//DSPACE::Functions

#ifdef DSPACE_LABEL
layout(location = 0) out uint fragLabel;
uniform int objectLabel;
#else
layout(location = 0) out vec4 fragColor;
uniform vec3 bodyColor;     // linear light, times brightness
uniform vec3 bodyEmission;  // linear light, exposed
uniform vec3 bodyRadii;     // [m]
uniform mat3 viewFromNormal; // of the ellipsoid's normals in its own axes to view axes
#ifdef DSPACE_TEXTURE
uniform sampler2D colorTexture;
uniform vec3 textureRows; // longitude of its left edge [turns]; its rows; 1: geodetic latitudes
#endif
#endif
#ifdef DSPACE_DISC
uniform vec4 discBox; // window from the pivot: left, bottom, right, top of the body
uniform float discDepth; // of its nearest point
#ifdef DSPACE_SPREAD
uniform vec2 discSpread; // 1 / (2 variance), 1 / (2 pi variance) [samples]
#endif
#endif

vec3 bodyPlace = vec3(0.0); // of the present sample, in the body's axes [m]
#define DSPACE_ECLIPSE_PLACE bodyPlace
#ifndef DSPACE_LABEL
//DSPACE::Lighting
#endif

struct Hit
{
  bool found;
  vec3 unit; // on the sphere
  vec3 positionVC;
};

// Where the ray misses, the place on the sphere that is closest to it: what varies across the limb is
// smooth.
Hit crossing(vec2 window)
{
  vec3 from = vec3(1.0, window);
  vec3 o = rayOrigin * from;
  vec3 d = rayDirection * from;
  float a = dot(d, d);
  float b = dot(o, d);
  float c = gap > -1.0 ? gap : dot(o, o) - 1.0;
  float square = b * b - a * c;
  float root = sqrt(max(square, 0.0));
  float t = gap > -1.0 && b < 0.0 ? c / (root - b) : (-b - root) / a;
  Hit hit;
  hit.unit = normalize(o + t * d);
  hit.positionVC = viewOrigin * from + t * (viewDirection * from);
  hit.found = square >= 0.0 && hit.positionVC.z < 0.0;
  return hit;
}

#ifndef DSPACE_LABEL
// The light of a place that the camera sees. `footprint`: how far the picture's samples are apart on the
// unit sphere.
vec3 lightOf(Hit hit, float footprint)
{
  vec3 normal = normalize(hit.unit / bodyRadii);
  vec3 color = bodyColor;
#ifdef DSPACE_TEXTURE
  float sine = textureRows.z > 0.5 ? normal.z : normalize(hit.unit * bodyRadii).z;
  float level = max(log2(footprint * textureRows.y / 3.14159265), 0.0);
  float edge = 0.5 * exp2(level) / textureRows.y;
  vec2 place = vec2(atan(hit.unit.y * bodyRadii.y, hit.unit.x * bodyRadii.x) / 6.2831853 - textureRows.x,
    0.5 + asin(clamp(sine, -1.0, 1.0)) / 3.14159265);
  place.y = edge < 0.5 ? clamp(place.y, edge, 1.0 - edge) : 0.5; // rows repeat, but not across poles
  color *= textureLod(colorTexture, place, level).rgb;
#endif
  bodyPlace = hit.unit * bodyRadii;
  vec3 N = normalize(viewFromNormal * normal);
#ifdef DSPACE_LIT
  return shaded(color, N, hit.positionVC, vec2(0.0, 1.0)) + bodyEmission;
#else
  return color + bodyEmission;
#endif
}
#endif

void main()
{
  vec2 window = gl_FragCoord.xy - pivot;
#ifdef DSPACE_DISC
#ifdef DSPACE_SPREAD
  vec2 low = discBox.xy;
  vec2 high = discBox.zw;
#else
  vec2 low = max(window - 0.5, discBox.xy);
  vec2 high = min(window + 0.5, discBox.zw);
#endif
  vec2 size = high - low;
#ifdef DSPACE_LABEL
  // The pixel of the middle, and those whose middles it covers.
  vec2 middle = 0.5 * (discBox.xy + discBox.zw);
  bool central = all(lessThanEqual(window - 0.5, middle)) && all(greaterThan(window + 0.5, middle));
  Hit hit = crossing(window);
  if (!central && !hit.found)
  {
    discard;
  }
  gl_FragDepth = hit.found ? depthOf(hit.positionVC.z) : discDepth;
  fragLabel = uint(objectLabel);
#else
  if (any(lessThanEqual(size, vec2(0.0))) || texelFetch(opaqueDepth, ivec2(gl_FragCoord.xy), 0).r > discDepth)
  {
    discard;
  }
  vec3 sum = vec3(0.0);
  float covered = 0.0;
  float footprint = 2.0 * max(size.x / (discBox.z - discBox.x), size.y / (discBox.w - discBox.y)) / float(DSPACE_DISC);
  for (int j = 0; j < DSPACE_DISC; ++j)
  {
    for (int i = 0; i < DSPACE_DISC; ++i)
    {
      vec2 place = low + size * (vec2(float(i), float(j)) + 0.5) / float(DSPACE_DISC);
      Hit hit = crossing(place);
      if (hit.found)
      {
#ifdef DSPACE_SPREAD
        vec2 away = window - place;
        float weight = exp(-dot(away, away) * discSpread.x) * discSpread.y;
#else
        float weight = 1.0;
#endif
        sum += weight * lightOf(hit, footprint);
        covered += weight;
      }
    }
  }
  float share = size.x * size.y / float(DSPACE_DISC * DSPACE_DISC);
  fragColor = vec4(sum, covered) * share;
#ifdef DSPACE_SPREAD
  fragColor.a = max(fragColor.a, 1.0 / 65536.0); // exposed, as stars are
#endif
#endif
#else
  Hit hit = crossing(window);
#ifdef DSPACE_LABEL
  if (!hit.found)
  {
    discard;
  }
  fragLabel = uint(objectLabel);
#else
  vec3 across = dFdx(hit.unit);
  vec3 along = dFdy(hit.unit);
  // Half of the longer side of the pixel's print: sharp to the limb without many more samples.
  float footprint = max(0.5 * sqrt(max(dot(across, across), dot(along, along))),
    sqrt(length(cross(across, along))));
  if (!hit.found)
  {
    discard;
  }
#ifdef DSPACE_ANGLES
  bodyPlace = hit.unit * bodyRadii;
  vec3 N = normalize(viewFromNormal * normalize(hit.unit / bodyRadii));
  fragColor = photometricAngles(N, hit.positionVC, cameraParallel);
#elif defined(DSPACE_DISPLAY_COLOR)
  fragColor = vec4(lightOf(hit, footprint), 0.0);
#else
  fragColor = vec4(lightOf(hit, footprint), 1.0);
#endif
#endif
  gl_FragDepth = depthOf(hit.positionVC.z);
#endif
}
