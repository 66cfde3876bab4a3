"""Range sensors: lidars and altimeters."""
import numpy as np

from dspace._core.fields import array_of, number, put, reject, word
from dspace._core.strict import Strict
from dspace.cameras.model import CameraModel
from dspace.errors import InvalidArgument, WrongType
from dspace.proto import ranges_pb2 as pb

REPORTS = {"first": 0, "last": 1, "mean": 2, "least": 3}  # RangeSensor.Report


class RangeSensor(Strict):
    """What lidars and altimeters share: dspace.Lidar, dspace.Altimeter. Immutable."""

    def _set(self, about, report, maximum_range, **settings):
        self._about = about
        self._message = pb.RangeSensor(report=word(report, REPORTS, "the report", about))
        put(self._message, about, **settings)
        if settings["rays"] == 0:
            reject(about, "rays", 0, "1 to 10000")
        if maximum_range is not None and number(maximum_range, "maximum_range", about) != np.inf:
            put(self._message, about, maximum_range=maximum_range)
        self._settings = {"report": report, "maximum_range": maximum_range, **settings}

    @property
    def settings(self):
        """Its numbers by name."""
        return dict(self._settings)

    @property
    def shape(self):
        """Of the arrays of its scans."""
        return self._shape

    def _put_beams(self, message, first, count):
        """Writes the beams from `first` on, `count` of them, into a ScanRanges."""
        raise NotImplementedError

    def _is_flash(self):
        return False


class Lidar(RangeSensor):
    """A scanning or a flash lidar. Immutable.

        lidar = dspace.Lidar(azimuth_deg=np.arange(-180, 180, 0.2), elevation_deg=np.linspace(-15, 15, 16), maximum_range=100)
        scan = scene.scan(lidar, frame="rover/mast", seed=7)
        scan.save("scan.ply")

    azimuth_deg, elevation_deg: arrays of angles of its beams, one at each azimuth and elevation; the result's arrays have
    the shape (elevations, azimuths). Azimuths are clockwise from Y seen from Z, -360 to 360; elevations are from the plane
    of X and Y towards Z, -90 to 90, of the frame's axes X right, Y forward, Z up. Lidar.of_directions() and Lidar.flash()
    make others.

    minimum_range [m]: what is nearer gives no echo, and hides what is behind it. maximum_range [m]; None: no limit.
    divergence_deg: full angle of a beam's cone, 0 to 180; 0: one ray. rays: of a beam with a divergence, 1 to 10000: the
    axis, and others evenly over the cone. report: of the surfaces in one beam "first", "last", "mean" (of the rays,
    weighted with their light) or "least" (within the cone, searched for between the rays too).

    noise [m] and noise_fraction: the standard deviation of a range is sqrt(noise**2 + (noise_fraction * range)**2).
    drop_out: probability that a beam is lost. greatest_incidence_deg: steeper surfaces give no echo. least_intensity
    [1/m^2]: fainter beams are lost. The intensity is the mean over the rays of albedo * cos(incidence) / range**2, a ray
    without an echo as 0. terrain_albedo: of all terrain; that of an object is the mean of its colour's linear red, green
    and blue, without textures.

    Raises dspace.InvalidArgument, which names the value and what is accepted; ranges are checked by Scene.scan()."""

    def __init__(self, azimuth_deg, elevation_deg=0.0, minimum_range=0.0, maximum_range=None, divergence_deg=0.0, rays=19,
                 report="first", noise=0.0, noise_fraction=0.0, drop_out=0.0, greatest_incidence_deg=90.0,
                 least_intensity=0.0, terrain_albedo=0.2):
        about = "lidar"
        self._set(about, report, maximum_range, minimum_range=minimum_range, divergence_deg=divergence_deg, rays=rays,
                  noise=noise, noise_fraction=noise_fraction, drop_out=drop_out, least_intensity=least_intensity,
                  greatest_incidence_deg=greatest_incidence_deg, terrain_albedo=terrain_albedo)
        self._grid = [_angles(value, name, most, about) for value, name, most in
                      ((azimuth_deg, "azimuth_deg", 360.0), (elevation_deg, "elevation_deg", 90.0))]
        self._directions = self._model = self._size = None
        self._shape = (self._grid[1].size, self._grid[0].size)

    @classmethod
    def of_directions(cls, directions, **settings):
        """A lidar with a beam in each direction (..., 3), of any length but 0, in the frame's axes; of a camera in its axes
        X right, Y down, Z forward. The result's arrays have the shape (...). settings: as of Lidar()."""
        about = "lidar"
        accepted = "an array (..., 3) of finite vectors that are not zero"
        array = array_of(directions, "the directions", accepted, about)
        if array.ndim < 2 or array.shape[-1] != 3 or not np.isfinite(array).all() or not array.any(axis=-1).all():
            reject(about, "directions", directions, accepted)
        if not array.size:
            raise InvalidArgument(f"{about}: it has no beams; accepted: {accepted}", about)
        lidar = cls(0.0, **settings)
        lidar._grid, lidar._directions, lidar._shape = None, np.array(array).reshape(-1, 3), array.shape[:-1]
        return lidar

    @classmethod
    def flash(cls, model=None, size=None, **settings):
        """A flash lidar: a beam along the ray of each pixel of a CameraModel, or with size=(width, height) of the scene's
        camera. The result's arrays have the shape (height, width). A pixel's rays begin at its entrance pupil. settings: as
        of Lidar()."""
        about = "lidar"
        if model is not None and not isinstance(model, CameraModel):
            reject(about, "the model", model, "a dspace.CameraModel", WrongType)
        size = model.size if size is None and model is not None else size
        if size is None:
            reject(about, "the size", size, "(width, height), or a model that has one")
        lidar = cls(0.0, **settings)
        lidar._grid, lidar._model, lidar._size = None, model, tuple(size)
        lidar._shape = (lidar._size[1], lidar._size[0])
        return lidar

    def _is_flash(self):
        return self._size is not None

    def _put_beams(self, message, first, count):
        message.first_beam = first
        if self._directions is not None:
            message.directions.direction[:] = self._directions[first:first + count].ravel().tolist()
            return
        message.beam_count = count
        if self._is_flash():
            message.pixels = True
        elif not message.HasField("grid"):
            message.grid.azimuth_deg.extend(self._grid[0].tolist())
            message.grid.elevation_deg.extend(self._grid[1].tolist())

    def __repr__(self):
        return f"<dspace.Lidar, {' x '.join(map(str, self.shape))} beams>"


class Altimeter(RangeSensor):
    """A beam-limited altimeter: it reports the least range within the cone of its beam. Immutable.

        altimeter = dspace.Altimeter(beam_width_deg=10, noise=0.1)
        height = scene.scan(altimeter, frame="lander").range

    beam_width_deg: full angle of the cone, 0 to 180; 0: one ray. direction (3,): of its axis in the frame's axes; of a
    camera in its axes X right, Y down, Z forward. rays: from which the least range is searched for, to a millimetre on ground
    that is smooth between them. Other arguments and errors: as of Lidar(). The result's arrays have the shape ()."""

    _shape = ()

    def __init__(self, beam_width_deg, direction=(0.0, 0.0, -1.0), rays=397, minimum_range=0.0, maximum_range=None, noise=0.0,
                 noise_fraction=0.0, drop_out=0.0, greatest_incidence_deg=90.0, least_intensity=0.0, terrain_albedo=0.2):
        about = "altimeter"
        self._set(about, "least", maximum_range, minimum_range=minimum_range, divergence_deg=beam_width_deg, rays=rays,
                  noise=noise, noise_fraction=noise_fraction, drop_out=drop_out, least_intensity=least_intensity,
                  greatest_incidence_deg=greatest_incidence_deg, terrain_albedo=terrain_albedo)
        accepted = "three finite numbers that are not all 0"
        self._direction = array_of(direction, "the direction", accepted, about)
        if self._direction.shape != (3,) or not np.isfinite(self._direction).all() or not self._direction.any():
            reject(about, "the direction", direction, accepted)

    def _put_beams(self, message, first, count):
        message.directions.direction[:] = self._direction.tolist()

    def __repr__(self):
        return f"<dspace.Altimeter, beam of {self._settings['divergence_deg']:g} deg>"


def _angles(value, name, most, about):
    accepted = f"a number or an array (n,) of angles, -{most:g} to {most:g} degrees"
    array = np.atleast_1d(array_of(value, name, accepted, about))
    if array.ndim != 1 or not (np.abs(array) <= most).all():
        reject(about, name, value, accepted)
    if not array.size:
        raise InvalidArgument(f"{about}: it has no beams: {name} is empty; accepted: {accepted}", about)
    return np.array(array)
