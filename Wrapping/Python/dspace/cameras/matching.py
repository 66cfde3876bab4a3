"""Disparity of rectified pictures: by OpenCV's matcher where python3-opencv is installed, else by blocks of a census."""
import numpy as np

from dspace._core.fields import array_of, integer, reject
from dspace.errors import NotFound

METHODS = ("sgbm", "census")
BAND = 64  # rows matched at a time by "census", which bounds its memory
REACH = 3  # pixels: the census compares a pixel with its neighbours within
UNIQUE = 1.05  # the second best block costs at least this much more
WORST = np.uint32(2**20)  # the cost of a block that is outside


def match(left, right, disparities, window=None, method=None):
    """Disparity (h, w) [pixels], float32, of the left one of two rectified pictures; NaN: not found.

    What is at column u of the left picture is at column u - disparity of the right one, in the same row. left, right: arrays
    of one size, (h, w), or (h, w, 3 or 4) of colours. disparities: (least, most), whole pixels; most - least up to 4096.
    window: the side of a block [pixels], odd, 3 to 31 (default: 5 for "sgbm", 9 for "census"). method: "sgbm", OpenCV's
    semi-global matcher, or "census", Dspace's own: Hamming distances of 7 x 7 census codes, summed over a block, with a check from
    right to left; None: "sgbm" where it is installed, else "census". Both give parts of a pixel.

    Raises dspace.InvalidArgument, and dspace.NotFound where a named method is not installed."""
    about = "match of two pictures"
    left, right = (_grey(each, what, about) for each, what in ((left, "the left picture"), (right, "the right picture")))
    if left.shape != right.shape:
        reject(about, "the right picture's shape", right.shape, f"that of the left one, {left.shape}")
    try:
        least, most = (integer(each, "a disparity", about) for each in disparities)
    except (TypeError, ValueError):
        reject(about, "disparities", disparities, "(least, most), whole pixels")
    if not 0 < most - least <= 4096 or abs(least) > 2**15:
        reject(about, "disparities", (least, most), "(least, most), most above least by 1 to 4096 pixels")
    method = chosen(method)
    window = (5 if method == "sgbm" else 9) if window is None else integer(window, "the window", about)
    if not 3 <= window <= 31 or window % 2 == 0:
        reject(about, "the window", window, "an odd number from 3 to 31 pixels")
    return (_sgbm if method == "sgbm" else _census)(left, right, least, most, window)


def chosen(method=None):
    """The method that match() uses."""
    about = "match of two pictures"
    if method is not None and method not in METHODS:
        reject(about, "the method", method, ", ".join(map(repr, METHODS)))
    if method == "census":
        return method
    try:
        import cv2  # noqa: F401
        return "sgbm"
    except ImportError:
        if method is None:
            return "census"
        raise NotFound(f"{about}: OpenCV is not installed; accepted: Debian's package python3-opencv, or the method 'census'",
                       "python3-opencv") from None


def grey_of(picture):
    """A picture (h, w) or (h, w, 3 or 4) as floats (h, w): of colours the mean, NaN and infinities as 0."""
    picture = np.asarray(picture)
    grey = (picture if picture.ndim == 2 else picture[..., :3].mean(axis=-1, dtype=np.float64)).astype(np.float32)
    return np.nan_to_num(grey, copy=False, nan=0.0, posinf=0.0, neginf=0.0)


def _grey(picture, what, about):
    accepted = "an array (h, w), or (h, w, 3 or 4), of at least 16 x 16 pixels"
    shape = array_of(picture, what, accepted, about).shape
    if not (len(shape) == 2 or len(shape) == 3 and shape[2] in (3, 4)) or min(shape[:2]) < 16:
        reject(about, f"{what}'s shape", shape, accepted)
    return grey_of(picture)


# --- OpenCV ----------------------------------------------------------------------------------------

def _sgbm(left, right, least, most, window):
    import cv2
    low, high = np.percentile(np.stack((left, right)), (0.5, 99.5))
    scale = 255.0 / max(high - low, 1e-30)
    bytes_of = [np.clip((each - low) * scale, 0, 255).astype(np.uint8) for each in (left, right)]
    count = -(-(most - least) // 16) * 16  # it takes multiples of 16
    # It gives nothing for the first columns, where the whole range would not fit: they get a border, which is cut off.
    border = max(least + count, 0)
    wide = [np.pad(each, ((0, 0), (border, 0)), mode="edge") for each in bytes_of]
    matcher = cv2.StereoSGBM_create(minDisparity=least, numDisparities=count, blockSize=window, P1=8 * window * window,
                                    P2=32 * window * window, disp12MaxDiff=1, uniquenessRatio=5, speckleWindowSize=50,
                                    speckleRange=2, mode=cv2.STEREO_SGBM_MODE_HH)
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)  # equal pictures give equal disparities
    try:
        found = matcher.compute(*wide)[:, border:].astype(np.float32) / 16
    finally:
        cv2.setNumThreads(threads)
    columns = np.arange(found.shape[1])
    found[(found < least) | (found > most) | (columns - found < 0) | (columns - found > len(columns) - 1)] = np.nan
    return found


# --- Ours ------------------------------------------------------------------------------------------

def _codes(picture):
    """The census of each pixel: a bit for each neighbour, set where it is darker than the pixel."""
    height, width = picture.shape
    wide = np.pad(picture, REACH, mode="edge")
    codes = np.zeros(picture.shape, np.uint64)
    for dy in range(2 * REACH + 1):
        for dx in range(2 * REACH + 1):
            if (dy, dx) != (REACH, REACH):
                codes = (codes << np.uint64(1)) | (wide[dy:dy + height, dx:dx + width] < picture)
    return codes


def _ones(codes):
    """The number of bits that are set."""
    one, two, four = (np.uint64(k) for k in (0x5555555555555555, 0x3333333333333333, 0x0F0F0F0F0F0F0F0F))
    codes = codes - ((codes >> np.uint64(1)) & one)
    codes = (codes & two) + ((codes >> np.uint64(2)) & two)
    codes = (codes + (codes >> np.uint64(4))) & four
    return ((codes * np.uint64(0x0101010101010101)) >> np.uint64(56)).astype(np.uint32)


def _summed(values, window):
    """Sums over blocks of window x window, the edges repeated."""
    wide = np.pad(values, window // 2, mode="edge")
    for axis in (0, 1):
        sums = np.cumsum(wide, axis=axis, dtype=np.uint32)
        zero = np.zeros_like(np.take(sums, [0], axis=axis))
        sums = np.concatenate((zero, sums), axis=axis)
        count = wide.shape[axis] - window + 1
        wide = np.take(sums, range(window, window + count), axis=axis) - np.take(sums, range(count), axis=axis)
    return wide


def _census(left, right, least, most, window):
    codes = _codes(left), _codes(right)
    height, width = left.shape
    out = np.empty((height, width), np.float32)
    for top in range(0, height, BAND):
        first, last = max(top - window // 2, 0), min(top + BAND + window // 2, height)
        rows = slice(top - first, min(top + BAND, height) - first)
        costs = np.full((most - least + 1, rows.stop - rows.start, width), WORST)
        for k in range(len(costs)):
            shift = least + k
            here = slice(max(shift, 0), min(width, width + shift))  # columns of the left picture
            if here.start < here.stop:
                there = slice(here.start - shift, here.stop - shift)
                bits = _ones(codes[0][first:last, here] ^ codes[1][first:last, there])
                costs[k][:, here] = _summed(bits, window)[rows]
        out[top:top + BAND] = _best(costs, least)
    return out


def _best(costs, least):
    """The disparity of least cost, where it is distinct and the right picture agrees."""
    count, rows, width = costs.shape
    row, column = np.ogrid[:rows, :width]
    best = costs.argmin(axis=0)
    lowest = costs[best, row, column]
    before, after = (costs[np.clip(best + step, 0, count - 1), row, column].astype(float) for step in (-1, 1))
    # Between steps: two lines of equal and opposite slopes through the three costs.
    with np.errstate(invalid="ignore", divide="ignore"):
        offset = 0.5 * (before - after) / (np.maximum(before, after) - lowest)
    inner = (best > 0) & (best < count - 1) & (before < WORST) & (after < WORST)
    found = (least + best + np.where(inner, np.nan_to_num(offset), 0.0)).astype(np.float32)
    others = np.ma.masked_array(costs, np.abs(np.arange(count)[:, None, None] - best) <= 1) if count > 3 else None
    good = lowest < WORST
    if others is not None:
        good &= others.min(axis=0).filled(WORST) >= UNIQUE * lowest
    # The same costs as the right picture sees them.
    seen = np.full_like(costs, WORST)
    for k in range(count):
        shift = least + k
        here = slice(max(shift, 0), min(width, width + shift))
        if here.start < here.stop:
            seen[k][:, here.start - shift:here.stop - shift] = costs[k][:, here]
    back = seen.argmin(axis=0)
    there = column - least - best
    inside = (there >= 0) & (there < width)
    good &= inside & (np.abs(back[row, np.clip(there, 0, width - 1)] - best) <= 1)
    found[~good] = np.nan
    return found
