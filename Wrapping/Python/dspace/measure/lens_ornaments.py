"""What a camera with a lens sees, as ornaments: its frustum, and its footprint on the ground and objects."""
import numpy as np

from dspace._core.fields import integer, number, reject
from dspace._core.strict import Strict
from dspace.cameras.model import CameraModel
from dspace.errors import InvalidArgument, WrongType
from dspace.measure.ranges import Lidar
from dspace.measure.scans import Scans

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

    def add_lens_footprint(self, model, frame=None, camera=None, *, steps=32, maximum_range=1e6, lift=0.02, without=(),
                           ornamental=True, **settings):
        """A line where the rays of the image's border meet the ground and physical objects first, by exact rays. The model's own
        pose is in `frame` (default: the root), or its axes are those of the scene's `camera`. steps: rays along each edge, 1 to
        1000. maximum_range [m]: what is farther leaves a gap. lift [m]: by which the line is nearer to the camera, so that the
        ground does not hide it. without: objects that the rays do not meet. Rays begin at the camera, also those of a moving
        pupil. Returns a LensFootprint; its update() follows what has moved."""
        about = "lens footprint"
        _check_model(model, about)
        if not 0.0 <= number(lift, "the lift", about) < np.inf:
            reject(about, "the lift", lift, "0 m or more")
        return LensFootprint(self._scene, model, frame, camera, _border(model, steps, about), maximum_range, lift, without,
                             dict(settings, ornamental=ornamental))


class LensFootprint(Strict):
    """The border of what a camera sees: Scene.add_lens_footprint()."""

    def __init__(self, scene, model, frame, camera, pixels, maximum_range, lift, without, settings):
        self._scene, self._lift, self._without, self._settings = scene, lift, without, settings
        directions = model.rays(pixels, in_camera=camera is not None)[1]
        self._known = np.isfinite(directions).all(axis=1)
        if not self._known.any():
            raise InvalidArgument("lens footprint: the lens has no ray at the image's border; accepted: a lens that has",
                                  "lens footprint")
        self._lidar = Lidar.of_directions(directions[self._known], maximum_range=maximum_range)
        self._place = dict(camera=camera) if camera is not None else dict(frame=frame, position=model.position)
        self._mesh = None
        self._points = np.full(self._known.shape + (3,), np.nan)
        self.update()

    @property
    def object(self):
        """The Mesh of its line, in the root; None while it meets nothing."""
        return self._mesh

    @property
    def points(self):
        """Where the rays meet something (n, 3), around the image's border from its top left, in the root; NaN: nothing."""
        return self._points.copy()

    def update(self):
        """Measures it again, at the present poses."""
        scan = Scans(self._scene).scan(self._lidar, without=self._without, **self._place)
        self._points[self._known] = scan.point
        known = np.isfinite(self._points).all(axis=1)
        count = known.size
        lines = np.array([(i, (i + 1) % count) for i in range(count) if known[i] and known[(i + 1) % count]])
        if not len(lines):
            if self._mesh is not None:
                self._mesh.remove()
                self._mesh = None
            return
        lifted = self._points.copy()
        lifted[self._known] = scan.point - np.minimum(self._lift, 0.5 * scan.range)[:, None] * scan.direction
        lifted[~known] = lifted[known][0]
        if self._mesh is None:
            self._mesh = self._scene.add_mesh(lifted, lines=lines, **self._settings)
        else:
            self._mesh.update(points=lifted, lines=lines)

    def remove(self):
        """Removes its line from the scene."""
        if self._mesh is not None:
            self._mesh.remove()
            self._mesh = None

    def __repr__(self):
        return f"<dspace.LensFootprint of {int(np.isfinite(self._points).all(axis=1).sum())} of {len(self._points)} rays>"


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
