"""Detectors: from radiance to electrons and counts."""
import json
import math

import numpy as np

from dspace._core.fields import array_of, flag, integer, number, reject
from dspace._core.strict import Strict
from dspace.cameras.model import CameraModel, _check, _vtk, _wrapped
from dspace.errors import WrongType

ROWS = 64  # of rays at a time, for the falloff


class Sensor(Strict):
    """A detector with its optics' light. Immutable.

        sensor = dspace.Sensor(exposure_s=0.01, f_number=12, bands_nm=[(600, 800)], read_noise=10)
        planes = scene.simulate_image(model, radiance=True)
        counts = sensor.expose(planes["radiance"], model, seed=7)

    exposure_s [s]; f_number; pixel_pitch [m]; transmission of the lens and quantum_efficiency, 0 to 1; bands_nm: one or three
    (red, green, blue) pairs of wavelengths [nm]; bayer: "" or "RGGB", "BGGR", "GRBG", "GBRG"; point_spread: standard deviation
    of a Gaussian blur [pixels]; photon_noise; read_noise: standard deviation [electrons]; dark_current [electrons/s]; full_well
    [electrons]; gain [electrons per count]; bits, 8 to 16; offset [counts]; falloff: the light of a pixel whose ray makes
    the angle t with the axis is cos(t) ** falloff (4: the law of a simple lens; 0: none).

    Radiance of a channel is that of the whole solar spectrum, whose shape is a black body's of 5772 K; a band has its part.
    Raises dspace.InvalidArgument, which names the value and what is accepted."""

    def __init__(self, exposure_s=0.01, f_number=4.0, pixel_pitch=5e-6, transmission=0.9, quantum_efficiency=0.5,
                 bands_nm=((600, 700), (500, 600), (400, 500)), bayer="", point_spread=0.0, photon_noise=True, read_noise=0.0,
                 dark_current=0.0, full_well=50000.0, gain=12.5, bits=12, offset=0.0, falloff=0.0):
        about = "sensor"
        bands = array_of(bands_nm, "bands_nm", "pairs of wavelengths [nm]", about)
        if bands.ndim != 2 or bands.shape[1] != 2 or not np.isfinite(bands).all():
            reject(about, "bands_nm", bands_nm, "pairs of wavelengths [nm]")
        if not isinstance(bayer, str):
            reject(about, "bayer", bayer, "a str", WrongType)
        settings = {name: number(value, name, about) for name, value in dict(
            exposure_s=exposure_s, f_number=f_number, pixel_pitch=pixel_pitch, transmission=transmission,
            quantum_efficiency=quantum_efficiency, point_spread=point_spread, read_noise=read_noise,
            dark_current=dark_current, full_well=full_well, gain=gain, offset=offset).items()}
        for name, value in settings.items():
            if not np.isfinite(value):
                reject(about, name, value, "a finite number")
        self._falloff = number(falloff, "falloff", about)
        if not 0.0 <= self._falloff <= 20.0:
            reject(about, "falloff", falloff, "0 to 20")
        self._settings = {**settings, "bands_nm": bands.tolist(), "bayer": bayer, "bits": integer(bits, "bits", about),
                          "photon_noise": flag(photon_noise, "photon_noise", about)}
        if not -2**31 <= self._settings["bits"] < 2**31:
            reject(about, "bits", bits, "8 to 16")
        self._vtk = self._make(0)

    def _make(self, seed):
        made = _vtk().vtkDspaceSensor()
        _check(made.Set(json.dumps({**self._settings, "seed": seed})))
        return made

    @property
    def settings(self):
        """Its numbers by name."""
        return {**self._settings, "falloff": self._falloff}

    @property
    def response(self):
        """Electrons per W/m^2/sr of each channel, on the axis."""
        return np.array([self._vtk.GetResponse(channel) for channel in range(self._vtk.GetChannels())])

    def electrons(self, radiance, model=None):
        """Mean electrons (h, w, channels) from light, after blur. radiance: (h, w, 3) [W/m^2/sr]; NaN and negative values
        count as 0. model: the CameraModel, needed for a falloff."""
        radiance = _radiance(radiance)
        self._check_model(model, radiance.shape[1::-1])
        return self._electrons(radiance, model, 0)

    def _check_model(self, model, size):
        if self._falloff > 0 and not isinstance(model, CameraModel):
            reject("sensor", "the model", model, "a dspace.CameraModel, for the falloff", WrongType)
        if self._falloff > 0 and model.size is not None and model.size != tuple(size):
            reject("sensor", "the radiance's size", tuple(size), f"that of the model, {model.size}")

    def _electrons(self, radiance, model, top):
        """As electrons(), of rows of an image from the row `top` on."""
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkCommonCore import vtkFloatArray
        height, width = radiance.shape[:2]
        falloff = _wrapped(self._falloffs(model, width, height, top).ravel()) if self._falloff > 0 else None
        out = vtkFloatArray()
        _check(self._vtk.Electrons(_wrapped(radiance.reshape(-1, 3)), width, height, falloff, out))
        return vtk_to_numpy(out).reshape(height, width, -1)

    def _falloffs(self, model, width, height, first):
        found = np.zeros((height, width), np.float32)
        u = np.arange(width, dtype=float)
        for top in range(0, height, ROWS):
            v = np.arange(first + top, first + min(top + ROWS, height), dtype=float)
            cosine = model.rays(np.stack(np.meshgrid(u, v), axis=-1), in_camera=True)[1][..., 2]
            found[top:top + ROWS] = np.nan_to_num(np.clip(cosine, 0.0, 1.0)) ** self._falloff
        return found

    def expose(self, radiance, model=None, seed=0, frame=0):
        """Counts (h, w), or (h, w, 3) of three bands without a Bayer pattern, uint16.

        Equal seeds (0 to 2**64 - 1) and frames (0 to 2**32 - 1) give equal noise: a pixel's depends on them and on its own
        place. Other arguments as for electrons()."""
        radiance = _radiance(radiance)
        return Exposure(self, radiance.shape[1::-1], model, seed, frame).add(radiance)

    def __repr__(self):
        s = self._settings
        return f"<dspace.Sensor of {s['exposure_s']:g} s, f/{s['f_number']:g}, {s['bits']} bits>"


class Exposure:
    """An image of a Sensor in rows from its top, with the bytes of Sensor.expose(). size: (width, height) of the image."""

    def __init__(self, sensor, size, model=None, seed=0, frame=0):
        about = "sensor"
        seed, frame = integer(seed, "the seed", about), integer(frame, "the frame", about)
        if not 0 <= seed < 2**64:
            reject(about, "the seed", seed, "0 to 2**64 - 1")
        if not 0 <= frame < 2**32:
            reject(about, "the frame", frame, "0 to 2**32 - 1")
        sensor._check_model(model, size)
        self._sensor, self._model, self._frame, self._size = sensor, model, frame, tuple(size)
        self._vtk = sensor._make(seed)
        spread = sensor.settings["point_spread"]
        self._reach = math.ceil(5 * spread) + 1 if spread > 0 else 0  # rows: the kernel's, in Sensor.cxx
        self._rows, self._first, self._done = None, 0, 0  # light that is not used up, its first row, rows that are exposed

    @property
    def channels(self):
        """Of the counts: 1 or 3."""
        return self._vtk.GetCountChannels()

    def add(self, radiance):
        """Takes the next rows (n, width, 3), and returns the counts of the rows that they complete; there may be none: those
        near the last one wait for its neighbours, unless the image is complete."""
        from vtkmodules.vtkCommonCore import vtkUnsignedShortArray
        from vtkmodules.util.numpy_support import vtk_to_numpy
        width, height = self._size
        radiance = _radiance(radiance)
        self._rows = radiance if self._rows is None else np.concatenate((self._rows, radiance))
        end = self._first + len(self._rows)
        if radiance.shape[1] != width or end > height:
            reject("sensor", "the shape of the next rows", radiance.shape, f"(n, {width}, 3), {height} rows in all")
        ready = height if end == height else max(end - self._reach, self._done)
        count = ready - self._done
        above = max(self._done - self._reach, 0)
        if count:
            part = np.ascontiguousarray(self._rows[above - self._first:])
            electrons = self._sensor._electrons(part, self._model, above)[self._done - above:][:count]
            out = vtkUnsignedShortArray()
            _check(self._vtk.Counts(_wrapped(np.ascontiguousarray(electrons).reshape(-1, electrons.shape[2])), width, count, 0,
                                    self._done, self._frame, out))
            counts = vtk_to_numpy(out)
        else:
            counts = np.empty(0, np.uint16)
        self._done = ready
        keep = max(ready - self._reach, 0)
        self._rows, self._first = self._rows[keep - self._first:], keep
        return counts.reshape((count, width) + ((3,) if self.channels == 3 else ()))


def _radiance(radiance):
    """Light (h, w, 3) as floats, checked."""
    about = "sensor"
    radiance = np.ascontiguousarray(array_of(radiance, "the radiance", "an array (h, w, 3)", about), dtype=np.float32)
    if radiance.ndim != 3 or radiance.shape[2] != 3 or not radiance.size:
        reject(about, "the radiance's shape", radiance.shape, "(h, w, 3)")
    return radiance
