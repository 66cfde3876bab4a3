"""Wheel tracks on terrain."""
import numpy as np

from dspace._core import wire
from dspace._core.fields import array_of, file_path, flag, put, put_given, reject
from dspace.errors import InvalidArgument, WrongType

_CONTACTS = "a dict of wheels' names to contacts (x, y) or (n, 2), or what a vehicle's solve() returns"


class TerrainTracks:
    """The wheel tracks of a Terrain, which delegates to it."""

    def __init__(self, terrain):
        self._terrain, self._scene, self._name = terrain, terrain._scene, terrain.name

    def track(self, wheels, width, sinkage=0.0, heading_deg=None, rolled=None, wall=None,
              rim_width=None, rim_height=None, tread_pitch=None, tread_depth=None, begin=False):
        """Rolls wheels to new contacts. Each wheel leaves a rut, which pictures, depth images and all queries include.
        Queries of `undisturbed` exclude ruts.

        wheels: {name: (x, y) or points (n, 2) or (n, 3)} in the terrain's frame (on a body (x, y, z) or (n, 3); the
        ground on a point's vertical counts), or the state that a vehicle's
        solve() returns, of which the wheel centers are used. Each name is one track, which the call extends.
        begin=True starts new tracks, without ruts from the last contacts. Solve the vehicle on `undisturbed`, lowered
        by the sinkage if the vehicle should stand in its ruts; on the tracked ground it would sink twice.

        sinkage: depth of the rut's floor below the ground (0). heading_deg: heading of the wheels in degrees,
        counter-clockwise from X, on a body from east (default: along the path). rolled: the distance that the rims
        have turned (default: the distance moved, on a body along its ellipsoid). Each of these is a number, or a dict
        of a number or n numbers for each name. width: width of the floor, which is the wheels' contact. wall: width of
        each wall, seen from above (0.02). rim_width, rim_height: a rim beside the rut (none). tread_pitch,
        tread_depth: bars across the floor, deeper by up to tread_depth (none). All lengths are in metres. Where ruts
        overlap, the deepest counts."""
        label = self._terrain._label()
        # A vehicle's state gives the wheel centers, because a wide wheel may rest on either edge.
        contacts = getattr(wheels, "wheel_centers", wheels)
        if not isinstance(contacts, dict):
            reject(label, "wheels", wheels, _CONTACTS, WrongType)
        for what, given in (("sinkage", sinkage), ("heading_deg", heading_deg), ("rolled", rolled)):
            unknown = set(given) - set(contacts) if isinstance(given, dict) else set()
            if unknown:
                reject(label, f"a wheel of {what}", sorted(unknown, key=str)[0],
                       f"wheels that are given: {', '.join(map(repr, contacts))}")
        if self._terrain._stands_on_body is None:  # asked once: it never changes
            self._terrain._stands_on_body = self._terrain.on_body
        body = self._terrain._stands_on_body
        command = self._scene._command()
        message = command.track_wheels
        put(message, label, terrain=self._name, width=width, begin=flag(begin, "begin", label))
        put_given(message, label, wall=wall, rim_width=rim_width, rim_height=rim_height,
                  tread_pitch=tread_pitch, tread_depth=tread_depth)
        for name, points in contacts.items():
            what = f"{label}, wheel {name!r}"
            accepted = "(x, y, z) or (n, 3)" if body else "(x, y) or (n, 2)"
            points = np.atleast_2d(array_of(points, "its contacts", accepted, what))
            if points.ndim != 2 or points.shape[1] not in ((3,) if body else (2, 3)):
                raise InvalidArgument(f"{what}: its contacts have shape {points.shape}; accepted: {accepted}", what)
            size = 3 if body else 2
            rows = np.full((len(points), size + 3), np.nan)
            rows[:, :size] = points[:, :size]
            for column, field, given in ((size, "heading_deg", heading_deg), (size + 1, "sinkage", sinkage),
                                         (size + 2, "rolled", rolled)):
                value = given.get(name) if isinstance(given, dict) else given
                if value is None and field != "sinkage":
                    continue
                value = array_of(0.0 if value is None else value, f"its {field}",
                                 "a number, or one a contact", what)
                if value.shape not in ((), (len(points),)):
                    raise InvalidArgument(f"{what}: its {field} has shape {value.shape}; accepted: a "
                                          f"number, or ({len(points)},), one a contact", what)
                rows[:, column] = value
            wheel = message.wheel.add()
            put(wheel, what, name=name)
            wire.put_array(wheel, "contact", rows)
        self._scene._execute(command)

    def clear_tracks(self):
        """Removes all tracks and their ruts."""
        self._scene._do("clear_tracks", terrain=self._name)

    def save_tracks(self, path):
        """Writes all tracks as GeoJSON: one LineString for each track, in map coordinates, with its sizes."""
        self._scene._do("save_tracks", terrain=self._name,
                        path=file_path(path, "the path", self._terrain._label()))

    def load_tracks(self, path):
        """Adds the tracks of a file that save_tracks() wrote, or lines of other programs with a "sinkage"."""
        self._scene._do("load_tracks", terrain=self._name,
                        path=file_path(path, "the path", self._terrain._label()))

    @property
    def tracks(self):
        """A dict of length (sum of all tracks [m]), contacts (the number stored; contacts on a straight line between
        others are not stored) and bytes (in use of add_terrain's track_budget)."""
        info = self._terrain._info()
        return {"length": info.track_length, "contacts": info.track_contacts,
                "bytes": info.track_bytes}
