"""Recordings played back, with no simulation."""
import bisect
import hashlib
import os
import time

from dspace._fields import number, refuse
from dspace.errors import Corrupt, InvalidArgument, NotFound
from dspace.recording_file import RecordingFile, commands_of
from dspace.session import commands_pb2 as pb
from dspace.sessions import Session


class Playback:
    """A recording in a session of its own, at a time that may go either way.

        with dspace.Playback("run.dspace") as run:
            run.seek(12.5)
            run.session.viewports["main"].save("at_12_5.png")

    Its steps are the times that the simulation set, each with all that came until the next one. The session
    shows what the recorded one did, to the byte. What is added to it is gone with the next seek back.

    check_assets: files that the recording names must be what they were, else dspace.Corrupt names the one
    that is not.
    """

    def __init__(self, path, check_assets=True):
        self.file = RecordingFile(path)
        self.session = None
        try:
            if check_assets:
                self._check_assets()
            self._begin()
        except BaseException:
            self.close()
            raise

    def _check_assets(self):
        for path, digest, size in self.file.assets:
            if digest is None:  # it could not be read then: a folder, or not of this machine
                continue
            if not os.path.isfile(path):
                raise NotFound(f"{self.file.label}: file {path!r}, which it names, is not there", path)
            if os.path.getsize(path) != size or _sha256(path) != digest:
                raise Corrupt(f"{self.file.label}: file {path!r} has changed since it was recorded; accepted: "
                              f"its {size} bytes of SHA-256 {digest.hex()}", path)

    def _begin(self):
        first = self.file.first
        start = self.file.snapshot(first - 1)
        last = max(self.file.last, first - 1)
        steps = self.file.steps()
        seqs = [seq for seq, _ in steps]
        self.times = [at for _, at in steps]  # [s], of each step
        self._ends = [seq - 1 for seq in seqs[1:]] + [last]
        if not seqs or seqs[0] > first or start.payload:  # what was there and done before time was first set
            self.times.insert(0, start.time)
            self._ends.insert(0, seqs[0] - 1 if seqs else last)
        self.session = Session()
        self._at = None  # the command after which the session is
        self.index = 0
        self._go(0)

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.close()

    def close(self):
        if self.session is not None:
            self.session.close()
        self.file.close()

    @property
    def duration(self):
        """Seconds from the first step's time to the last one's."""
        return self.times[-1] - self.times[0]

    @property
    def time(self):
        """The present step's [s]."""
        return self.times[self.index]

    def seek(self, at):
        """To the last step that is not after `at` [s]; returns its time. Before the first step: an error."""
        at = number(at, "the time", self.file.label)
        if at < min(self.times):
            raise InvalidArgument(f"{self.file.label}: the time is {at!r} s; accepted: {min(self.times)!r} on",
                                  self.file.label)
        if all(a <= b for a, b in zip(self.times, self.times[1:])):
            index = bisect.bisect_right(self.times, at) - 1
        else:  # time went back in it
            index = max(i for i, each in enumerate(self.times) if each <= at)
        self._go(index)
        return self.time

    def step(self, n=1):
        """n steps on, or back; stops at the ends. Returns how many were made."""
        if isinstance(n, bool) or not isinstance(n, int):
            refuse(self.file.label, "the number of steps", n, "a whole number")
        before = self.index
        self._go(min(max(before + n, 0), len(self.times) - 1))
        return self.index - before

    def play(self, speed=1.0, on_step=None, until=None):
        """Steps on, or with a negative speed back, in `speed` times real time (0: as fast as it goes), to the
        end, to the time `until` [s], or until on_step(playback), called after each step, returns False."""
        speed = number(speed, "the speed", self.file.label)
        direction = -1 if speed < 0 else 1
        began, from_time = time.monotonic(), self.time
        while True:
            following = self.index + direction
            if not 0 <= following < len(self.times):
                return
            if until is not None and (self.times[following] - until) * direction > 0:
                return
            if speed:
                wait = (self.times[following] - from_time) / speed - (time.monotonic() - began)
                time.sleep(max(wait, 0.0))
            self._go(following)
            if on_step is not None and on_step(self) is False:
                return

    def _go(self, index):
        target = self._ends[index]
        snapshot = None
        if self._at is None or target < self._at:
            snapshot = self.file.snapshot(target)
        elif target > self._at:
            nearest = self.file.ask("SELECT max(seq) FROM snapshot WHERE seq <= ?", target)[0][0]
            if nearest is not None and nearest > self._at:
                snapshot = self.file.snapshot(target)
        if snapshot is not None:
            self._at = None  # unknown, if one of these fails
            self._clear()
            for command in commands_of(snapshot):
                self._carry_out(command, f"snapshot {snapshot.seq}")
            self._at = snapshot.seq
        for row in self.file.rows(self._at + 1, target) if target > self._at else ():
            self._carry_out(row.payload, f"command {row.seq}")
            self._at = row.seq
        self.index = index

    def _clear(self):
        for name in list(self.session.viewports):
            command = pb.Command()
            command.remove_viewport.viewport = name
            self.session.execute(command)
        for name in list(self.session.scenes):
            command = pb.Command(scene=name)
            command.remove_scene.SetInParent()
            self.session.execute(command)

    def _carry_out(self, payload, what):
        answer = self.session.vtk.Execute(payload)
        reply = pb.Reply.FromString(answer.encode() if isinstance(answer, str) else answer)
        if reply.HasField("error"):
            raise Corrupt(f"{self.file.label}: {what} is refused: {reply.error.message}", self.file.label)


def _sha256(path):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        for block in iter(lambda: file.read(1 << 20), b""):
            digest.update(block)
    return digest.digest()
