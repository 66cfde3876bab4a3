"""Scans of a scene by range sensors."""
import time

import numpy as np

from dspace._core.fields import integer, put, put_given, put_vector, reject
from dspace._core.signals import check_signals
from dspace.cameras.images import SceneImages
from dspace.errors import InvalidArgument, WrongType
from dspace.frames.poses import matrix_of_quaternion
from dspace.measure.obstacles import object_ids, put_measuring
from dspace.measure.point_cloud import RangeScan
from dspace.measure.ranges import RangeSensor
from dspace.terrain.site import Site

FIRST, MOST, SECONDS = 256, 65536, 0.25  # beams of the first request, and of any; the time that one should take [s]
WIDTHS = {"range": (), "true_range": (), "direction": (3,), "point": (3,), "normal": (3,), "incidence_deg": (),
          "intensity": (), "object": (), "outcome": ()}


class Scans:
    """Scans with range sensors for a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def scan(self, sensor, *, frame=None, position=None, site=None, camera=None, vantage=None, seed=0, number=0, terrain=True,
             objects=True, hide=(), without=(), deadline=None, progress=None):
        """Measures ranges by exact rays in double precision. Returns a RangeScan.

        sensor: a dspace.Lidar or a dspace.Altimeter. It is at the origin of `frame` (a Frame or its path; default: the root),
        or at a `position` (3,) in it [m], with the frame's axes X right, Y forward, Z up; or at a `site` (Terrain.site(), one point) with X east, Y north, Z up;
        or at a `camera` (or the active one of `vantage`). A Lidar.flash() takes a camera, or with a model `frame`, in which
        the model's own pose is.

        Beams meet the triangles of all terrains (terrain=False: none), with wheel tracks, and of physical objects that the
        scene shows (objects=False: none), at their finest level. hide: fragments, or their names, that they do not meet.
        without: objects, or their names, such as the sensor's own housing. All beams are at the scene's present time.

        seed (0 to 2**64 - 1), number (of the scan, 0 to 2**32 - 1): equal ones give equal noise and drop-outs. deadline:
        longest time [s]; default: none. progress: called with the fraction that is done, 0 to 1. Ctrl-C stops the scan.

        Raises dspace.InvalidArgument for settings out of range and for a sensor below the ground of a terrain;
        dspace.NotFound; dspace.DeadlineExceeded."""
        about = "scan"
        if not isinstance(sensor, RangeSensor):
            reject(about, "the sensor", sensor, "a dspace.Lidar or a dspace.Altimeter", WrongType)
        if progress is not None and not callable(progress):
            reject(about, "progress", progress, "a function of one number", WrongType)
        for value, what, bits in ((seed, "the seed", 64), (number, "the number", 32)):
            if not 0 <= integer(value, what, about) < 2**bits:
                reject(about, what, value, f"0 to 2**{bits} - 1")
        command = self._scene._command()
        message = command.scan_ranges
        put_measuring(self._scene, message.measuring, about, terrain, objects, hide, None, "exact")
        message.without_object.extend(object_ids(self._scene, without, about))
        message.sensor.CopyFrom(sensor._message)
        message.sensor.seed, message.sensor.scan = seed, number
        self._put_place(message, sensor, frame, position, site, camera, vantage, about)
        total = int(np.prod(sensor.shape, dtype=np.int64))
        begin = time.monotonic()
        parts, first, count = [], 0, FIRST
        things = {}
        while first < total:
            count = min(count, total - first)
            sensor._put_beams(message, first, count)
            if first == 0:
                put_given(message.measuring, about, deadline_s=deadline)
            elif deadline is not None:  # of the whole scan
                message.measuring.deadline_s = max(deadline - (time.monotonic() - begin), 0.001)
            since = time.monotonic()
            reply = self._scene._execute(command).ranges
            took = time.monotonic() - since
            parts.append([np.array(getattr(reply, name)).reshape((-1,) + width) for name, width in WIDTHS.items()])
            things.update((thing.object, thing) for thing in reply.thing)
            pose = reply.pose
            first += count
            count = min(max(int(count * SECONDS / max(took, 1e-3)), FIRST), 4 * count, MOST)
            if progress is not None:
                progress(first / total)
            check_signals()
        arrays = {name: np.concatenate([part[i] for part in parts]).reshape(sensor.shape + width)
                  for i, (name, width) in enumerate(WIDTHS.items())}
        return _scan_of(arrays, things, pose)

    def _put_place(self, message, sensor, frame, position, site, camera, vantage, about):
        flash = sensor._is_flash()
        if position is not None and (flash or site is not None or camera is not None or vantage is not None):
            reject(about, "the position", position, "it in a frame, of a sensor that is no flash lidar")
        given = [name for name, value in (("frame", frame), ("site", site), ("camera", camera)) if value is not None]
        if len(given) > 1 or site is not None and (vantage is not None or flash):
            raise InvalidArgument(f"{about}: its place is given by {', '.join(given)}; accepted: a frame, a site or a camera; "
                                  "for a flash lidar no site", about)
        if flash or camera is not None or vantage is not None:
            SceneImages(self._scene)._put_camera(message.camera, sensor._model if flash else None, camera, vantage,
                                                 frame, sensor._size if flash else None, False, about)
        elif site is not None:
            if not isinstance(site, Site) or site.shape != ():
                reject(about, "the site", site, "one point of Terrain.site()", WrongType)
            self._scene._require_own(site.terrain, f"terrain {site.terrain.name!r}", about)
            put(message.site, about, terrain=site.terrain.name, map_x=float(site.x), map_y=float(site.y),
                height=float(site.height))
        else:
            message.place.frame = self._scene._frame_id(frame)
            if position is not None:
                put_vector(message.place.position, position, "the position", about)


def _scan_of(arrays, things, pose):
    for name, array in arrays.items():
        array = array.astype({"object": np.uint32, "outcome": np.uint8}.get(name, float))
        arrays[name] = array[()] if array.shape == () else array
    things = sorted(things.items())
    return RangeScan(**arrays, names={id: thing.terrain or thing.name for id, thing in things},
                     fragments={id: thing.fragment for id, thing in things},
                     position=np.array([pose.position.x, pose.position.y, pose.position.z]),
                     rotation=matrix_of_quaternion([getattr(pose.rotation, axis) for axis in "wxyz"]))
