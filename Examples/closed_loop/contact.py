"""Whether a box touches triangles, exactly: by separating axes (Akenine-Möller, J. Graphics Tools 6, 2001)."""
import numpy as np


def touches(corners, middle, rotation, half):
    """Whether each triangle (n, 3, 3) shares a point with a box.

    middle (3) [m]; rotation: 3 x 3, its columns the box's axes; half: half its sides (3) [m]."""
    half = np.asarray(half, float)
    v = (np.asarray(corners, float) - middle) @ rotation  # in the box's axes
    edges = np.roll(v, -1, axis=1) - v
    apart = (v.min(axis=1) > half).any(axis=1) | (v.max(axis=1) < -half).any(axis=1)  # the box's faces
    normal = np.cross(edges[:, 0], edges[:, 1])
    reach = np.abs(normal) @ half
    apart |= np.abs(np.einsum("ni,ni->n", normal, v[:, 0])) > reach  # the triangle's plane
    for unit in np.eye(3):
        for k in range(3):
            axis = np.cross(unit, edges[:, k])
            along = np.einsum("nci,ni->nc", v, axis)
            reach = np.abs(axis) @ half
            apart |= (along.min(axis=1) > reach) | (along.max(axis=1) < -reach)
    return ~apart


class Body:
    """The box that holds a rover, in its own axes: X forward, Y left, Z up, its origin on the ground."""

    def __init__(self, low=(-1.05, -0.8, 0.0), high=(1.05, 0.8, 1.2)):
        self.low, self.high = np.asarray(low, float), np.asarray(high, float)

    @property
    def radius(self):
        """Of the circle about the origin that holds it, seen from above [m]."""
        return float(np.hypot(*np.maximum(np.abs(self.low), np.abs(self.high))[:2]))

    def touched(self, position, rotation, stones):
        """The stones that it touches at a pose."""
        middle = position + rotation @ (0.5 * (self.low + self.high))
        half = 0.5 * (self.high - self.low)
        near = [stone for stone in stones if np.linalg.norm(stone.middle - middle[:2]) < stone.radius + np.linalg.norm(half)]
        return [stone for stone in near if touches(stone.corners, middle, rotation, half).any()]
