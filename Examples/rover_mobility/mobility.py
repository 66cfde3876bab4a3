"""How the rover moves: six wheels that stay on the ground and roll on it without slipping.

In each step of a millisecond the body advances by its speed and curvature, seen from above; its height, roll and
pitch, the rockers' and the bogies' angles follow from the six wheels' contacts (Newton's method, six
equations for six unknowns). A wheel is a thin disc: its contact is the rim's point where the ground's
tangent plane touches it. It turns as far as its middle moves along the ground, over its radius.
"""
import numpy as np

EYE = np.eye(3)


class Hills:
    """Rolling ground in closed form: z = sum of a sin(k . xy + p)."""

    WAVES = np.array([(0.10, 0.75, 0.10, 0.3), (0.07, -0.30, 1.05, 1.1), (0.035, 1.50, -0.90, 2.0),
                      (0.018, 0.60, 2.30, 0.5), (0.012, 2.60, 0.90, 4.0)])  # a [m], k [1/m], p [rad]

    def heights(self, x, y):
        a, kx, ky, p = self.WAVES.T
        return np.sin(x[..., None] * kx + y[..., None] * ky + p) @ a

    def gradients(self, x, y):
        """dz/dx and dz/dy."""
        a, kx, ky, p = self.WAVES.T
        c = np.cos(x[..., None] * kx + y[..., None] * ky + p)
        return c @ (a * kx), c @ (a * ky)


class Plane:
    """z = z0 + gx x + gy y."""

    def __init__(self, gx=0.0, gy=0.0, z0=0.0):
        self.gx, self.gy, self.z0 = gx, gy, z0

    def heights(self, x, y):
        return self.z0 + self.gx * x + self.gy * y

    def gradients(self, x, y):
        return np.full(x.shape, self.gx), np.full(x.shape, self.gy)


class Mobility:
    """A rover of a model on ground (heights and gradients of arrays), from (x, y, heading) on [m, rad].

    After each step: time [s], angles (a joint angle a body [rad]), position and rotation of the chassis,
    contacts (6, 3), centres (6, 3), turned (6,): how far each wheel has turned about its axle in the world
    [rad], rolled (6,): how far its middle has come along the ground [m]."""

    CONTACT_STEPS = 5, 2  # each makes the contact's direction ten times better, its height a hundred times;
    # fewer of them where the step before is at hand
    TOLERANCE = 1e-9  # metres that a wheel may be off the ground

    def __init__(self, model, ground, x=0.0, y=0.0, heading=0.0):
        self.model, self.ground = model, ground
        names = [body.name for body in model.bodies]
        self.parents = np.array([names.index(body.parent) if body.parent else -1 for body in model.bodies])
        self.wheels = model.wheels
        self.steering = np.array([self.parents[k] if model.bodies[self.parents[k]].joint == "steering" else -1
                                  for k in self.wheels])
        self.steered = np.flatnonzero(self.steering >= 0)
        self._positions = np.array([body.position for body in model.bodies])
        self._axes = np.array([body.axis for body in model.bodies])
        self._levels = self._sort()
        self._columns = {joint: np.array([k for k, body in enumerate(model.bodies) if body.joint == joint], int)
                         for joint in ("rocker", "bogie", "steering", "wheel")}
        self._signs = np.array([model.bodies[k].sign for k in self._columns["rocker"]])
        # Where the wheels stand on level ground, from above: what steering is worked out for.
        at_rest = self._forward(np.zeros((1, 6)), np.zeros(len(names)), np.zeros(3))[1][0, self.wheels]
        self.places = at_rest[:, :2]
        self.time, self.angles = 0.0, np.zeros(len(names))
        self._pose = np.array([x, y, heading], float)
        ground_here = ground.heights(np.array([x]), np.array([y]))[0]
        self._free = np.array([ground_here - at_rest[:, 2].mean() + model.wheel_radius, 0, 0, 0, 0, 0])
        self._jacobian, self._age, self.up = None, 0, None
        self._before = self._free, self._free  # one and two steps ago
        self.turned, self.rolled = np.zeros(6), np.zeros(6)
        self._settle()

    def _sort(self):
        """Bodies by their depth, with their constant parts as arrays."""
        depth = np.zeros(len(self.parents), int)
        for k, parent in enumerate(self.parents):
            depth[k] = depth[parent] + 1 if parent >= 0 else 0
        levels = []
        for d in range(1, depth.max() + 1):
            which = np.flatnonzero(depth == d)
            axes = self._axes[which]
            K = np.zeros((len(which), 3, 3))
            K[:, 0, 1], K[:, 0, 2], K[:, 1, 2] = -axes[:, 2], axes[:, 1], -axes[:, 0]
            K -= K.transpose(0, 2, 1)
            levels.append((which, self.parents[which], self._positions[which], K, K @ K))
        return levels

    # --- Kinematics ----------------------------------------------------------------------------

    def _forward(self, free, angles, pose):
        """Rotations (n, bodies, 3, 3) and origins (n, bodies, 3) of all bodies in the world.

        free (n, 6): height, roll, pitch, rocker and bogies; angles: of steering."""
        n = len(free)
        a = np.tile(angles, (n, 1))
        a[:, self._columns["rocker"]] = free[:, 3:4] * self._signs
        a[:, self._columns["bogie"]] = free[:, 4:6]
        a[:, self._columns["wheel"]] = 0.0  # turning moves no rim
        R = np.empty((n, len(self.parents), 3, 3))
        p = np.empty((n, len(self.parents), 3))
        R[:, 0] = attitude(pose[2], free[:, 1], free[:, 2])
        p[:, 0, :2], p[:, 0, 2] = pose[:2], free[:, 0]
        for which, parents, offsets, K, K2 in self._levels:
            s, c = np.sin(a[:, which]), np.cos(a[:, which])
            own = EYE + s[..., None, None] * K + (1 - c)[..., None, None] * K2
            above = R[:, parents]
            R[:, which] = above @ own
            p[:, which] = p[:, parents] + (above @ offsets[..., None])[..., 0]
        return R, p

    def _contact(self, R, p):
        """Gaps (n, 6) under the wheels, contacts and the discs' upward directions (n, 6, 3)."""
        centres, axles = p[:, self.wheels], R[:, self.wheels][..., 1]
        steps = self.CONTACT_STEPS[self.up is not None]
        up = np.empty_like(centres)
        up[...] = (0.0, 0.0, 1.0) if self.up is None else self.up
        for step in range(steps + 1):
            up -= np.einsum("nwi,nwi->nw", up, axles)[..., None] * axles
            up /= np.sqrt(np.einsum("nwi,nwi->nw", up, up))[..., None]
            contacts = centres - self.model.wheel_radius * up
            if step < steps:
                up[..., 0], up[..., 1] = (-g for g in self.ground.gradients(contacts[..., 0], contacts[..., 1]))
                up[..., 2] = 1.0
        return contacts[..., 2] - self.ground.heights(contacts[..., 0], contacts[..., 1]), contacts, up

    def _settle(self):
        """Puts all wheels on the ground."""
        one, two = self._before
        self._free, self._before = 3 * (self._free - one) + two, (self._free, one)  # as it went on before
        for _ in range(50):
            R, p = self._forward(self._free[None], self.angles, self._pose)
            gaps, contacts, up = self._contact(R, p)
            if np.abs(gaps).max() <= self.TOLERANCE:
                break
            if self._jacobian is None or self._age > 40:
                self._jacobian, self._age = self._derivatives(), 0
            self._age += 1
            self._free = self._free - self._jacobian @ gaps[0]
        else:
            raise ValueError(f"the rover at {self._pose[0]:.3f}, {self._pose[1]:.3f} m does not stand with all wheels "
                             f"on the ground: {1000 * np.abs(gaps).max():.3g} mm are left; accepted: gentler ground")
        self.rotations, self.origins = R[0], p[0]
        self.contacts, self.centres, self.up = contacts[0], p[0, self.wheels], up[0]
        self.angles[self._columns["rocker"]] = self._free[3] * self._signs
        self.angles[self._columns["bogie"]] = self._free[4:6]

    def _derivatives(self, h=1e-6):
        """The inverse of d gaps / d free, by central differences."""
        trial = self._free + h * np.concatenate((np.eye(6), -np.eye(6)))
        gaps = self._contact(*self._forward(trial, self.angles, self._pose))[0]
        return np.linalg.inv(((gaps[:6] - gaps[6:]) / (2 * h)).T)

    # --- Driving -------------------------------------------------------------------------------

    def step(self, dt, speed, curvature):
        """Goes on for dt seconds at a speed [m/s] and a curvature [1/m, to the left], seen from above."""
        before = self.rotations, self.centres, self.up
        # The corner wheels point along their circles about the common centre.
        x, y = self.places[self.steered].T
        self.angles[self.steering[self.steered]] = np.arctan2(curvature * x, 1 - curvature * y)
        turn = speed * curvature * dt
        middle = self._pose[2] + 0.5 * turn  # of a circle's chord
        length = speed * dt * np.sinc(0.5 * turn / np.pi)
        self._pose = self._pose + (length * np.cos(middle), length * np.sin(middle), turn)
        self._settle()
        self._roll(*before)
        self.time += dt

    def _roll(self, rotations, centres, up):
        """Turns the wheels by how far their middles went along the ground."""
        axles = self.rotations[self.wheels, :, 1] + rotations[self.wheels, :, 1]
        (ax, ay, az), (ux, uy, uz) = axles.T, (self.up + up).T  # midway, so that a step's error is of third order
        forward = np.array((ay * uz - az * uy, az * ux - ax * uz, ax * uy - ay * ux))
        forward /= np.sqrt((forward * forward).sum(0))
        way = ((self.centres - centres).T * forward).sum(0)
        self.rolled += way
        self.turned += way / self.model.wheel_radius
        # What carries the wheel turns about the axle, too: the joint makes the rest.
        carriers = self.parents[self.wheels]
        step = rotations[carriers].transpose(0, 2, 1) @ self.rotations[carriers]
        self.angles[self.wheels] += way / self.model.wheel_radius - 0.5 * (step[:, 0, 2] - step[:, 2, 0])

    def rows(self):
        """Local poses (bodies, 7): px py pz qw qx qy qz, the chassis' in the world."""
        half = 0.5 * self.angles
        out = np.empty((len(half), 7))
        out[:, :3], out[:, 3], out[:, 4:] = self._positions, np.cos(half), np.sin(half)[:, None] * self._axes
        out[0, :3] = self.origins[0]
        out[0, 3:] = attitude_quaternion(self._pose[2], self._free[1], self._free[2])
        return out


def attitude(heading, roll, pitch):
    """(n, 3, 3): Rz(heading) Ry(pitch) Rx(roll)."""
    ch, sh = np.cos(heading), np.sin(heading)
    cr, sr, cp, sp = np.cos(roll), np.sin(roll), np.cos(pitch), np.sin(pitch)
    R = np.empty((len(roll), 3, 3))
    R[:, 0, 0], R[:, 0, 1], R[:, 0, 2] = ch * cp, ch * sp * sr - sh * cr, ch * sp * cr + sh * sr
    R[:, 1, 0], R[:, 1, 1], R[:, 1, 2] = sh * cp, sh * sp * sr + ch * cr, sh * sp * cr - ch * sr
    R[:, 2, 0], R[:, 2, 1], R[:, 2, 2] = -sp, cp * sr, cp * cr
    return R


def attitude_quaternion(heading, roll, pitch):
    """The same rotation as w, x, y, z."""
    (ch, sh), (cr, sr), (cp, sp) = ((np.cos(0.5 * a), np.sin(0.5 * a)) for a in (heading, roll, pitch))
    return np.array((ch * cp * cr + sh * sp * sr, ch * cp * sr - sh * sp * cr, ch * sp * cr + sh * cp * sr,
                     sh * cp * cr - ch * sp * sr))
