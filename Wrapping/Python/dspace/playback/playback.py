"""Playback of recordings, without a simulation."""
import bisect
import math
import time

from dspace._core.fields import flag, integer, number, real, reject, text
from dspace._core.replies import to_reply, warn
from dspace._core.traits import scene_name
from dspace._core.wire import command_of
from dspace.clients.session import Session
from dspace.errors import Corrupt, InvalidArgument, NotFound, WrongType
from dspace.playback.spans import spans_of
from dspace.playback.steps import StepTimes, rounding, steps_of
from dspace.playback.telemetry import RecordedTelemetry
from dspace.proto import commands_pb2 as pb, terrain_pb2
from dspace.recording.assets import RecordedFiles
from dspace.recording.file import RecordingFile, commands_of

BUILDING = terrain_pb2.TerrainReply.BUILDING
MOST_KEYS = 100_000
AT_ONCE = 3600.0  # longest single sleep [s]; the operating system limits the argument
SET_TIME = pb.Command.SET_TIME_FIELD_NUMBER


def scene_of(payload):
    return scene_name(command_of(payload))


class Playback:
    """Plays a recording in its own session, forward and backward.

        with dspace.Playback("run.dspace") as run:
            run.seek(12.5)
            run.session.viewports["main"].save("at_12_5.png")

    A step is a time that the simulation set, with all commands until the next one. The times are those of all scenes,
    or of the scene `scene` (dspace.NotFound if the recording has none of that name). The session draws the same
    pictures as the recorded one, byte for byte. Additions to the session are lost at the next seek back.

    Packed files are unpacked into a temporary folder, which close() removes. check_assets: the other files must be
    unchanged, else dspace.Corrupt or dspace.NotFound names the one that differs or is absent. unpack_limit: the most
    bytes that packed files may have unpacked (default: 1 GiB and 20 times the recording's size), else dspace.Resource.

    A command with text that is not UTF-8, as earlier versions recorded it, is played with this text as UTF-8; a
    dspace.DspaceWarning names the command. A recording that was just begun raises dspace.NotFound.

    A salvaged recording lacks commands. `gaps` lists the spans that cannot be shown, each up to the next snapshot,
    including steps that may lack a command. A dspace.DspaceWarning lists them.
    """

    def __init__(self, path, check_assets=True, scene=None, unpack_limit=None):
        self.file = RecordingFile(path)
        self.session = self._files = None
        try:
            self._checks = flag(check_assets, "check_assets", self.file.label)
            self._unpack_limit = unpack_limit
            self._scene = None if scene is None else text(scene, "the scene", self.file.label)
            self._telemetry = RecordedTelemetry(self.file, self._scene)
            self._read_steps()
            self._require_scene()
            if self.gaps:
                warn(f"{self.file.label}: commands are lost, and nothing is shown from "
                     + ", nor from ".join(str(gap) for gap in self.gaps))
            self.session = self._make_session()
            self._left_out = set()  # warnings that were given
            self._told = set()  # rows of foreign text that were told
            self._at = None  # the last command that the session has executed
            self.index = 0
            self._go(0)
        except BaseException:
            self.close()
            raise

    def _make_session(self):
        return Session()

    def _read_steps(self):
        steps, gaps = steps_of(self.file, self._scene)
        if not steps:
            self.file.reject_no_steps()
        self._take_files()  # after the steps: a recording notes the files of a command before the command
        self.gaps = gaps
        self._ends = [step.end for step in steps]
        self.times = [step.time for step in steps]  # [s], of each step
        self._steps = StepTimes(self.times)

    def _require_scene(self):
        if self._scene is None or self.file.steps(self._scene):
            return
        there = [key[1] for key in spans_of(self) if key[0] == "scene"]
        if self._scene not in there:
            raise NotFound(f"{self.file.label}: there is no scene {self._scene!r}; there are: "
                           + (", ".join(map(repr, there)) or "none"), self.file.label)

    def _take_files(self):
        """Unpacks or checks the files that were recorded since the last call."""
        if self._files is None:
            self._files = RecordedFiles(self.file, self._checks, self._unpack_limit)
        else:
            self._files.update()

    def update(self):
        """Reads the steps that were added to a recording that is being written. Returns their number. The previous
        last step may have new commands; seek to it again to apply them. Files that were added are unpacked or checked,
        with the errors of the constructor."""
        before = len(self.times)
        self._read_steps()
        return len(self.times) - before

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.close()

    def close(self):
        if self.session is not None:
            self.session.close()
        if self._files is not None:
            self._files.close()
        self.file.close()

    @property
    def duration(self):
        """The time from the first step to the last one [s]."""
        return self.times[-1] - self.times[0]

    @property
    def time(self):
        """The time of the present step [s]."""
        return self.times[self.index]

    def seek(self, at):
        """Moves to the last step that is not after `at` [s] and returns the recorded time of that step.

        A step that is late by no more than a rounding counts as at the time: a thousandth of the step before it, at
        most 0.1 ms (Documentation/Recording.md). Where time went back in the recording (a simulation that was reset),
        the step is in the latest run of steps that reaches `at`, or else in the latest run that begins before it.
        Raises dspace.InvalidArgument before the first step and dspace.Corrupt in a gap."""
        at = number(at, "the time", self.file.label)
        index = self._steps.index_at(at)
        if index is None:
            raise InvalidArgument(f"{self.file.label}: the time is {at!r} s; accepted: {min(self.times)!r} on",
                                  self.file.label)
        for gap in self.gaps:
            if gap.before == index + 1 and gap.begin is not None and (
                    at >= gap.begin - rounding(gap.begin, max(gap.begin - self.times[index], 0.0))):
                raise Corrupt(f"{self.file.label}: at {at!r} s its commands are lost: {gap}", self.file.label)
        self._go(index)
        return self.time

    def step(self, n=1):
        """Moves n steps forward, or back if n is negative, and stops at the ends. Returns the number of steps made."""
        n = integer(n, "the number of steps", self.file.label, "a whole number")
        before = self.index
        self._go(min(max(before + n, 0), len(self.times) - 1))
        return self.index - before

    def play(self, speed=1.0, on_step=None, until=None):
        """Plays at `speed` times real time; a negative speed plays backward.

        Playback ends at the end of the recording, at the time `until` [s] (within a rounding, as in seek()), or when
        on_step(playback), which is called after each step, returns False. If several steps are due, only the last one
        is shown, so that playback keeps its pace. A speed of 0, or -inf for backward, shows every step as fast as
        possible."""
        speed = real(speed, "the speed", self.file.label)
        until = None if until is None else real(until, "until", self.file.label, "a time [s]")
        if on_step is not None and not callable(on_step):
            reject(self.file.label, "on_step", on_step, "a function of the Playback", WrongType)
        paced = speed != 0 and math.isfinite(speed)
        direction = -1 if speed < 0 else 1
        began, from_time = time.monotonic(), self.time
        while True:
            following = self.index + direction
            if not 0 <= following < len(self.times):
                return
            if self._passes(following, direction, until):
                return
            if paced:
                if (self.times[following] - self.time) * direction < 0:  # a simulation that was reset: from there on
                    began, from_time = time.monotonic(), self.times[following]
                due = began + (self.times[following] - from_time) / speed
                while (wait := due - time.monotonic()) > 0:
                    time.sleep(min(wait, AT_ONCE))
                following = self._due(following, direction, from_time + speed * (time.monotonic() - began), until)
            self._go(following)
            if on_step is not None and on_step(self) is False:
                return

    def export(self, path, start=None, end=None, step=None, scene="scene", **options):
        """Writes a scene with the recorded motion of its frames into a binary glTF file (.glb); see Scene.export, which
        takes `options`.

        start and end [s]: of the animation, default: the first and the last step. step [s]: between key frames, at most
        100,000 of them; default: every recorded step. Objects are those at `end`, where the playback then is. A frame
        that comes later than `start` stands still until then; frames that move to another parent keep their last
        one."""
        label = self.file.label
        start = min(self.times) if start is None else real(start, "start", label)
        end = max(self.times) if end is None else real(end, "end", label)
        if not start <= end < math.inf:
            raise InvalidArgument(f"{label}: start is {start!r} s and end {end!r} s; accepted: start not after end", label)
        times = sorted({time for time in self.times if start < time < end} | {start, end})
        if step is not None:
            step = real(step, "step", label)
            if not step > 0 or (end - start) / step > MOST_KEYS:
                raise InvalidArgument(f"{label}: step is {step!r} s; accepted: > 0, at most {MOST_KEYS} key frames", label)
            times = [start + i * step for i in range(int((end - start) / step * (1 + 1e-12)) + 1)]
            times += [end] if end - times[-1] > 1e-6 * step else []
        rows = []  # the poses by frame id, at each time
        for time_s in times:
            self.seek(time_s)
            shown = self.session.scenes[scene]
            ids = [frame.id for frame in shown.frames.values()]
            rows.append(dict(zip(ids, shown.poses(ids))))
        poses, later = [], dict(rows[-1])
        for row in reversed(rows):
            later.update((id, pose) for id, pose in row.items() if id in later)
            poses.append([later[id] for id in ids])
        poses.reverse()
        moving = {"times": times, "frames": ids, "poses": poses} if ids and len(times) > 1 else {}
        shown.export(path, **moving, **options)

    def telemetry(self, name=None, scene=None):
        """Returns the dspace.playback.telemetry.Series of a channel over the complete recording, or a dict of all
        channels without a name. A Series unpacks into times and values. The file is read once.

            times, values = run.telemetry("rover/power")

        scene: a scene's name; default: the playback's scene, or the only one that has telemetry or events. Raises
        dspace.Unsupported if a channel was removed and defined again with another unit or kind."""
        return self._telemetry.series(name, scene)

    def events(self, scene=None):
        """Returns all Events of a scene in order, including those that the scene no longer keeps."""
        return self._telemetry.events(scene)

    def _due(self, index, direction, now, until):
        """Returns the last step from `index`, in the given direction, that is beyond neither `now` nor `until`, and
        before the time reverses."""
        while 0 <= index + direction < len(self.times):
            following = self.times[index + direction]
            if ((following - self.times[index]) * direction < 0 or (following - now) * direction > 0
                    or self._passes(index + direction, direction, until)):
                break
            index += direction
        return index

    def _passes(self, index, direction, until):
        """Returns whether a step lies beyond the time at which playback ends."""
        if until is None:
            return False
        if direction > 0:
            return self._steps.is_after(index, until)
        return self.times[index] < until and not self._steps.is_at(index, until)

    def _go(self, index):
        target = self._ends[index]
        snapshot = reached = None
        if self._at is None or target < self._at:
            snapshot = self.file.snapshot(target)
        elif target > self._at:
            snapshots = self.file.snapshots
            nearest = bisect.bisect_right(snapshots, target)
            if nearest and snapshots[nearest - 1] > self._at:
                snapshot = self.file.snapshot(target)
        if snapshot is not None:
            self._at = None  # unknown, if one of these fails
            self._clear()
            for command in commands_of(snapshot):
                self._carry_out(command, f"snapshot {snapshot.seq}")
            self._at = snapshot.seq
            reached = snapshot.time if self._scene is None else None
        for row in self.file.rows(self._at + 1, target) if target > self._at else ():
            self._carry_out(row.payload, f"command {row.seq}")
            self._at = row.seq
            if self._scene is None or row.kind == SET_TIME and scene_of(row.payload) == self._scene:
                reached = row.time
        self._check_step(index, reached)
        self.index = index

    def _check_step(self, index, reached):
        """Verifies that the step has its expected time. The index of steps has no checksums, but the rows have."""
        good = reached in (None, self.times[index])
        following = self._ends[index] + 1
        if good and index + 1 < len(self.times):
            row = next(self.file.rows(following, following))
            good = row.kind == SET_TIME and (row.time == self.times[index + 1]
                                             or any(gap.before == index + 1 for gap in self.gaps))
        if not good:
            raise self.file.corrupt(f"its index of times is damaged near command {following}")

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
        if what in self.file.foreign and what not in self._told:
            self._told.add(what)
            warn(f"{self.file.label}: {what} holds text that is not UTF-8; it is read as Windows-1252 (Latin-1)")
        payload = self._files.map(payload)
        reply = to_reply(self.session.vtk.Replay(payload, self._files.vtk))
        if reply.HasField("error"):
            raise Corrupt(f"{self.file.label}: {what} is rejected: {reply.error.message}", self.file.label)
        if reply.warning and command_of(payload).HasField("create_drawn"):
            self._tell_left_out(reply.warning)
        if self._files.folder and b"/overviews" in payload:
            self._wait_for_overviews(command_of(payload))

    def _tell_left_out(self, texts):
        """Warns of objects whose drawers this process lacks, once each, however often the playback jumps."""
        for each in texts:
            if each not in self._left_out:
                self._left_out.add(each)
                warn(f"{self.file.label}: {each}")

    def _wait_for_overviews(self, opened):
        """Waits until the overviews of an unpacked raster are built again. The recorded pictures showed overviews."""
        while opened.HasField("open_terrain"):
            asked = pb.Command(scene=opened.scene)
            asked.describe_terrain.terrain = opened.open_terrain.name
            if self.session.execute(asked).terrain.overview_build != BUILDING:
                return
            time.sleep(0.01)
