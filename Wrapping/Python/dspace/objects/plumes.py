"""Plumes of thrusters and dust, driven by numbers of a simulation."""
import numpy as np

from dspace._core.fields import color as color_of, flag, integer, number, numbers, reject
from dspace.errors import InvalidArgument
from dspace.objects.factory import ObjectFactory

MOST = 50_000  # particles at one time


def uniform(seed, numbers_of, stream):
    """Numbers from 0 to 1 for particles, the same on every machine (S. Vigna's SplitMix64 of seed, number and stream)."""
    with np.errstate(over="ignore"):
        z = (np.asarray(numbers_of, np.uint64) * np.uint64(4) + np.uint64(stream)
             + np.uint64(seed) * np.uint64(0xD1B54A32D192ED03)) * np.uint64(0x9E3779B97F4A7C15)
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        z ^= z >> np.uint64(31)
    return (z >> np.uint64(11)).astype(float) * 2.0**-53


class Plume:
    """Particles that leave a nozzle (Scene.add_plume). Where they are depends on the times and numbers that were set alone."""

    def __init__(self, scene, frame, axis, spread, lifetime, acceleration, color, seed, settings):
        self._scene, self._frame, self._axis, self._spread = scene, frame, axis, spread
        self._lifetime, self._acceleration, self._color, self._seed = lifetime, acceleration, color, seed
        self._settings = settings
        self._parts = []  # (begin [s], particles before it, rate, speed): each until the next
        self.mesh = None

    def set(self, rate=None, speed=None, time=None):
        """The numbers of the simulation from `time` (default: the scene's) on: rate [particles/s], 0 and more, and speed
        [m/s]; those that are not given stay. Times do not go back; clear() begins anew."""
        about = "plume"
        time = self._scene.time if time is None else number(time, "the time", about)
        if not np.isfinite(time):
            reject(about, "the time", time, "a finite number of seconds")
        last = self._parts[-1] if self._parts else (time, 0.0, 0.0, 0.0)
        if time < last[0]:
            raise InvalidArgument(f"{about}: its numbers are set for {time:g} s after those for {last[0]:g} s; accepted: times "
                                  "that do not go back (clear() begins anew)", about)
        rate = last[2] if rate is None else number(rate, "the rate", about)
        speed = last[3] if speed is None else number(speed, "the speed", about)
        if not 0 <= rate * self._lifetime <= MOST:
            reject(about, "the rate", rate, f"0 to {MOST / self._lifetime:g} particles/s, {MOST} at one time")
        if not 0 <= speed < np.inf:
            reject(about, "the speed", speed, "0 m/s and more")
        made = last[1] + last[2] * (time - last[0])
        if self._parts and time == last[0]:
            self._parts.pop()
        self._parts.append((time, made, rate, speed))
        # What no particle that lives comes from is forgotten.
        while len(self._parts) > 1 and self._parts[1][0] < time - self._lifetime:
            self._parts.pop(0)
        return self.update(time)

    def particles(self, time=None):
        """Positions (n, 3) [m] in the frame and ages (n,) [s] of the particles at a time (default: the scene's)."""
        time = self._scene.time if time is None else number(time, "the time", "plume")
        positions, ages = [np.empty((0, 3))], [np.empty(0)]
        for i, (begin, made, rate, speed) in enumerate(self._parts):
            replaced = i + 1 < len(self._parts) and self._parts[i + 1][0] <= time
            end = self._parts[i + 1][0] if replaced else time
            if rate <= 0 or end < begin:
                continue
            first = int(np.ceil(made + rate * max(0.0, time - self._lifetime - begin)))
            # What begins at the time of a change belongs to the new numbers.
            last = int(np.ceil(self._parts[i + 1][1])) - 1 if replaced else int(np.floor(made + rate * (end - begin)))
            k = np.arange(first, last + 1)
            age = time - (begin + (k - made) / rate)
            k, age = k[(age >= 0) & (age < self._lifetime)], age[(age >= 0) & (age < self._lifetime)]
            positions.append(self._places(k, age, speed))
            ages.append(age)
        return np.concatenate(positions), np.concatenate(ages)

    def _places(self, k, age, speed):
        # Evenly over the cone's solid angle.
        cosine = 1.0 - uniform(self._seed, k, 0) * (1.0 - np.cos(self._spread))
        sine = np.sqrt(np.maximum(0.0, 1.0 - cosine**2))
        turn = 2 * np.pi * uniform(self._seed, k, 1)
        x = np.cross(self._axis, np.eye(3)[np.argmin(np.abs(self._axis))])
        x /= np.linalg.norm(x)
        y = np.cross(self._axis, x)
        direction = (cosine[:, None] * self._axis + (sine * np.cos(turn))[:, None] * x + (sine * np.sin(turn))[:, None] * y)
        each = speed * (0.9 + 0.2 * uniform(self._seed, k, 2))  # within a tenth of the speed
        return direction * (each * age)[:, None] + 0.5 * self._acceleration * (age**2)[:, None]

    def update(self, time=None):
        """Draws the particles at a time (default: the scene's). Call it once in each step; returns their number."""
        positions, ages = self.particles(time)
        if len(ages) == 0:
            if self.mesh is not None:
                self.mesh.visible = False
            return 0
        colors = np.empty((len(ages), 4))
        colors[:, :3] = self._color
        colors[:, 3] = 1.0 - ages / self._lifetime
        if self.mesh is None:
            self.mesh = ObjectFactory(self._scene).add_mesh(positions, colors=colors, frame=self._frame, **self._settings)
        else:
            self.mesh.update(points=positions, colors=colors)
            self.mesh.visible = True
        return len(ages)

    def clear(self):
        """Removes all particles, and the numbers that were set."""
        self._parts.clear()
        self.update()


class PlumeFactory:
    """Makes the plumes of a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def add_plume(self, frame=None, axis=(0, 0, 1), spread_deg=10.0, lifetime=1.0, acceleration=(0, 0, 0), color="#d0d8ff",
                  seed=0, physical=False, point_size=3.0, **settings):
        """A plume of a thruster, or dust, from the origin of `frame` along `axis`. Returns a Plume; Plume.set takes the rate
        and the speed that the simulation has.

        spread_deg: half angle of its cone, 0 to 90. lifetime [s]: particles fade out over it. acceleration [m/s^2], in the
        frame's axes: gravity for dust. seed: another one gives other particles; the same numbers always give the same. physical:
        it counts as something that a real camera sees; default: ornamental. Particles move in the axes of the frame."""
        about = "plume"
        axis = numbers(axis, 3, "the axis", about)
        length = np.linalg.norm(axis)
        if not (np.isfinite(length) and length > 0):
            reject(about, "the axis", axis.tolist(), "a direction of any length but 0")
        spread = number(spread_deg, "the spread", about)
        if not 0 <= spread <= 90:
            reject(about, "the spread", spread_deg, "0 to 90 degrees")
        lifetime = number(lifetime, "the lifetime", about)
        if not 0 < lifetime < np.inf:
            reject(about, "the lifetime", lifetime, "a positive number of seconds")
        acceleration = numbers(acceleration, 3, "the acceleration", about)
        if not np.all(np.isfinite(acceleration)):
            reject(about, "the acceleration", acceleration.tolist(), "finite numbers")
        seed = integer(seed, "the seed", about)
        if seed < 0:
            reject(about, "the seed", seed, "0 and more")
        settings = {"ornamental": not flag(physical, "physical", about), "lit": False, "point_size": point_size, **settings}
        frame = self._scene.root if frame is None else frame
        return Plume(self._scene, frame, axis / length, np.radians(spread), lifetime, acceleration,
                     color_of(color, "the colour", about), seed, settings)
