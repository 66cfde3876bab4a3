"""Rotations as arrays of 3 × 3 matrices, for many poses at once."""
import numpy as np


def packed(values):
    """A copy (n,) of numbers, without gaps between them. Columns of tables become it before sin, cos, arctan, ...

    numpy 1.24 takes another way through these, which differs in the last bit, where the gaps behind a column's last
    number touch the memory of the result: the same script would give other numbers with other addresses."""
    return np.array(values, float, order="C")


def about_axis(axis, angle):
    """Rotation matrices (n, 3, 3) about one unit axis by angles (n,) [rad]."""
    x, y, z = axis
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = packed(angle)
    s, c = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.eye(3) + s * k + (1 - c) * (k @ k)


def from_rpy(roll, pitch, yaw):
    """URDF's fixed-axis roll, pitch, yaw [rad] as one 3 × 3 matrix: Rz(yaw) Ry(pitch) Rx(roll)."""
    one = lambda axis, a: about_axis(axis, np.array([a]))[0]
    return one((0, 0, 1), yaw) @ one((0, 1, 0), pitch) @ one((1, 0, 0), roll)


def to_quaternion(r):
    """Unit quaternion (w, x, y, z), w >= 0, of a 3 × 3 rotation matrix (Shepperd's method)."""
    r = np.asarray(r, float)
    trace = np.trace(r)
    choice = int(np.argmax([trace, *np.diag(r)]))
    if choice == 0:
        q = np.array([1 + trace, r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    else:
        i = choice - 1
        j, k = (i + 1) % 3, (i + 2) % 3
        q = np.empty(4)
        q[0] = r[k, j] - r[j, k]
        q[1 + i] = 1 + r[i, i] - r[j, j] - r[k, k]
        q[1 + j] = r[j, i] + r[i, j]
        q[1 + k] = r[k, i] + r[i, k]
    q /= np.linalg.norm(q)
    return -q if q[0] < 0 else q
