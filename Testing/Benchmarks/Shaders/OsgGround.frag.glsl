#version 120
varying vec3 normal;
void main()
{
  float light = max(dot(normalize(normal), gl_LightSource[0].position.xyz), 0.0);
  gl_FragColor = vec4(gl_FrontMaterial.diffuse.rgb * light, 1.0);
}
