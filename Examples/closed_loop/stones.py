"""Rocks of the closed loop: meshes, whose triangles also judge contacts."""
import numpy as np

SOIL = np.array((0.55, 0.38, 0.27))  # sRGB


class Stone:
    """A rock: points (n, 3) in the scene's root [m], triangles (m, 3), and a circle around it seen from above."""

    def __init__(self, points, triangles, colors):
        self.points, self.triangles, self.colors = points, triangles, colors
        self.middle = 0.5 * (points[:, :2].min(axis=0) + points[:, :2].max(axis=0))
        self.radius = float(np.linalg.norm(points[:, :2] - self.middle, axis=1).max())

    @property
    def corners(self):
        """(m, 3, 3): the corners of its triangles."""
        return self.points[self.triangles]


def scatter(start, goal, count, rng, width=11.0, gap=4.6, clear=2.5):
    """Places and sizes (n, 3): x, y, radius [m] of rocks about the straight way: the first two lie on it. There are fewer than
    `count` where there is no room for more.

    gap: the least free space between two rocks [m]; clear: around start and goal."""
    start, goal = np.asarray(start, float), np.asarray(goal, float)
    length = np.linalg.norm(goal - start)
    along = (goal - start) / length
    across = np.array((-along[1], along[0]))
    placed = []
    for attempt in range(4000):
        if len(placed) == count:
            break
        radius = rng.uniform(0.3, 0.6)
        if len(placed) < 2:
            at = start + along * length * (0.38, 0.68)[len(placed)] + across * rng.uniform(-0.3, 0.3)
        else:
            at = start + along * rng.uniform(0, length) + across * rng.uniform(-0.5, 0.5) * width
        if min(np.linalg.norm(at - start), np.linalg.norm(at - goal)) < clear + radius:
            continue
        if all(np.linalg.norm(at - other[:2]) > gap + radius + other[2] for other in placed):
            placed.append((*at, radius))
    return np.array(placed)


def make(x, y, ground, radius, rng):
    """A Stone about (x, y) that stands on height `ground`, and reaches some way below."""
    points, triangles = _sphere(3)
    waves = rng.normal(size=(6, 3)) * 2.5
    phases = rng.uniform(0, 2 * np.pi, 6)
    bumps = 1 + 0.06 * np.sin(points @ waves.T + phases).sum(axis=1, keepdims=True) / 1.5
    points = points * bumps * radius * np.array((1.0, rng.uniform(0.75, 1.0), rng.uniform(0.9, 1.2)))
    shade = 0.75 + 0.35 * rng.random(len(points))
    colors = np.clip(SOIL * 0.9 * shade[:, None], 0, 1)
    return Stone(points + (x, y, ground + 0.25 * radius), triangles, colors)


def _sphere(times):
    """An icosahedron, divided: points on the unit sphere and triangles, counter-clockwise from outside."""
    g = (1 + 5 ** 0.5) / 2
    points = np.array([(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g),
                       (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]) / np.hypot(1, g)
    triangles = np.array([(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
                          (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11),
                          (6, 2, 10), (8, 6, 7), (9, 8, 1)])
    for _ in range(times):
        edges = np.sort(np.concatenate((triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]])), axis=1)
        unique, back = np.unique(edges, axis=0, return_inverse=True)
        middles = points[unique].sum(axis=1)
        middles /= np.linalg.norm(middles, axis=1, keepdims=True)
        ab, bc, ca = len(points) + back.reshape(3, -1)
        a, b, c = triangles.T
        points = np.vstack((points, middles))
        triangles = np.concatenate([np.column_stack(each) for each in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return points, triangles
