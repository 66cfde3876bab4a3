"""frames.json: a vehicle of single-part models, as a tree of frames that each may show a mesh.

    {"vehicle": "...", "frames": [{"name": "chassis", "parent": null, "translation_m": [0, 0, 0],
                                   "mesh": "chassis.obj", "joint_axis": null}, ...]}

translation_m is the frame's origin in its parent at rest; joint_axis (x, y, z or null) what it turns
about. Further keys: mirror (the mesh in the plane XZ), mesh_rotated_180_about_z, wheel_radius_m. Axes
X forward, Y left, Z up. Other keys are not read.
"""
import json
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from dspace.errors import Corrupt, NotFound

FILE_NAME = "frames.json"
MODELS = (".urdf", ".gltf", ".glb", ".wrl", ".wrz", ".obj", ".stl", ".ply")  # suffixes of other model files
_NOTHING = object()


@dataclass
class FileFrame:
    """One frame of the file."""
    name: str
    parent: str  # or None, of the root
    translation: np.ndarray  # in its parent [m]
    axis: str  # "x", "y", "z" or None
    mesh: Path  # or None
    matrix: np.ndarray  # 4 x 4, of the mesh in the frame; may mirror
    wheel_radius: float  # [m], or None


def path_of(path):
    """The file that a folder, or a file's own path, stands for."""
    path = Path(path)
    return path / FILE_NAME if path.is_dir() else path


def read_frames_file(path):
    """(name of the vehicle, its FileFrames with parents first) of a frames.json or its folder.

    Raises dspace.NotFound, or dspace.Corrupt (a ValueError) naming the file, the frame and the key."""
    file = path_of(path)
    label = f"file '{file}'"
    try:
        document = json.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError as e:
        if file.parent.is_dir():
            raise NotFound(f"folder '{file.parent}': it has no {file.name}; accepted: the folder of a {FILE_NAME}, or a "
                           f"model file{_models_in(file.parent)}", label) from e
        raise NotFound(f"{label}: there is no such file", label) from e
    except OSError as e:
        raise NotFound(f"{label}: cannot be read ({e.strerror or e})", label) from e
    except (ValueError, RecursionError) as e:
        raise Corrupt(f"{label}: is no JSON ({str(e)[:200]})", label) from e
    entries = document.get("frames") if isinstance(document, dict) else None
    if not isinstance(entries, list) or not entries:
        raise Corrupt(f"{label}: expected an object with a list 'frames' of at least one frame", label)
    frames = {}
    for i, entry in enumerate(entries):
        frame = _frame(entry, i, file, label)
        if frame.name in frames:
            raise Corrupt(f"{label}: frames[{i}]: the name '{frame.name}' is taken", label)
        frames[frame.name] = frame
    name = document.get("vehicle")
    return name if isinstance(name, str) and name else file.parent.name, _ordered(frames, label)


def _models_in(folder):
    """What a message says of the model files of a folder."""
    found = sorted(each.name for each in folder.iterdir() if each.suffix.lower() in MODELS)[:5]
    return f", such as {', '.join(map(repr, found))} there" if found else f" ({', '.join(MODELS)})"


def _frame(entry, i, file, label):
    where = f"{label}: frames[{i}]"
    if not isinstance(entry, dict):
        raise Corrupt(f"{where}: is {_shown(entry)}; accepted: an object", label)

    def take(key, accepted, good, absent=_NOTHING):
        value = entry.get(key, absent)
        if value is absent and absent is not _NOTHING:
            return absent
        if not good(value):
            problem = "is missing" if value is _NOTHING else f"is {_shown(value)}"
            raise Corrupt(f"{where}: '{key}' {problem}; accepted: {accepted}", label)
        return value

    name = take("name", "a text", lambda v: isinstance(v, str) and v != "")
    where += f" '{name}'"
    parent = take("parent", "the name of a frame, or null for the root",
                  lambda v: v is None or (isinstance(v, str) and v != ""))
    translation = take("translation_m", "3 finite numbers [m]",
                       lambda v: isinstance(v, list) and len(v) == 3 and all(map(_finite, v)))
    axis = take("joint_axis", "'x', 'y', 'z' or null",
                lambda v: v is None or (isinstance(v, str) and v in ("x", "y", "z")), None)
    mesh = take("mesh", "the name of a file, or null",
                lambda v: v is None or (isinstance(v, str) and v != "" and "\0" not in v), None)
    mirror = take("mirror", "true or false", lambda v: isinstance(v, bool), False)
    turned = take("mesh_rotated_180_about_z", "true or false", lambda v: isinstance(v, bool), False)
    radius = take("wheel_radius_m", "a number above 0 [m]", lambda v: _finite(v) and v > 0, None)
    matrix = np.eye(4)
    if mirror:
        matrix[1, 1] = -1.0
    if turned:
        matrix[0, 0] = matrix[1, 1] = -1.0
    return FileFrame(name, parent, np.array(translation, float), axis,
                     file.parent / mesh if mesh else None, matrix, radius)


def _ordered(frames, label):
    roots = [f.name for f in frames.values() if f.parent is None]
    if len(roots) != 1:
        raise Corrupt(f"{label}: 'parent' is null in {roots or 'no frame'}; accepted: in one", label)
    for frame in frames.values():
        if frame.parent is not None and frame.parent not in frames:
            raise Corrupt(f"{label}: frame '{frame.name}': 'parent' is '{frame.parent}', which is no "
                          "frame of the file", label)
    children, seen, sorted_already = {}, {None}, True
    for frame in frames.values():
        children.setdefault(frame.parent, []).append(frame)
        sorted_already = sorted_already and frame.parent in seen
        seen.add(frame.name)
    if sorted_already:
        return list(frames.values())
    ordered = list(children[None])
    for frame in ordered:  # the loop appends to it
        ordered += children.get(frame.name, [])
    if len(ordered) != len(frames):
        lost = next(name for name in frames if all(f.name != name for f in ordered))
        raise Corrupt(f"{label}: frame '{lost}': 'parent' leads round in a circle", label)
    return ordered


def _finite(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _shown(value):
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:77]}..."
