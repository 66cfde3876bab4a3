"""What the rover is: its bodies, joints and shapes, all worked out from a few sizes.

Axes: X forward, Y left, Z up; metres, radians. The kinematics and the scene both read this and nothing
else, so that a size is changed in one place.
"""
from dataclasses import dataclass, field

import numpy as np

ALUMINIUM, RUBBER, GOLD, DARK = (0.78, 0.79, 0.8), (0.16, 0.16, 0.17), (0.85, 0.65, 0.25), (0.25, 0.27, 0.3)


@dataclass(frozen=True)
class Shape:
    """kind: "box" (size: 3 lengths), "cylinder" (size: radius and height, along Y) or "tube" (from the
    body's origin to `position`, size: radius). position: of its middle in the body."""
    kind: str
    size: tuple
    position: tuple = (0.0, 0.0, 0.0)
    color: tuple = ALUMINIUM


@dataclass(frozen=True)
class Body:
    """A body on its parent, turning about `axis` through `position` (in the parent) by one joint angle."""
    name: str
    parent: str
    position: tuple = (0.0, 0.0, 0.0)
    axis: tuple = (0.0, 1.0, 0.0)
    joint: str = "fixed"  # or "rocker", "bogie", "steering", "wheel"
    sign: float = 1.0  # of the joint's coordinate: the differential turns the right rocker against the left one
    shapes: tuple = ()


@dataclass(frozen=True)
class RoverModel:
    """Six wheels on rockers and bogies; the four at the corners steer. Sizes in metres.

    The chassis' origin is over the middle wheels' axle, midway between the sides, at the rockers' height."""
    wheelbase: float = 1.1  # front to rear axle; the middle wheels are halfway
    track: float = 0.95  # left to right wheels' middles
    wheel_radius: float = 0.16
    wheel_width: float = 0.14
    rocker_height: float = 0.30  # of its pivot above the axles
    bodies: tuple = field(init=False)

    def __post_init__(self):
        for name in ("wheelbase", "track", "wheel_radius", "wheel_width", "rocker_height"):
            if not 0.01 <= getattr(self, name) <= 10:
                raise ValueError(f"{name} is {getattr(self, name)!r} m; accepted: 0.01 to 10 m")
        object.__setattr__(self, "bodies", tuple(self._bodies()))

    def _bodies(self):
        half, side, drop = 0.5 * self.wheelbase, 0.5 * self.track, self.rocker_height
        arm = side - 0.7 * self.wheel_width  # the arms run beside the wheels
        out = side - arm
        length, width = 0.8 * self.wheelbase, 2 * arm - 0.12
        yield Body("rover", "", shapes=(
            Shape("box", (length, width, 0.26), (0.0, 0.0, 0.18), GOLD),
            Shape("box", (length, width + 0.06, 0.02), (0.0, 0.0, 0.32), DARK),
            Shape("cylinder", (0.03, 2 * arm))))
        yield Body("mast", "rover", (0.35 * length, 0.0, 0.31), shapes=(
            Shape("tube", (0.025,), (0.0, 0.0, 0.5)), Shape("box", (0.1, 0.26, 0.09), (0.0, 0.0, 0.54))))
        for name, y in (("left", 1.0), ("right", -1.0)):
            bogie_x, bogie_z = -0.5 * half, -0.45 * drop
            steer = lambda x, z: (Shape("tube", (0.022,), (0.0, 0.0, z)),)
            yield Body(f"rocker_{name}", "rover", (0.0, y * arm, 0.0), joint="rocker", sign=y, shapes=(
                Shape("tube", (0.03,), (half, 0.0, -0.1)), Shape("tube", (0.03,), (bogie_x, 0.0, bogie_z)),
                Shape("box", (0.05, out, 0.05), (half, 0.5 * y * out, -0.1))))
            yield Body(f"steering_front_{name}", f"rocker_{name}", (half, y * out, -0.1), (0.0, 0.0, 1.0),
                       "steering", shapes=steer(half, -(drop - 0.1)))
            yield self._wheel(f"wheel_front_{name}", f"steering_front_{name}", (0.0, 0.0, -(drop - 0.1)))
            yield Body(f"bogie_{name}", f"rocker_{name}", (bogie_x, 0.0, bogie_z), joint="bogie", shapes=(
                Shape("tube", (0.026,), (-bogie_x, 0.0, -(drop + bogie_z))),
                Shape("tube", (0.026,), (-half - bogie_x, 0.0, 0.0)),
                Shape("box", (0.05, out, 0.05), (-bogie_x, 0.5 * y * out, -(drop + bogie_z))),
                Shape("box", (0.05, out, 0.05), (-half - bogie_x, 0.5 * y * out, 0.0))))
            yield self._wheel(f"wheel_middle_{name}", f"bogie_{name}", (-bogie_x, y * out, -(drop + bogie_z)))
            yield Body(f"steering_rear_{name}", f"bogie_{name}", (-half - bogie_x, y * out, 0.0),
                       (0.0, 0.0, 1.0), "steering", shapes=steer(-half, -(drop + bogie_z)))
            yield self._wheel(f"wheel_rear_{name}", f"steering_rear_{name}", (0.0, 0.0, -(drop + bogie_z)))

    def _wheel(self, name, parent, position):
        r, w = self.wheel_radius, self.wheel_width
        return Body(name, parent, position, joint="wheel", shapes=(
            Shape("cylinder", (r, w), color=RUBBER), Shape("box", (1.7 * r, 1.02 * w, 0.25 * r), color=ALUMINIUM)))

    def number(self, name):
        return [body.name for body in self.bodies].index(name)

    @property
    def wheels(self):
        """Numbers of the wheels' bodies: front, middle and rear, left and then right."""
        return np.array([k for k, body in enumerate(self.bodies) if body.joint == "wheel"])
