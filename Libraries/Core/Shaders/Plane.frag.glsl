#version 330 core
//DSPACE::Defines
// What SunMask.frag must know of the nearest surface.
in vec3 positionVC;

layout(location = 0) out vec4 plane; // its normal as it is drawn, of any length; z in view axes, not 0

void main()
{
  plane = vec4(cross(dFdx(positionVC), dFdy(positionVC)), positionVC.z);
}
