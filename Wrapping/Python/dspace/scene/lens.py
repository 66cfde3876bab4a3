"""The lens that a viewport shows its camera's view through."""
from dspace._core.fields import reject
from dspace._core.strict import Strict
from dspace.cameras.model import CameraModel
from dspace.errors import WrongType


class ViewportLens(Strict):
    """A part of Viewport."""

    @property
    def lens(self):
        """The CameraModel through whose lens the viewport shows its camera's view; None, as in a new viewport: the camera's
        own projection.

            view.lens = dspace.CameraModel.read("navcam.cahvore")
            view.lens = None

        The model's image is as large as the viewport holds it whole, in its middle; pixels without a ray are black. The
        camera supplies the pose, the viewport shadows, light and exposure. The model needs a size; its own pose has no effect,
        its rays start at the middle of a moving entrance pupil. Colour is captured and saved, and picks are those of the
        pixel's own ray (a radius searches the source view of that pixel alone); Unsupported is raised for other planes and
        explanations, which simulate_image() has. Captions, props of VTK in the viewport's own renderer and gradients of the
        background are left out. Raises InvalidArgument for a model without a size, or of which no pixel has a ray;
        Unsupported for line scans."""
        found = self._info().lens
        return CameraModel.from_json(found) if found else None

    @lens.setter
    def lens(self, lens):
        if lens is not None and not isinstance(lens, CameraModel):
            reject(self._label, "the lens", lens, "a dspace.CameraModel, or None", WrongType)
        self._do("set_viewport", lens="" if lens is None else lens.json)
