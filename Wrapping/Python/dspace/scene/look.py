"""How a viewport lights and exposes its pictures, and the planes of light that it measures."""
from dspace._core.fields import keywords, put_given, word
from dspace._core.strict import Strict
from dspace.proto import commands_pb2 as pb

TONES = {"linear": 0, "filmic": 1}
LOOK = ("shadows", "shadow_cascades", "shadow_map_size", "shadow_distance", "cascade_colors", "lit_colors", "fill",
        "exposure", "automatic_exposure", "tone")


class ViewportLook(Strict):
    """A part of Viewport."""

    def set(self, **values):
        """Changes several settings in one command, all checked before any is set: shadows, shadow_cascades,
        shadow_map_size, shadow_distance, cascade_colors, lit_colors, fill, exposure, automatic_exposure, tone. Each is
        also a property."""
        keywords(values, LOOK, self._label())
        values = {key: value for key, value in values.items() if value is not None}
        if "tone" in values:
            values["tone"] = word(values["tone"], TONES, "tone", self._label)
        command = pb.Command()
        command.set_viewport.viewport = self._name
        put_given(command.set_viewport, self._label, **values)
        self._client.execute(command)

    @property
    def shadows(self):
        """Whether the Sun casts shadows; False in a new viewport."""
        return self._info().shadows

    @shadows.setter
    def shadows(self, shadows):
        self._do("set_viewport", shadows=shadows)

    @property
    def shadow_cascades(self):
        """The number of shadow maps, each for a range of distances from the camera, 1 to 8; 4 in a new viewport."""
        return self._info().shadow_cascades

    @shadow_cascades.setter
    def shadow_cascades(self, shadow_cascades):
        self._do("set_viewport", shadow_cascades=shadow_cascades)

    @property
    def shadow_map_size(self):
        """Texels along a side of each shadow map, 256 to 16384 as far as OpenGL has them; 2048 in a new viewport."""
        return self._info().shadow_map_size

    @shadow_map_size.setter
    def shadow_map_size(self, shadow_map_size):
        self._do("set_viewport", shadow_map_size=shadow_map_size)

    @property
    def shadow_distance(self):
        """[m] along the camera's Z that the shadow maps reach, up to 1e12; 0, as in a new viewport: as the view requires."""
        return self._info().shadow_distance

    @shadow_distance.setter
    def shadow_distance(self, shadow_distance):
        self._do("set_viewport", shadow_distance=shadow_distance)

    @property
    def cascade_colors(self):
        """Whether the range of each shadow map is drawn in a colour of its own, for engineers."""
        return self._info().cascade_colors

    @cascade_colors.setter
    def cascade_colors(self, cascade_colors):
        self._do("set_viewport", cascade_colors=cascade_colors)

    @property
    def lit_colors(self):
        """With shadows: lit surfaces show in false colours how much of the Sun's disc they see, blue (0) over green to
        yellow (1). The default exposure is assumed. Viewport.lit_fraction() gives the numbers."""
        return self._info().lit_colors

    @lit_colors.setter
    def lit_colors(self, lit_colors):
        self._do("set_viewport", lit_colors=lit_colors)

    @property
    def fill(self):
        """White light from all directions for the eye, as a fraction of the Sun's, 0 to 1; 0.2 in a new viewport. Pictures with
        physical_only have none, nor has a scene without a Sun."""
        return self._info().fill

    @fill.setter
    def fill(self, fill):
        self._do("set_viewport", fill=fill)

    @property
    def exposure(self):
        """Factor on linear light, above 0, up to 1e12. At 1, as in a new viewport, a white matt surface that faces the Sun at
        1 au shows 1. The background, unlit objects, most ornaments and overlays keep their display colours."""
        return self._info().exposure

    @exposure.setter
    def exposure(self, exposure):
        self._do("set_viewport", exposure=exposure)

    @property
    def automatic_exposure(self):
        """Whether `exposure` multiplies the exposure that the picture itself requires, in place of 1: the factor that takes
        the 99th percentile of the luminances above 0 of lit surfaces to 0.6 (of a grid of at most 256 x 256 points; 1
        where nothing is lit). It depends on nothing but the picture."""
        return self._info().automatic_exposure

    @automatic_exposure.setter
    def automatic_exposure(self, automatic_exposure):
        self._do("set_viewport", automatic_exposure=automatic_exposure)

    @property
    def tone(self):
        """How linear light x becomes display values: "linear" (cut at 1) or "filmic", which compresses highlights and
        darkens shadows: x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14) for each channel, up to 1 (Narkowicz 2015)."""
        return list(TONES)[self._info().tone]

    @tone.setter
    def tone(self, tone):
        self.set(tone=tone)

    # --- Planes of light -------------------------------------------------------------------------

    def radiance(self, physical_only=True, hide=()):
        """(h, w, 3) float32: light towards the camera [W/m^2/sr], red, green and blue, linear, before exposure. A white
        Lambertian surface that faces the Sun at 1 au has 1361 / pi in each. Of the physical scene, whatever
        physical_only, without fill light: the mean over a pixel's samples, 0 where nothing is. Unlit surfaces count
        with their colour as linear light. See depth() for the arguments."""
        return self._one("radiance", physical_only, hide)

    def lit_fraction(self, physical_only=True, hide=()):
        """(h, w) float32: the part of the Sun's disc that lights what each pixel shows, 0 (shadow, night) to 1; NaN where
        nothing was hit."""
        return self._one("lit_fraction", physical_only, hide)

    def incidence(self, physical_only=True, hide=()):
        """(h, w) float32: degrees between the Sun and the normal with which the surface is lit, 0 to 180; NaN where nothing
        was hit, without a Sun, and for what lights do not shade: unlit objects, labels, props of VTK."""
        return self._one("incidence", physical_only, hide)

    def emission(self, physical_only=True, hide=()):
        """(h, w) float32: degrees between the camera and the normal with which the surface is lit, 0 to 180; NaN where
        nothing was hit, and for what lights do not shade."""
        return self._one("emission", physical_only, hide)

    def phase(self, physical_only=True, hide=()):
        """(h, w) float32: degrees between the Sun and the camera, seen from the surface, 0 to 180; NaN as of
        incidence()."""
        return self._one("phase", physical_only, hide)

    def _one(self, plane, physical_only, hide):
        return self.capture(False, physical_only=physical_only, hide=hide, **{plane: True})[plane]
