"""Texts, lines and circles that are painted over views."""
import numpy as np

from dspace._core.fields import array_of, flag, real, reject, text

ALIGN = ("left", "center", "right")
LABEL = "overlay"


def _places(at, points):
    """The places of an item for the window: `at` in pixels, or `points` in the root."""
    if (at is None) == (points is None):
        reject(LABEL, "the place", (at, points), "one of `at` and `points`")
    what, given, columns = ("at", at, 2) if points is None else ("points", points, 3)
    array = np.atleast_2d(array_of(given, f"`{what}`", f"{columns} numbers, or rows of {columns}", LABEL))
    if array.ndim != 2 or array.shape[1] != columns or not array.size or not np.isfinite(array).all():
        reject(LABEL, f"`{what}`", given, f"{columns} finite numbers, or rows of {columns}")
    return {what: array.tolist()}


class Item:
    """One text, line or circle of an Overlay."""

    def __init__(self, overlay, fields):
        self._overlay = overlay
        self._number = overlay._ask("item", item=fields)["item"]

    def set(self, *, at=None, points=None, **changes):
        """Changes what was given to the method that made it: at or points, text, color, size, align, radius, width, filled,
        closed."""
        changes = _checked(changes)
        if at is not None or points is not None:
            changes.update(_places(at, points))
        self._overlay._ask("set", item=self._number, changes=changes)

    def remove(self):
        """Removes it from the overlay."""
        self._overlay._ask("remove", item=self._number)


def _checked(fields):
    for name, value in fields.items():
        if name in ("text", "color"):
            text(value, f"`{name}`", LABEL)
        elif name == "align":
            if value not in ALIGN:
                reject(LABEL, "`align`", value, ", ".join(ALIGN))
        elif name in ("filled", "closed"):
            flag(value, f"`{name}`", LABEL)
        elif name in ("size", "radius", "width"):
            if not real(value, f"`{name}`", LABEL) > 0.0:
                reject(LABEL, f"`{name}`", value, "more than 0 pixels")
        else:
            reject(LABEL, "an argument", name, "at, points, text, color, size, align, radius, width, filled, closed")
    return fields


class Overlay:
    """What is painted over one view, or over all; App.add_overlay() makes it.

    Places are `points`, in the root of the view's scene [m], which move with the camera and show through what hides them;
    or `at`, in pixels of the view from the top left, below 0 from the right or the bottom. color: such as "#ffd23f" or
    "white". All have a dark edge, so that they are seen on any ground.

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
        size: of the letters [pixels]."""
        return Item(self, {"kind": "text", **_places(at, points),
                           **_checked({"text": words, "color": color, "size": size, "align": align})})

    def line(self, *, at=None, points=None, color="#ffd23f", width=2, closed=False):
        """Straight lines from place to place; closed: also from the last to the first."""
        return Item(self, {"kind": "line", **_places(at, points), **_checked({"color": color, "width": width, "closed": closed})})

    def circle(self, *, at=None, points=None, radius=5, color="#ffd23f", width=2, filled=False):
        """A circle about each place. radius, width: [pixels]."""
        return Item(self, {"kind": "circle", **_places(at, points),
                           **_checked({"color": color, "radius": radius, "width": width, "filled": filled})})

    def close(self):
        """Removes all of it."""
        self._ask("close")
