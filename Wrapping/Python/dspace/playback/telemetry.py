"""Telemetry and events of a whole recording, read without drawing or playing it."""
import numpy as np

from dspace._core.fields import Named, shown, text
from dspace._core.traits import DEFAULT_SCENE, scene_name
from dspace._core.wire import command_of, get_array
from dspace.errors import InvalidArgument, NotFound, Unsupported
from dspace.playback.steps import StepTimes
from dspace.proto import commands_pb2 as pb
from dspace.proto import telemetry_pb2
from dspace.recording.file import commands_of
from dspace.telemetry.messages import Event

TEXT = telemetry_pb2.CreateTelemetry.TEXT
FIELDS = pb.Command.DESCRIPTOR.fields_by_name
KINDS = [FIELDS[name].number for name in ("create_scene", "remove_scene", "set_time", "create_telemetry",
                                          "set_telemetry", "set_telemetry_texts", "remove_telemetry", "log_event")]


class Series:
    """One channel over a recording: times [s] and values as arrays of equal length.

        times, values = run.telemetry("rover/power")

    A value holds until the time of the next one. There is one value for each time that the simulation set the channel,
    in the order of the commands; of several at one time the last one holds. Numbers are floats; NaN means no value,
    also where the channel was removed or commands are lost. Choices are numbers (labels: {number: label}). Texts are
    str; None means no value."""

    def __init__(self, channel, times, values, clock=()):
        self.name, self.unit, self.description = channel.name, channel.unit, channel.description
        self.kind = ("number", "text", "choice")[channel.kind]
        self.labels = {label.value: label.label for label in channel.label}
        self.times, self.values = times, values
        # The StepTimes of a Playback of this scene. All series share them.
        self._clock = clock if isinstance(clock, StepTimes) else StepTimes(clock)

    def __iter__(self):
        return iter((self.times, self.values))

    def at(self, time):
        """Returns the value that holds at a time [s]: the last one that was set at or before it, or NaN (None for a
        text). A step that is late by no more than a rounding counts as at the time, as in Playback.seek(). Where time
        went back in the recording, the value that was set last counts."""
        before = np.flatnonzero(self.times <= self._clock.step_at(time))
        if not len(before):
            return None if self.kind == "text" else float("nan")
        value = self.values[before[-1]]
        return value if self.kind == "text" else float(value)

    def __repr__(self):
        unit = f" {self.unit}" if self.unit else ""
        return f"<dspace.Series {self.name!r}{unit}, {len(self.times)} values>"


def _what(event):
    """Returns an event without the id of its frame, which a snapshot omits if the frame was removed."""
    event = type(event).FromString(event.SerializeToString())
    event.ClearField("frame")
    return event


class _Scene:
    """Collects the values of a scene's channels, command by command."""

    def __init__(self, file, name):
        self.file, self.name = file, name
        self.time = 0.0
        self.channels = {}  # by name: the CreateTelemetry that made it last
        self.open = {}      # by id: CreateTelemetry, of those that are there
        self.found = {}     # by name: [(times, values)]
        self.steps = []     # (ids, values, times) of numbers, not sorted by channel yet
        self.clock = []     # each time that was set [s]; first that before it was
        self.events, self.last = [], 0
        self.numbers = {}   # by number: the LogEvent, of the scene that is there, not of one removed before it

    def define(self, channel, seq):
        before = self.channels.get(channel.name)
        if before is not None and (before.kind, before.unit, list(before.label)) != (
                channel.kind, channel.unit, list(channel.label)):
            # Values of two units in one array would look like one.
            raise Unsupported(f"{self.file.label}: telemetry {shown(channel.name)} is defined a second time, by "
                              f"command {seq}, with another kind, unit ({before.unit!r}, then {channel.unit!r}) or "
                              "labels; accepted: the same, or a part by `dspace log cut`", channel.name)
        self.channels[channel.name] = channel
        self.open[channel.id] = channel
        self.found.setdefault(channel.name, [])

    def set_numbers(self, message, from_now):
        ids, values = get_array(message, "id", np.uint64), np.array(message.value)
        given = message.time_s and not from_now
        self.steps.append((ids, values, np.array(message.time_s) if given else np.full(len(ids), self.time)))

    def set_texts(self, message, from_now):
        for number, (id, value) in enumerate(zip(message.id, message.text)):
            self.put(id, [message.time_s[number] if message.time_s and not from_now else self.time], [value])

    def put(self, id, times, values):
        self.found[self.open[id].name].append((times, values))

    def end(self, ids, time):
        """Ends the values of some channels at a time."""
        self.sort()
        for id in ids:
            self.put(id, [time], [None if self.open[id].kind == TEXT else np.nan])

    def sort(self):
        """Sorts values by channel and keeps their order within each channel."""
        if self.steps:
            ids, values, times = (np.concatenate(each) for each in zip(*self.steps))
            self.steps = []
            order = np.argsort(ids, kind="stable")
            ids, values, times = ids[order], values[order], times[order]
            starts = np.flatnonzero(np.r_[True, ids[1:] != ids[:-1]]) if len(ids) else []
            for a, b in zip(starts, [*starts[1:], len(ids)]):
                self.put(int(ids[a]), times[a:b], values[a:b])

    def lose(self):
        """Ends all channels, because the following commands are lost."""
        self.end(list(self.open), self.time)
        self.open = {}

    def forget(self):
        """The scene was removed: its channels end, and its events count from 1 again."""
        self.lose()
        self.time, self.last, self.numbers = 0.0, 0, {}

    def goes_on(self, events):
        """Returns whether the events of a later state belong to this scene. The scene may have been removed and created
        again."""
        if max((event.number for event in events), default=0) < self.last:
            return False
        return all(_what(self.numbers.get(event.number, event)) == _what(event) for event in events)

    def series(self):
        self.sort()
        made, clock = {}, StepTimes(self.clock)
        for name in sorted(self.found):
            channel, parts = self.channels[name], self.found[name]
            times = np.concatenate([np.asarray(each, dtype=float) for each, _ in parts]) if parts else np.zeros(0)
            kind = object if channel.kind == TEXT else float
            values = np.concatenate([np.array(each, dtype=kind) for _, each in parts]) if parts else np.zeros(0, kind)
            made[name] = Series(channel, times, values, clock)
        return Named("telemetry channel", made)

    def apply(self, command, seq, from_now=False):
        """Applies a command. from_now: its values hold from the scene's present time on, not from their own."""
        kind = command.WhichOneof("command")
        if kind == "set_time":
            self.time = command.set_time.time_s
            self.clock.append(self.time)
        elif kind == "create_scene":
            self.clock.append(self.time)
        elif kind == "create_telemetry":
            self.define(command.create_telemetry, seq)
        elif kind == "set_telemetry":
            self.set_numbers(command.set_telemetry, from_now)
        elif kind == "set_telemetry_texts":
            self.set_texts(command.set_telemetry_texts, from_now)
        elif kind == "remove_telemetry":
            self.end(command.remove_telemetry.id, self.time)
            for id in command.remove_telemetry.id:
                self.open.pop(id)
        elif kind == "log_event" and command.log_event.number > self.last:  # a snapshot has older ones again
            self.last = command.log_event.number
            self.numbers[self.last] = command.log_event
            self.events.append(Event(command.log_event))
        elif kind == "remove_scene":
            self.forget()


class History:
    """The telemetry and events of a recording, by scene."""

    def __init__(self, file):
        self.file, self.scenes = file, {}
        for number, (_, last, snapshot) in enumerate(file.blocks()):
            if snapshot is None:  # no state to begin with: it cannot be shown either
                for scene in self.scenes.values():
                    scene.lose()
                continue
            self._begin(file.snapshot(snapshot), number > 0)
            for row in file.rows_of(KINDS, snapshot + 1, last):
                command = command_of(row.payload)
                self._scene(command).apply(command, row.seq)

    def _scene(self, command):
        name = scene_name(command)
        if name not in self.scenes:
            self.scenes[name] = _Scene(self.file, name)
        return self.scenes[name]

    def _begin(self, snapshot, after_loss):
        """Applies a snapshot: the first one, or one after lost commands. After lost commands it is unknown since when
        the values hold."""
        commands = [command_of(payload) for payload in commands_of(snapshot)]
        events, there = {}, {self._scene(command) for command in commands}
        for command in commands:
            if command.WhichOneof("command") == "log_event":
                events.setdefault(self._scene(command), []).append(command.log_event)
        for scene in self.scenes.values():
            scene.lose()
            if scene not in there or not scene.goes_on(events.get(scene, ())):
                scene.forget()
            scene.time = 0.0  # of a scene whose time was not set
        times = {self._scene(command): command for command in commands if command.WhichOneof("command") == "set_time"}
        for command in commands:
            kind, scene = command.WhichOneof("command"), self._scene(command)
            # The first time of a scene, before its present one, is where clocks count from.
            if kind not in ("create_scene", "remove_scene") and not (kind == "set_time" and command is not times[scene]):
                self._scene(command).apply(command, snapshot.seq, after_loss)
        for scene in there:
            scene.clock = scene.clock or [scene.time]

    def scene(self, name):
        if name in self.scenes:
            return self.scenes[name]
        if name is not None:
            raise NotFound(f"{self.file.label}: there is no scene {shown(name)}; there are: "
                           + (", ".join(map(repr, self.scenes)) or "none"), name)
        telling = [each for each in self.scenes.values() if each.channels or each.events]
        if len(telling) > 1:
            raise InvalidArgument(f"{self.file.label}: several scenes have telemetry or events; accepted: scene= one "
                                  "of " + ", ".join(repr(each.name) for each in telling), self.file.label)
        return telling[0] if telling else _Scene(self.file, DEFAULT_SCENE)


class RecordedTelemetry:
    """The telemetry and events of a recording over its whole time, for a Playback."""

    def __init__(self, file, scene):
        """scene: the name of the default one; None for the only one that has telemetry or events."""
        self._file = file
        self._scene = scene
        self._history = None  # (the file's last command when it was read, History)

    def _read(self, scene):
        scene = self._scene if scene is None else text(scene, "the scene", self._file.label)
        last = self._file.last
        if self._history is None or self._history[0] != last:  # the file may have grown
            self._history = (last, History(self._file))
        return self._history[1].scene(scene)

    def series(self, name, scene):
        """Returns the Series of a channel, or a dict of all without a name."""
        series = self._read(scene).series()
        return series if name is None else series[text(name, "the name", self._file.label)]

    def events(self, scene):
        """Returns all Events of a scene in order."""
        return list(self._read(scene).events)
