"""Kernels, reference frames and the sky of a scene."""
import collections

import numpy as np

from dspace._core import wire
from dspace._core.fields import array_of, file_path, flag, integer, items, put, real, reject, text, word
from dspace._core.strict import Strict
from dspace.errors import InvalidArgument, WrongType
from dspace.sky.places import put_place

# One step of Frames.explain: `frame` is given against `relative` by `source`, whose stated accuracy is `accuracy`.
FrameStep = collections.namedtuple("FrameStep", "frame relative source accuracy")
# A body in the sky: azimuth clockwise from north, elevation, angular radius of the disc [deg], range [m], lit
# fraction of the disc; the Sun's: what an eclipse by the Earth (over the Moon) or the Moon (over the Earth) leaves of it.
SkyBody = collections.namedtuple("SkyBody", "name azimuth_deg elevation_deg range radius_deg lit_fraction")
# A point of a body: longitude (east), planetocentric and geodetic latitude [deg], position [m] in the body-fixed axes;
# arrays where several times were asked for.
SubPoint = collections.namedtuple("SubPoint", "longitude_deg latitude_deg geodetic_latitude_deg position frame")
# What kernels contain: see Kernels.
KernelFrame = collections.namedtuple("KernelFrame", "name id kind center kernel")
KernelClock = collections.namedtuple("KernelClock", "id begin_s end_s")
KernelInstrument = collections.namedtuple("KernelInstrument", "id shape frame boresight boundary")
KernelSegment = collections.namedtuple("KernelSegment", "file kind name body center frame type begin_s end_s")
KernelConflict = collections.namedtuple("KernelConflict", "name winner loser")
KernelContent = collections.namedtuple("KernelContent", "file kind variables items")


def _times(times, about):
    """Times as a flat array; None: none given. Also whether it was one number."""
    if times is None:
        return np.empty(0), True
    array = array_of(times, "the times", "seconds past J2000 TDB: a number or an array of one dimension", about)
    if array.ndim > 1:
        raise InvalidArgument(f"{about}: the times have shape {array.shape}; accepted: one dimension", about)
    if array.ndim == 1 and not array.size:
        raise InvalidArgument(f"{about}: there are no times; accepted: at least one", about)
    return array.reshape(-1), array.ndim == 0


class Kernels(Strict):
    """The SPICE kernels of a scene: SPK, binary PCK, CK (attitude) and text kernels (PCK, LSK, FK, IK, SCLK,
    meta-kernels), in the order of loading. What is loaded later wins. After all kernels come JPL's DE405 (1960 to 2060,
    where Debian's casacore-data-jpl-de405 is installed) and ERFA. A table of the IERS, finals2000A or EOP C04, is loaded
    as a kernel, too: UT1 and polar motion, for times in UT1 and for ITRF93. The last one alone is used.

        scene.kernels.load("moon_080317.tf", "moon_pa_de421_1900-2050.bpc")
    """

    def __init__(self, scene):
        self._scene = scene

    def _list(self):
        return self._scene._ask("list_kernels").kernels

    def load(self, *paths):
        """Loads kernels; all or none. A kernel that is loaded already is moved to the end."""
        command = self._scene._command()
        command.load_kernels.path.extend(file_path(path, "the path", "kernel") for path in paths)
        if not paths:
            reject("kernels", "the paths", paths, "at least one")
        self._scene._execute(command)

    def unload(self, *paths):
        """Unloads kernels by their paths as `paths` returns them; without arguments all."""
        command = self._scene._command()
        command.unload_kernels.SetInParent()
        command.unload_kernels.path.extend(text(path, "the path", "kernel") for path in paths)
        self._scene._execute(command)

    @property
    def paths(self):
        """As loaded, absolute."""
        return list(self._list().path)

    @property
    def files(self):
        """All files, with those that meta-kernels name."""
        return list(self._list().file)

    @property
    def frames(self):
        """The frames that frame kernels define: name, NAIF id, kind ("PCK", "CK", "TK", ...), centre, file."""
        return [KernelFrame(f.name, f.id, f.kind, f.center, f.kernel) for f in self._list().frame]

    @property
    def clocks(self):
        """Spacecraft clocks: NAIF id, first and last time [s past J2000 TDB]."""
        return [KernelClock(c.id, c.begin_s, c.end_s) for c in self._list().clock]

    @property
    def instruments(self):
        """Fields of view, by NAIF id: shape, frame, boresight (unit), boundary (unit vectors, an array (n, 3)): the
        corners of a rectangle or polygon in order, a vector on the rim of a circle, the semi-axes of an ellipse."""
        return {i.id: KernelInstrument(i.id, i.shape, i.frame,
                                       np.array([i.boresight.x, i.boresight.y, i.boresight.z]),
                                       np.array(i.boundary).reshape(-1, 3)) for i in self._list().instrument}

    @property
    def segments(self):
        """The segments of binary kernels: file, kind ("SPK", "PCK", "CK"), name, body (NAIF id of the target; class id of
        the body-fixed frame; structure), centre, frame, type, first and last time [s past J2000 TDB] (NaN: of a CK whose
        clock is not loaded)."""
        return [KernelSegment(s.file, s.kind, s.name, s.body, s.center, s.frame, s.type, s.begin_s, s.end_s)
                for s in self._list().segment]

    @property
    def contents(self):
        """What text kernels and tables of the IERS contain: file, kind ("LSK", "PCK", "FK", "IK", "SCLK", "MK", "EOP"; "":
        not stated), number of variables, and items in words ("radii of SUN, MERCURY, ...")."""
        return [KernelContent(c.file, c.kind, c.variables, list(c.item)) for c in self._list().content]

    @property
    def conflicts(self):
        """Variables to which two text kernels give different values: name, the file that won, the file that lost."""
        return [KernelConflict(c.name, c.winner, c.loser) for c in self._list().conflict]

    def __repr__(self):
        return f"<dspace.Kernels of scene {self._scene.name!r}>"


class ReferenceFrames(Strict):
    """Reference frames: J2000 and SPICE's other inertial frames, IAU_* (pck00011), MOON_ME and MOON_PA, ITRF93, and the
    frames of loaded kernels (body-fixed, spacecraft, instruments, stations). Case does not matter.

    Without kernels MOON_ME and MOON_PA follow DE405's libration (MOON_ME within 0.28 arcsec of DE421's), and ITRF93
    ERFA's precession and nutation without polar motion. explain() states the source and accuracy of each answer.
    """

    def __init__(self, scene):
        self._scene = scene

    def _turn(self, start, end, times, rates):
        about = "frames"
        command = self._scene._command()
        message = command.turn_frames
        setattr(message, "from", text(start, "the frame to turn from", about, "a name such as 'J2000'"))
        message.to = text(end, "the frame to turn to", about, "a name such as 'J2000'")
        message.rates = rates
        array, single = _times(times, about)
        wire.put_array(message, "time_s", array)
        return self._scene._execute(command).frame_turns, single

    def rotation(self, start, end, times=None):
        """The matrix R that takes components in `start` to those in `end`: v_end = R @ v_start.

        times: seconds past J2000 TDB; None: the scene's time. One time gives an array (3, 3), n times (n, 3, 3)."""
        reply, single = self._turn(start, end, times, False)
        rotation = np.array(reply.rotation).reshape(-1, 3, 3)
        return rotation[0] if single else rotation

    def turn(self, start, end, times=None):
        """(R, dR/dt [1/s]): v_end = R v_start, and for velocities also dR/dt of positions. The rate is NaN where a CK has
        none. As rotation()."""
        reply, single = self._turn(start, end, times, True)
        rotation, rate = (np.array(a).reshape(-1, 3, 3) for a in (reply.rotation, reply.rate))
        return (rotation[0], rate[0]) if single else (rotation, rate)

    def explain(self, start, end, time=None):
        """The frames between two frames at a time, each with its source and accuracy: a list of FrameStep."""
        reply, _ = self._turn(start, end, time, False)
        return [FrameStep(s.frame, s.relative, s.source, s.accuracy) for s in reply.step]

    def sub_solar_point(self, body, times=None, frame=None, observer=None, correction="CN+S"):
        """The point of a body below the Sun: SubPoint. frame: body-fixed; None: MOON_ME, ITRF93 or IAU_*. observer: a
        body that sees it at the time (light time); None: at the time itself. correction: how light shows the Sun to the body,
        and the body to the observer: "NONE", "LT" or "CN" (the same: light time, iterated), "LT+S" or "CN+S"."""
        return self._sub_points(body, times, frame, observer, False, correction)

    def sub_observer_point(self, body, observer, times=None, frame=None, correction="CN+S"):
        """The point of a body below an observer, as it sees it: SubPoint. correction: as sub_solar_point."""
        return self._sub_points(body, times, frame, observer, True, correction)

    def _sub_points(self, body, times, frame, observer, below_observer, correction):
        about = f"body {body!r}"
        command = self._scene._command()
        message = command.find_sub_points
        message.body = text(body, "the body", about)
        message.frame = text("" if frame is None else frame, "the frame", about)
        message.observer = text("" if observer is None else observer, "the observer", about)
        message.below_observer = below_observer
        word(correction, CORRECTIONS, "the correction", about)
        message.correction = correction
        array, single = _times(times, about)
        wire.put_array(message, "time_s", array)
        reply = self._scene._execute(command).sub_points
        point = np.array(reply.point).reshape(-1, 3)
        position = np.array(reply.position).reshape(-1, 3)
        if single:
            return SubPoint(*(float(each) for each in point[0]), position[0], reply.frame)
        return SubPoint(point[:, 0], point[:, 1], point[:, 2], position, reply.frame)

    def __repr__(self):
        return f"<dspace.ReferenceFrames of scene {self._scene.name!r}>"


def sky_of(reply):
    """The bodies of a SkyReply, by name."""
    return {b.name: SkyBody(b.name, b.azimuth_deg, b.elevation_deg, b.range, b.radius_deg, b.lit_fraction)
            for b in reply.sky.body}


def put_targets(scene, message, targets, time, about):
    """Writes the targets (names; a str: one) and the time (None: the scene's) into a SkyState."""
    names = [targets] if isinstance(targets, str) else items(targets, "the targets", about, "names of bodies")
    message.target.extend(text(name, "a target", about, "the name of a body") for name in names)
    if not names:
        reject(about, "the targets", targets, "at least one")
    if time is not None:
        message.time_s = scene.tdb(time) if isinstance(time, str) else real(
            time, "the time", about, "a time as text (Scene.tdb), or seconds past J2000 TDB")


# States of a body: position [m], velocity [m/s], light time [s] (arrays where several times were asked for); warnings and
# sources say where they come from.
States = collections.namedtuple("States", "position velocity light_time sources")
StateSource = collections.namedtuple("StateSource", "body center source accuracy hidden")
CORRECTIONS = {"NONE": 0, "CN": 1, "CN+S": 2, "LT": 3, "LT+S": 4}  # as SPICE names them; numbers of Ephemeris.Correction


class SceneSky:
    """The members of Scene and Terrain about the sky."""

    def __init__(self, scene):
        self._scene = scene

    def sky(self, targets="sun", body=None, site=None, frame=None, position=None, geodetic=False, time=None):
        """Where bodies stand over a place: SkyBody by name, with light time and stellar aberration, without refraction.

        The place: `body` with `site` = longitude (east), latitude [deg] and, if it is not 0, height [m]; or `frame`, a
        frame that follows the time (add_celestial_frame) or one below it, whose axes are X east, Y north, Z up, with a
        `position` [m] in it. geodetic: the latitude is of the ellipsoid's normal, else planetocentric. time: as text
        (Scene.tdb), or seconds past J2000 TDB; None: the scene's."""
        about = "sky"
        command = self._scene._command()
        message = command.sky_state
        put_targets(self._scene, message, targets, time, about)
        if (body is None) == (frame is None):
            reject(about, "body and frame", (body, frame), "one of them")
        if frame is not None:
            if site is not None:
                reject(about, "a site on a frame", site, "a site of a body")
            message.place.frame = self._scene._frame_id(frame)
            if position is not None:
                p = array_of(position, "the position", "x, y, z [m]", about)
                if p.shape != (3,):
                    reject(about, "the position", position, "x, y, z [m]")
                message.place.position.x, message.place.position.y, message.place.position.z = p
        else:
            if position is not None:
                reject(about, "a position without a frame", position, "a frame with it")
            put_place(message.celestial, body, None, (0, 90) if site is None else site, geodetic, about)
        return sky_of(self._scene._execute(command))

    def ephemeris(self, target, observer, times=None, axes="J2000", correction="NONE"):
        """States of a body or spacecraft from another one (names or NAIF ids): States.

        times: seconds past J2000 TDB; None: the scene's time. axes: a reference frame. correction: "NONE", "LT", "LT+S",
        "CN", "CN+S". Its sources, in the order of search: loaded SPKs, DE405, ERFA."""
        about = "ephemeris"
        command = self._scene._command()
        message = command.ephemeris
        for field, value in (("target", target), ("observer", observer)):
            value = str(value) if isinstance(value, int) and not isinstance(value, bool) else value
            setattr(message, field, text(value, f"the {field}", about, "a name or NAIF id"))
        message.axes = text(axes, "the axes", about, "a name such as 'J2000'")
        message.correction = word(correction, CORRECTIONS, "the correction", about)
        array, single = _times(times, about)
        wire.put_array(message, "time_s", array)
        reply = self._scene._execute(command).ephemeris
        sources = [StateSource(s.body, s.center, s.source, s.accuracy, tuple(s.hidden)) for s in reply.source]
        reply.ClearField("source")
        state, light_time = wire.get_arrays(reply, "state", "light_time_s")
        state = state.reshape(-1, 6)
        if single:
            return States(state[0, :3], state[0, 3:], float(light_time[0]), sources)
        return States(state[:, :3], state[:, 3:], light_time, sources)

    def tdb(self, text_or_texts):
        """Seconds past J2000 TDB of a time as text, or an array of several: ISO 8601, "2026-11-01T00:00:00.5", in UTC unless
        " TAI", " TT", " TDB" or " UT1" follows. Leap seconds are those of a loaded LSK, else of ERFA or the system's
        list."""
        about = "time"
        single = isinstance(text_or_texts, str)
        command = self._scene._command()
        message = command.convert_times
        message.SetInParent()
        message.text.extend(text(each, "the time", about, "a text such as '2026-11-01T00:00'") for each in (
            [text_or_texts] if single else items(text_or_texts, "the times", about, "texts")))
        times = np.array(self._scene._execute(command).times.time_s)
        return float(times[0]) if single else times

    def utc(self, times=None, decimals=3):
        """UTC as text of seconds past J2000 TDB (a list for an array; None: the scene's time)."""
        about = "time"
        command = self._scene._command()
        put(command.convert_times, about, decimals=decimals)
        array, single = _times(self._scene.time if times is None else times, about)
        wire.put_array(command.convert_times, "time_s", array)
        texts = list(self._scene._execute(command).times.utc)
        return texts[0] if single else texts

    def time_text(self, times=None, scale="TDB", decimals=3):
        """Seconds past J2000 TDB as text in a time scale: "UTC", "TAI", "TT", "TDB", or "UT1" (load a table of the IERS
        as a kernel); a list for an array; None: the scene's time. The scale is not part of the text."""
        about = "time"
        command = self._scene._command()
        put(command.convert_times, about, decimals=decimals)
        command.convert_times.scale = text(scale, "the scale", about, "UTC, TAI, TT, TDB, UT1")
        array, single = _times(self._scene.time if times is None else times, about)
        wire.put_array(command.convert_times, "time_s", array)
        texts = list(self._scene._execute(command).times.utc)
        return texts[0] if single else texts

    def add_celestial_frame(self, name, body, axes=None, site=None, parent=None, center=None, center_axes="J2000",
                            correction="NONE", geodetic=False):
        """A new frame that follows the scene's time: its origin is that of a body or spacecraft (`body`: a name or NAIF
        id), and its axes are a reference frame (`axes`, default J2000); or with `site` = longitude (east), latitude
        [deg], height [m] its origin is a place of the body, and its axes are X east, Y north, Z up.

            moon = scene.add_celestial_frame("moon", "moon", axes="MOON_ME", center="moon", center_axes="J2000")
            site = scene.add_celestial_frame("site", "moon", site=(29.1957, -84.7906), parent=moon)
            earth = scene.add_celestial_frame("earth", "earth", axes="ITRF93", center="moon")
            scene.time = 846763269.0  # all of them move

        center, center_axes: what the parent stands for: the body at its origin and the reference frame of its axes.
        Without a center, the parent must be such a frame itself. correction: how light shows the body to the centre:
        "NONE" (where it is), "LT", "LT+S", "CN", "CN+S". The frame's pose cannot be set otherwise (Frame.stop_motion
        ends that). Setting the scene's time to one that kernels do not cover raises an error and changes nothing."""
        frame = self._scene.add_frame(name, parent)
        about = f"frame {name!r}"
        try:
            command = self._scene._command()
            message = command.set_frame_motion
            message.frame = frame.id
            put_place(message.place, body, axes, site, geodetic, about)
            if center is not None:
                put_place(message.parent, center, center_axes, None, False, about)
            message.correction = text(correction, "the correction", about)
            self._scene._execute(command)
        except Exception:
            frame.remove()
            raise
        return frame

    def stop_motion(self, frame):
        """Ends that a frame follows the scene's time: it keeps its present pose."""
        command = self._scene._command()
        command.set_frame_motion.frame = self._scene._frame_id(frame)
        self._scene._execute(command)


def follow_sun(scene, frame=None, body=None, axes=None, site=None, geodetic=False):
    """Scene.sun.follow."""
    about = "light 'sun'"
    command = scene._command()
    message = command.set_sun_motion
    message.SetInParent()
    if frame is not None:
        message.frame = scene._frame_id(frame)
    if body is not None:
        put_place(message.place, body, axes, site, geodetic, about)
    scene._execute(command)


def stop_sun(scene, stop=True):
    """Scene.sun.stop."""
    command = scene._command()
    command.set_sun_motion.stop = flag(stop, "stop", "light 'sun'")
    scene._execute(command)
