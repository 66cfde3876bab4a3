"""What scans of range sensors return, and their files."""
import io
import pathlib
from dataclasses import dataclass

import numpy as np

from dspace._core.fields import file_path
from dspace._core.files import atomic_write
from dspace.errors import InvalidArgument

OUTCOMES = ("echo", "nothing", "too near", "oblique", "faint", "lost", "no beam")  # RangesReply.Outcome
PLY = (("x", "f8", "double"), ("y", "f8", "double"), ("z", "f8", "double"), ("nx", "f4", "float"), ("ny", "f4", "float"),
       ("nz", "f4", "float"), ("range", "f8", "double"), ("incidence_deg", "f4", "float"), ("intensity", "f4", "float"),
       ("object", "u4", "uint"), ("beam", "u4", "uint"))
CSV = ("beam", "outcome", "x", "y", "z", "range", "true_range", "incidence_deg", "intensity", "nx", "ny", "nz", "object",
       "name", "fragment")


@dataclass(frozen=True, eq=False, repr=False)
class RangeScan:
    """The ranges of a scan: arrays of the sensor's shape, which numbers, or arrays (3,), are for an altimeter.

    range: as measured, from the beam's origin [m]; NaN without an echo. true_range: without noise. point (..., 3): at
    `range` on the beam's axis, in the root [m]. direction (..., 3): of the axis, unit, in the root. normal (..., 3): of the
    surface on the sensor's side, in the root. incidence_deg: between the ray and the normal. intensity [1/m^2]: see Lidar.
    object: ids as in labels of pictures, of terrain too; 0: no echo. outcome: why there is no echo, an index of
    RangeScan.OUTCOMES. names, fragments: of each object id, by id; their names at the time of the scan.

    position (3,), rotation (3, 3): of the sensor's axes in the root; its columns are the axes."""

    range: object
    true_range: object
    direction: np.ndarray
    point: np.ndarray
    normal: np.ndarray
    incidence_deg: object
    intensity: object
    object: object
    outcome: object
    names: dict
    fragments: dict
    position: np.ndarray
    rotation: np.ndarray

    OUTCOMES = OUTCOMES

    @property
    def local_point(self):
        """The points (..., 3) in the sensor's axes [m]: X right, Y forward, Z up of azimuths and elevations and of
        frames; those of the camera, X right, Y down, Z forward, of directions and pixels at a camera."""
        return (self.point - self.position) @ self.rotation

    def __len__(self):
        """The number of echoes."""
        return int(np.count_nonzero(self.outcome == 0))

    def save(self, path):
        """Writes the echoes: .ply, a point cloud (binary, points in the root and their normals, range, incidence,
        intensity, object, beam), or .csv, every beam with its outcome. Raises dspace.InvalidArgument for another ending,
        dspace.Io."""
        path = file_path(path, "the path", "scan")
        ending = pathlib.Path(path).suffix.lower()
        if ending not in (".ply", ".csv"):
            raise InvalidArgument(f"file {path!r}: accepted: a name with .ply or .csv", path)
        atomic_write(path, self._ply() if ending == ".ply" else self._csv())

    def _columns(self):
        columns = {name: np.atleast_1d(getattr(self, name)).reshape(-1)
                   for name in ("range", "true_range", "incidence_deg", "intensity", "object", "outcome")}
        columns["x"], columns["y"], columns["z"] = np.reshape(self.point, (-1, 3)).T
        columns["nx"], columns["ny"], columns["nz"] = np.reshape(self.normal, (-1, 3)).T
        columns["beam"] = np.arange(columns["range"].size)
        return columns

    def _ply(self):
        columns = self._columns()
        echo = columns["outcome"] == 0
        rows = np.empty(int(echo.sum()), dtype=[(name, "<" + kind) for name, kind, _ in PLY])
        for name, _, _ in PLY:
            rows[name] = columns[name][echo]
        head = ["ply", "format binary_little_endian 1.0", "comment a scan by dspace: metres, in the scene's root"]
        head += [f"comment object {id}: {name}".replace("\n", " ") for id, name in self.names.items()]
        head += [f"element vertex {rows.size}"] + [f"property {word} {name}" for name, _, word in PLY] + ["end_header", ""]
        return "\n".join(head).encode() + rows.tobytes()

    def _csv(self):
        columns = self._columns()
        out = io.StringIO()
        out.write(",".join(CSV) + "\n")
        for i in range(columns["range"].size):
            id = int(columns["object"][i])
            cells = [str(i), OUTCOMES[columns["outcome"][i]]]
            cells += ["" if np.isnan(columns[name][i]) else repr(float(columns[name][i])) for name in CSV[2:12]]
            names = (self.names.get(id, ""), self.fragments.get(id, ""))
            out.write(",".join(cells + [str(id)] + [_quoted(name) for name in names]) + "\n")
        return out.getvalue().encode()

    def __repr__(self):
        echoes = np.atleast_1d(self.range)[np.atleast_1d(self.outcome) == 0]
        span = f", {echoes.min():.6g} to {echoes.max():.6g} m" if echoes.size else ""
        return f"<dspace.RangeScan {echoes.size} echoes of {np.size(self.range)} beams{span}>"


def _quoted(text):
    return '"' + text.replace('"', '""') + '"' if set(text) & set(',"\n') else text
