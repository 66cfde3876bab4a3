"""What a camera with a lens sees, as an ornament: its frustum."""
import numpy as np

from dspace._core.fields import integer, number, reject
from dspace.cameras.model import CameraModel
from dspace.errors import InvalidArgument, WrongType

EDGES = 4  # of an image


class LensOrnaments:
    """Makes ornaments of lenses for a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def add_lens_frustum(self, model, length, frame=None, *, in_camera=False, steps=16, ornamental=True, **settings):
        """Lines along the rays of the image's corners, `length` metres long, and between their ends along the image's border, as
        the lens bends it. It moves with `frame` (default: the root), in which the model's own pose is; in_camera=True:
        whose axes are the camera's X right, Y down, Z forward. steps: lines along each edge, 1 to 1000. settings: as of other
        objects (color, line_width, ...). Where the lens has no ray there is no line. Returns a Mesh."""
        about = "lens frustum"
        _check_model(model, about)
        if not 0.0 < number(length, "the length", about) < np.inf:
            reject(about, "the length", length, "above 0 m")
        origins, directions = model.rays(_border(model, steps, about), in_camera=in_camera)
        ends = origins + length * directions
        known = np.isfinite(ends).all(axis=1)
        count = ends.shape[0]
        points = np.where(np.concatenate((known, known))[:, None], np.concatenate((origins, ends)), 0.0)
        along = np.arange(0, count, count // EDGES)  # the corners
        lines = [(i, i + count) for i in along if known[i]]
        lines += [(count + i, count + (i + 1) % count) for i in range(count) if known[i] and known[(i + 1) % count]]
        if not lines:
            raise InvalidArgument(f"{about}: the lens has no ray at the image's border; accepted: a lens that has", about)
        return self._scene.add_mesh(points, lines=np.array(lines), frame=frame, ornamental=ornamental, **settings)


def _check_model(model, about):
    if not isinstance(model, CameraModel):
        reject(about, "the model", model, "a dspace.CameraModel", WrongType)
    if model.size is None:
        reject(about, "the model", model, "one with the size of its image (CameraModel.with_size)")


def _border(model, steps, about):
    """Pixels around the image's border, from the outer corner of the top left one on, `steps` an edge."""
    if not 1 <= integer(steps, "steps", about) <= 1000:
        reject(about, "steps", steps, "1 to 1000")
    width, height = model.size
    corners = np.array(((0, 0), (width, 0), (width, height), (0, height)), float) - 0.5
    share = np.arange(steps)[:, None] / steps
    return np.concatenate([a + share * (b - a) for a, b in zip(corners, np.roll(corners, -1, axis=0))])
