"""Telemetry: named values of a scene, for tables, plots and overlays."""
import math
import re
from collections.abc import Mapping

import numpy as np

from dspace._core import wire
from dspace._core.fields import about, array_of, items, number, put, reject, shown, text, word
from dspace._core.strict import Strict
from dspace._core.traits import limits
from dspace.errors import InvalidArgument, NotFound, WrongType
from dspace.proto import telemetry_pb2

KINDS = {"number": telemetry_pb2.CreateTelemetry.NUMBER, "text": telemetry_pb2.CreateTelemetry.TEXT,
         "choice": telemetry_pb2.CreateTelemetry.CHOICE}
STATES = ("no value", "good", "warning", "alarm")
MAXIMUM_TEXT = limits(telemetry_pb2.SetTelemetryTexts, "text").most_bytes
# As IsControlCharacter of TextCharacters.cxx.
CONTROLS = re.compile("[\0-\x1f\x7f-\x9f\u034f\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufe00-\ufe0f\ufeff"
                      "\ufff0-\ufffc]")
LIMITS = ("alarm_low", "warning_low", "warning_high", "alarm_high")


def _label(name):
    return f"telemetry {shown(name)}"


def _put_limits(message, limits, label):
    for name, value in limits.items():
        if value is not None:
            setattr(message, name, number(value, name, label))


def ids_of(scene):
    """Returns {name: (id, kind)} of the channels of a scene that this client knows."""
    return scene._client.telemetry.setdefault(scene.name, {})


def _line(value, label):
    """Validates the text of a value here, before the numbers that are set with it are sent. Raises
    dspace.InvalidArgument for a text that the session would reject."""
    value = text(value, "the text", label)
    size = len(value.encode())
    if size > MAXIMUM_TEXT:
        raise InvalidArgument(f"{label}: its text has {size} bytes; accepted: up to {MAXIMUM_TEXT}", label)
    if CONTROLS.search(value):
        reject(label, "its text", value, "one without control characters (no tab, no line break)")
    return value


class Channel(Strict):
    """One channel of a scene's telemetry: scene.telemetry["rover/power"].

    Each property queries the session when it is read; `info` returns all of them in one query."""

    def __init__(self, scene, id, name, kind):
        self._scene, self._id, self._name, self._kind = scene, id, name, kind

    @property
    def scene(self):
        return self._scene

    @property
    def id(self):
        """The number that identifies the channel in commands."""
        return self._id

    @property
    def name(self):
        return self._name

    @property
    def kind(self):
        """"number", "text" or "choice"."""
        return next(name for name, kind in KINDS.items() if kind == self._kind)

    @property
    def info(self):
        """The present TelemetryInfo message (telemetry.proto)."""
        command = self._scene._command()
        command.list_telemetry.id.append(self._id)
        with about(_label(self._name)):
            return self._scene._execute(command).telemetry.channel[0]

    @property
    def value(self):
        """The value, which may be set. A number is a float, NaN if there is no value. A choice is its label and a text
        is a str, None if there is no value. Set a choice by its label or its number."""
        return value_of(self.info)

    @value.setter
    def value(self, value):
        Telemetry(self._scene).set({self: value})

    @property
    def time(self):
        """Simulation time of the value's last change [s], or None if it was never set."""
        info = self.info
        return info.time_s if info.HasField("time_s") else None

    @property
    def state(self):
        """"no value", "good", "warning" or "alarm": the value compared to the limits."""
        return STATES[self.info.state]

    @property
    def unit(self):
        return self.info.channel.unit

    @property
    def description(self):
        return self.info.channel.description

    @property
    def labels(self):
        """{number: label} of a choice; empty for other kinds."""
        return {label.value: label.label for label in self.info.channel.label}

    @property
    def limits(self):
        """A dict of the limits that are set: alarm_low, warning_low, warning_high, alarm_high."""
        limits = self.info.channel.limits
        return {name: getattr(limits, name) for name in LIMITS if limits.HasField(name)}

    def set_limits(self, alarm_low=None, warning_low=None, warning_high=None, alarm_high=None):
        """Replaces all limits; None: no limit. A value on a limit is within it."""
        command = self._scene._command()
        message = command.set_telemetry_limits
        message.id = self._id
        given = dict(zip(LIMITS, (alarm_low, warning_low, warning_high, alarm_high)))
        _put_limits(message.limits, given, _label(self._name))
        self._scene._execute(command)

    def remove(self):
        """Removes the channel. Its name may be used again. This object can no longer be used."""
        command = self._scene._command()
        command.remove_telemetry.id.append(self._id)
        ids_of(self._scene).pop(self._name, None)
        self._scene._execute(command)

    def __eq__(self, other):
        return isinstance(other, Channel) and (self._scene, self._id) == (other._scene, other._id)

    def __hash__(self):
        return hash((self._scene, self._id))

    def __repr__(self):
        try:
            info = self.info
            unit = f" {info.channel.unit}" if info.channel.unit else ""
            return f"<dspace.Channel {self._name!r}, {value_of(info)!r}{unit}>"
        except Exception:  # a repr never raises
            return f"<dspace.Channel {self._name!r}, not in the scene any more>"


def value_of(info):
    """Returns the value of a TelemetryInfo, as Channel.value."""
    if info.channel.kind == telemetry_pb2.CreateTelemetry.NUMBER:
        return info.value
    return info.text if info.state else None


class Telemetry(Mapping):
    """The channels of a scene by name: scene.telemetry.

        power = scene.telemetry.add("rover/power", unit="W", warning_low=20, alarm_low=5)
        power.value = 12.5
        scene.telemetry.set({"rover/power": 12.0, "rover/charge": 0.4})    # one message
        scene.telemetry["rover/power"].value
    """

    def __init__(self, scene):
        self._scene = scene

    def _list(self, **fields):
        command = self._scene._command()
        command.list_telemetry.SetInParent()
        put(command.list_telemetry, "telemetry", **fields)
        return self._scene._execute(command).telemetry.channel

    def _channel(self, info):
        channel = info.channel
        ids_of(self._scene)[channel.name] = (channel.id, channel.kind)
        return Channel(self._scene, channel.id, channel.name, channel.kind)

    def add(self, name, unit="", description="", kind="number", labels=None, value=None, alarm_low=None,
            warning_low=None, warning_high=None, alarm_high=None):
        """Adds a channel and returns it.

        name: names joined by '/', such as "rover/wheel_fl/torque", up to 255 bytes. unit: free text; UCUM is
        recommended ("m/s", "deg", "N.m", "Cel"). kind: "number", "text", or "choice". labels: of a choice: a dict of
        integers to labels, or the labels of 0, 1, 2, ... value: the first value; default: no value. Limits apply to
        numbers. They are finite, alarm_low <= warning_low <= warning_high <= alarm_high; a value on a limit is within
        it. Raises dspace.Error, such as dspace.AlreadyExists for a name that is in use."""
        label = _label(name)
        command = self._scene._command()
        message = command.create_telemetry
        put(message, label, name=name, unit=unit, description=description)
        message.kind = word("choice" if labels is not None and kind == "number" else kind, KINDS, "the kind",
                            label)
        if labels is not None:
            if not hasattr(labels, "items"):
                labels = dict(enumerate(items(labels, "labels", label, "a list of labels, or a dict of integers "
                                                                       "to labels")))
            for each, name_of_it in labels.items():
                put(message.label.add(), label, label=name_of_it)
                try:
                    message.label[-1].value = each
                except (TypeError, ValueError):
                    reject(label, "a label's value", each, "an integer from -2147483648 to 2147483647")
        limits = dict(zip(LIMITS, (alarm_low, warning_low, warning_high, alarm_high)))
        if any(limit is not None for limit in limits.values()):
            _put_limits(message.limits, limits, label)
        channel = self._channel(self._scene._execute(command).telemetry.channel[0])
        if value is not None:
            channel.value = value
        return channel

    def set(self, values, array=None):
        """Sets many values at once, all or none.

        values: a dict of channels or their names to values; or, with `array`, a list of channels or names (fastest: an
        integer array of ids, see Channel.id). array: as many numbers. NaN, or None for a choice, means no value. None
        for a text sets an empty text. Numbers go in one message and texts in a second one; if another client removes a
        text channel between the two, the numbers stay set. A value equal to the present one changes nothing."""
        if array is not None:
            numbers = array_of(array, "the values", "an array of numbers", "telemetry")
            quick = isinstance(values, np.ndarray) and np.issubdtype(values.dtype, np.integer)
            keys = values.ravel() if quick else items(values, "the channels", "telemetry",
                                                      "a list of channels or names, or an integer array of ids")
            if numbers.shape != (len(keys),):
                reject("telemetry", "the shape of the values", numbers.shape, f"({len(keys)},), one a channel")
            if quick:
                if len(keys) and keys.min() < 0:
                    reject("telemetry", "an id", int(keys.min()), "ids of channels, from 1 on")
                command = self._scene._command()
                command.set_telemetry.SetInParent()
                wire.put_array(command.set_telemetry, "id", keys.astype(np.uint64))
                wire.put_array(command.set_telemetry, "value", numbers)
                self._execute(command)
                return
            pairs = [(*self._known(key), value) for key, value in zip(keys, numbers.tolist())]
        elif hasattr(values, "items"):
            pairs = [(*self._known(key), value) for key, value in values.items()]
        else:
            reject("telemetry", "the values", values, "a dict of names to values, or channels and an array",
                   WrongType)
        numbers, texts = self._scene._command(), self._scene._command()
        ids, found = [], []
        for name, id, kind, value in pairs:
            label = _label(name)
            if kind == telemetry_pb2.CreateTelemetry.TEXT:
                texts.set_telemetry_texts.id.append(id)
                texts.set_telemetry_texts.text.append(_line("" if value is None else value, label))
                continue
            if kind == telemetry_pb2.CreateTelemetry.CHOICE:
                value = self._choice(name, id, value)
            ids.append(id)
            found.append(number(value, "the value", label))
        if ids:
            wire.put_array(numbers.set_telemetry, "id", np.array(ids, dtype=np.uint64))
            wire.put_array(numbers.set_telemetry, "value", np.array(found, dtype=float))
            self._execute(numbers)
        if texts.HasField("set_telemetry_texts"):
            self._execute(texts)

    def _execute(self, command):
        try:
            self._scene._execute(command)
        except NotFound:  # another client has removed a channel; query the ids again next time
            ids_of(self._scene).clear()
            raise

    def _known(self, key):
        """Returns (name, id, kind) of a channel or a name."""
        if isinstance(key, Channel):
            if key.scene != self._scene:
                reject(_label(key.name), "its scene", key.scene.name, f"a channel of {self._scene.name!r}")
            return key.name, key.id, key._kind
        found = ids_of(self._scene).get(text(key, "the name", "telemetry", "a channel, or its name"))
        if found is None:
            self[key]
            found = ids_of(self._scene)[key]
        return (key, *found)

    def _choice(self, name, id, value):
        if value is None:
            return math.nan
        if not isinstance(value, str):
            return value
        labels = Channel(self._scene, id, name, KINDS["choice"]).labels
        for each, label in labels.items():
            if label == value:
                return each
        raise InvalidArgument(f"{_label(name)}: the value is {shown(value)}; accepted: "
                              f"{', '.join(map(repr, labels.values()))}", _label(name))

    def below(self, name):
        """Returns the channel `name` and those below it ("rover": "rover", "rover/..."), sorted by name."""
        return [self._channel(info) for info in self._list(below=text(name, "the name", "telemetry"))]

    def read(self, below=""):
        """Returns {name: value} of all channels, or of those below a name, in one request."""
        return {info.channel.name: value_of(info)
                for info in self._list(below=text(below, "the name", "telemetry"))}

    def __getitem__(self, name):
        command = self._scene._command()
        command.list_telemetry.name.append(text(name, "the name", "telemetry"))
        return self._channel(self._scene._execute(command).telemetry.channel[0])

    def __contains__(self, name):
        try:
            return isinstance(name, str) and bool(self[name])
        except NotFound:
            return False

    def __iter__(self):
        return iter([info.channel.name for info in self._list()])

    def __len__(self):
        return len(self._list())

    def items(self):
        """Returns the (name, Channel) pairs, in one request."""
        return [(info.channel.name, self._channel(info)) for info in self._list()]

    def values(self):
        """Returns the Channels, in one request."""
        return [self._channel(info) for info in self._list()]

    def __repr__(self):
        try:
            return f"<dspace.Telemetry of scene {self._scene.name!r}, {len(self)} channels>"
        except Exception:  # a repr never raises
            return f"<dspace.Telemetry of scene {self._scene.name!r}, gone>"


class NoValue:
    """The text that overlays show, for any format, if a channel has no value."""

    def __format__(self, _):
        return "–"


def overlay_value(scene, key):
    """Returns what an overlay shows for a channel, such as "rover/power", or for its unit, "rover/power.unit": a float,
    a str or a NoValue. Returns None if the scene has no such channel."""
    for name, of in ((key, None), (key[:-5], "unit")) if key.endswith(".unit") else ((key, None),):
        try:
            info = scene.telemetry[name].info
        except NotFound:
            continue
        if of == "unit":
            return info.channel.unit
        return value_of(info) if info.state else NoValue()
    return None
