"""Wheel tracks on terrain."""
import numpy as np

from dspace._core import wire
from dspace._core.fields import array_of, file_path, flag, put, put_given, reject
from dspace.errors import InvalidArgument, WrongType

_CONTACTS = "a dict of wheels' names to contacts (x, y) or (n, 2), or what a vehicle's solve() returns"


class TerrainTracks:
    """The wheel tracks of a Terrain, which delegates to it: of clipmaps on a plane."""

    def __init__(self, terrain):
        self._terrain, self._scene, self._name = terrain, terrain._scene, terrain.name

    def track(self, wheels, width, sinkage=0.0, heading_deg=None, rolled=None, wall=None,
              rim_width=None, rim_height=None, tread_pitch=None, tread_depth=None, begin=False):
        """Wheels roll on to new contacts; what they roll over is a rut, drawn (also in depth images)
        and answered by every query from then on. `undisturbed` answers without.

        wheels: {name: (x, y) or points (n, 2) or (n, 3)} in the terrain's frame, or the state that a
        vehicle's solve() returns: its wheels' middles. Each name is a track that goes on; begin=True begins them anew,
        without a rut from where they were. Solve on `undisturbed`, less the sinkage where the vehicle
        is to stand in its ruts: on the tracked ground it would sink twice.
        sinkage: metres of the ruts' floor below the ground; heading_deg: of the wheels,
        counter-clockwise from X (along the path); rolled: metres that their rims have turned (as far
        as they moved): a number, or a dict of a number or n for each name.
        width: of the floor, the wheels' contact. wall: of each wall, seen from above (0.02).
        rim_width, rim_height: of a rim thrown up beside it (none). tread_pitch, tread_depth: bars
        across the floor, deeper by up to tread_depth (none). All metres. Where ruts overlap the
        deepest counts."""
        label = self._terrain._label()
        # Of a vehicle's state the wheels' middles: a wide wheel may rest on either edge.
        contacts = getattr(wheels, "wheel_centers", wheels)
        if not isinstance(contacts, dict):
            reject(label, "wheels", wheels, _CONTACTS, WrongType)
        for what, given in (("sinkage", sinkage), ("heading_deg", heading_deg), ("rolled", rolled)):
            unknown = set(given) - set(contacts) if isinstance(given, dict) else set()
            if unknown:
                reject(label, f"a wheel of {what}", sorted(unknown, key=str)[0],
                       f"wheels that are given: {', '.join(map(repr, contacts))}")
        command = self._scene._command()
        message = command.track_wheels
        put(message, label, terrain=self._name, width=width, begin=flag(begin, "begin", label))
        put_given(message, label, wall=wall, rim_width=rim_width, rim_height=rim_height,
                  tread_pitch=tread_pitch, tread_depth=tread_depth)
        for name, points in contacts.items():
            what = f"{label}, wheel {name!r}"
            points = np.atleast_2d(array_of(points, "its contacts", "(x, y) or (n, 2)", what))
            if points.ndim != 2 or points.shape[1] not in (2, 3):
                raise InvalidArgument(f"{what}: its contacts have shape {points.shape}; accepted: "
                                      "(x, y) or (n, 2)", what)
            rows = np.full((len(points), 5), np.nan)
            rows[:, :2] = points[:, :2]
            for column, field, given in ((2, "heading_deg", heading_deg), (3, "sinkage", sinkage),
                                         (4, "rolled", rolled)):
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
        """All tracks as GeoJSON: a LineString a track, in map coordinates, with its sizes."""
        self._scene._do("save_tracks", terrain=self._name,
                        path=file_path(path, "the path", self._terrain._label()))

    def load_tracks(self, path):
        """Adds tracks that save_tracks() wrote, or lines of other programs with a "sinkage"."""
        self._scene._do("load_tracks", terrain=self._name,
                        path=file_path(path, "the path", self._terrain._label()))

    @property
    def tracks(self):
        """A dict of length (metres of all wheels), contacts (that are kept: those on a line between
        others are left out) and bytes (of the budget, add_terrain's track_budget)."""
        info = self._terrain._info()
        return {"length": info.track_length, "contacts": info.track_contacts,
                "bytes": info.track_bytes}
