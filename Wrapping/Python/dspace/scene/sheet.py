"""Sheets: several viewports in one picture, each at its position."""
import numpy as np

from dspace._core.fields import color, file_path, integers, items, reject
from dspace._core.files import atomic_write
from dspace._core.png import png
from dspace.errors import WrongType
from dspace.scene.viewport import Viewport

MAXIMUM_SIDE = 32768  # pixels
MAXIMUM_PIXELS = 2**28
ACCEPTED = f"(width, height), two integers from 1 to {MAXIMUM_SIDE}, and {MAXIMUM_PIXELS} pixels in all"


def sheet_of(viewports, size=None, background=(0, 0, 0), path=None, physical_only=False):
    """Session.sheet() of these viewports."""
    about = "sheet"
    viewports = items(viewports, "the viewports", about, "a list of viewports")
    for each in viewports:
        if not isinstance(each, Viewport):
            reject(about, "a viewport", each, "a dspace.Viewport", WrongType)
    if not viewports:
        reject(about, "the list of viewports", viewports, "one or more")
    if path is not None:
        path = file_path(path, "the path", about)
        if not path.lower().endswith(".png"):
            reject(about, "the path", path, "one that ends with .png")
    ground = color(background, "the background", about)
    if not all(0 <= each <= 1 for each in ground):
        reject(about, "the background", background, "red, green and blue from 0 to 1, '#rrggbb' or a CSS name")
    places = [(*each.position, *each.size) for each in viewports]
    for viewport, (x, y, _, _) in zip(viewports, places):
        if x < 0 or y < 0:
            reject(f"sheet, viewport {viewport.name!r}", "its position", (x, y), "0 and more (view.position = x, y)")
    least = tuple(max(place[side] + place[side + 2] for place in places) for side in (0, 1))
    width, height = least if size is None else integers(size, 2, "the size", about, ACCEPTED)
    if not (1 <= width <= MAXIMUM_SIDE and 1 <= height <= MAXIMUM_SIDE and width * height <= MAXIMUM_PIXELS):
        reject(about, "the size", (width, height), ACCEPTED)
    for viewport, (x, y, w, h) in zip(viewports, places):
        if x + w > width or y + h > height:
            reject(f"sheet, viewport {viewport.name!r}", "its place", f"({x}, {y}) of {w} x {h} pixels",
                   f"a place within the sheet of {width} x {height}, or size=None")
    out = np.empty((height, width, 3), np.uint8)
    out[:] = np.round(np.array(ground) * 255).astype(np.uint8)
    for viewport, (x, y, w, h) in zip(viewports, places):
        out[y:y + h, x:x + w] = viewport.image(physical_only=physical_only)
    if path is not None:
        atomic_write(path, png(out), f"file {path!r}")
    return out
