"""A vehicle's camera mast: the joints that pan and tilt its head, and their angles for straight ahead."""
import re
from dataclasses import dataclass

import numpy as np

from .rotations import about_axis

_MAST = re.compile(r"mast|rsm|pancam|camera_head|(^|_)pan(_|$)", re.I)


@dataclass
class Mast:
    """Pan and tilt joints; at (pan_zero, tilt_zero) [deg] the head's X axis looks straight ahead and
    level. Signs are +1 where positive angles turn the head to the left, and down."""
    pan: object
    tilt: object
    pan_zero: float
    tilt_zero: float
    pan_sign: float
    tilt_sign: float

    def look(self, left_deg, down_deg):
        """Joint name -> degrees, kept within the joints' limits."""
        pan = self.pan_zero + self.pan_sign * left_deg
        tilt = self.tilt_zero + self.tilt_sign * down_deg
        return {self.pan.name: float(np.clip(pan, self.pan.lower, self.pan.upper)),
                self.tilt.name: float(np.clip(tilt, self.tilt.lower, self.tilt.upper))}


def find_mast(description, X_MR):
    """The Mast, or None. The pan joint turns about the vertical and is named like a mast; the tilt
    joint comes next and turns about a level axis; the head's link has X along the view."""
    for pan in description.joints:
        named = _MAST.search(pan.name) or _MAST.search(pan.child)
        if pan.kind not in ("revolute", "continuous") or not named:
            continue
        r0 = X_MR.T @ _rotation(description, pan.parent) @ pan.rotation
        if abs((r0 @ pan.axis)[2]) < 0.9:
            continue
        for tilt in description.joints:
            if tilt.kind not in ("revolute", "continuous") or tilt.parent != pan.child:
                continue
            across = pan.axis @ tilt.rotation @ tilt.axis
            if abs(across) > 0.1:
                continue
            return _aim(pan, tilt, r0)
    return None


def _rotation(description, link):
    r = np.eye(3)
    for joint in description.chain(link):
        r = r @ joint.rotation
    return r


def _aim(pan, tilt, r0):
    """Finds straight ahead by halving a search over both angles."""
    def view(a, b):
        first = r0 @ about_axis(pan.axis, np.radians(a))
        return np.einsum("nij,jk,nk->ni", first, tilt.rotation,
                         about_axis(tilt.axis, np.radians(b))[:, :, 0])

    best, span = np.zeros(2), 180.0
    while span > 1e-7:
        g = np.linspace(-span, span, 25)
        a, b = (v.ravel() for v in np.meshgrid(best[0] + g, best[1] + g))
        # Both ways over the top look ahead: prefer the smaller tilt, and angles within the limits.
        cost = np.linalg.norm(view(a, b) - [1.0, 0, 0], axis=1) + 1e-9 * np.abs(b)
        for joint, angle in ((pan, a), (tilt, b)):
            cost = cost + 10.0 * ((angle < joint.lower - span / 12) | (angle > joint.upper + span / 12))
        k = int(np.argmin(cost))
        best, span = np.array([a[k], b[k]]), span / 6
    a, b = np.array([best[0], best[0] + 1.0, best[0]]), np.array([best[1], best[1], best[1] + 1.0])
    v = view(a, b)
    return Mast(pan, tilt, float(best[0]), float(best[1]), float(np.sign(v[1, 1])), float(-np.sign(v[2, 2])))
