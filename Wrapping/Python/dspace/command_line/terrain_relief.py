"""Hillshades of `dspace terrain render`: relief that true light does not show is exaggerated.

Pixels of kilometres have slopes of fractions of a degree. Their true shading is one grey, so maps are shaded with
heights multiplied by a factor, which the command prints."""
import math

import numpy as np

STEEP_ENOUGH = math.tan(math.radians(3.0))  # slope of a pixel that true light shows
SHOWN = math.tan(math.radians(20.0))  # slope that exaggerated ground has
STEEPEST = math.tan(math.radians(60.0))  # of the steepest slopes, exaggerated
SHARES = (90, 99)  # percentiles of the slopes: the one that is to be shown, and the steepest that count
LEVEL = SHOWN / 1e4  # slopes below it are those of rounding: depths are floats
FACING = 0.3  # least cosine between the ground's normal and the view: nearer to the limb heights are inexact


def tangential(heights, normals, pixel):
    """Returns the change of the heights along the surface, (h, w, 3) in metres a metre, NaN where it is not known.

    heights: (h, w) metres above the surface without relief, NaN beside it. normals: (h, w, 3) of that surface, in axes
    X right, Y up, Z to the camera; pixel: metres."""
    down, right = (np.gradient(heights, pixel, axis=i) if heights.shape[i] > 1 else np.zeros_like(heights) for i in (0, 1))
    slope = np.stack([right, -down, np.zeros_like(right)], axis=-1)
    # Of a surface that is seen at an angle: what lies in it of the change across the picture.
    return slope - normals * np.sum(slope * normals, axis=-1, keepdims=True)


def automatic(heights, normals, pixel):
    """Returns the factor for a map with these heights, as `tangential` takes them: 1 where true light shows the relief,
    else one that makes the 90th percentile of the slopes, from pixel to pixel, 20 degrees, but the 99th no more than 60
    degrees, to two digits."""
    slopes = np.linalg.norm(tangential(heights, normals, pixel), axis=-1)[normals[..., 2] > FACING]
    slopes = slopes[np.isfinite(slopes)]
    steep, steepest = np.percentile(slopes, SHARES) if len(slopes) else (0.0, 0.0)
    if not LEVEL < steep < STEEP_ENOUGH:
        return 1.0
    return max(1.0, float(f"{min(SHOWN / steep, STEEPEST / steepest):.2g}"))


def shade(picture, heights, normals, pixel, factor, sun, light):
    """Returns a picture of colors, (h, w, 3) sRGB, shaded by Lambert's law.

    heights, normals, pixel: as `tangential` takes them. factor: multiplies the heights. sun: the direction towards it,
    unit, in the axes of the normals. light: (fill, sun), of a surface that faces it."""
    slope = np.nan_to_num(tangential(heights, normals, pixel))
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
