"""Places of a scene, with their local vertical and north."""
import numpy as np

from dspace._core.fields import reject
from dspace.errors import InvalidArgument
from dspace.frames.frame import Frame
from dspace.frames.poses import Pose
from dspace.terrain.site import Site


class ScenePlace:
    """A Site, or a Frame or its path, where the scene has it at present."""

    def __init__(self, scene, place, what, about):
        self._scene = scene
        if isinstance(place, Frame):
            place = place.path  # a Playback creates its frames again when it seeks back
        if not isinstance(place, (str, Site)):
            reject(about, what, place, "a Site, a Frame or its path")
        if isinstance(place, Site):
            scene._require_own(place.terrain, f"terrain {place.terrain.name!r}", about)
            if place.shape != ():
                raise InvalidArgument(f"{about}: {what} has the shape {place.shape}; accepted: one place", about)
            x, y = float(place.x), float(place.y)
            self._map = [x, y, place.terrain.height(x, y, map=True) + float(place.height)]
        self.place = place

    def position(self):
        """In the root [m]."""
        if isinstance(self.place, Site):
            terrain = self.place.terrain
            return terrain.frame.world_pose.apply(np.asarray(terrain.from_map(self._map), float))
        return self._pose().position

    def _pose(self):
        return Pose.from_row(self._scene.poses([self.place], relative_to=self._scene.root)[0])

    def axes(self, position, meridian=False):
        """East, north and up in the root at the place's position there, as rows: of the terrain below, on a body from the meridian's
        north, on a plane from the map's Y axis (meridian=True: from the meridian's north too, where it has longitudes); without
        terrain those of the frame."""
        for terrain in [self.place.terrain] if isinstance(self.place, Site) else self._scene.terrains.values():
            pose = terrain.frame.world_pose
            inner = pose.inverse().apply(position)
            if isinstance(self.place, Site) or np.isfinite(terrain.height(*terrain.to_map(inner)[:2], map=True)):
                return _local_axes(terrain, inner, meridian) @ pose.matrix[:3, :3].T / pose.scale
        return self._pose().matrix[:3, :3].T / self._pose().scale


def _local_axes(terrain, point, meridian):
    """East, north and up at a point of the terrain's frame, as rows: by the slopes of height and latitude, or of the map's y."""
    size = 1.0  # [m]
    around = np.asarray(point) + size * np.concatenate((np.eye(3), -np.eye(3)))
    map_ = np.asarray(terrain.to_map(around))
    along = map_[:, 1]
    if terrain.on_body or meridian and terrain._map_is_in_degrees() is not None:
        along = terrain.locate(around).latitude
    up, north = ((values[:3] - values[3:]) / (2.0 * size) for values in (map_[:, 2], np.asarray(along)))
    up /= np.linalg.norm(up)
    north = north - up * (up @ north)
    north /= np.linalg.norm(north)
    return np.stack((np.cross(north, up), north, up))
