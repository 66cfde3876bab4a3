"""A map of hazards from points that a rover's cameras measure."""
import numpy as np

STEP = 0.2  # [m]: a difference in height within 3 x 3 cells that no wheel climbs
LEAST = 3  # points in a cell


class HazardMap:
    """Square cells over the ground, each with the evidence for a hazard. low, high: corners (x, y) [m]; cell: a side [m]."""

    def __init__(self, low, high, cell=0.15):
        self.low, self.cell = np.asarray(low, float), cell
        self.shape = tuple(np.ceil((np.asarray(high) - self.low) / cell).astype(int))  # columns along x, rows along y
        self.evidence = np.zeros(self.shape, np.float32)  # above 0: a hazard
        self.seen = np.zeros(self.shape, bool)

    def cells(self, xy):
        return np.floor((np.asarray(xy) - self.low) / self.cell).astype(int)

    def middles(self):
        """(columns, rows, 2): the middles of all cells."""
        return self.low + self.cell * (np.stack(np.meshgrid(*map(np.arange, self.shape), indexing="ij"), axis=-1) + 0.5)

    def add(self, points, eye, reach=8.0):
        """Points (n, 3) [m] that were seen from `eye` (3), as far as `reach` [m]. Near ones count more."""
        points = points.reshape(-1, 3)
        points = points[np.isfinite(points).all(axis=1)]
        distance = np.linalg.norm(points - eye, axis=1)
        points = points[distance < reach]
        at = self.cells(points[:, :2])
        inside = ((at >= 0) & (at < self.shape)).all(axis=1)
        points, at = points[inside], at[inside]
        flat = np.ravel_multi_index(tuple(at.T), self.shape)
        count = np.bincount(flat, minlength=np.prod(self.shape)).reshape(self.shape)
        highest = np.full(self.shape, -np.inf)
        lowest = np.full(self.shape, np.inf)
        np.maximum.at(highest.ravel(), flat, points[:, 2])
        np.minimum.at(lowest.ravel(), flat, points[:, 2])
        known = count >= LEAST
        highest[~known], lowest[~known] = -np.inf, np.inf
        step = _around(highest, np.maximum) - _around(lowest, np.minimum)
        near = np.linalg.norm(self.middles() - np.asarray(eye)[:2], axis=-1)
        weight = np.clip(2.0 - near / 4.0, 0.25, 1.5)
        change = np.where(step > STEP, 1.0, -0.5) * weight
        self.evidence[known] = np.clip(self.evidence[known] + change[known], -3.0, 6.0)
        self.seen |= known

    def clearance(self):
        """Metres (columns, rows) from each cell to the nearest hazard; infinite without one."""
        found = np.argwhere(self.evidence > 0)
        out = np.full(self.shape, np.inf)
        rows = np.arange(self.shape[1])
        for column in range(self.shape[0]):
            if len(found):
                squares = (found[:, 0] - column) ** 2 + (found[:, 1] - rows[:, None]) ** 2
                out[column] = self.cell * np.sqrt(squares.min(axis=1))
        return out


def _around(values, pick):
    """The greatest or the least of 3 x 3 cells."""
    wide = np.pad(values, 1, mode="edge")
    out = values
    for dx in range(3):
        for dy in range(3):
            out = pick(out, wide[dx:dx + values.shape[0], dy:dy + values.shape[1]])
    return out
