"""What the bars and keys of views do: cameras of their own, chases, copies, and maps in step with other views."""
import math

import numpy as np

from dspace import Pose
from dspace._core.fields import reject
from dspace.errors import Error, NotFound, WrongType
from dspace.links.watching import OWN
from dspace.proto import commands_pb2 as pb, viewports_pb2
from dspace.scene.viewport import Viewport

CHASE = np.array((-5.0, 0.0, 2.0)) / math.hypot(5.0, 2.0)  # direction from what is chased to the camera
EMPTY = 5.0  # [m] from a frame without objects
LOOK = ("shadows", "shadow_cascades", "shadow_map_size", "shadow_distance", "cascade_colors", "lit_colors", "fill", "exposure",
        "automatic_exposure", "tone")
COPIED = ("samples", "ornaments", "corner_axes", "navigation", "eye_height", "walk_speed", "lens")
SIZE = (640, 400)  # of a viewport until its widget has one
ABOVE = 10.0  # a map's camera stands so many times its height above the ground
CLOSE = 1e-6  # of a map's height: smaller differences are rounding


def required(view, about="view"):
    """Raises dspace.WrongType for anything but a Viewport."""
    if not isinstance(view, Viewport):
        reject(about, "the view", view, "a dspace.Viewport", WrongType)
    return view


def camera_of(view):
    """The camera that a view looks through. Raises dspace.NotFound without any."""
    camera = required(view).camera or view.scene.vantages[view.vantage].active
    if camera is None:
        raise NotFound(f"{view._label()}: it looks through no camera; accepted: one with a camera", view.name)
    return camera


def own_camera(view):
    """The camera of a view, which may be moved. A view of a recording or a server gets a copy of the recorded one, which
    stays as it is."""
    camera = camera_of(view)
    if not view.name.startswith(OWN) or camera.vantage.startswith(OWN) or camera.name.startswith(OWN):
        return camera
    scene = view.scene
    if view.name not in scene.vantages:
        scene.add_vantage(view.name)
    made = _copy(camera, camera.name, view.name)
    view.camera = made
    return made


def _copy(camera, name, vantage):
    scene, pose = camera._scene, camera.pose
    frame = camera.frame if pose is not None else None
    return scene.add_camera(name, frame=frame, pose=pose or camera.pose_in(), vantage=vantage, **camera.projection)


def fit(view, things=None):
    """Fills the view with objects or frames (default: all that is visible), without turning its camera."""
    own_camera(view)
    view.fit(things)


def chase(view, frame, distance=None):
    """Lets the camera of a view follow a frame from behind, at `distance` [m] (default: three and a half times the size of
    what is on the frame and below). frame: a Frame or its path; None: the camera stands still where it is."""
    camera = own_camera(view)
    scene = view.scene
    if frame is None:
        camera.attach(None, camera.pose_in())
        return
    frame = scene.frame(frame) if isinstance(frame, str) else frame
    if distance is None:
        distance = _distance(view, camera, frame)
    camera.chase(frame, offset=tuple(CHASE * distance))


def _distance(view, camera, frame):
    """So far away that what is on a frame fills the picture [m]; 5 without objects."""
    command = view.scene._command()
    command.fit_camera.vantage, command.fit_camera.name = camera.vantage, camera.name
    view.scene._put_things(command.fit_camera, frame, view._label)
    try:
        mount = view.scene._execute(command).camera.mount
    except Error:  # nothing that has a size
        return EMPTY
    stands = next((each for each in view.scene.frames.values() if each.id == mount.frame), view.scene.root)
    p = mount.pose.position
    away = stands.pose_in(view.scene.root).apply((p.x, p.y, p.z)) - frame.world_pose.position
    return float(np.linalg.norm(away)) or EMPTY


def copy(app, view, size=SIZE):
    """A new viewport that looks as a view does, with a camera of its own; it is not shown yet."""
    camera, scene = camera_of(view), view.scene
    base, number = view.name.rstrip("0123456789 ") or view.name, 2
    there = {*app.views, *view._client.execute(pb.Command(list_viewports=viewports_pb2.ListViewports())).viewports.name}
    while f"{base} {number}" in there:
        number += 1
    name = f"{base} {number}"
    if name.startswith(OWN):
        scene.add_vantage(name)
        made = _copy(camera, camera.name, name)
    else:
        made = _copy(camera, name, camera.vantage)
    shown = scene.add_viewport(size, made, name=name)
    for setting in COPIED:
        setattr(shown, setting, getattr(view, setting))
    shown.set(**{setting: getattr(view, setting) for setting in LOOK})
    for fragment in view.hidden_fragments:
        shown.hide(fragment)
    return shown


class MapLink:
    """Keeps an orthographic map in step with a 3D view, both ways; App.open_map() and App.link_map() return it.

    The map is centred on the ground that the view looks at, north up, and follows the view. Where the map is panned, the
    view moves along the ground by as much, without turning. Their scales are their own, but for the first one. On a
    body, north is that of the place."""

    def __init__(self, app, map_view, view):
        self._app, self.map, self.view = app, required(map_view), required(view)
        if map_view._client is not view._client or map_view.scene.name != view.scene.name:
            reject("map", "the views", (map_view.name, view.name), "two of one scene")
        if map_view == view:
            reject("map", "the view", view.name, "another one than the map")
        self._seen = self._centre = None
        own_camera(view)
        camera = own_camera(map_view)
        target, up, distance = self._ground()
        if "height" not in camera.projection:
            lens = camera_of(view).projection
            angle = math.radians(lens["fov_deg"]) if "fov_deg" in lens else None
            self._height = 2.0 * distance * math.tan(0.5 * angle) * 2.0 if angle else lens.get("height", distance)
        else:
            self._height = camera.projection["height"]
        map_view.navigation = "map"
        self._put(target, up)
        self._note()
        for each in (map_view, view):
            app._watch_pictures(each, self._drawn)

    # --- Where they look -----------------------------------------------------------------------

    def _ground(self):
        """The ground [root] that the view looks at, the direction of up there, and its distance [m]."""
        pose, scene = camera_of(self.view).pose_in(), self.view.scene
        eye, forward = np.array(pose.position), pose.rotation @ (0.0, 0.0, 1.0)
        best = None
        for terrain in scene.terrains.values():
            X = scene.root.pose_in(terrain.frame)
            distance = float(terrain.intersect(X.apply(eye), X.rotation @ forward)) / X.scale
            if math.isfinite(distance) and (best is None or distance < best[0]):
                best = distance, terrain
        if best is not None:
            target = eye + best[0] * forward
            return target, self._up(best[1], target), best[0]
        terrains = list(scene.terrains.values())
        if terrains and terrains[0].on_body:
            up = self._up(terrains[0], eye)
            return eye - up, up, 1.0
        # The plane z = 0 of the root; above the horizon, what is below the camera.
        if forward[2] * eye[2] < 0.0:
            distance = -eye[2] / forward[2]
            return eye + distance * forward, np.array((0.0, 0.0, 1.0)), distance
        return np.array((eye[0], eye[1], 0.0)), np.array((0.0, 0.0, 1.0)), abs(eye[2]) or 1.0

    def _up(self, terrain, point):
        X = terrain.frame.pose_in(self.view.scene.root)
        if not terrain.on_body:
            return X.rotation @ (0.0, 0.0, 1.0)
        away = point - np.array(X.position)
        return away / np.linalg.norm(away)

    def _north(self, up):
        """The direction of north in the root where up is `up`: along the terrain's Y, on a body to its pole."""
        terrains = list(self.view.scene.terrains.values())
        rotation = terrains[0].frame.pose_in(self.view.scene.root).rotation if terrains else np.eye(3)
        north = rotation @ ((0.0, 0.0, 1.0) if terrains and terrains[0].on_body else (0.0, 1.0, 0.0))
        north = north - (north @ up) * up
        if np.linalg.norm(north) < 1e-9:  # at a pole
            north = np.cross(up, rotation @ (0.0, 1.0, 0.0))
        return north / np.linalg.norm(north)

    # --- Steps ---------------------------------------------------------------------------------

    def _put(self, target, up):
        """Centres the map on a point of the root."""
        north = self._north(up)
        east = np.cross(north, up)
        rotation = np.column_stack((east, -north, -up))  # X right, Y down, Z forward
        eye = np.asarray(target) + ABOVE * self._height * up
        pose = Pose.from_matrix(np.block([[rotation, eye[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]]))
        camera = camera_of(self.map)
        self.map.scene.add_camera(camera.name, pose=pose, height=self._height, vantage=camera.vantage)

    def _note(self):
        self._seen = camera_of(self.view).pose_in()
        self._centre = np.array(camera_of(self.map).pose_in().position)
        self._height = camera_of(self.map).projection.get("height", self._height)

    def _drawn(self):
        """One of them has a new picture."""
        try:
            pose, centre = camera_of(self.view).pose_in(), np.array(camera_of(self.map).pose_in().position)
            height = camera_of(self.map).projection.get("height")
        except Error:  # one is closed, or not there at this time
            return
        if height is None:
            self.close()
            return
        near = CLOSE * height
        turned = np.abs(np.array(pose.quaternion) - np.array(self._seen.quaternion)).max()
        moved = np.linalg.norm(np.array(pose.position) - np.array(self._seen.position))
        self._height = height
        if moved > near or turned > 1e-9:
            target, up, _ = self._ground()
            self._put(target, up)
        elif np.linalg.norm(centre - self._centre) > near:
            self._pan(centre)
        else:
            return
        self._note()

    def _pan(self, centre):
        """Moves the view by as much as the map was panned."""
        camera = own_camera(self.view)
        down = camera_of(self.map).pose_in().rotation @ (0.0, 0.0, 1.0)
        step = centre - self._centre
        step = step - (step @ down) * down
        if camera.pose is None:  # it chases: the map follows it
            return
        pose = camera.pose_in()
        camera.attach(None, Pose(np.array(pose.position) + step, pose.quaternion))

    def close(self):
        """They move on their own again."""
        for each in (self.map, self.view):
            self._app._unwatch_pictures(each, self._drawn)
        self._app.map_links = [link for link in self._app.map_links if link is not self]

    def __repr__(self):
        return f"<dspace map {self.map.name!r} in step with {self.view.name!r}>"
