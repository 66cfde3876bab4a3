"""Texts, lines and circles that are painted over views."""
import numpy as np

from dspace._core.fields import array_of, flag, real, reject, text

ALIGN = ("left", "center", "right")
FIELDS = {"text": ("text", "color", "size", "align"), "line": ("color", "width", "closed"),
          "circle": ("color", "radius", "width", "filled")}  # by kind, beside at and points
LEAST = {"text": 1, "line": 2, "circle": 1}  # places
PIXELS = {"size": (4, 400), "radius": (0.5, 10_000), "width": (0.5, 100)}
LABEL = "overlay"


def _places(at, points, least):
    """The places of an item for the window: `at` in pixels, or `points` in the root."""
    if (at is None) == (points is None):
        reject(LABEL, "the place", (at, points), "one of `at` and `points`")
    what, given, columns = ("at", at, 2) if points is None else ("points", points, 3)
    array = np.atleast_2d(array_of(given, f"`{what}`", f"{columns} numbers, or rows of {columns}", LABEL))
    if array.ndim != 2 or array.shape[1] != columns or len(array) < least or not np.isfinite(array).all():
        rows = f"{columns} finite numbers, or rows of {columns}" if least == 1 else f"{least} or more rows of {columns} finite numbers"
        reject(LABEL, f"`{what}`", given, rows)
    return {what: array.tolist()}


def _checked(kind, fields):
    """The fields of an item of a kind as JSON takes them."""
    checked = {}
    for name, value in fields.items():
        if name not in FIELDS[kind]:
            reject(LABEL, f"an argument of a {kind}", name, "at, points, " + ", ".join(FIELDS[kind]))
        if name in ("text", "color"):
            checked[name] = text(value, f"`{name}`", LABEL)
        elif name == "align":
            if value not in ALIGN:
                reject(LABEL, "`align`", value, ", ".join(ALIGN))
            checked[name] = value
        elif name in PIXELS:
            low, high = PIXELS[name]
            checked[name] = real(value, f"`{name}`", LABEL)
            if not low <= checked[name] <= high:
                reject(LABEL, f"`{name}`", value, f"{low:g} to {high:g} pixels")
        else:
            checked[name] = flag(value, f"`{name}`", LABEL)
    return checked


class Item:
    """One text, line or circle of an Overlay."""

    def __init__(self, overlay, kind, at, points, fields):
        self._overlay, self._kind = overlay, kind
        item = {"kind": kind, **_places(at, points, LEAST[kind]), **_checked(kind, fields)}
        self._number = overlay._ask("item", item=item)["item"]

    def set(self, *, at=None, points=None, **changes):
        """Changes what was given to the method that made it: at or points, and of a text text, color, size, align; of a line
        color, width, closed; of a circle color, radius, width, filled."""
        changes = _checked(self._kind, changes)
        if at is not None or points is not None:
            changes.update(_places(at, points, LEAST[self._kind]))
        self._overlay._ask("set", item=self._number, changes=changes)

    def remove(self):
        """Removes it from the overlay."""
        self._overlay._ask("remove", item=self._number)


class Overlay:
    """What is painted over one view, or over all; App.add_overlay() makes it.

    Places are `points`, in the root of the view's scene [m], which move with the camera and show through what hides them;
    or `at`, in pixels of the view from the top left, below 0 from the right or the bottom. color: such as "#ffd23f" or
    "white". All have an edge that sets them off from any ground. Items at points are seen through the lens of a view with one.

        overlay = app.add_overlay()
        goal = overlay.circle(points=(10, 4, 0.3), radius=8)
        name = overlay.text("goal", points=(10, 4, 0.6), align="center")
        clock = overlay.text("", at=(12, -12))
        app.every(0.1, lambda: clock.set(text=f"{scene.time:.1f} s"))
    """

    def __init__(self, ask, view):
        self._asked = ask
        self._number = ask({"do": "overlay", "what": "add", "view": "" if view is None else view.name})["overlay"]

    def _ask(self, what, **fields):
        return self._asked({"do": "overlay", "what": what, "overlay": self._number, **fields})

    def text(self, words, *, at=None, points=None, color="white", size=13, align="left"):
        """Text; its first line's base begins (align: "left"), has its middle ("center") or ends ("right") at the place.
        size: of the letters, 4 to 400 pixels."""
        return Item(self, "text", at, points, {"text": words, "color": color, "size": size, "align": align})

    def line(self, *, at=None, points=None, color="#ffd23f", width=2, closed=False):
        """Straight lines from place to place; closed: also from the last to the first. width: 0.5 to 100
        pixels."""
        return Item(self, "line", at, points, {"color": color, "width": width, "closed": closed})

    def circle(self, *, at=None, points=None, radius=5, color="#ffd23f", width=2, filled=False):
        """A circle about each place. radius: 0.5 to 10,000 pixels; width: 0.5 to 100."""
        return Item(self, "circle", at, points, {"color": color, "radius": radius, "width": width, "filled": filled})

    def close(self):
        """Removes all of it."""
        self._ask("close")
