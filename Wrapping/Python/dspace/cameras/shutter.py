"""Pictures of scenes that move while the shutter is open: motion blur, and rows that are exposed one after another."""
import numpy as np

from dspace._core.fields import flag, integer, number, reject, word
from dspace._core.strict import Strict
from dspace.cameras.model import CameraModel
from dspace.errors import WrongType

WHITE = np.pi / 1361.0  # display light of a radiance [W/m^2/sr] at an exposure of 1
AT_ONCE = ("depth", "range", "label", "lit_fraction", "incidence", "emission", "phase", "normal")
MOST = 4096  # instants of a row, and bands


class Shutter(Strict):
    """When the rows of an image are exposed. Immutable.

    exposure_s: how long each row is exposed [s], above 0. readout_s: from the middle of the first row's exposure to that of the
    last one's [s]; 0: all rows at once (a global shutter). direction: "down", the top row is the first, or "up". samples: the
    instants over which a row's light is averaged, 1 to 4096: the middles of equal parts of the exposure. bands: into how many
    bands of rows, each of one time, the image is divided where readout_s is not 0, 1 to 4096; no more than there are rows.
    Raises dspace.InvalidArgument and dspace.WrongType."""

    def __init__(self, exposure_s, readout_s=0.0, direction="down", samples=8, bands=64):
        about = "shutter"
        self._exposure_s = number(exposure_s, "exposure_s", about)
        if not 0.0 < self._exposure_s < np.inf:
            reject(about, "exposure_s", exposure_s, "a number of seconds above 0")
        self._readout_s = number(readout_s, "readout_s", about)
        if not 0.0 <= self._readout_s < np.inf:
            reject(about, "readout_s", readout_s, "a number of seconds, 0 or above")
        self._turn = word(direction, {"down": 1.0, "up": -1.0}, "the direction", about)
        self._direction = direction
        for name, value in (("samples", samples), ("bands", bands)):
            if not 1 <= integer(value, name, about) <= MOST:
                reject(about, name, value, f"1 to {MOST}")
        self._samples, self._bands = int(samples), int(bands)

    exposure_s = property(lambda self: self._exposure_s)
    readout_s = property(lambda self: self._readout_s)
    direction = property(lambda self: self._direction)
    samples = property(lambda self: self._samples)
    bands = property(lambda self: self._bands)

    def rows(self, height):
        """The bands of an image of `height` rows: a list of (first row, row past the last, the middle of its exposure [s]). 0 is
        the middle of the whole image's exposure."""
        count = min(self._bands, height) if self._readout_s > 0 else 1
        edges = np.round(np.linspace(0, height, count + 1)).astype(int)
        pitch = self._turn * self._readout_s / max(height - 1, 1)
        return [(int(first), int(last), float(pitch * (0.5 * (first + last - 1) - 0.5 * (height - 1))))
                for first, last in zip(edges, edges[1:])]

    def instants(self, middle=0.0):
        """The times [s] over which a row is averaged whose exposure has this middle [s]."""
        return middle + self._exposure_s * ((np.arange(self._samples) + 0.5) / self._samples - 0.5)

    def __repr__(self):
        return (f"Shutter(exposure_s={self._exposure_s!r}, readout_s={self._readout_s!r}, direction={self._direction!r}, "
                f"samples={self._samples}, bands={self._bands})")


def exposed_image(images, shutter, at, color, radiance, planes, model, camera, vantage, frame, size, scale, samples, exposure,
                  ornaments, hide, tile, progress):
    """Scene.simulate_exposure(). images: a SceneImages; planes: of AT_ONCE, name: whether it is wanted."""
    about = "exposed image"
    if not isinstance(shutter, Shutter):
        reject(about, "the shutter", shutter, "a dspace.Shutter", WrongType)
    if not callable(at):
        reject(about, "at", at, "a function of a time [s], which puts the scene there", WrongType)
    if progress is not None and not callable(progress):
        reject(about, "progress", progress, "a function of one number", WrongType)
    if model is not None and not isinstance(model, CameraModel):
        reject(about, "the model", model, "a dspace.CameraModel, or None", WrongType)
    wanted = {name: flag(value, name, about) for name, value in planes.items()}
    color, radiance = flag(color, "color", about), flag(radiance, "radiance", about)
    shape = size if size is not None else model.size if model is not None else None
    if shape is None:
        reject(about, "the size", None, "(width, height), where the model has none")
    camera_of = (model, camera, vantage, frame, size, scale)
    light = images._command({"color": False, "radiance": True, **dict.fromkeys(AT_ONCE, False)}, *camera_of, samples, 1.0, ornaments,
                            hide)
    once = images._command({"color": color, "radiance": False, **wanted}, *camera_of, samples, exposure, ornaments, hide)
    middles = color or any(wanted.values())
    width, height = (int(v) for v in shape)
    made, total = {}, None

    def take_once(x, y, columns, rows, part):
        for name, values in part.items():
            if name not in made:
                made[name] = np.empty((height, width) + values.shape[2:], values.dtype)
            made[name][y:y + values.shape[0], x:x + values.shape[1]] = values

    def add_light(x, y, columns, rows, part):
        total[y:y + part["radiance"].shape[0], x:x + part["radiance"].shape[1]] += part["radiance"]

    bands = shutter.rows(height)
    lens, done, count = None, 0, len(bands) * (shutter.samples * (color or radiance) + middles)
    if color or radiance:
        total = np.zeros((height, width, 3))
    try:
        for first, last, middle in bands:
            work = [(light, add_light, time) for time in shutter.instants(middle)] if total is not None else []
            if middles:
                work.append((once, take_once, middle))
            for command, take, time in work:
                at(float(time))
                drawn = images._draw(command, take, tile, None, size, model, (first, last))
                lens = lens or drawn
                done += 1
                if progress is not None:
                    progress(done / count)
    finally:
        at(0.0)
    if total is not None:
        mean = (total / shutter.samples).astype(np.float32)
        if radiance:
            made["radiance"] = mean
        if color:
            made["color"][..., :3] = display(mean, exposure)
    return {**made, "lens": lens}


def display(radiance, exposure):
    """The sRGB bytes of a radiance [W/m^2/sr], as simulate_image() makes them, within a step."""
    linear = np.clip(np.nan_to_num(radiance * (exposure * WHITE)), 0.0, 1.0)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.rint(255.0 * encoded).astype(np.uint8)
