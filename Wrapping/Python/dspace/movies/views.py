"""The parts of a movie's picture: views, and overlays of text."""
import math
import re
from dataclasses import dataclass, field

from dspace._core.fields import color, flag, integer, number, numbers, reject, text
from dspace._core.traits import DEFAULT_SCENE, FONT_SIZES
from dspace.errors import WrongType
from dspace.scene.look import TONES
from dspace.scene.viewport import ANCHORS

FIELD = re.compile(r"\{\{|\}\}|\{([^{}:]*)(?::([^{}]*))?\}")  # {name:format}, and {{ and }}, which are braces
WIDEST = 99
LOOK = ("shadows", "fill", "exposure", "automatic_exposure", "tone")


def writable(form, is_number):
    """Returns whether a format is valid for numbers (is_number) or for any kind of value. A format with a width or
    precision above 99 is invalid."""
    if any(int(digits) > WIDEST for digits in re.findall(r"[0-9]+", form)):
        return False
    for value in (1.0, 1, "x")[:1 if is_number else 3]:
        try:
            format(value, form)
            return True
        except ValueError:
            pass
    return False


@dataclass
class View:
    """A part of the movie's picture.

    rectangle: left, top, width, height as fractions of the picture, 0 to 1. scene, vantage: their names.
    camera: the name of a camera of the scene; "": the view follows its keys. near, far: clip distances in metres
    along Z (default: automatic, see Camera.set_projection). hide: names of fragments that the view does not draw. ornaments: whether
    ornamental objects are drawn. background: sRGB, 0 to 1, or a color name; background_top: the top color of a
    gradient. corner_axes: whether the root's axes are drawn in the corner. shadows, fill, exposure, automatic_exposure,
    tone: as of a dspace.Viewport. Raises dspace.InvalidArgument or dspace.WrongType for other values."""
    name: str = "main"
    rectangle: tuple = (0.0, 0.0, 1.0, 1.0)
    scene: str = DEFAULT_SCENE
    vantage: str = "main"
    camera: str = ""
    near: float = None
    far: float = None
    hide: tuple = ()
    ornaments: bool = True
    background: object = None
    background_top: object = None
    corner_axes: bool = False
    shadows: bool = False
    fill: float = 0.2
    exposure: float = 1.0
    automatic_exposure: bool = False
    tone: str = "linear"
    keys: list = field(default_factory=list)

    def __post_init__(self):
        about = f"view {self.name!r}"
        if not text(self.name, "the name", about):
            reject("a view", "the name", self.name, "one that is not empty")
        self.rectangle = tuple(map(float, numbers(self.rectangle, 4, "the rectangle", about)))
        x, y, width, height = self.rectangle
        if not (0 <= x < 1 and 0 <= y < 1 and 0 < width <= 1 + 1e-9 - x and 0 < height <= 1 + 1e-9 - y):
            reject(about, "the rectangle", self.rectangle, "left, top, width, height within 0 to 1")
        for name in ("scene", "vantage", "camera"):
            text(getattr(self, name), name, about)
        for name in ("ornaments", "corner_axes", "shadows", "automatic_exposure"):
            flag(getattr(self, name), name, about)
        if isinstance(self.hide, str) or not all(isinstance(each, str) for each in self.hide):
            reject(about, "hide", self.hide, "a list of fragments' names", WrongType)
        self.hide = tuple(self.hide)
        self._check_colors(about)
        self._check_distances(about)
        self._check_light(about)

    def _check_light(self, about):
        self.fill = number(self.fill, "fill", about)
        if not 0 <= self.fill <= 1:
            reject(about, "fill", self.fill, "0 to 1")
        self.exposure = number(self.exposure, "exposure", about)
        if not 0 < self.exposure <= 1e12:
            reject(about, "exposure", self.exposure, "above 0, up to 1e12")
        if self.tone not in TONES:
            reject(about, "tone", self.tone, " or ".join(map(repr, TONES)))

    @property
    def look(self):
        """How it is lit and exposed, as Viewport.set() takes it."""
        return {name: getattr(self, name) for name in LOOK}

    def _check_colors(self, about):
        for name in ("background", "background_top"):
            value = getattr(self, name)
            if value is None:
                continue
            parts = color(value, name, about)
            if not all(0 <= each <= 1 for each in parts):
                reject(about, name, value, "red, green and blue from 0 to 1")
            if not isinstance(value, str):
                setattr(self, name, tuple(map(float, parts)))
        if self.background_top is not None and self.background is None:
            reject(about, "background_top", self.background_top, "none without a background")

    def _check_distances(self, about):
        near, far = (None if value is None else number(value, name, about)
                     for name, value in (("near", self.near), ("far", self.far)))
        if near is not None and not 1e-9 <= near <= 1e18:
            reject(about, "near", self.near, "1e-9 to 1e18 metres")
        least = 0.05 if near is None else near
        if far is not None and not (least < far <= 1e18 or far == math.inf):
            reject(about, "far", self.far, f"more than near ({least:g}), up to 1e18 metres, or infinite")
        self.near, self.far = near, far

    def pixels(self, size):
        """Returns (left, top, right, bottom) in pixels of a picture of that size."""
        x, y, width, height = self.rectangle
        # Sums are rounded to nine digits, so that 0.02 + 0.68 equals 0.7 and adjacent views meet.
        left, top, right, bottom = (round(round(part, 9) * pixels) for part, pixels in
                                    zip((x, y, x + width, y + height), (*size, *size)))
        if right <= left or bottom <= top:
            reject(f"view {self.name!r}", "the rectangle", self.rectangle, f"a pixel or more of {size}")
        return left, top, right, bottom


@dataclass
class Overlay:
    """A title, or a table of texts and values, over a view.

    rows: (label, value) pairs. A value may hold {movie} and {run} (times [s]), {FRAME.x}, {FRAME.y} and {FRAME.z} (a
    frame's position in the root [m]), and names of the source's telemetry. Each may have a format, such as {run:.2f},
    with a width and precision up to 99. {{ and }} give one brace each. view: the name of a view; "": the first.
    since, until: movie times [s] between which it is shown. font_size: pixels, 4 to 200; 0: the picture's height / 40,
    within 8 to 200. Raises dspace.InvalidArgument or dspace.WrongType for other values."""
    title: str = ""
    rows: tuple = ()
    view: str = ""
    anchor: str = "top left"
    font_size: int = 0
    since: float = 0.0
    until: float = None

    def __post_init__(self):
        about = f"overlay {self.title!r}"
        text(self.title, "the title", about)
        rows = []
        for number_, row in enumerate(self.rows, 1):
            if not isinstance(row, (tuple, list)) or len(row) != 2 or not all(isinstance(c, str) for c in row):
                reject(about, "a row", row, "a label and a value, each a str", WrongType)
            rows.append(tuple(row))
            if re.search("[{}]", FIELD.sub("", row[1])):
                reject(about, f"the value of row {number_}", row[1], "each brace with its other one, as in {run:.2f}; "
                       "{{ or }} for a brace that is drawn")
            for key, form in FIELD.findall(row[1]):
                if not writable(form, key in ("movie", "run")):
                    reject(about, "a value's format", f"{{{key}:{form}}}", "one such as {run:.2f}, of up to "
                           f"{WIDEST} characters and places")
        self.rows = tuple(rows)
        if not self.title and not rows:
            reject(about, "what it says", "", "a title, or rows")
        if self.anchor not in ANCHORS:
            reject(about, "anchor", self.anchor, ", ".join(map(repr, ANCHORS)))
        integer(self.font_size, "font_size", about, "an integer, 0 or 4 to 200")
        if self.font_size and not FONT_SIZES[0] <= self.font_size <= FONT_SIZES[1]:
            reject(about, "font_size", self.font_size, "0 or 4 to 200 pixels")
        self.since = number(self.since, "since", about)
        if not math.isfinite(self.since):
            reject(about, "since", self.since, "a finite number")
        if self.until is not None:
            self.until = number(self.until, "until", about)
            if not self.until > self.since:
                reject(about, "until", self.until, f"after since ({self.since:g} s)")

    def shows(self, time):
        return self.since <= time and (self.until is None or time < self.until)

    def pixels(self, size):
        """Returns the font size in pixels for a picture of that size."""
        return self.font_size or min(FONT_SIZES[1], max(8, round(size[1] / 40)))
