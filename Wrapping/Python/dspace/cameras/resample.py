"""Values of images between their pixels."""
import numpy as np


def resample(image, pixels, nearest=False):
    """The values of an image (h, w, ...) at pixels (n, m, 2), (0, 0) being the centre of the top-left one.

    They are interpolated between four pixels, or taken from the nearest. Integers are rounded. Pixels beyond the image's
    outer edges, and NaN, give 0 for integers, else NaN."""
    height, width = image.shape[:2]
    u, v = pixels[..., 0], pixels[..., 1]
    with np.errstate(invalid="ignore"):
        inside = (u >= -0.5) & (u <= width - 0.5) & (v >= -0.5) & (v <= height - 0.5)
    u = np.clip(np.where(inside, u, 0.0), 0, width - 1)
    v = np.clip(np.where(inside, v, 0.0), 0, height - 1)
    whole = np.issubdtype(image.dtype, np.integer)
    if nearest or image.dtype == bool:
        out = image[np.rint(v).astype(np.intp), np.rint(u).astype(np.intp)].copy()
    else:
        x, y = np.minimum(u.astype(np.intp), max(width - 2, 0)), np.minimum(v.astype(np.intp), max(height - 2, 0))
        right, below = np.minimum(x + 1, width - 1), np.minimum(y + 1, height - 1)
        more = (...,) + (None,) * (image.ndim - 2)
        s, t = (u - x)[more], (v - y)[more]
        mixed = ((1 - t) * ((1 - s) * image[y, x] + s * image[y, right])
                 + t * ((1 - s) * image[below, x] + s * image[below, right]))
        out = (np.rint(mixed) if whole else mixed).astype(image.dtype)
    out[~inside] = 0 if whole or image.dtype == bool else np.nan
    return out
