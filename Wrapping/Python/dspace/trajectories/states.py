"""Where something is at each time: tables of states, files, conics."""
import csv

import numpy as np

from dspace._core.fields import array_of, file_path, number, put_vector, reject
from dspace.errors import Corrupt, InvalidArgument, Io, NotFound, WrongType

J2000 = 2451545.0  # Julian date
DAY = 86400.0
KINDS = {"hermite": 0, "lagrange": 1, "linear": 2}
COLUMNS = ("time", "x", "y", "z", "vx", "vy", "vz")


def pack(values):
    return np.ascontiguousarray(values, "<f8").tobytes()


class Path:
    """What scene.add_trajectory accepts. States are about a centre in axes F that do not turn (J2000)."""

    def _put(self, message):
        raise NotImplementedError


class States(Path):
    """A table of states.

    times: (n,) [s], ascending: TDB past J2000, or the simulation's own clock. positions: (n, 3) [m]. velocities: (n, 3)
    [m/s]; None: unknown. interpolation: "hermite" (default; odd degree, takes velocities), "lagrange" (default without
    velocities) or "linear". degree: of the polynomial, 1 to 31; default 7, or less where there are fewer states."""

    def __init__(self, times, positions, velocities=None, interpolation=None, degree=None):
        about = "states"
        self.times = array_of(times, "the times", "an array (n,)", about)
        self.positions = array_of(positions, "the positions", "an array (n, 3)", about)
        self.velocities = None if velocities is None else array_of(velocities, "the velocities", "an array (n, 3)", about)
        n = len(self.times) if self.times.ndim == 1 else -1
        for what, array in (("positions", self.positions), ("velocities", self.velocities)):
            if array is not None and array.shape != (n, 3):
                raise InvalidArgument(f"{about}: the times have shape {self.times.shape}, the {what} {array.shape}; accepted: "
                                      "(n,) and (n, 3)", about)
        word = ("lagrange" if velocities is None else "hermite") if interpolation is None else interpolation
        if word not in KINDS:
            reject(about, "the interpolation", interpolation, ", ".join(KINDS))
        if word == "hermite" and velocities is None:
            raise InvalidArgument(f"{about}: Hermite's interpolation takes velocities, and there are none; accepted: "
                                  "'lagrange' or 'linear'", about)
        self.interpolation = word
        most = {"hermite": 2 * n - 1, "lagrange": n - 1, "linear": 1}[word]
        self.degree = max(1, min(7, most)) if degree is None else int(number(degree, "the degree", about))
        if not 1 <= self.degree <= 31:
            reject(about, "the degree", degree, "1 to 31")

    def __len__(self):
        return len(self.times)

    def __repr__(self):
        return f"<States, {len(self)} at times, {self.interpolation} of degree {self.degree}>"

    def _put(self, message):
        message.states.time = pack(self.times)
        message.states.position = pack(self.positions)
        if self.velocities is not None:
            message.states.velocity = pack(self.velocities)
        message.states.interpolation.kind = KINDS[self.interpolation]
        message.states.interpolation.degree = self.degree


class Oem(Path):
    """A CCSDS Orbit Ephemeris Message (502.0-B, keyword-value notation), with the interpolation that it states."""

    def __init__(self, path):
        self.path = file_path(path, "the path", "OEM")

    def _put(self, message):
        message.oem = self.path


class Xyzv(Path):
    """A file of Julian dates (TDB), positions [km] and velocities [km/s], as Celestia and Cosmographia read them."""

    def __init__(self, path):
        self.path = file_path(path, "the path", "xyzv file")

    def _put(self, message):
        message.xyzv = self.path


class Conic(Path):
    """Motion about the centre by its gravity alone: an ellipse, a parabola or a hyperbola from one state.

    position [m], velocity [m/s] at `time` [s]; mu: GM of the centre [m^3/s^2]."""

    def __init__(self, position, velocity, mu, time=0.0):
        self.position, self.velocity = position, velocity
        self.mu = number(mu, "mu", "conic")
        self.time = number(time, "the time", "conic")

    def _put(self, message):
        put_vector(message.conic.position, self.position, "the position", "conic")
        put_vector(message.conic.velocity, self.velocity, "the velocity", "conic")
        message.conic.mu = self.mu
        message.conic.time_s = self.time


def put_path(message, path, about):
    """Writes a Path, the name of a file, or a dspace.Trajectory into a TrajectoryPath message."""
    own = getattr(path, "_path", None)
    if own is not None and not isinstance(path, Path):  # a Trajectory
        message.CopyFrom(own)
    elif isinstance(path, Path):
        path._put(message)
    elif isinstance(path, str) or hasattr(path, "__fspath__"):
        name = file_path(path, "the path", about)
        if name.lower().endswith((".bsp", ".spk")):
            reject(about, "the path", path, "an OEM or .xyzv file; of an SPK kernel, load it (scene.kernels.load) and give "
                   "scene.body_path(body, center, begin, end)")
        (Xyzv if name.lower().endswith(".xyzv") else Oem)(name)._put(message)
    else:
        reject(about, "the path", path, "States, a Conic, an OEM or .xyzv file, a Trajectory", WrongType)


def read_states(path, columns=None, scale=1.0, epoch=0.0, julian=False, interpolation=None, degree=None):
    """States from a CSV file whose first line names its columns.

    columns: a dict from "time", "x", "y", "z" and, if there are any, "vx", "vy", "vz" to the names in the file; by default
    the same names in any case, and "t" for the time. scale: metres per unit of the file (1000: kilometres). Times are
    seconds after `epoch` [s past J2000], or Julian dates (TDB) with julian=True. Empty lines are skipped."""
    label = f"file {str(path)!r}"
    try:
        with open(file_path(path, "the path", label), newline="", encoding="utf-8-sig") as file:
            rows = list(csv.reader(file))
    except FileNotFoundError:
        raise NotFound(f"{label}: there is no such file", label) from None
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise Io(f"{label}: {error}", label) from None
    rows = [(i + 1, row) for i, row in enumerate(rows) if any(word.strip() for word in row)]
    if not rows:
        raise Corrupt(f"{label}: it is empty; accepted: a line with the names of columns, and states", label)
    names = [word.strip() for word in rows[0][1]]
    lower = [name.lower() for name in names]
    chosen = {}
    for key in columns or ():
        if key not in COLUMNS:
            reject(label, "a column", key, ", ".join(COLUMNS))
        if columns[key] not in names:
            raise NotFound(f"{label}: it has no column {columns[key]!r}; it has {', '.join(names)}", label)
        chosen[key] = names.index(columns[key])
    if columns is None:
        for key in COLUMNS:
            for word in (key, "t") if key == "time" else (key,):
                if word in lower and key not in chosen:
                    chosen[key] = lower.index(word)
    missing = [key for key in COLUMNS[:4] if key not in chosen]
    velocities = [key for key in COLUMNS[4:] if key in chosen]
    if missing or len(velocities) not in (0, 3):
        wanted = missing or [key for key in COLUMNS[4:] if key not in chosen]
        raise NotFound(f"{label}: no column is given for {', '.join(wanted)}; it has {', '.join(names)}", label)
    keys = COLUMNS[:4] + tuple(velocities)
    values = np.empty((len(rows) - 1, len(keys)))
    for i, (line, row) in enumerate(rows[1:]):
        for k, key in enumerate(keys):
            word = row[chosen[key]].strip() if chosen[key] < len(row) else ""
            try:
                values[i, k] = float(word)
            except ValueError:
                raise Corrupt(f"{label}, line {line}: {key} is {word!r}; accepted: a number", label) from None
    if not np.all(np.isfinite(values)):
        bad = rows[1 + int(np.argwhere(~np.isfinite(values))[0, 0])][0]
        raise Corrupt(f"{label}, line {bad}: a number is not finite; accepted: finite numbers", label)
    times = (values[:, 0] - J2000) * DAY if julian else values[:, 0] + number(epoch, "the epoch", label)
    factor = number(scale, "the scale", label)
    if not (factor > 0 and np.isfinite(factor)):
        reject(label, "the scale", scale, "a positive number of metres")
    return States(times, factor * values[:, 1:4], factor * values[:, 4:7] if velocities else None, interpolation, degree)
