#version 330 core
//DSPACE::Defines
// Takes the place of Dspace's Instance.vert.glsl. Its outputs are what the fragment shaders read:
// `label` for labels, else `baseColor`, and for lit surfaces `positionVC`, `normalVC` and `surface`.
layout(location = 0) in vec2 corner; // 0 to 1 along both edges

uniform mat4 MCVCMatrix;   // object to view
uniform mat3 normalMatrix; // the same for normals
uniform mat4 VCDCMatrix;   // view to clip space; SetView() sets it
uniform vec3 sail;         // edge [m], ripple [m], phase [rad]
uniform vec4 sailColor;
uniform int objectLabel;

#ifdef DSPACE_LABEL
flat out uint label;
#else
flat out vec4 baseColor;
out vec2 sheet;
#endif
#ifdef DSPACE_LIT
out vec3 positionVC;
out vec3 normalVC;
flat out vec3 surface; // metallic, roughness, 1 or -1 where the matrix mirrors
#endif

void main()
{
  vec2 place = (corner - 0.5) * sail.x;
  float k = 6.2831853 * 3.0 / sail.x;
  vec2 angle = k * place + vec2(sail.z);
  vec4 p = vec4(place, sail.y * sin(angle.x) * cos(angle.y), 1.0);
  vec4 placed = MCVCMatrix * p;
  gl_Position = VCDCMatrix * placed;
#ifdef DSPACE_LABEL
  label = uint(objectLabel);
#else
  baseColor = sailColor;
  sheet = corner;
#endif
#ifdef DSPACE_LIT
  positionVC = placed.xyz;
  vec2 slope = sail.y * k * vec2(cos(angle.x) * cos(angle.y), -sin(angle.x) * sin(angle.y));
  normalVC = normalMatrix * vec3(-slope, 1.0);
  surface = vec3(0.0, 1.0, sign(determinant(mat3(MCVCMatrix))));
#endif
}
