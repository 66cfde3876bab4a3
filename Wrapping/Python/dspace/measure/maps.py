"""Maps of horizons, viewsheds and illumination over terrain."""
import pathlib
import time

import numpy as np

from dspace._core.fields import array_of, file_path, flag, items, put, real, reject, text
from dspace.errors import DeadlineExceeded, InvalidArgument, WrongType
from dspace.measure.map_file import MapFile
from dspace.measure.plans import BodySite
from dspace.terrain.site import Site
from dspace.terrain.terrain import Terrain

WAIT_S = 0.2  # of one request: the session is free between two
VIEWED = ("visible", "least_height", "count")  # Viewshed.Quantity
LIT = ("lit_fraction", "longest_night", "earth_fraction", "permanent_shadow", "station_fraction")  # IlluminationMap.Quantity


class Maps:
    """Makes maps for a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def horizon_map(self, terrain, path, *, height=0.0, azimuths=360, extent=None, cell_size=0.0, fast=False, replace=False,
                    threads=0, progress=None, deadline=None):
        """Writes the horizon of every cell of a grid over a terrain to a GeoTIFF: a band per azimuth, elevations [deg] of the
        highest ground over the plane that is normal to the local vertical, -90 where nothing is in sight, NaN without data.
        Returns a MapFile.

        terrain: a Terrain or its name. Its ground, with the body's curvature where it is on its body, is the only obstacle.
        path: of a new file (on the server's disk with a RemoteSession). height: of the observers above the ground [m], 0 to
        1e6. azimuths: evenly spaced, 1 to 3600, clockwise from true north, and from the map's Y axis on a plane and in a polar
        projection (MapFile.first_deg).
        extent: map coordinates (left, top, right, bottom); default: the whole terrain. cell_size: in map units, brought to a
        whole number of the terrain's posts, 1 to 64; 0: the terrain's pixels. fast=True: in about two thirds of the time, to some
        half a degree where slopes are up to 0.3; default: to 0.01 degrees.

        The work runs in `threads` of its own (0: as many as the processor runs at once). progress: a function that is
        called with the done fraction and the estimated seconds left. Where Ctrl-C, an exception of progress, or the
        deadline [s] ends the work, "PATH.part" and "PATH.part.done" stay, and the same call continues them: the result is
        the same to the byte. replace=True: an existing file, and a partial one of other inputs, are removed first.

        Raises dspace.AlreadyExists for an existing file, for a partial one of other inputs and for one that another
        process writes; dspace.Resource for a map that does not fit the disk; dspace.InvalidArgument; dspace.DeadlineExceeded."""
        about = "horizon map"
        command = self._scene._command()
        message = command.horizon_map
        message.terrain = self._terrain(terrain, about)
        put(message, about, height=height, azimuths=azimuths)
        if azimuths == 0:
            reject(about, "azimuths", azimuths, "1 to 3600")
        message.fast = flag(fast, "fast", about)
        _put_area(message.area, about, extent, cell_size)
        bands = [f"azimuth {360.0 * k / azimuths:.9g} deg" for k in range(azimuths)]
        return self._make(command, message, about, path, bands, replace, threads, progress, deadline)

    def viewshed(self, sites, path, *, target_height=0.0, radius=None, quantities=("visible",), extent=None, cell_size=0.0,
                 replace=False, threads=0, progress=None, deadline=None):
        """Writes what is seen from one site, or from several together, to a GeoTIFF. Returns a MapFile.

        sites: a Site (Terrain.site) of one point or of many, up to 10,000. target_height: of the targets above the ground
        of each cell [m]. radius: greatest distance along the ground [m]; default: no limit. quantities: one or more of
        "visible" (1: a site sees the target; 0: none does), "least_height" [m] (of the lowest target above the ground that
        a site would see) and "count" (of the sites that see the target); a band each. NaN without ground and beyond the
        radius. The lines of sight are exact in double precision over the terrain's triangles; its ground is the only
        obstacle. Paint it on the terrain with terrain.add_false_color(path).

        The other arguments and errors are those of horizon_map()."""
        about = "viewshed"
        if not isinstance(sites, Site):
            reject(about, "sites", sites, "a Site: terrain.site(x, y, height)", WrongType)
        self._scene._require_own(sites.terrain, f"terrain {sites.terrain.name!r}", about)
        command = self._scene._command()
        message = command.viewshed
        for x, y, height in zip(sites.x.reshape(-1), sites.y.reshape(-1), sites.height.reshape(-1)):
            site = message.site.add()
            site.terrain = sites.terrain.name
            site.map_x, site.map_y, site.height = float(x), float(y), float(height)
        put(message, about, target_height=target_height)
        if radius is not None:
            if not real(radius, "radius", about) > 0.0:
                reject(about, "radius", radius, "more than 0 m, or None")
            put(message, about, radius=radius)
        quantities = _put_quantities(message, quantities, VIEWED, about)
        _put_area(message.area, about, extent, cell_size)
        return self._make(command, message, about, path, quantities, replace, threads, progress, deadline)

    def illumination_map(self, horizons, path, *, start=None, end=None, step=3600.0, quantities=("lit_fraction",),
                         terrain=None, body=None, sun=None, earth=None, stations=(), station_mask=0.0, eclipses=True,
                         replace=False, threads=0, progress=None, deadline=None):
        """Writes how the cells of a horizon map are lit over a time to a GeoTIFF. Returns a MapFile.

        horizons: the MapFile of horizon_map(), or its path. start, end: times, as text (Scene.tdb) or seconds past J2000
        TDB; step: [s]. The steps are start, start + step, ... before the end. quantities: one or more of "lit_fraction" (of
        the time, 0 to 1: the mean of the visible part of the Sun's disc), "longest_night" ([s] with the disc completely
        hidden: consecutive steps times the step), "earth_fraction" (of the time that the Earth's centre is above the
        horizon), "permanent_shadow" (1: the disc is hidden at every step) and "station_fraction" (of the time that one of `stations`
        has the cell in sight: direct to the Earth).

        terrain: a Terrain or its name; a map of another ground is then rejected. body: that the map lies on; default: the
        one that its CRS names. sun, earth: arrays (n, 3) of the centres [m] at every step in the terrain's frame, in place
        of start, end and the ephemeris; earth only with sun. eclipses: the Earth eclipses the Sun over the Moon, and the
        Moon over the Earth, as discs of their largest radii, in "lit_fraction": an eclipse is no night, and no shadow.
        With sun nothing eclipses it.

        stations: up to 100 BodySites on the Earth, for "station_fraction". One has a cell in sight while it stands above the
        cell's horizon, and the middle of the map is station_mask [deg] or more over the station's horizontal.

        On a plane the Sun's direction is that at the middle of the map. Where nothing is in sight, and on a plane below
        0, the horizon is level. The other arguments and errors are those of horizon_map()."""
        about = "illumination map"
        command = self._scene._command()
        message = command.illumination_map
        message.horizon_path = file_path(horizons.path if isinstance(horizons, MapFile) else horizons, "the horizon map", about)
        if terrain is not None:
            message.terrain = self._terrain(terrain, about)
        if body is not None:
            message.body = text(body, "the body", about)
        if not real(step, "step", about) > 0.0:
            reject(about, "step", step, "more than 0 s")
        message.step_s = step
        if (sun is None) == (start is None or end is None):
            raise InvalidArgument(f"{about}: start, end and sun are {start!r}, {end!r} and {'given' if sun is not None else None}; "
                                  "accepted: start and end, or sun", about)
        if sun is None:
            message.start_s, message.end_s = self._time(start, "start", about), self._time(end, "end", about)
        else:
            message.sun_position.extend(_places(sun, "sun", about))
        if earth is not None:
            message.earth_position.extend(_places(earth, "earth", about))
        for station in [stations] if isinstance(stations, BodySite) else items(stations, "the stations", about, "dspace.BodySites"):
            if not isinstance(station, BodySite) or str(station.body).lower() not in ("earth", "399"):
                reject(about, "a station", station, "a dspace.BodySite on the Earth", WrongType)
            put(message.station.add(), about, longitude_deg=station.longitude_deg, latitude_deg=station.latitude_deg,
                height=station.height, geodetic=station.geodetic)
        put(message, about, station_mask_deg=station_mask)
        message.eclipses = flag(eclipses, "eclipses", about)
        quantities = _put_quantities(message, quantities, LIT, about)
        return self._make(command, message, about, path, quantities, replace, threads, progress, deadline)

    # --- Work ----------------------------------------------------------------------------------

    def _make(self, command, message, about, path, bands, replace, threads, progress, deadline):
        file = message.file
        file.path = file_path(path, "the path", about)
        if pathlib.PurePath(file.path).suffix.lower() not in (".tif", ".tiff"):
            reject(about, "the path", file.path, "a GeoTIFF, a name with .tif or .tiff")
        file.replace = flag(replace, "replace", about)
        put(file, about, threads=threads)
        if deadline is not None and not real(deadline, "deadline", about) > 0.0:
            reject(about, "deadline", deadline, "more than 0 s, or None")
        if progress is not None and not callable(progress):
            reject(about, "progress", progress, "a function, or None", WrongType)
        file.wait_s = WAIT_S
        last = np.inf if deadline is None else time.monotonic() + deadline
        while True:
            reply = self._request(command, file)
            try:
                if progress is not None:
                    progress(reply.fraction, reply.left_s)
                if reply.complete:
                    return MapFile(reply.path, reply.columns, reply.rows, tuple(bands), reply.cell_size)
                if time.monotonic() >= last:
                    raise DeadlineExceeded(f"{about}: {100.0 * reply.fraction:.1f} % of it is done at its deadline of {deadline} "
                                           "s; accepted: a later deadline; the same call continues it", about)
            except BaseException:
                self._cancel(command, file)
                raise

    def _request(self, command, file):
        try:
            return self._scene._execute(command).map
        except KeyboardInterrupt:
            self._cancel(command, file)
            raise

    def _cancel(self, command, file):
        file.cancel = True
        self._scene._execute(command)

    # --- Arguments -----------------------------------------------------------------------------

    def _terrain(self, terrain, about):
        if isinstance(terrain, Terrain):
            self._scene._require_own(terrain, f"terrain {terrain.name!r}", about)
            return terrain.name
        return text(terrain, "the terrain", about, "a dspace.Terrain or its name")

    def _time(self, value, what, about):
        return self._scene.tdb(value) if isinstance(value, str) else real(value, what, about, "a time as text, or seconds")


def _put_area(area, about, extent, cell_size):
    area.SetInParent()
    put(area, about, cell_size=cell_size)
    if extent is not None:
        edges = array_of(extent, "the extent", "left, top, right, bottom", about)
        if edges.shape != (4,):
            reject(about, "the extent", extent, "left, top, right, bottom in map coordinates")
        area.extent.extend(edges.tolist())


def _put_quantities(message, quantities, known, about):
    chosen = [quantities] if isinstance(quantities, str) else list(items(quantities, "quantities", about, "a list of words"))
    for quantity in chosen:
        if quantity not in known:
            reject(about, "a quantity", quantity, ", ".join(known))
    if not chosen:
        reject(about, "quantities", quantities, "one or more of " + ", ".join(known))
    descriptor = message.DESCRIPTOR.enum_types_by_name["Quantity"]
    message.quantity.extend(descriptor.values_by_name[quantity.upper()].number for quantity in chosen)
    return chosen


def _places(places, what, about):
    array = array_of(places, what, "an array (n, 3) of places [m]", about)
    if array.ndim != 2 or array.shape[1] != 3 or not len(array):
        raise InvalidArgument(f"{about}: {what} has the shape {array.shape}; accepted: (n, 3)", about)
    return array.reshape(-1).tolist()
