#version 120
// osgTerrain's ground, lit in each pixel.
varying vec3 normal;
void main()
{
  normal = gl_NormalMatrix * gl_Normal;
  gl_Position = ftransform();
}
