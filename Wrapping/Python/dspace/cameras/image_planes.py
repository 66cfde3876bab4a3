"""Planes that follow from the ranges of a picture through a lens: points, ground coordinates, motion. Double precision."""
import numpy as np

from dspace._core import wire
from dspace._core.fields import reject
from dspace._core.strict import Strict
from dspace.cameras.model import CameraModel
from dspace.errors import WrongType
from dspace.frames.poses import Pose

ROWS = 128  # of pixels whose rays are asked for at a time


class ImageState(Strict):
    """Where a camera and the objects of a scene are at a time: Scene.image_state(). Taken by the argument `motion` of
    Scene.simulate_image(), of the same scene. Does not change."""

    def __init__(self, scene, model, in_camera, pose):
        self._scene = scene
        self._model = model
        self._in_camera = in_camera
        self._X_RM = pose.matrix  # of the axes in which the model projects
        self._X_RO = object_poses(scene)

    def pixels_of(self, points):
        """Pixels (n, 2) of points (n, 3) of the root in its state; NaN: not seen."""
        X = self._X_RM  # of scale 1 or that of the model's frame
        local = np.linalg.solve(X[:3, :3], (points - X[:3, 3]).T).T
        return self._model.project(local, in_camera=self._in_camera)

    def __repr__(self):
        return f"<dspace.ImageState of {len(self._X_RO)} objects>"


def object_poses(scene):
    """The axes of every object in the root now: a dict of 4 x 4 matrices by id."""
    infos = scene._ask("list_objects").objects.object
    command = scene._command()
    command.get_poses.frame.extend(info.frame for info in infos)
    rows = wire.get_array(scene._execute(command).poses, "pose").reshape(-1, 8) if infos else ()
    poses = {}
    for info, row in zip(infos, rows):
        X_FO = np.eye(4)
        X_FO[:3] = np.reshape(info.offset, (3, 4))
        poses[info.id] = Pose._of_row(row).matrix @ X_FO
    return poses


def image_state(images, model, camera, vantage, frame, size, scale, about):
    """The ImageState of a camera that is given as for simulate_image()."""
    scene = images._scene
    if not isinstance(model, CameraModel):
        reject(about, "the model", model, "a dspace.CameraModel", WrongType)
    command = scene._command()
    images._put_camera(command.unproject_pixels.camera, model, camera, vantage, frame, size, scale, about)
    put = command.unproject_pixels.camera
    if size is not None and model.size is not None and tuple(size) != model.size:
        model = model.scaled(size)
    if frame is not None:
        question = scene._command()
        question.get_poses.frame.append(put.frame)
        row = np.array(scene._execute(question).poses.pose)
        return ImageState(scene, model, False, Pose._of_row(row))
    pose = scene._ask("get_camera_pose", vantage=put.vantage, name=put.camera).camera_pose.pose
    p, q = pose.position, pose.rotation
    return ImageState(scene, model, True, Pose._computed((p.x, p.y, p.z), (q.w, q.x, q.y, q.z), 1.0))


def points_of(images, planes, camera):
    """Points (h, w, 3) in the root of a picture's ranges [m]; NaN: nothing is seen. camera: what _put_camera() takes."""
    ranges = planes["range"].astype(float)
    height, width = ranges.shape
    points = np.empty((height, width, 3))
    u = np.arange(width, dtype=float)
    for top in range(0, height, ROWS):
        v = np.arange(top, min(top + ROWS, height), dtype=float)
        origins, directions = images.pixel_rays(np.stack(np.meshgrid(u, v), axis=-1), *camera)
        rows = ranges[top:top + ROWS, :, None]
        points[top:top + ROWS] = origins + np.where(np.isfinite(rows), rows, np.nan) * directions
    return points


def ground_of(terrain, points, geographic):
    """Map x, y and height, or longitude, latitude and height, (h, w, 3) of points in the root; NaN where they are."""
    X = terrain.frame.world_pose.matrix
    found = np.full(points.shape, np.nan)
    known = np.isfinite(points).all(axis=-1)
    if known.any():
        local = np.linalg.solve(X[:3, :3], (points[known] - X[:3, 3]).T).T
        values = terrain.to_map(local)
        if geographic:
            where = terrain.locate(local)
            values = np.column_stack((where.longitude, where.latitude, values[:, 2]))
        found[known] = values
    return found


def motion_of(scene, planes, points, state):
    """Pixels (h, w, 2): where each pixel's surface is in the state, less where it is now."""
    height, width = planes["label"].shape
    motion = np.full((height, width, 2), np.nan, np.float32)
    now = object_poses(scene)
    for id in np.unique(planes["label"]):
        if id == 0 or id not in state._X_RO:
            continue
        v, u = np.nonzero((planes["label"] == id) & np.isfinite(points).all(axis=-1))
        if not u.size:
            continue
        # From the present place to that of the state, about the object's own place: without loss of digits far from the root.
        A, B = now[id], state._X_RO[id]
        moved = np.linalg.solve(A[:3, :3], (points[v, u] - A[:3, 3]).T).T @ B[:3, :3].T + B[:3, 3]
        motion[v, u] = state.pixels_of(moved) - np.column_stack((u, v))
    return motion
