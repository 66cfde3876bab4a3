"""Which steps of a recording can be shown whole, and what is lost between them."""
import bisect
import math
from typing import NamedTuple, Optional

from dspace._traits import scene_name
from dspace._wire import command_of


class Step(NamedTuple):
    """The state after command `end`: a time that was set, and all that came until the next one."""

    time: float  # [s]
    end: int


class Gap(NamedTuple):
    """A span of which nothing can be shown: commands first..last are lost or cannot be made use of.

    begin, end: simulation time [s] of the first step that may lack a command, and of the next one that is whole;
    None: the recording's own begin or end. before: how many whole steps come before it.
    """

    first: int
    last: int
    begin: Optional[float]
    end: Optional[float]
    before: int

    def __str__(self):
        begin = "the beginning" if self.begin is None else f"{self.begin:g} s"
        return f"{begin} to {'the end' if self.end is None else f'{self.end:g} s'} (commands {self.first} to {self.last})"


def blocks_of(file):
    """Ranges (first, last) of commands that are there, with none missing within one."""
    if not file.last:  # a state and nothing after it
        seq = file.ask("SELECT max(seq) FROM snapshot")[0][0] or 0
        return [(seq + 1, seq)]
    lost = file.lost
    if not lost:
        return [(file.first, file.last)]
    starts = [1] + [last + 1 for _, last in lost]
    ends = [first - 1 for first, _ in lost]
    # Where a snapshot is the last of all, its state and nothing after it.
    return [(a, b) for a, b in zip(starts, ends) if a <= b] + [(starts[-1], max(file.last, starts[-1] - 1))]


def set_times(file, scene):
    """(command, time) of each step, of one scene or of all."""
    if scene is None:
        return file.steps()
    found = []
    for seq, time, payload in file.ask("SELECT seq, time, payload FROM command INDEXED BY step WHERE kind = 13"):
        if scene_name(command_of(payload)) == scene:
            found.append((seq, time))
    return sorted(found)


def led_in(inside, seq, time, any_before):
    """(command, time) of each step after a snapshot, whose command and time these are: first what was there and done
    before time was first set, or after what is lost."""
    if any_before or not inside or inside[0][0] > seq + 1:
        return [(seq + 1, time), *inside]
    return inside


def steps_of(file, scene=None):
    """The Steps of a RecordingFile, and its Gaps. After lost commands the next snapshot goes on."""
    # In this order: of one that is being written each sees more than the one before, and what is beyond the last
    # block is left out.
    blocks = blocks_of(file)
    snapshots = [seq for seq, in file.ask("SELECT seq FROM snapshot ORDER BY seq")]
    times = set_times(file, scene)
    steps, gaps = [], []
    begin, first = None, 1 if file.lost else blocks[0][0]  # of the gap that is open
    is_open = False
    for number, (a, b) in enumerate(blocks):
        place = bisect.bisect_left(snapshots, a - 1)
        if place == len(snapshots) or snapshots[place] > max(b, a - 1):
            is_open = True  # no state to begin with
            continue
        base = file.snapshot(snapshots[place])
        is_open = is_open or base.seq > a - 1
        inside = [(seq, time) for seq, time in times if base.seq < seq <= b]
        inside = led_in(inside, base.seq, base.time, is_open or number or base.payload)
        found = [Step(time, following - 1) for (_, time), (following, _) in zip(inside, [*inside[1:], (b + 1, None)])]
        cut = None if number == len(blocks) - 1 else found.pop()
        if found:
            if is_open:
                gaps.append(Gap(first, base.seq, begin, found[0].time, len(steps)))
            steps += found
        if cut is not None and (found or not is_open):
            begin, first = cut.time, b + 1
        is_open = is_open and not found or cut is not None
    if is_open:
        gaps.append(Gap(first, max([file.last, *snapshots]), begin, None, len(steps)))
    return steps, gaps


def runs_of(times):
    """Ranges [begin, end) of steps whose times do not go back."""
    turns = [i for i in range(1, len(times)) if times[i] < times[i - 1]]
    return list(zip([0, *turns], [*turns, len(times)]))


def rounding(time, step):
    """How far from its recorded time [s] a step may be asked for and still be meant: a simulation that adds up its steps
    is the later, or the earlier, the longer it runs. step: its distance [s] from the nearest step on the side of what is
    asked. A thousandth of that, at most 0.1 ms; at least two spacings of doubles at that time, up to half of `step`."""
    return max(min(1e-3 * step, 1e-4), min(2 * math.ulp(time), 0.5 * step))


def _neighbour(times, index, direction):
    """The time of the next step of another time in the same run, or None."""
    other = index + direction
    while 0 <= other < len(times) and times[other] == times[index]:
        other += direction
    found = 0 <= other < len(times) and (times[other] - times[index]) * direction > 0
    return times[other] if found else None


def is_at(times, index, at):
    """Whether a step counts as at a time [s]: it is late or early by no more than a rounding. At the ends of a run its
    only neighbour counts; a step that is alone may be off by two spacings of doubles."""
    time = times[index]
    if not abs(time - at) <= max(1e-4, 2 * math.ulp(time)):  # no rounding is larger
        return False
    side = -1 if time > at else 1
    other = _neighbour(times, index, side)
    other = _neighbour(times, index, -side) if other is None else other
    return abs(time - at) <= (2 * math.ulp(time) if other is None else rounding(time, abs(other - time)))


def is_after(times, index, at):
    """Whether a step is later than a time [s], by more than a rounding; than what is not a number each is."""
    return not (times[index] <= at or is_at(times, index, at))


def index_at(times, runs, at):
    """Of the latest run that reaches a time, or else the latest that begins before it, the last step not after it, as
    is_after() says; None before all of them. Of steps that lie closely a step at the very time is before all others."""
    begun = None
    for begin, end in reversed(runs):
        if not is_after(times, begin, at):
            if at <= times[end - 1] or is_at(times, end - 1, at):
                following = bisect.bisect_right(times, at, begin, end)
                if following < end and is_at(times, following, at):
                    following = bisect.bisect_right(times, times[following], begin, end)
                return following - 1
            begun = end - 1 if begun is None else begun
    return begun


def step_at(times, time, runs=None):
    """A time [s] for those who know no roundings: `time`, or that of the step that is late by one. runs: as of
    runs_of(); absent: time never goes back."""
    index = index_at(times, runs or [(0, len(times))], time) if len(times) else None
    return time if index is None else max(time, times[index])
