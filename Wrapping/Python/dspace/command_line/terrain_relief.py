"""Hillshades of `dspace terrain render`: relief that true light does not show is exaggerated.

Pixels of kilometres have slopes of fractions of a degree. Their true shading is one grey, so maps are shaded with
heights multiplied by a factor, which the command prints."""
import math

import numpy as np

STEEP_ENOUGH = math.tan(math.radians(3.0))  # slope of a pixel that true light shows
SHOWN = math.tan(math.radians(20.0))  # slope that exaggerated ground has
SHARE = 90  # percentile of the slopes that counts
SIDE = 48  # places along each side of a raster that are looked at


def automatic(ground, pixel):
    """Returns the factor for a map whose pixels have `pixel` metres: 1 where true light shows the relief, else one that
    makes the 90th percentile of the slopes, from pixel to pixel, 20 degrees, to two digits."""
    slopes = []
    for terrain, (x0, x1, y0, y1) in zip(ground.terrains, ground.maps):
        step = pixel / ground.metres_per_unit
        if not 0 < step < min(x1 - x0, y1 - y0):
            continue
        x, y = (a.ravel() for a in np.meshgrid(np.linspace(x0, x1 - step, SIDE), np.linspace(y0, y1 - step, SIDE)))
        here, east, north = (terrain.height(x + u, y + v, map=True) for u, v in ((0, 0), (step, 0), (0, step)))
        rise = np.hypot(east - here, north - here)
        slopes.append(rise[np.isfinite(rise)] / pixel)
    slopes = np.concatenate(slopes) if slopes else np.zeros(0)
    steep = float(np.percentile(slopes, SHARE)) if len(slopes) else 0.0
    if not 0 < steep < STEEP_ENOUGH:
        return 1.0
    return float(f"{SHOWN / steep:.2g}")


def shade(picture, heights, normals, pixel, factor, sun, light):
    """Returns a picture of colors, (h, w, 3) sRGB, shaded by Lambert's law.

    heights: (h, w) metres above the surface without relief, NaN beside it. normals: (h, w, 3) of that surface, in axes
    X right, Y up, Z to the camera; pixel: metres. factor: multiplies the heights. sun: the direction towards it, unit,
    in these axes. light: (fill, sun), of a surface that faces it."""
    down, right = np.gradient(heights, pixel)
    slope = np.nan_to_num(np.stack([right, -down, np.zeros_like(right)], axis=-1))
    # Of a surface that is seen at an angle: what lies in it of the change across the picture.
    slope -= normals * np.sum(slope * normals, axis=-1, keepdims=True)
    facing = normals - factor * slope
    facing /= np.linalg.norm(facing, axis=-1, keepdims=True)
    lit = light[0] + light[1] * np.clip(facing @ sun, 0.0, None)
    lit[~np.isfinite(heights)] = 1.0  # beside the ground
    linear = to_linear(picture / 255.0) * lit[..., None]
    return np.round(255.0 * to_display(np.clip(linear, 0.0, 1.0))).astype(np.uint8)


def to_linear(color):
    """sRGB to linear light (IEC 61966-2-1)."""
    return np.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)


def to_display(light):
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def told(factor):
    return "" if factor == 1 else f"; relief exaggerated {factor:g} times"
