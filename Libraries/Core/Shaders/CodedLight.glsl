// Light {N} by VTK's names. Code may name more lights than there are.
#if DSPACE_LIGHT_COUNT > {N}
#define lightColor{N} dspaceDisplay(lightColor[{N}])
#define lightDirectionVC{N} lightDirectionVC[{N}]
#define lightPositionVC{N} lightPositionVC[{N}]
#define lightAttenuation{N} lightAttenuation[{N}]
#define lightPositional{N} (lightKind[{N}] == 1 || lightKind[{N}] == 2 ? 1 : 0)
#else
#define lightColor{N} vec3(0.0)
#define lightDirectionVC{N} vec3(0.0, 0.0, -1.0)
#define lightPositionVC{N} vec3(0.0)
#define lightAttenuation{N} vec3(1.0, 0.0, 0.0)
#define lightPositional{N} 0
#endif
