// What changes at a pole, where longitude jumps within a triangle: it is found at each pixel.
#if defined(DSPACE_POLE) && defined(DSPACE_MIXED)
in vec3 poleDirection; // in the chart's axes: Z out of the pole
uniform float poleSign; // -1 at the south pole
uniform vec2 poleTurn; // cosine and sine of the longitude of the chart's X

// Longitude from -180 to 180, latitude; and longitude from 0 to 360, which does not jump where the
// first does.
vec3 degreesAt()
{
  vec2 aside = vec2(poleDirection.x, poleSign * poleDirection.y);
  float longitude = degrees(atan(poleTurn.y * aside.x + poleTurn.x * aside.y,
    poleTurn.x * aside.x - poleTurn.y * aside.y));
  float latitude = poleSign * degrees(atan(poleDirection.z, length(poleDirection.xy)));
  return vec3(longitude, latitude, longitude < 0.0 ? longitude + 360.0 : longitude);
}
#endif
#ifdef DSPACE_POLE_TEXTURE
uniform sampler2D colorTexture;
uniform mat2 degreesTexture; // longitude and latitude to the texture
uniform vec2 degreesOrigin;

vec4 poleTexture()
{
  vec3 at = degreesAt();
  // Its size on the screen is that of the longitude that does not jump here.
  vec2 t = degreesTexture * at.xy + degreesOrigin;
  vec2 other = degreesTexture * at.zy + degreesOrigin;
  vec2 dx = dFdx(t);
  vec2 dy = dFdy(t);
  vec2 otherX = dFdx(other);
  vec2 otherY = dFdy(other);
  bool jump = dot(dx, dx) + dot(dy, dy) > dot(otherX, otherX) + dot(otherY, otherY);
  return textureGrad(colorTexture, t, jump ? otherX : dx, jump ? otherY : dy);
}
#endif
