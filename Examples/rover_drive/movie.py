"""Pictures of the demo: several in one, and to files."""
import numpy as np

from dspace._core.files import atomic_write
from dspace._core.png import png


def save_image(path, picture):
    """A PNG; `picture`: an array (height, width, 3) of sRGB bytes."""
    atomic_write(path, png(picture))


def tile(pictures):
    """Four pictures of one size in two rows, with a thin line between them."""
    a, b, c, d = (np.array(p[..., :3]) for p in pictures)
    for picture in (a, c):
        picture[:, -1] = 0
    for picture in (a, b):
        picture[-1] = 0
    return np.vstack((np.hstack((a, b)), np.hstack((c, d))))
