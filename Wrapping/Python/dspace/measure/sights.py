"""Lines of sight and horizons of a scene."""
import numpy as np

from dspace._core.fields import array_of, flag, integer, put, put_given, reject
from dspace.errors import InvalidArgument, WrongType
from dspace.frames.poses import Pose
from dspace.measure.obstacles import object_ids, put_measuring
from dspace.measure.results import Horizon, LinesOfSight
from dspace.measure.work import measure
from dspace.terrain.site import Site

MOST_LINES = 1_000_000
FEW_LINES = 100  # are measured at once, without a thread
PLACE = "a Site, a Frame, a path, or an array (..., 3) of points [m]"


class Sights:
    """Measures lines of sight and horizons for a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def line_of_sight(self, start, end, *, frame=None, wavelength=None, terrain=True, objects=True, hide=(), without=(),
                      clearance=True, deadline=None, method="exact", resolution=None, progress=None):
        """Tests lines of sight by rays in double precision. Returns LinesOfSight.

        start, end: a Site (Terrain.site), a Frame or the path of one (its origin), or an array (..., 3) of points [m] in
        `frame` (default: the root). Shapes broadcast: one start and many ends, or pairs; at most a million lines.
        wavelength: of radio waves [m], 1e-9 to 1e9: the result then has fresnel_free.

        Obstacles are all terrains (terrain=False: none) with their exact triangles between posts, and the triangles of
        the physical objects that the scene shows (objects=False: none), at their finest level. hide: fragments, or their
        names, that are no obstacles. without: objects, or their names, that are none, such as the antennas. A terrain on
        its body hides by the body's curvature too; a terrain on a plane is flat.

        clearance=False: only whether the line is clear, and what blocks it first: some twenty times as fast. deadline: longest
        time [s]; default: none.

        method: "exact", by rays; "image", by telephoto pictures from the start towards the end: clear where the middle pixel's ray
        reaches to 1e-4 of the distance before the end; "both": image_clear beside the exact results. They may differ where the
        margin (clearance_deg) is less than an angle of a pixel (image_pixel_deg). Pictures draw terrain more coarsely beyond half
        of its level_size posts.
        resolution: pixels of a picture of 90 degrees, 16 to 16384 (default 2048).

        progress: called as progress(fraction, left_s) during a long measurement; an exception in it cancels the measurement. A server
        keeps serving its viewers.

        Raises dspace.InvalidArgument for a start that is its end, for a place below the ground of a terrain that is an
        obstacle, and for a Site off the data or where there is none; dspace.DeadlineExceeded."""
        about = "line of sight"
        command = self._scene._command()
        message = command.line_of_sight
        put_measuring(self._scene, message.measuring, about, terrain, objects, hide, deadline, method, resolution)
        put_given(message, about, wavelength=wavelength)
        message.no_clearance = not flag(clearance, "clearance", about)
        message.without_object.extend(object_ids(self._scene, without, about))
        starts, ends = self._places(start, "the start", frame, about), self._places(end, "the end", frame, about)
        try:
            shape = np.broadcast_shapes(starts.shape, ends.shape)
        except ValueError:
            raise InvalidArgument(f"{about}: the start and the end have the shapes {starts.shape} and {ends.shape}; "
                                  "accepted: shapes that broadcast", about) from None
        count = int(np.prod(shape, dtype=np.int64))
        if not 1 <= count <= MOST_LINES:
            reject(about, "the number of lines", count, f"1 to {MOST_LINES}")
        starts, ends = starts.spread(shape), ends.spread(shape)
        for i in range(count):
            pair = message.pair.add()
            starts.put(i, pair, "from", "from_site")
            ends.put(i, pair, "to", "to_site")
        if count > FEW_LINES or progress is not None:
            reply = measure(self._scene, command, message.measuring, about, progress)
        else:
            reply = self._scene._execute(command)
        return self._lines(reply.line_of_sight, shape, wavelength is not None, method)

    def horizon(self, place, azimuths=1440, *, frame=None, terrain=True, objects=True, hide=(), without=(), deadline=None,
                method="exact", resolution=None, progress=None):
        """Measures the horizon around a place by rays in double precision. Returns a Horizon: at each of `azimuths` (1 to
        a million) evenly spaced azimuths the greatest elevation at which a ray meets an obstacle, to 1e-6 degrees.

        place: one place, as for line_of_sight(): a Site, a Frame, a path, or a point (3,) in `frame`. North is that of the
        terrain below the place; without terrain the Y axis of the place's frame, whose Z axis is up. terrain, objects,
        hide, without, deadline and errors: as for line_of_sight(). method: "exact"; "image", by four pictures of 90 degrees, or
        "both": image_elevation_deg and more beside the exact results. resolution: pixels along a side of a picture. progress: as for
        line_of_sight()."""
        about = "horizon"
        command = self._scene._command()
        message = command.horizon
        put_measuring(self._scene, message.measuring, about, terrain, objects, hide, deadline, method, resolution)
        put(message, about, azimuths=azimuths)
        if integer(azimuths, "azimuths", about) < 1:
            reject(about, "azimuths", azimuths, "1 to 1000000")
        message.without_object.extend(object_ids(self._scene, without, about))
        places = self._places(place, "the place", frame, about)
        if places.shape != ():
            raise InvalidArgument(f"{about}: the place has the shape {places.shape}; accepted: one place", about)
        places.put(0, message, "place", "site")
        reply = measure(self._scene, command, message.measuring, about, progress).horizon
        cache, origin = {0: None}, getattr(reply, "from")
        objects = np.array([self._cached(cache, id) for id in reply.object], dtype=object)
        image = np.array(reply.image_elevation_deg) if method != "exact" else None
        elevation, distance, point = (np.array(values) for values in (reply.elevation_deg, reply.distance, reply.point))
        seen = {}
        if method != "exact":
            seen = {"image_distance": np.array(reply.image_distance), "image_point": np.array(reply.image_point).reshape(-1, 3),
                    "image_cameras": tuple(_pose_of(pose) for pose in reply.image_camera)}
        if method == "image":
            elevation, distance, point = image.copy(), seen["image_distance"].copy(), seen["image_point"].copy()
            objects = np.full(azimuths, None)
        return Horizon(np.arange(azimuths) * (360.0 / azimuths), elevation, distance, point.reshape(-1, 3), objects,
                       np.array([origin.x, origin.y, origin.z]), reply.first_deg if reply.HasField("first_deg") else None, image,
                       reply.image_pixel_deg if method != "exact" else None, method=method, **seen)

    # --- Arguments -----------------------------------------------------------------------------

    def _places(self, place, what, frame, about):
        if isinstance(place, Site):
            self._scene._require_own(place.terrain, f"terrain {place.terrain.name!r}", about)
            return _Sites(place)
        if isinstance(place, (np.ndarray, list, tuple)):
            points = array_of(place, what, PLACE, about)
            if points.shape[-1:] != (3,):
                raise InvalidArgument(f"{about}: {what} has the shape {points.shape}; accepted: {PLACE}", about)
            return _Points(points, self._scene._frame_id(frame))
        if place is None:
            reject(about, what, place, PLACE, WrongType)
        return _Points(np.zeros(3), self._scene._frame_id(place))

    # --- Results -------------------------------------------------------------------------------

    def _cached(self, cache, id):
        if id and cache.get(id) is None:
            cache[id] = self._scene._object(id)
        return cache[id]

    def _lines(self, reply, shape, waves, method):
        sights = reply.sight
        cache = {0: None}
        point = np.array([[s.point.x, s.point.y, s.point.z] if not s.clear else [np.nan] * 3 for s in sights])

        def of(values, kind=float):
            array = np.array(values, dtype=kind).reshape(shape)
            return array[()] if shape == () and kind is object else array.item() if shape == () else array
        return LinesOfSight(of([s.clear for s in sights], bool), of([s.terrain for s in sights], object),
                            of([self._cached(cache, s.object) for s in sights], object), point.reshape(shape + (3,)),
                            of([s.distance for s in sights]), of([s.range for s in sights]),
                            of([s.clearance for s in sights]), of([s.clearance_deg for s in sights]),
                            of([s.fresnel_free for s in sights]) if waves and method != "image" else None,
                            of([s.image_clear for s in sights], bool) if method != "exact" else None,
                            reply.image_pixel_deg if method != "exact" else None)


def _pose_of(message):
    p, q = message.position, message.rotation
    return Pose((p.x, p.y, p.z), (q.w, q.x, q.y, q.z))


class _Points:
    """Points of one frame."""

    def __init__(self, points, frame):
        self._points, self._frame = points, frame
        self.shape = points.shape[:-1]

    def spread(self, shape):
        return _Points(np.broadcast_to(self._points, shape + (3,)).reshape(-1, 3), self._frame)

    def put(self, i, message, place, _):
        field = getattr(message, place)
        field.frame = self._frame
        field.position.x, field.position.y, field.position.z = map(float, self._points.reshape(-1, 3)[i])


class _Sites:
    """The points of a Site."""

    def __init__(self, site, arrays=None):
        self._site = site
        self._arrays = arrays or (site.x, site.y, site.height)
        self.shape = self._arrays[0].shape

    def spread(self, shape):
        return _Sites(self._site, tuple(np.broadcast_to(array, shape).reshape(-1) for array in self._arrays))

    def put(self, i, message, _, site):
        field = getattr(message, site)
        field.terrain = self._site.terrain.name
        field.map_x, field.map_y, field.height = (float(array.reshape(-1)[i]) for array in self._arrays)
