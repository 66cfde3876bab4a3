"""Poses, rotations, and what may be given for them."""
import numpy as np

from dspace._core.fields import array_of, number, numbers, reject
from dspace.errors import InvalidArgument, WrongType

# As FrameRules.h has them.
MAXIMUM_COORDINATE = 1e18
MINIMUM_SCALE, MAXIMUM_SCALE = 1e-12, 1e12
UNIT_TOLERANCE = 1e-6


def vector(value, what="a vector"):
    """Three finite or other numbers as an array; the command checks the values."""
    return numbers(value, 3, what)


def quaternion_of_axis(axis, angle_deg):
    """The rotation by `angle_deg` about `axis` ("x", "y", "z" or 3 numbers)."""
    if isinstance(axis, str):
        axes = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
        if axis not in axes:
            reject(None, "the axis", axis, "x, y, z or 3 numbers")
        axis = axes[axis]
    axis = vector(axis, "the axis")
    length = np.linalg.norm(axis)
    if not 0 < length < np.inf:
        reject(None, "the axis", axis, "any direction but zero, of finite numbers")
    angle_deg = number(angle_deg, "the angle")
    if not np.isfinite(angle_deg):
        reject(None, "the angle", angle_deg, "a finite number of degrees")
    half = np.radians(angle_deg) / 2
    return np.concatenate(([np.cos(half)], np.sin(half) * axis / length))


def multiply(a, b):
    """Quaternion product: first b, then a."""
    w, v = a[0], np.asarray(a[1:])
    x, u = b[0], np.asarray(b[1:])
    return np.concatenate(([w * x - v @ u], w * u + x * v + np.cross(v, u)))


def matrix_of_quaternion(q):
    """3 x 3 rotation matrix of a unit quaternion."""
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def quaternion_of_matrix(matrix):
    """The unit quaternion (w >= 0) of a rotation matrix."""
    m = array_of(matrix, "the matrix", "3 x 3, a rotation")
    if m.shape != (3, 3) or not np.allclose(m @ m.T, np.eye(3), atol=1e-6) or np.linalg.det(m) < 0:
        raise InvalidArgument(f"the matrix\n{m}\nis no rotation; accepted: 3 x 3, orthonormal, det +1")
    # The largest component first: it is never small.
    squares = np.array([1 + m[0, 0] + m[1, 1] + m[2, 2], 1 + m[0, 0] - m[1, 1] - m[2, 2],
                        1 - m[0, 0] + m[1, 1] - m[2, 2], 1 - m[0, 0] - m[1, 1] + m[2, 2]])
    k = int(np.argmax(squares))
    wx, wy, wz = m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]
    xy, xz, yz = m[0, 1] + m[1, 0], m[0, 2] + m[2, 0], m[1, 2] + m[2, 1]
    q = np.array([[squares[0], wx, wy, wz], [wx, squares[1], xy, xz], [wy, xy, squares[2], yz],
                  [wz, xz, yz, squares[3]]][k])
    q /= np.linalg.norm(q)
    return -q if q[0] < 0 else q


_ROW = "8 numbers px py pz qw qx qy qz scale, or 7 without the scale"


class Pose:
    """X_WG, the pose of G in W: p_W = position + rotation (scale p_G). Does not change.

    position [m, within 1e18]; quaternion (w, x, y, z), unit within 1e-6; scale 1e-12 to 1e12, uniform.
    """

    __slots__ = ("position", "quaternion", "scale")

    def __init__(self, position=(0, 0, 0), quaternion=(1, 0, 0, 0), scale=1.0):
        given = position, quaternion
        position = vector(position, "the position").copy()
        quaternion = numbers(quaternion, 4, "the quaternion", None, "4 numbers w, x, y, z").copy()
        scale = number(scale, "the scale")
        if not (np.abs(position) <= MAXIMUM_COORDINATE).all():  # false for NaN, as all of these
            reject(None, "the position", given[0], "3 finite numbers within 1e18 m")
        if not abs(np.linalg.norm(quaternion) - 1) <= UNIT_TOLERANCE:
            reject(None, "the quaternion", given[1], "w, x, y, z of length 1 within 1e-6; its length "
                   f"is {np.linalg.norm(quaternion):.9g}")
        if not MINIMUM_SCALE <= scale <= MAXIMUM_SCALE:
            reject(None, "the scale", scale, "from 1e-12 to 1e12")
        self._hold(position, quaternion, scale)

    def _hold(self, position, quaternion, scale):
        position.setflags(write=False)
        quaternion.setflags(write=False)
        object.__setattr__(self, "position", position)
        object.__setattr__(self, "quaternion", quaternion)
        object.__setattr__(self, "scale", float(scale))

    def __setattr__(self, name, value):
        raise AttributeError("a Pose does not change; make a new one")

    @classmethod
    def from_row(cls, row):
        """From px py pz qw qx qy qz scale, or without the scale, which then is 1."""
        array = array_of(row, "the pose", _ROW)
        if array.shape not in ((7,), (8,)):
            reject(None, "the pose", row, _ROW, WrongType)
        return cls(array[:3], array[3:7], array[7] if len(array) == 8 else 1.0)

    @classmethod
    def _computed(cls, position, quaternion, scale):
        # What is computed from good poses may leave the range of those that are set.
        pose = object.__new__(cls)
        pose._hold(np.array(position, dtype=float), np.array(quaternion, dtype=float), scale)
        return pose

    @classmethod
    def _of_row(cls, row):
        return cls._computed(row[:3], row[3:7], row[7])

    @classmethod
    def from_matrix(cls, matrix):
        """From a 4 x 4 matrix whose upper left part is a rotation times a scale."""
        accepted = "4 x 4, a rotation times a scale and a position over 0, 0, 0, 1"
        m = array_of(matrix, "the matrix", accepted)
        if m.shape != (4, 4):
            raise WrongType(f"the matrix has shape {m.shape}; accepted: {accepted}")
        if not np.isfinite(m).all():
            raise InvalidArgument(f"the matrix\n{m}\nis not finite; accepted: {accepted}")
        scale = np.cbrt(np.linalg.det(m[:3, :3]))
        if (not scale > 0 or not np.array_equal(m[3], (0, 0, 0, 1))
                or not np.allclose(m[:3, :3] @ m[:3, :3].T / scale**2, np.eye(3), atol=1e-6)):
            raise InvalidArgument(f"the matrix\n{m}\nis no pose; accepted: {accepted}")
        return cls(m[:3, 3], quaternion_of_matrix(m[:3, :3] / scale), scale)

    @classmethod
    def from_rpy_deg(cls, roll, pitch, yaw, position=(0, 0, 0), scale=1.0):
        """Rotations about the fixed X, then Y, then Z axis, in degrees."""
        q = multiply(quaternion_of_axis("z", yaw), multiply(quaternion_of_axis("y", pitch),
                                                            quaternion_of_axis("x", roll)))
        return cls(position, q, scale)

    @classmethod
    def from_axis_deg(cls, axis, angle, position=(0, 0, 0), scale=1.0):
        """A rotation by `angle` degrees about `axis` ("x", "y", "z" or a vector)."""
        return cls(position, quaternion_of_axis(axis, angle), scale)

    @property
    def row(self):
        """px py pz qw qx qy qz scale."""
        return np.concatenate((self.position, self.quaternion, (self.scale,)))

    @property
    def rotation(self):
        """3 x 3 rotation matrix."""
        return matrix_of_quaternion(self.quaternion)

    @property
    def matrix(self):
        """4 x 4 matrix."""
        m = np.eye(4)
        m[:3, :3] = self.scale * self.rotation
        m[:3, 3] = self.position
        return m

    @property
    def rpy_deg(self):
        """Roll, pitch, yaw in degrees, as from_rpy_deg takes them."""
        m = self.rotation
        return np.degrees([np.arctan2(m[2, 1], m[2, 2]),
                           np.arctan2(-m[2, 0], np.hypot(m[0, 0], m[1, 0])),
                           np.arctan2(m[1, 0], m[0, 0])])

    def apply(self, points):
        """p_W of points p_G, an array (..., 3)."""
        return self.position + self.scale * np.asarray(points, dtype=float) @ self.rotation.T

    def inverse(self):
        """X_GW."""
        w, x, y, z = self.quaternion
        q = np.array([w, -x, -y, -z])
        return Pose._computed(matrix_of_quaternion(q) @ -self.position / self.scale, q,
                              1 / self.scale)

    def __matmul__(self, other):
        """X_WH = X_WG @ X_GH."""
        q = multiply(self.quaternion, other.quaternion)
        return Pose._computed(self.apply(other.position), q / np.linalg.norm(q),
                              self.scale * other.scale)

    def __eq__(self, other):
        return isinstance(other, Pose) and np.array_equal(self.row, other.row)

    def __hash__(self):
        return hash(self.row.tobytes())

    def __repr__(self):
        numbers = ", ".join(f"{v:.6g}" for v in self.position)
        turns = ", ".join(f"{v:.6g}" for v in self.quaternion)
        scale = "" if self.scale == 1 else f", scale={self.scale:.6g}"
        return f"Pose(position=({numbers}), quaternion=({turns}){scale})"


def to_pose(position=None, quaternion=None, scale=None, pose=None):
    """One Pose from what a caller gave; `pose` may be a Pose, a 4 x 4 matrix or a row of 8 or 7."""
    if pose is None:
        return Pose((0, 0, 0) if position is None else position,
                    (1, 0, 0, 0) if quaternion is None else quaternion,
                    1.0 if scale is None else scale)
    if position is not None or quaternion is not None or scale is not None:
        raise InvalidArgument("both pose and its parts are given; accepted: one or the other")
    if isinstance(pose, Pose):
        return pose
    accepted = f"a dspace.Pose, a 4 x 4 matrix, or {_ROW}"
    array = array_of(pose, "the pose", accepted)
    if array.shape == (4, 4):
        return Pose.from_matrix(array)
    if array.shape not in ((7,), (8,)):
        reject(None, "the pose", pose, accepted, WrongType)
    return Pose.from_row(array)
