"""Pictures of the closed loop."""
import numpy as np

from dspace._core.files import atomic_write
from dspace._core.png import png

COLORS = np.array([(0.10, 0.10, 0.30), (0.10, 0.45, 0.60), (0.30, 0.75, 0.45), (0.95, 0.85, 0.25), (0.85, 0.25, 0.10)])


def save(path, picture):
    atomic_write(path, png(picture))


def disparity_picture(disparity):
    """Near is red, far is blue, grey: not found."""
    most = np.nanpercentile(disparity, 99) if np.isfinite(disparity).any() else 1.0
    at = np.clip(np.nan_to_num(disparity) / max(most, 1e-6), 0, 1) * (len(COLORS) - 1)
    low = np.minimum(at.astype(int), len(COLORS) - 2)
    part = (at - low)[..., None]
    colors = (1 - part) * COLORS[low] + part * COLORS[low + 1]
    colors[~np.isfinite(disparity)] = 0.35
    return np.rint(255 * colors).astype(np.uint8)


def map_picture(drive):
    """The map of hazards, north on top: grey unseen, green free, red hazards, yellow the track, white the rocks' outlines."""
    hazards = drive.hazards
    colors = np.full(hazards.shape + (3,), 0.35)
    colors[hazards.seen] = (0.25, 0.45, 0.30)
    colors[hazards.seen & (hazards.clearance() < drive.body.radius)] = (0.55, 0.40, 0.25)
    colors[hazards.evidence > 0] = (0.85, 0.15, 0.10)
    scale = 4
    colors = np.repeat(np.repeat(colors, scale, axis=0), scale, axis=1)

    def dots(points, color, size=1):
        at = np.floor((np.asarray(points) - hazards.low) / hazards.cell * scale).astype(int)
        for dx in range(-size, size + 1):
            for dy in range(-size, size + 1):
                x, y = np.clip(at + (dx, dy), 0, np.array(colors.shape[:2]) - 1).T
                colors[x, y] = color

    angle = np.linspace(0, 2 * np.pi, 200)
    for stone in drive.stones:
        dots(stone.middle + stone.radius * np.column_stack((np.cos(angle), np.sin(angle))), (1, 1, 1), 0)
    dots(np.array(drive.track), (1.0, 0.85, 0.1), 1)
    dots([drive.start], (0.2, 0.6, 1.0), 4)
    dots([drive.goal], (0.9, 0.3, 0.9), 4)
    return np.rint(255 * colors.transpose(1, 0, 2)[::-1]).astype(np.uint8)


def fitted(picture, width):
    """The picture, its nearest pixels taken, at another width."""
    rows = np.arange(round(picture.shape[0] * width / picture.shape[1])) * picture.shape[1] // width
    columns = np.arange(width) * picture.shape[1] // width
    return picture[np.minimum(rows, picture.shape[0] - 1)[:, None], columns]


def sheet(top, map_, above):
    """Two pictures side by side, and two below them, all of one width together."""
    first = np.hstack(top)
    width = first.shape[1]
    return np.vstack((first, fitted(map_, width), fitted(above[..., :3], width)))
