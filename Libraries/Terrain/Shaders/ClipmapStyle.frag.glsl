// What the parts of a terrain's style read.
#ifdef DSPACE_MIXED
in vec4 styleAt; // height [m], slope [deg], grid lines along columns and rows (whole at a line)
#endif
#ifdef DSPACE_BRIGHTNESS
uniform float groundBrightness; // of the ground of a body
#endif
#ifdef DSPACE_TRACKS
in float trackAt; // how much is rolled over
uniform vec4 trackColor; // linear light, opacity
#endif
