#version 330 core
//DSPACE::Defines
// A rectangle of the picture in which a body is seen.
uniform vec4 boxNDC; // left, bottom, right, top

void main()
{
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(mix(boxNDC.xy, boxNDC.zw, corner), 0.0, 1.0);
}
