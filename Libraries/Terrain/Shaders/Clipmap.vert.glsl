// Draws the posts of one clipmap level, relative to the camera. The parts before this one say what
// the ground is, where it stands, and what the fragment shader is given.
layout(location = 0) in vec2 cell; // post of the window, 0 to cells

uniform vec2 lastPlace; // where the last one stands: the lattice may end between two
uniform float heightHigh; // of the camera, as two floats
uniform float heightLow;
uniform mat4 VCDCMatrix;

void main()
{
  vec2 at = clamp(cell, firstPost, lastPost);
  Ground ground = groundAt(at);
  vec2 place = min(at, lastPlace);
  float above = (ground.here.x - heightHigh) - heightLow;
  Standing standing = standingAt(place, ground.here, above);
  gl_Position = VCDCMatrix * vec4(standing.positionVC, 1.0);
  putLook(standing, ground, place);
  putStyle(standing, ground, at, place);
}
