"""Sunlit areas and the power of solar cells in a scene."""
import numpy as np

from dspace._core.fields import flag, integer, items, put_given, real, reject
from dspace.errors import WrongType
from dspace.measure.obstacles import object_ids, put_measuring
from dspace.measure.plans import ProjectedAreas
from dspace.measure.results import LitArea
from dspace.measure.scene_places import ScenePlace
from dspace.measure.work import measure

MOST_OBJECTS = 10_000


class Lit:
    """Measures sunlit areas for a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def lit_area(self, objects, *, parts=(), sun=None, efficiency=1.0, both_sides=False, samples=4096, terrain=True,
                 obstacles=True, hide=(), without=(), deadline=None, method="exact", resolution=None,
                 progress=None):
        """Measures the sunlit area of objects and the power of solar cells on them, by rays in double precision. Returns
        LitArea.

        objects: one object (or its name), for numbers, or a list of up to 10,000, for arrays (n,). parts: names of parts of
        the objects, such as the solar cells of a model; default: all. both_sides=True: both sides of faces count, and the
        area is twice as large; default: the front, from which the corners run counter-clockwise.

        sun: a dict with the arguments of Sun.set(), such as dict(azimuth_deg=90, elevation_deg=5); default: the scene's Sun.
        efficiency: of the cells, 0 to 1. The power is the irradiance times the area projected towards the Sun times the
        efficiency. The temperature of cells does not count.

        From `samples` places of each object (1 to a million, spread over its faces, at least one on each), rays run to 16
        points of the Sun's disc. The lit fraction of a face of which a straight shadow hides a part is off by some
        1/samples**0.75. Shadows are those of the objects themselves, of other objects (obstacles=False: none) and of all
        terrains (terrain=False: none); hide, without, deadline and progress: as for line_of_sight(). A place below the ground
        is dark. While a body of the scene stands before a body that is the Sun (Scene.add_body), the part of the disc that it
        leaves at the middle of each object is a factor of the results (LitArea.sun_left), unless `sun` is given.

        method: "exact"; "image", by a parallel picture from the Sun of `resolution` pixels a side (default 2048), or "both":
        image_projected_area beside the exact results. The picture takes the Sun as a point, and both sides of faces.

        Raises dspace.InvalidArgument for terrain, for objects whose faces have no area or are not shown, and for a scene without
        a Sun; dspace.NotFound for unknown parts; dspace.DeadlineExceeded."""
        about = "lit area"
        command = self._scene._command()
        message = command.lit_area
        single = isinstance(objects, str) or not isinstance(objects, (list, tuple, set, frozenset, np.ndarray))
        ids = object_ids(self._scene, [objects] if single else objects, about)
        if not 1 <= len(ids) <= MOST_OBJECTS:
            reject(about, "the number of objects", len(ids), f"1 to {MOST_OBJECTS}")
        put_measuring(self._scene, message.measuring, about, terrain, obstacles, hide, deadline, method, resolution)
        message.object.extend(ids)
        for part in items([parts] if isinstance(parts, str) else parts, "parts", about, "names of parts"):
            if not isinstance(part, str):
                reject(about, "the part", part, "a name", WrongType)
            message.part.append(part)
        message.without_object.extend(object_ids(self._scene, without, about))
        message.both_sides = flag(both_sides, "both_sides", about)
        put_given(message, about, efficiency=efficiency, samples=samples)
        if samples == 0:
            reject(about, "samples", samples, "1 to 1000000")
        if sun is not None:
            if not isinstance(sun, dict):
                reject(about, "the Sun", sun, "a dict with arguments of Sun.set()", WrongType)
            self._scene.sun._fill(message.sun, sun)
        reply = measure(self._scene, command, message.measuring, about, progress).lit_area

        def of(name):
            values = np.array([getattr(surface, name) for surface in reply.surface])
            return float(values[0]) if single else values
        things = [self._scene._object(surface.object) for surface in reply.surface]
        return LitArea(things[0] if single else things, of("area"), of("lit_area"), of("projected_area"), of("power"),
                       reply.irradiance, np.array([reply.sun.x, reply.sun.y, reply.sun.z]),
                       of("image_projected_area") if method != "exact" else None,
                       of("image_pixel_area") if method != "exact" else None, of("sun_left"))

    def projected_areas(self, objects, place, *, azimuths=72, lowest=-5.0, highest=90.0, rows=20, parts=(), efficiency=1.0,
                        both_sides=False, samples=512, hide=(), without=(), progress=None):
        """Measures the lit area of objects, projected towards the Sun, for suns all around a place. Returns ProjectedAreas, which
        power_profile() takes as a panel: so a profile over years has the shadows of the vehicle and the habitat.

        objects, parts, both_sides, samples (of each object), hide, without: as for lit_area(). place: a Site, or a Frame or its path,
        as power_profile() gets it: its north and vertical count. azimuths (1 to 3600) times rows (2 to 1000) directions, at elevations
        from lowest to highest [deg]. The Sun is a point; terrain throws no shadow here: the profile's mask does. What turns with the
        time keeps its present pose. efficiency: of the cells, 0 to 1.

        progress(fraction): called after each row; what it raises ends the work."""
        about = "projected areas"
        single = isinstance(objects, str) or not isinstance(objects, (list, tuple, set, frozenset, np.ndarray))
        objects = [objects] if single else items(objects, "the objects", about, "objects, or their names")
        object_ids(self._scene, objects, about)  # rejects what is none
        if not 0.0 <= real(efficiency, "the efficiency", about) <= 1.0:
            reject(about, "the efficiency", efficiency, "0 to 1")
        if progress is not None and not callable(progress):
            reject(about, "progress", progress, "a function, or None", WrongType)
        if not 1 <= integer(azimuths, "azimuths", about) <= 3600:
            reject(about, "azimuths", azimuths, "1 to 3600")
        if not 2 <= integer(rows, "rows", about) <= 1000:
            reject(about, "rows", rows, "2 to 1000")
        if not -90.0 <= real(lowest, "lowest", about) < real(highest, "highest", about) <= 90.0:
            reject(about, "the elevations", (lowest, highest), "ascending, -90 to 90")
        where = ScenePlace(self._scene, place, "the place", about)
        axes = where.axes(where.position(), meridian=True)
        area = np.empty((rows, azimuths))
        for row, elevation in enumerate(np.radians(np.linspace(lowest, highest, rows))):
            for column, azimuth in enumerate(np.radians(np.arange(azimuths) * (360.0 / azimuths))):
                towards = np.array((np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation))) @ axes
                lit = self.lit_area(objects, parts=parts, sun={"direction": towards, "radius_deg": 0.0}, both_sides=both_sides,
                                    samples=samples, terrain=False, hide=hide, without=without)
                area[row, column] = lit.projected_area.sum()
            if progress is not None:
                progress((row + 1) / rows)
        return ProjectedAreas(area, float(lowest), float(highest), efficiency)
