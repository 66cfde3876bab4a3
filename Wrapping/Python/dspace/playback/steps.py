"""The steps of a recording that can be shown, the gaps between them, and the step at a time. PlaybackSteps.h and
StepTimes.h in C++ implement the rules."""
import array
from typing import NamedTuple, Optional

from dspace import vtk as _vtk


class Step(NamedTuple):
    """The state after command `end`: a time that was set, and all commands until the next time."""

    time: float  # [s]
    end: int


class Gap(NamedTuple):
    """A span that cannot be shown, because commands first..last are lost or unusable.

    begin, end: simulation time [s] of the first step that may lack a command, and of the next complete step; None: the
    beginning or the end of the recording. before: the number of complete steps before the gap.
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
    """Returns the Steps of a RecordingFile, of one scene or of all, and its Gaps. After lost commands, playback
    continues at the next snapshot."""
    reply = file.playback_steps(scene)
    value = lambda gap, name: getattr(gap, name) if gap.HasField(name) else None
    return (list(map(Step, reply.time_s, reply.seq)),
            [Gap(gap.first, gap.last, value(gap, "begin_s"), value(gap, "end_s"), gap.before) for gap in reply.gap])


class StepTimes:
    """The times of steps [s], and the rule that finds the step at a time. Times go back where a simulation was reset. A
    run is a range of steps whose times do not go back.

    A step is at a time if the two differ by no more than a rounding (Documentation/Recording.md)."""

    def __init__(self, times):
        self.times = list(times)
        self._vtk = _vtk.vtkDspaceStepTimes()
        self._vtk.SetTimes(array.array("d", self.times).tobytes())

    def __len__(self):
        return len(self.times)

    def index_at(self, at):
        """Returns the index of the last step that is not after a time, or None before all steps. The step is that of
        the latest run that reaches the time, or else of the latest run that begins before it. Among close steps, one
        at exactly this time has precedence."""
        index = self._vtk.IndexAt(at)
        return None if index < 0 else index

    def is_at(self, index, at):
        """Returns whether a step is at a time: late or early by no more than a rounding."""
        return self._vtk.IsAt(index, at)

    def is_after(self, index, at):
        """Returns whether a step is later than a time by more than a rounding. Every step is later than NaN."""
        return self._vtk.IsAfter(index, at)

    def step_at(self, at):
        """Returns a time for code that does not handle roundings: `at`, or the time of the step that is late by one."""
        index = self.index_at(at)
        return at if index is None else max(at, self.times[index])


def rounding(time, step):
    """Returns the largest difference [s] at which a requested time still means a step at the recorded `time`. step:
    distance [s] to the nearest step on the side of the requested time."""
    return _vtk.vtkDspaceStepTimes.Rounding(time, step)
