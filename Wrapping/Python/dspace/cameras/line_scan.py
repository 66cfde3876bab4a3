"""Pictures of push-broom cameras, line by line."""
import numpy as np

from dspace._core.fields import flag, reject
from dspace.cameras.model import CameraModel
from dspace.errors import WrongType

# What stands where a line has no ray, plane by plane.
NOTHING = {"color": 0, "radiance": 0.0, "depth": np.inf, "range": np.inf, "label": 0}


def row_models(model):
    """For each line of a CameraModel of type line_scan the model of its one row, at its pose, or None where it has no ray.

    The pose is the one that turns the rays of the row at rest into those of the line (W. Kabsch 1976), in double precision."""
    lens = model._content["model"]
    width, height = model.size
    center = (lens["center"][0], lens["center"][1] - lens["row"])
    same = dict(size=(width, 1), focal_length=lens["focal_length"], matrix=lens["matrix"], center=center, radial=lens["radial"])
    across = np.column_stack([np.arange(width, dtype=float), np.zeros(width)])
    _, rest = CameraModel("usgs", **same).rays(across)
    for line in range(height):
        origins, seen = model.rays(across + (0.0, line))
        if not np.isfinite(seen).all():
            yield None
            continue
        u, _, v = np.linalg.svd(seen.T @ rest)
        turn = u @ np.diag((1.0, 1.0, np.linalg.det(u @ v))) @ v
        yield CameraModel("usgs", position=origins[0], quaternion=_quaternion(turn), **same)


def _quaternion(turn):
    """(w, x, y, z) of a rotation, by the greatest of the four (S. W. Shepperd 1978)."""
    trace = np.trace(turn)
    squares = np.array([trace, *np.diag(turn)])
    k = int(np.argmax(squares))
    if k == 0:
        q = np.array([1.0 + trace, turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    else:
        i = k - 1
        j, m = (i + 1) % 3, (i + 2) % 3
        q = np.empty(4)
        q[0] = turn[m, j] - turn[j, m]
        q[1 + i] = 1.0 + turn[i, i] - turn[j, j] - turn[m, m]
        q[1 + j] = turn[j, i] + turn[i, j]
        q[1 + m] = turn[m, i] + turn[i, m]
    return q / np.linalg.norm(q)


def scanned_image(images, model, at, frame, planes, samples, exposure, ornaments, hide, progress):
    """Scene.simulate_lines(). images: a SceneImages; planes: name: whether it is wanted."""
    about = "line scan"
    if not isinstance(model, CameraModel) or model.type != "line_scan":
        reject(about, "the model", model, "a dspace.CameraModel of type line_scan", WrongType)
    if model.size is None or model.size[0] < 3:
        reject(about, "the model's size", model.size, "(width, height), of at least 3 pixels a line")
    if at is not None and not callable(at):
        reject(about, "at", at, "a function of the number of a line, which puts the scene there, or None", WrongType)
    if progress is not None and not callable(progress):
        reject(about, "progress", progress, "a function of one number", WrongType)
    if frame is None:
        reject(about, "the frame", frame, "the frame in which the model's poses are")
    wanted = {name: flag(value, name, about) for name, value in planes.items()}
    width, height = model.size
    made, empty = {}, []
    for line, row in enumerate(row_models(model)):
        if at is not None:
            at(line)
        if row is None:
            empty.append(line)
            continue
        for name, values in images.simulate_image(row, frame=frame, samples=samples, exposure=exposure, ornaments=ornaments,
                                                  hide=hide, **wanted).items():
            if name == "lens":
                continue
            if name not in made:
                made[name] = np.empty((height, width) + values.shape[2:], values.dtype)
            made[name][line] = values[0]
        if progress is not None:
            progress((line + 1) / height)
    if len(empty) == height:
        reject(about, "the model", model, "one of whose lines some have rays")
    for name, values in made.items():
        values[empty] = NOTHING.get(name, np.nan)
    return made
