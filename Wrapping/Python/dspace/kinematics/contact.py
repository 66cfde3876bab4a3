"""Rests a suspension's wheels on terrain: forward kinematics, wheel contact, Newton's method.

All arrays run over n poses at once. A wheel is a true disc of radius r and width w: its clearance is
the smallest height of its rim's surface above the terrain below, and zero when it rests.
"""
from dataclasses import dataclass

import numpy as np

from .rotations import about_axis, packed


@dataclass
class Rest:
    """n solved poses, world axes."""
    rotation: np.ndarray  # (n, 3, 3) chassis (rover axes) to world
    position: np.ndarray  # (n, 3) rover axes' origin
    free: np.ndarray  # (n, k) free coordinates [rad]
    roll: np.ndarray  # (n,) [rad]
    pitch: np.ndarray
    frames: list  # per node (R (n, 3, 3), p (n, 3)) in the chassis
    centres: np.ndarray  # (n, wheels, 3)
    contacts: np.ndarray  # (n, wheels, 3) lowest point of each rim above the terrain
    clearance: np.ndarray  # (n, wheels) [m], 0 when resting


def forward(suspension, angles):
    """Node frames in the chassis, with axes parallel to the chassis' at position zero and origin at
    the node's own: [(R (n, 3, 3), p (n, 3))] for angles (n, nodes) [rad]."""
    frames = []
    n = len(angles)
    for k, node in enumerate(suspension.nodes):
        turned = about_axis(node.axis, angles[:, k])
        if node.parent < 0:
            frames.append((turned, np.broadcast_to(node.origin, (n, 3))))
        else:
            r, p = frames[node.parent]
            offset = node.origin - suspension.nodes[node.parent].origin
            frames.append((r @ turned, p + r @ offset))
    return frames


def chassis_rotation(heading, roll, pitch):
    """(n, 3, 3): Rz(heading) Ry(pitch) Rx(roll) [rad]."""
    one = lambda axis, a: about_axis(axis, np.asarray(a, float))
    return one((0, 0, 1), heading) @ one((0, 1, 0), pitch) @ one((1, 0, 0), roll)


def _rim_points(centre, up, ahead, axle, radius, phi, side):
    """Points of the rim at angles phi from the lowest one and offsets `side` along the axle, each
    (n, m): (n, m, 3)."""
    return (centre[:, None] + (radius * np.sin(phi))[..., None] * ahead[:, None]
            - (radius * np.cos(phi))[..., None] * up[:, None] + side[..., None] * axle[:, None])


# Search of the rim: a coarse sweep, then ever finer ones about the best point. The last step of
# 0.05 degrees leaves an error of r (1 - cos 0.025 deg) < 1e-7 r on smooth ground.
_SIDES = np.array([0.0, -0.25, 0.25, -0.5, 0.5])
_COARSE = np.radians(np.array(sorted(range(-75, 76, 5), key=abs), float))
_FINE = [(np.radians(1.0) * np.array(sorted(range(-5, 6), key=abs)), 0.5),
         (np.radians(0.25) * np.array(sorted(range(-4, 5), key=abs)), 0.25),
         (np.radians(0.05) * np.array(sorted(range(-5, 6), key=abs)), 0.125)]
_BLOCK = 4096  # wheels searched at once: a sweep's points stay within some tens of megabytes


def wheel_contact(heights, centre, axle, radius, width):
    """Lowest clearance of rims with given centres and unit axles (n, 3), radii and widths (n,):
    (clearance (n,), point (n, 3)). If many points are equally low, as on level ground, the result is the middle
    one."""
    n = len(centre)
    if n > _BLOCK:
        parts = [wheel_contact(heights, *(a[k:k + _BLOCK] for a in (centre, axle, radius, width)))
                 for k in range(0, n, _BLOCK)]
        return tuple(np.concatenate(a) for a in zip(*parts))
    radius, width = radius[:, None], width[:, None]
    up = np.array([0, 0, 1.0]) - axle[:, 2:] * axle
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    ahead = np.cross(axle, up)
    phi0, side0 = np.zeros((n, 1)), np.zeros((n, 1))
    best_gap, best_point = None, None
    for dphi, scale in [(_COARSE, 1.0)] + _FINE:
        grid_phi, grid_side = (g.ravel() for g in np.meshgrid(dphi, _SIDES * scale, indexing="ij"))
        phi = phi0 + grid_phi
        side = np.clip(side0 + width * grid_side, -width / 2, width / 2)
        p = _rim_points(centre, up, ahead, axle, radius, phi, side)
        z = heights(p[..., :2].reshape(-1, 2)).reshape(n, -1)
        gap = p[..., 2] - z
        # A tie (and rounding) goes to the middle: 1e-9 m is far below any tolerance.
        k = np.argmin(gap + 1e-9 * (np.abs(side) / width + np.abs(phi)), axis=1)
        row = np.arange(n)
        phi0, side0 = phi[row, k][:, None], side[row, k][:, None]
        best_gap, best_point = gap[row, k], p[row, k]
    return best_gap, best_point


class _Problem:
    """Clearances and their derivatives for given unknowns: reference height, roll, pitch, free."""

    def __init__(self, suspension, terrain, xy, heading, steering):
        self.s, (self.heights, self.gradients) = suspension, terrain
        self.xy, self.heading, self.steering = xy, heading, steering

    def angles(self, free, rows):
        """(n, nodes) joint angles [rad]; spin stays zero, since it moves no rim."""
        a = np.zeros((len(free), len(self.s.nodes)))
        for k, node in enumerate(self.s.nodes):
            if node.role == "passive":
                a[:, k] = free @ node.coefficients
            elif node.role == "steering":
                a[:, k] = self.steering[rows, k]
        return a

    def evaluate(self, v, rows, derivatives=True):
        """Rest at unknowns v (n, 3 + k) of the poses `rows`, and the Jacobian (n, wheels, 3 + k)."""
        s = self.s
        r = chassis_rotation(self.heading[rows], v[:, 1], v[:, 2])
        reference = np.column_stack([self.xy[rows], v[:, 0]])
        position = reference - r @ s.reference
        frames = forward(s, self.angles(v[:, 3:], rows))
        n, m = len(v), len(s.wheels)
        centres = np.empty((n, m, 3))
        jacobian = np.zeros((n, m, v.shape[1])) if derivatives else None
        pitch_axis = chassis_rotation(self.heading[rows], 0 * v[:, 1], 0 * v[:, 1])[:, :, 1]
        axles = np.empty((n, m, 3))
        for w, wheel in enumerate(s.wheels):
            rw, pw = frames[wheel.spin]
            centres[:, w] = position + np.einsum("nij,nj->ni", r, pw)
            left = s.nodes[wheel.spin].axis * np.sign(s.nodes[wheel.spin].axis[1])
            axles[:, w] = np.einsum("nij,njk,k->ni", r, rw, left)
        size = np.tile([(wheel.radius, wheel.width) for wheel in s.wheels], (n, 1))
        flat_gap, flat_point = wheel_contact(self.heights, centres.reshape(-1, 3), axles.reshape(-1, 3),
                                             size[:, 0], size[:, 1])
        gap, contacts = flat_gap.reshape(n, m), flat_point.reshape(n, m, 3)
        if derivatives:
            # By the envelope theorem the lowest point moves as if fixed on the wheel's carrier.
            slope = np.asarray(self.gradients(flat_point[:, :2]), float).reshape(n, m, 2)
            normal = np.concatenate([-slope, np.ones((n, m, 1))], axis=2)
            arm = contacts - reference[:, None]
            jacobian[:, :, 0] = 1.0
            for column, axis in ((1, r[:, :, 0]), (2, pitch_axis)):
                jacobian[:, :, column] = np.einsum("nmi,nmi->nm", normal, np.cross(axis[:, None], arm))
            self._passive_columns(jacobian, normal, contacts, r, position, frames)
        rest = Rest(r, position, v[:, 3:], v[:, 1], v[:, 2], frames, centres, contacts, gap)
        return rest, jacobian

    def _passive_columns(self, jacobian, normal, contacts, r, position, frames):
        """Adds the turns of every passive node that carries a wheel."""
        nodes = self.s.nodes
        for k, node in enumerate(nodes):
            if node.role != "passive":
                continue
            carried = [w for w, wheel in enumerate(self.s.wheels) if k in self._ancestors(wheel.carrier)]
            if not carried:
                continue
            rk, pk = frames[k]
            origin = position + np.einsum("nij,nj->ni", r, pk)
            axis = np.einsum("nij,njk,k->ni", r, rk, node.axis)
            swing = np.cross(axis[:, None], contacts[:, carried] - origin[:, None])
            rate = np.einsum("nmi,nmi->nm", normal[:, carried], swing)
            jacobian[:, carried, 3:] += rate[..., None] * node.coefficients

    def _ancestors(self, node):
        out = []
        while node >= 0:
            out.append(node)
            node = self.s.nodes[node].parent
        return out


def rest_on(suspension, terrain, xy, heading, steering, tolerance=1e-6, iterations=40):
    """Solves n poses: reference point at xy (n, 2) [m], heading (n,) [rad], steering angles (n, nodes)
    [rad] in the nodes' own senses. Returns a Rest whose clearance tells how well each wheel rests.

    Newton's method with step halving, since the clearance has kinks where contact jumps from one
    facet or rim edge to another; the best state found is returned."""
    xy, heading = np.asarray(xy, float), np.asarray(heading, float)
    problem = _Problem(suspension, terrain, xy, heading, steering)
    n, unknowns = len(xy), 3 + len(suspension.free)
    everything = np.arange(n)
    v = np.zeros((n, unknowns))
    v[:, :3] = _plane_fit(suspension, terrain[0], xy, heading)
    best_v, best = v.copy(), np.full(n, np.inf)
    active, base, step, alpha = everything, v.copy(), np.zeros_like(v), np.ones(n)
    reached = np.full(n, np.inf)
    for _ in range(iterations):
        trial = base[active] + alpha[active, None] * step[active]
        rest, jacobian = problem.evaluate(trial, active)
        worst = np.abs(rest.clearance).max(axis=1)
        better = worst < best[active]
        best[active[better]], best_v[active[better]] = worst[better], trial[better]
        # Accept what improves on the last accepted state, or what could not be improved by halving.
        accept = (worst < 0.9 * reached[active]) | (alpha[active] < 0.2)
        rows = active[accept]
        if len(rows):
            base[rows], reached[rows], alpha[rows] = trial[accept], worst[accept], 1.0
            j = jacobian[accept]
            # A small damping keeps the step finite where the linkage is singular.
            jt = np.swapaxes(j, 1, 2)
            normal = jt @ j + 1e-12 * np.eye(unknowns)
            step[rows] = -np.linalg.solve(normal, jt @ rest.clearance[accept][..., None])[..., 0]
            limit = np.array([1.0] + [0.3] * (unknowns - 1))
            step[rows] = np.clip(step[rows], -limit, limit)
        alpha[active[~accept]] *= 0.5
        active = active[best[active] > tolerance]
        if not len(active):
            break
    return problem.evaluate(best_v, everything, derivatives=False)[0]


def _plane_fit(suspension, heights, xy, heading):
    """First guess: height, roll and pitch of the plane through the ground below the wheels."""
    centre = np.array([w.centre - suspension.reference for w in suspension.wheels])
    c, s = np.cos(heading)[:, None], np.sin(heading)[:, None]
    at = np.stack([xy[:, :1] + c * centre[:, 0] - s * centre[:, 1],
                   xy[:, 1:] + s * centre[:, 0] + c * centre[:, 1]], axis=-1)
    z = heights(at.reshape(-1, 2)).reshape(at.shape[:2])
    a = np.column_stack([np.ones(len(centre)), centre[:, 0], centre[:, 1]])
    fit = z @ np.linalg.pinv(a).T
    return np.column_stack([fit[:, 0], np.arctan(packed(fit[:, 2])), -np.arctan(packed(fit[:, 1]))])
