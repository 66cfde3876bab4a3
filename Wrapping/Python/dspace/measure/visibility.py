"""What a place sees of moving bodies over a span of time: contacts, and the power of panels."""
import numpy as np

from dspace._core import wire
from dspace._core.fields import array_of, flag, items, put, put_given, put_vector, real, reject, text, word
from dspace.errors import InvalidArgument, WrongType
from dspace.frames.frame import Frame
from dspace.measure.plans import Battery, BodySite, Orbiter, Panel, ProjectedAreas
from dspace.measure.results import Contact, Horizon, Moment, PowerProfile, SkyTrack
from dspace.measure.work import measure
from dspace.sky.places import put_place
from dspace.terrain.site import Site
from dspace.trajectories.states import put_path

PLACE = "a Site, a BodySite, a Frame or the path of one"
TARGET = "a name or NAIF id of a body, a BodySite, an Orbiter, a Frame or the path of one with a '/'"
TRACKING = {"fixed": 0, "vertical": 1, "full": 2}  # ProfilePower.Panel.Tracking


class Visibility:
    """Measures over spans of time for a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def sky_track(self, place, target, times, *, body=None, progress=None):
        """Returns the direction and range of a target over a place at many times: a SkyTrack.

        place: a Site (Terrain.site, of one point) above terrain with longitudes and latitudes, a BodySite, or a Frame that
        follows the time or hangs on one (or its path), whose axes are X east, Y north, Z up. The scene and its time do not
        change. body: of a Site: a name or NAIF id; default: the one that the terrain's CRS names. target: the name or NAIF
        id of a body or spacecraft (its centre); a BodySite of another body; an Orbiter; or a Frame (or its path, with a "/": "/rover") that
        follows the time, hangs on one that does, or moves along a Trajectory below one. times: seconds past J2000 TDB, a number or an array
        of one dimension, at most 2,000,000.

        progress: as for line_of_sight().

        Directions have light time and stellar aberration, without refraction."""
        about = "sky track"
        command = self._scene._command()
        message = command.track_sky
        self._put_place(message.place, place, body, about)
        self._put_target(message.target, target, 0.0, about)
        array = array_of(times, "the times", "seconds past J2000 TDB: a number or an array of one dimension", about)
        if array.ndim > 1 or not array.size:
            raise InvalidArgument(f"{about}: the times have the shape {array.shape}; accepted: one dimension, at least one", about)
        wire.put_array(message, "time_s", array.reshape(-1))
        found = wire.get_arrays(measure(self._scene, command, message, about, progress).sky_track, "azimuth_deg", "elevation_deg", "range", "time_s")
        if array.ndim == 0:
            found = [float(values[0]) for values in found]
        return SkyTrack(target, found[3], *found[:3])

    def contacts(self, place, targets, start, end, *, step=60.0, mask=0.0, station_mask=0.0, upper=False, body=None,
                 deadline=None, progress=None):
        """Finds when targets stand above the horizon of a place. Returns a list of Contact, by target and time.

        place, body: as for sky_track(). targets: one or a list (at most 1,000) of what sky_track() takes: names or NAIF ids of
        bodies and spacecraft; a BodySite, a station of another body, such as dspace.BodySite("earth", -116.89, 35.43, 1000.0); an
        Orbiter, such as dspace.Orbiter("orbit.oem"); Frames.
        start, end: seconds past J2000 TDB, or texts as for tdb().

        mask: the horizon of the place: one elevation [deg], a Horizon (Scene.horizon), or elevations at evenly spaced
        azimuths, clockwise from north. station_mask [deg]: the least elevation of the place over a station's horizontal.
        upper=True: the top of a body's disc counts, as for sunrise; else its centre. Bodies do not hide a target: the mask does.

        Rise and set are found by samples every `step` seconds (at most 2,000,000) and bisection, to 1 ms. Contacts and gaps
        shorter than a step are found too, unless two of them lie within two steps. deadline: longest time [s]. progress: as for
        line_of_sight().

        Raises dspace.InvalidArgument for an end that is not after the start; dspace.NotFound for unknown bodies;
        dspace.DeadlineExceeded."""
        about = "contacts"
        command = self._scene._command()
        message = command.find_contacts
        self._put_place(message.place, place, body, about)
        single = isinstance(targets, (str, int, BodySite, Orbiter, Frame))
        targets = [targets] if single else items(targets, "the targets", about, f"a list of {TARGET}")
        for target in targets:
            self._put_target(message.target.add(), target, station_mask, about, flag(upper, "upper", about))
        self._put_span(message, start, end, step, about)
        self._put_mask(message.mask, mask, about)
        put_given(message, about, deadline_s=deadline)

        def moment(at):
            return Moment(at.time_s, at.azimuth_deg, at.elevation_deg, at.range)
        return [Contact(targets[c.target], moment(c.rise), moment(c.set), moment(c.peak), c.since_before, c.until_after)
                for c in measure(self._scene, command, message, about, progress).contacts.contact]

    def power_profile(self, place, panels, start, end, *, step=3600.0, mask=0.0, battery=None, body=None, deadline=None,
                      progress=None):
        """Computes the power of solar panels at a place over a span of time. Returns a PowerProfile.

        place, body, mask, deadline, progress: as for contacts(). panels: a Panel, a ProjectedAreas, or a list of them (at most 10,000). battery: a Battery;
        default: none. start, end, step: the power is linear between the samples, of which there are at most 2,000,000.

        The irradiance is 1361 W/m^2 at 1 au, times the part of the Sun's disc above the horizon. The disc is of even radiance.
        The temperature of cells, light from the ground and atmospheres do not count; shadows of the vehicle itself do with
        ProjectedAreas only. Over the Moon
        the Earth eclipses the Sun, and over the Earth the Moon, as discs of their largest radii: beside the Earth's limb the light
        is then off by up to 1 % of the disc. Nights are found as contacts() finds them, by the horizon alone, to 1 ms."""
        about = "power profile"
        command = self._scene._command()
        message = command.profile_power
        self._put_place(message.place, place, body, about)
        panels = [panels] if isinstance(panels, (Panel, ProjectedAreas)) else items(panels, "the panels", about, "dspace.Panel")
        if not panels:
            raise InvalidArgument(f"{about}: there is no panel; accepted: a dspace.Panel or a list of them", about)
        for panel in panels:
            if not isinstance(panel, (Panel, ProjectedAreas)):
                reject(about, "the panel", panel, "a dspace.Panel or dspace.ProjectedAreas", WrongType)
            out = message.panel.add()
            if isinstance(panel, ProjectedAreas):
                _put_areas(out, panel, about)
                continue
            put(out, about, area=panel.area, efficiency=panel.efficiency)
            if not -90.0 <= real(panel.elevation_deg, "the panel's elevation_deg", about) <= 90.0:
                reject(about, "the panel's elevation_deg", panel.elevation_deg, "-90 to 90")
            out.tracking = word(panel.tracking, TRACKING, "the tracking", about)
            put_vector(out.normal, panel.normal, "the normal", about)
        if battery is not None:
            if not isinstance(battery, Battery):
                reject(about, "the battery", battery, "a dspace.Battery", WrongType)
            put(message.battery, about, capacity_wh=battery.capacity_wh, load=battery.load, charge=battery.charge,
                charging=battery.charging)
        self._put_span(message, start, end, step, about)
        self._put_mask(message.mask, mask, about)
        put_given(message, about, deadline_s=deadline)
        reply = measure(self._scene, command, message, about, progress).power_profile
        arrays = [np.array(getattr(reply, name)) for name in ("time_s", "sun_azimuth_deg", "sun_elevation_deg", "lit", "power")]
        charge = np.array(reply.charge) if battery is not None else None
        return PowerProfile(*arrays, charge, reply.lit_share, reply.energy / 3600.0, reply.longest_night_s, reply.night_start_s,
                            reply.least_charge if battery is not None else None, reply.empty_s, reply.missing / 3600.0)

    # --- Arguments -----------------------------------------------------------------------------

    def _put_place(self, message, place, body, about):
        if isinstance(place, Site):
            if place.shape != ():
                raise InvalidArgument(f"{about}: the place has the shape {place.shape}; accepted: one place", about)
            self._scene._require_own(place.terrain, f"terrain {place.terrain.name!r}", about)
            put(message.site, about, terrain=place.terrain.name, map_x=float(place.x), map_y=float(place.y),
                height=float(place.height))
            if body is not None:
                message.body = text(str(body), "the body", about)
            return
        if body is not None:
            reject(about, "the body", body, "it with a Site")
        if isinstance(place, BodySite):
            put_place(message.celestial, place.body, None, (place.longitude_deg, place.latitude_deg, place.height),
                      place.geodetic, about)
            return
        if place is None:
            reject(about, "the place", place, PLACE, WrongType)
        message.place.frame = self._scene._frame_id(place)

    def _put_target(self, message, target, station_mask, about, upper=False):
        if isinstance(target, BodySite):
            put_place(message, target.body, None, None, False, about)
            put(message.station, about, longitude_deg=target.longitude_deg, latitude_deg=target.latitude_deg,
                height=target.height, geodetic=target.geodetic)
            put(message, about, station_mask_deg=station_mask)
            return
        if isinstance(target, Orbiter):
            if target.body is not None:
                message.body = text(str(target.body), "the orbiter's body", about)
            if target.axes is not None:
                message.axes = text(target.axes, "the orbiter's axes", about, "the name of a reference frame")
            put_path(message.path, target.path, "orbiter")
            return
        if isinstance(target, Frame) or isinstance(target, str) and "/" in target:
            message.at.frame = self._scene._frame_id(target if isinstance(target, Frame) else target.lstrip("/"))
            return
        if isinstance(target, int) and not isinstance(target, bool):
            target = str(target)
        message.body = text(target, "the target", about, TARGET)
        message.upper = upper

    def _put_span(self, message, start, end, step, about):
        start, end = (self._scene.tdb(time) if isinstance(time, str) else time for time in (start, end))
        put(message, about, start_s=start, end_s=end, step_s=step)
        if not message.start_s < message.end_s:
            start, end = (f"{self._scene.time_text(each)} ({each:.3f} s past J2000 TDB)" if np.isfinite(each) else each
                          for each in (message.start_s, message.end_s))
            raise InvalidArgument(f"{about}: the span runs from {start} to {end}; accepted: an end after the start", about)
        if step == 0:
            reject(about, "the step", step, "above 0 s")

    def _put_mask(self, message, mask, about):
        if isinstance(mask, Horizon):
            put(message, about, first_deg=mask.first_deg or 0.0)
            mask = mask.elevation_deg
        array = array_of(mask, "the mask", "an elevation [deg], a Horizon, or elevations at evenly spaced azimuths", about)
        if array.ndim > 1:
            raise InvalidArgument(f"{about}: the mask has the shape {array.shape}; accepted: a number, or one dimension", about)
        wire.put_array(message, "elevation_deg", array.reshape(-1))


def _put_areas(message, panel, about):
    array = array_of(panel.area, "the areas", "an array (rows, azimuths) [m^2]", about)
    if array.ndim != 2 or not array.size:
        raise InvalidArgument(f"{about}: the areas have the shape {array.shape}; accepted: (rows, azimuths), at least one", about)
    put(message, about, efficiency=panel.efficiency)
    message.projected.azimuths = array.shape[1]
    put(message.projected, about, lowest_deg=panel.lowest_deg, highest_deg=panel.highest_deg)
    wire.put_array(message.projected, "area", array.reshape(-1))
