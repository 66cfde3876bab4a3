// Posts of a plane.
uniform vec3 originVC; // first post, at the camera's height
uniform vec3 columnVC; // a post
uniform vec3 rowVC;
uniform vec3 slopeColumnVC; // what a slope of 1 a level-0 post takes from the normal
uniform vec3 slopeRowVC;
#ifdef DSPACE_LAYER_NORMALS
uniform mat3 normalsVC; // takes normals of the scene to the view's
#endif
uniform mat2 slopePlane; // slopes east and north of those a level-0 column and row

Standing standingAt(vec2 place, vec4 here, float above)
{
  Standing standing;
  standing.positionVC = originVC + place.x * columnVC + place.y * rowVC + above * upVC;
  standing.normalVC = upNormalVC - here.y * slopeColumnVC - here.z * slopeRowVC;
  standing.cosSlope = dot(normalize(standing.normalVC), normalize(upNormalVC));
  standing.facing = vec3(-(slopePlane * here.yz), 1.0);
#if defined(DSPACE_HORIZON) && defined(DSPACE_ANGLES)
  standing.verticalVC = upNormalVC;
  standing.acrossVC = columnVC;
  standing.downVC = rowVC;
#endif
#ifdef DSPACE_LAYER_NORMALS
  standing.axesVC = normalsVC;
#endif
  return standing;
}
