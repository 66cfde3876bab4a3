"""When lines of sight between moving places of a scene are clear over a span of its time."""
import numpy as np

from dspace._core.fields import items, number, reject
from dspace.errors import InvalidArgument
from dspace.frames.frame import Frame
from dspace.measure.results import Contact, Horizon, Moment
from dspace.measure.scene_places import ScenePlace
from dspace.terrain.site import Site

MOST_STEPS = 100_000
GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)


class SightContacts:
    """Finds contacts by lines of sight for a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def sight_contacts(self, start, ends, begin, finish, *, step=60.0, precision=0.01, mask=None, playback=None, terrain=True,
                       objects=True, hide=(), without=()):
        """Finds when lines of sight from a place to others are clear while the scene's time runs. Returns a list of Contact,
        by end and time; its target is the end as given.

        start: a Site, or a Frame or its path. ends: one or a list of them. begin, finish: of the scene's time [s], or texts as
        for tdb(); at most 100,000 steps. What moves is what follows the time: celestial frames, frames on trajectories; with
        `playback` (the Playback of this scene) everything that was recorded, from step to step. The time is set back at the end.

        A contact lasts while line_of_sight() is clear with the same terrain, objects, hide and without, and while the end stands
        over the mask: a least elevation [deg], or a Horizon; None: none. Azimuth and elevation are those of the terrain below the
        start, on a body from the meridian's north, on a plane from the map's Y axis; without terrain those of the start frame,
        X east, Y north, Z up.

        Rise and set are found by samples every `step` seconds and bisection to `precision` [s]: a contact or gap between two
        samples is missed. The peak is the greatest elevation.

        Raises what line_of_sight() raises, dspace.InvalidArgument for a span of zero."""
        about = "sight contacts"
        scene = self._scene
        single = isinstance(ends, (str, Frame, Site))
        ends = [ends] if single else items(ends, "the ends", about, "a Site, a Frame, a path, or a list of them")
        begin, finish = (scene.tdb(time) if isinstance(time, str) else number(time, "the time", about) for time in (begin, finish))
        if not begin < finish or not np.isfinite([begin, finish]).all():
            raise InvalidArgument(f"{about}: the span runs from {begin!r} to {finish!r} s; accepted: an end after the start", about)
        if not 0.0 < number(precision, "the precision", about):
            reject(about, "the precision", precision, "above 0 s")
        step = number(step, "the step", about)
        if not step > 0.0 or (finish - begin) / step > MOST_STEPS:
            reject(about, "the step", step, f"above 0 s, and at most {MOST_STEPS:,} steps in the span")
        move = (lambda time: setattr(scene, "time", time)) if playback is None else playback.seek
        before = scene.time if playback is None else playback.time
        obstacles = {"terrain": terrain, "objects": objects, "hide": hide, "without": without}
        lines = [_Line(scene, start, end, move, mask, obstacles, about) for end in ends]
        count = max(1, int(np.ceil((finish - begin) / step - 1e-9)))
        times = np.append(begin + step * np.arange(count), finish)
        try:
            samples = []
            for time in times:
                move(time)
                samples.append([line.look(time) for line in lines])
            return [contact for i, line in enumerate(lines)
                    for contact in line.contacts([row[i] for row in samples], precision)]
        finally:
            move(before)


class _Line:
    """The line from a place to another one over time."""

    def __init__(self, scene, start, end, move, mask, obstacles, about):
        self._scene, self._end, self._move, self._obstacles = scene, end, move, obstacles
        self._ends = [ScenePlace(scene, place, what, about) for place, what in ((start, "the start"), (end, "the end"))]
        if mask is not None and not isinstance(mask, Horizon) and not -90.0 <= number(mask, "the mask", about) <= 90.0:
            reject(about, "the mask", mask, "-90 to 90 degrees, or a Horizon")
        self._mask = mask

    def look(self, time):
        """(the Moment, whether it is in contact) at the scene's present time."""
        start, end = self._ends
        from_place, to_place = (place.position() for place in self._ends)
        away = start.axes(from_place) @ (to_place - from_place)
        distance = float(np.linalg.norm(away))
        azimuth = float(np.degrees(np.arctan2(away[0], away[1])) % 360.0)
        elevation = float(np.degrees(np.arctan2(away[2], np.hypot(away[0], away[1]))))
        clear = bool(self._scene.line_of_sight(start.place, end.place, clearance=False, **self._obstacles).clear)
        if self._mask is not None:
            least = self._mask.elevation_at(azimuth) if isinstance(self._mask, Horizon) else self._mask
            clear = clear and elevation >= least
        return Moment(float(time), azimuth, elevation, distance), clear

    def _at(self, time):
        self._move(time)
        return self.look(time)

    def contacts(self, samples, precision):
        found = []
        for first, last in _runs([clear for _, clear in samples]):
            rise = samples[first][0] if first == 0 else self._edge(samples[first], samples[first - 1], precision)
            set_ = samples[last][0] if last + 1 == len(samples) else self._edge(samples[last], samples[last + 1], precision)
            inner = [moment for moment, _ in samples[first:last + 1]]
            best = max(range(len(inner)), key=lambda i: inner[i].elevation_deg)
            low = inner[best - 1].time if best else rise.time
            high = inner[best + 1].time if best + 1 < len(inner) else set_.time
            peak = max((rise, *inner, set_, self._peak(low, high, precision)), key=lambda moment: moment.elevation_deg)
            found.append(Contact(self._end, rise, set_, peak, first == 0, last + 1 == len(samples)))
        return found

    def _edge(self, inside, outside, precision):
        """The moment in contact that is nearest to the change between two samples."""
        inside, out = inside[0], outside[0].time
        while abs(out - inside.time) > precision:
            middle = 0.5 * (out + inside.time)
            if middle in (out, inside.time):
                break
            moment, clear = self._at(middle)
            if clear:
                inside = moment
            else:
                out = middle
        return inside

    def _peak(self, low, high, precision):
        """Golden-section search for the greatest elevation."""
        left, right = (self._at(high - GOLDEN * (high - low))[0], self._at(low + GOLDEN * (high - low))[0])
        while high - low > precision:
            if left.elevation_deg < right.elevation_deg:
                low, left = left.time, right
                right = self._at(low + GOLDEN * (high - low))[0]
            else:
                high, right = right.time, left
                left = self._at(high - GOLDEN * (high - low))[0]
        return max((left, right), key=lambda moment: moment.elevation_deg)


def _runs(flags):
    """(first, last) of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], flags, [False])).astype(int)))
    return [(int(first), int(end) - 1) for first, end in zip(edges[::2], edges[1::2])]
