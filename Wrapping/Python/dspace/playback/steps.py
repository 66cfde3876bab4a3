"""The steps of a recording that can be shown, the gaps between them, and the step at a time. C++ has the rules
(PlaybackSteps.h, StepTimes.h)."""
import array
from typing import NamedTuple, Optional

from dspace import vtk as _vtk


class Step(NamedTuple):
    """The state after command `end`: a time that was set, and all that came until the next one."""

    time: float  # [s]
    end: int


class Gap(NamedTuple):
    """A span of which nothing can be shown: commands first..last are lost or of no use.

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


def steps_of(file, scene=None):
    """The Steps of a RecordingFile, of one scene or of all, and its Gaps. After lost commands the next snapshot goes
    on."""
    reply = file.playback_steps(scene)
    value = lambda gap, name: getattr(gap, name) if gap.HasField(name) else None
    return (list(map(Step, reply.time_s, reply.seq)),
            [Gap(gap.first, gap.last, value(gap, "begin_s"), value(gap, "end_s"), gap.before) for gap in reply.gap])


class StepTimes:
    """The times of steps [s], and the one rule for which of them is at a time. Where a simulation was reset, times go
    back: a run is a range of steps whose times do not.

    A step counts as at a time where the two differ by no more than a rounding (Documentation/Recording.md)."""

    def __init__(self, times):
        self.times = list(times)
        self._vtk = _vtk.vtkDspaceStepTimes()
        self._vtk.SetTimes(array.array("d", self.times).tobytes())

    def __len__(self):
        return len(self.times)

    def index_at(self, at):
        """Of the latest run that reaches a time, or else the latest that begins before it, the last step that is not
        after it; None before all of them. Of steps that lie closely a step at the very time is before all others."""
        index = self._vtk.IndexAt(at)
        return None if index < 0 else index

    def is_at(self, index, at):
        """Whether a step counts as at a time: it is late or early by no more than a rounding."""
        return self._vtk.IsAt(index, at)

    def is_after(self, index, at):
        """Whether a step is later than a time, by more than a rounding; than not-a-number each is."""
        return self._vtk.IsAfter(index, at)

    def step_at(self, at):
        """A time for code that knows no roundings: `at`, or that of the step that is late by one."""
        index = self.index_at(at)
        return at if index is None else max(at, self.times[index])


def rounding(time, step):
    """How far from its recorded time a step may be asked for and still be meant [s]; step: its distance from the
    nearest step on the side of the time that is asked for [s]."""
    return _vtk.vtkDspaceStepTimes.Rounding(time, step)
