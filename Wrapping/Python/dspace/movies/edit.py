"""Edits the key frames of a movie by the times of its run, as on a timeline."""
import math
from dataclasses import replace

from dspace._core.fields import integer, number, reject
from dspace.errors import InvalidArgument, NotFound
from dspace.movies.keys import CameraPath, in_order

SAME = 1e-9  # [s] between run times that count as equal; and a double's rounding at large times


def same(a, b):
    """Whether two run times [s] are equal but for rounding."""
    return abs(a - b) <= max(SAME, 4 * math.ulp(max(abs(a), abs(b))))


class KeyEditor:
    """Changes the keys of one view of a Movie. Each change is checked as a whole before it is made.

    beginning: of the run [s]. Keys that state no run time get the one at which they are shown, which changes no
    picture. Changes keep the rate of each span (seconds of the run per second of the movie), so that later keys come
    earlier or later in the movie; new spans have the movie's `speed`. Keys are numbered from 0, by movie time. Other
    views and overlays keep their movie times."""

    def __init__(self, movie, view, beginning=0.0):
        self.movie, self.view = movie, view
        if view.camera:
            raise InvalidArgument(f"view {view.name!r}: it shows the camera {view.camera!r}; accepted: a view with keys, "
                                  "or without a camera", view.name)
        runs = movie.run_time(beginning)
        view.keys = [key if key.run is not None else replace(key, run=runs.at(key.time)) for key in view.keys]

    @property
    def keys(self):
        return self.view.keys

    @property
    def speed(self):
        """Seconds of the run per second of the movie, of new spans; never 0."""
        return self.movie.speed or 1.0

    def key(self, number_):
        """Returns key `number_`. Raises dspace.NotFound."""
        number_ = integer(number_, "the number of a key", self._about())
        if not 0 <= number_ < len(self.keys):
            raise NotFound(f"{self._about()}: there is no key {number_}; accepted: "
                           + (f"0 to {len(self.keys) - 1}" if self.keys else "none, it has no keys"), self._about())
        return self.keys[number_]

    def group(self, number_):
        """Returns the numbers of the first and the last key of a freeze that holds key `number_`: neighbours in one
        shot with equal run times."""
        first = last = number_
        while first > 0 and not self.keys[first].cut and same(self.keys[first - 1].run, self.keys[first].run):
            first -= 1
        while last + 1 < len(self.keys) and not self.keys[last + 1].cut and same(self.keys[last + 1].run,
                                                                                self.keys[last].run):
            last += 1
        return first, last

    def at(self, run):
        """Returns the numbers of the keys at a run time [s]."""
        return [number_ for number_, key in enumerate(self.keys) if same(key.run, run)]

    # --- Changes -------------------------------------------------------------------------------

    def add(self, run, make):
        """Adds the key make(time) at a run time where there is none; `time` is of the movie. Returns its number."""
        run = self._run(run)
        if self.at(run):
            reject(self._about(), "the run time of a new key", run, "one without a key")
        time, place, shift = self._place(run)
        keys = [replace(key, time=key.time + (shift if number_ >= place else 0.0))
                for number_, key in enumerate(self.keys)]
        keys.insert(place, replace(make(time), time=time, run=run))
        self._set(keys)
        return place

    def add_frozen(self, run, seconds, make):
        """Adds the key make(time) `seconds` of the movie after the key at this run time: meanwhile the run stands still
        and the camera moves. Returns its number."""
        run, seconds = self._run(run), self._seconds(seconds)
        there = self.at(run)
        if not there:
            reject(self._about(), "the run time at which the run freezes", run, "that of a key")
        after = self.group(there[0])[1]
        time = self.keys[after].time + seconds
        new = replace(make(time), time=time, run=self.keys[after].run)
        self._set([*self.keys[:after + 1], new, *(replace(key, time=key.time + seconds)
                                                   for key in self.keys[after + 1:])])
        return after + 1

    def move(self, number_, run):
        """Moves a key, with all of its freeze, to another run time between those of its neighbours in the shot."""
        self.key(number_)
        run = self._run(run)
        first, last = self.group(number_)
        low, high = self.limits(number_)
        if not low < run < high:
            reject(f"{self._about()}, key {number_}", "its run time", run, f"more than {low:g}, less than {high:g} s")
        keys = [replace(key, run=run) if first <= place <= last else key for place, key in enumerate(self.keys)]
        times = [keys[0].time]
        for old, before, new, after in zip(self.keys, self.keys[1:], keys, keys[1:]):
            span = before.time - old.time
            if not before.cut and not same(old.run, before.run):  # the rate stays
                span *= abs(after.run - new.run) / abs(before.run - old.run)
            times.append(times[-1] + span)
        self._set([replace(key, time=time) for key, time in zip(keys, times)])

    def limits(self, number_):
        """Returns the run times [s], both excluded, between which move() takes a key."""
        first, last = self.group(number_)
        run = self.keys[number_].run
        low, high = -math.inf, math.inf
        neighbours = []
        if first > 0 and not self.keys[first].cut:
            neighbours.append(self.keys[first - 1].run)
        if last + 1 < len(self.keys) and not self.keys[last + 1].cut:
            neighbours.append(self.keys[last + 1].run)
        for other in neighbours:
            low, high = (max(low, other), high) if other < run else (low, min(high, other))
        return low, high

    def set_span(self, number_, seconds):
        """Lets the span from a key to the next one take `seconds` of the movie: slow or fast motion."""
        self.key(number_)
        seconds = self._seconds(seconds)
        if number_ + 1 >= len(self.keys):
            reject(f"{self._about()}, key {number_}", "the span after it", None, "a key before the last")
        shift = seconds - (self.keys[number_ + 1].time - self.keys[number_].time)
        self._set([replace(key, time=key.time + (shift if place > number_ else 0.0))
                   for place, key in enumerate(self.keys)])

    def freeze(self, number_, seconds):
        """Lets the run stand still for `seconds` of the movie at a key, 0: not at all. The camera stands too where the
        freeze is new; add_frozen() adds another place for it."""
        self.key(number_)
        seconds = self._seconds(seconds, 0.0)
        first, last = self.group(number_)
        if first == last:
            if seconds > 0.0:
                key = self.keys[number_]
                self.add_frozen(key.run, seconds, lambda time: replace(key, time=time, cut=False))
            return
        begin, end = self.keys[first].time, self.keys[last].time
        keys = []
        for place, key in enumerate(self.keys):
            if place <= first:
                keys.append(key)
            elif place <= last and seconds > 0.0:
                keys.append(replace(key, time=begin + (key.time - begin) * seconds / (end - begin)))
            elif place > last:
                keys.append(replace(key, time=key.time + seconds - (end - begin)))
        self._set(keys)

    def change(self, number_, **values):
        """Gives a key other values (see Key), but no other time."""
        key = self.key(number_)
        for name in ("time", "run"):
            if name in values:
                reject(f"{self._about()}, key {number_}", name, values[name], "move() and set_span(), which move it")
        if "quaternion" in values:
            values = {"target": None, "target_frame": None, **values}
        elif "target" in values:
            values = {"quaternion": None, **values}
        lenses = [name for name in ("fov_deg", "height", "tangents") if values.get(name) is not None]
        if lenses:
            values = {"fov_deg": None, "height": None, "tangents": None, **values}
        self._set([*self.keys[:number_], replace(key, **values), *self.keys[number_ + 1:]])

    def erase(self, number_):
        """Removes a key. The other keys keep their run times, and the movie begins at 0 s."""
        gone = self.key(number_)
        keys = [*self.keys[:number_], *self.keys[number_ + 1:]]
        first, last = self.group(number_)
        if first != last and number_ in (first, last):  # a shorter freeze
            other = self.keys[number_ - 1 if number_ == last else number_ + 1]
            shift = abs(other.time - gone.time)
            keys = [replace(key, time=key.time - (shift if place >= number_ else 0.0))
                    for place, key in enumerate(keys)]
        if gone.cut and number_ < len(keys) and not keys[number_].cut:
            keys[number_] = replace(keys[number_], cut=True)
        if number_ == 0 and keys:
            shift = keys[0].time - gone.time
            keys = [replace(key, time=max(key.time - shift, 0.0), cut=False if place == 0 else key.cut)
                    for place, key in enumerate(keys)]
        self._set(keys)

    # --- What they share -----------------------------------------------------------------------

    def _about(self):
        return f"view {self.view.name!r}"

    def _run(self, run):
        run = number(run, "the run time", self._about())
        if not math.isfinite(run):
            reject(self._about(), "the run time", run, "a finite number of seconds")
        return run

    def _seconds(self, seconds, least=1e-3):
        seconds = number(seconds, "seconds", self._about())
        if not least <= seconds <= 1e6:
            reject(self._about(), "seconds", seconds, f"{least:g} to 1e6 of the movie")
        return seconds

    def _place(self, run):
        """Returns where a new key comes: its movie time, its number, and by how much later keys shift [s]."""
        keys, speed = self.keys, abs(self.speed)
        if not keys:
            return 0.0, 0, 0.0
        for place, (a, b) in enumerate(zip(keys, keys[1:]), 1):
            if not b.cut and min(a.run, b.run) < run < max(a.run, b.run):
                return a.time + (b.time - a.time) * (run - a.run) / (b.run - a.run), place, 0.0
        backwards = keys[-1].run < keys[0].run or self.speed < 0.0
        if (run < keys[0].run) != backwards:
            span = abs(keys[0].run - run) / speed
            return max(0.0, keys[0].time - span), 0, max(0.0, span - keys[0].time)
        for place, (a, b) in enumerate(zip(keys, keys[1:]), 1):
            if b.cut and (a.run < run < b.run or a.run > run > b.run):  # the end of a shot
                time = a.time + abs(run - a.run) / speed
                return time, place, max(0.0, time - b.time)
        return keys[-1].time + abs(run - keys[-1].run) / speed, len(keys), 0.0

    def _set(self, keys):
        keys = in_order(keys, self._about())
        if keys:
            CameraPath(keys, self._about())
        last = self.keys[-1].time if self.keys else 0.0
        self.view.keys = keys
        duration = self.movie._duration
        if duration is not None and keys:  # what came after the last key stays
            self.movie._duration = max(duration + keys[-1].time - last, 1e-3)
