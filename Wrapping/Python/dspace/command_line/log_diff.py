"""`dspace log diff`: finds where two runs differ; compares numbers with a tolerance."""
import itertools
import math

from dspace._core.wire import command_of
from dspace.command_line import Failed
from dspace.proto import commands_pb2 as pb
from dspace.recording.file import RecordingFile, commands_of

NAMES = pb.Command.DESCRIPTOR.fields_by_number
# Commands that name channels of telemetry by ids, and those after which ids name others.
OF_CHANNELS = ("create_telemetry", "set_telemetry", "set_telemetry_texts", "set_telemetry_limits", "remove_telemetry")
CHANNEL_KINDS, NAMING = ({pb.Command.DESCRIPTOR.fields_by_name[name].number for name in names}
                         for names in (OF_CHANNELS, ("create_telemetry", "remove_scene")))
UNNAMED = 1 << 62  # above this: ids that no command of the recording created


class Channels:
    """The names behind the ids of telemetry in one recording. Ids of two runs differ where other scenes had channels
    before them; names do not."""

    def __init__(self, numbers):
        self._numbers = numbers  # {(scene, name): number}, shared by the recordings that are compared
        self.ids = {}  # {(scene, id): number}

    def note(self, command):
        """Follows a command that gives or ends the meaning of ids."""
        if command.HasField("create_telemetry"):
            key = command.scene, command.create_telemetry.name
            self.ids[command.scene, command.create_telemetry.id] = self._numbers.setdefault(key, len(self._numbers) + 1)
        elif command.HasField("remove_scene"):
            self.ids = {key: number for key, number in self.ids.items() if key[0] != command.scene}

    def put(self, command):
        """Writes the numbers of the channels' names in place of ids."""
        kind = command.WhichOneof("command")
        if kind in OF_CHANNELS:
            message = getattr(command, kind)
            number = lambda id: self.ids.get((command.scene, id), id | UNNAMED)
            if kind in ("create_telemetry", "set_telemetry_limits"):
                message.id = number(message.id)
            else:
                message.id[:] = [number(id) for id in message.id]
        return command


def name_of(kind):
    field = NAMES.get(kind)
    return field.name if field else f"number {kind}"


def compare(options):
    """Compares both command streams: the same commands in the same order, with numbers and times that differ by no
    more than the tolerance. Channels of telemetry are compared by name, not by id."""
    if not options.tolerance >= 0:
        raise Failed(f"--tolerance {options.tolerance!r}; accepted: 0 and more")
    greatest = 0.0
    with RecordingFile(options.file) as one, RecordingFile(options.other) as two:
        if one.lost or two.lost:
            raise Failed("a recording that lacks commands cannot be compared; accepted: whole ones")
        if {one.first, two.first} != {1}:
            raise Failed("a part of a recording cannot be compared; accepted: whole ones")
        starts = [commands_of(file.snapshot(0)) for file in (one, two)]
        numbers = {}
        channels = Channels(numbers), Channels(numbers)
        if len(starts[0]) != len(starts[1]):
            print(f"they begin with different states, of {len(starts[0])} and {len(starts[1])} commands")
            return 1
        for a, b in zip(*starts):
            for payload, names in ((a, channels[0]), (b, channels[1])):
                names.note(command_of(payload))
            gap, where = difference(a, b, channels, channels[0].ids == channels[1].ids)
            if not gap <= options.tolerance:
                print(f"they begin with different states: {where}")
                return 1
            greatest = max(greatest, gap)
        alike = channels[0].ids == channels[1].ids
        for a, b in itertools.zip_longest(one.rows(), two.rows()):
            if a is None or b is None:
                longer, row = (options.file, a) if b is None else (options.other, b)
                print(f"the same up to command {row.seq - 1}; {longer} goes on with {name_of(row.kind)} "
                      f"at {row.time!r} s")
                return 1
            for row, names in ((a, channels[0]), (b, channels[1])):
                if row.kind in NAMING:
                    names.note(command_of(row.payload))
                    alike = channels[0].ids == channels[1].ids
            gap, where = difference(a.payload, b.payload, channels, alike or a.kind not in CHANNEL_KINDS)
            if abs(a.time - b.time) > gap:
                gap, where = abs(a.time - b.time), "the time"
            if not gap <= options.tolerance:
                kinds = name_of(a.kind) if a.kind == b.kind else f"{name_of(a.kind)} and {name_of(b.kind)}"
                print(f"they part at command {a.seq}, {a.time!r} s and {b.time!r} s: {kinds}, in {where}"
                      + (f" by {gap:.6g}" if gap < math.inf else ""))
                return 1
            greatest = max(greatest, gap)
        other = other_file(one, two)
        if other:
            print(f"the same commands, of other files: {other}")
            return 1
        print(f"the same: {one.last} commands" + (f", numbers to {greatest:.6g}" if greatest else ""))
    return 0


def other_file(one, two):
    """Returns the first file needed by the commands that differs between the recordings, or "" if none does."""
    there = [{asset.path: asset for asset in file.assets} for file in (one, two)]
    say = lambda asset: "is not noted" if asset is None else (
        f"has {asset.size} bytes of SHA-256 {asset.sha256.hex()}" if asset.state == "read" else f"is {asset.state}")
    for path in sorted({*there[0], *there[1]}):
        a, b = (each.get(path) for each in there)
        if a is None or b is None or (a.state, a.size, a.sha256) != (b.state, b.size, b.sha256):
            return f"{path!r} {say(a)}, and {say(b)}"
    return ""


def difference(a, b, channels, alike):
    """Returns the greatest difference of any number in two serialized commands and the name of its field. The
    difference is infinite if they differ in anything else. channels: the Channels of both recordings. alike: whether
    equal bytes mean the same channels."""
    if a == b and alike:
        return 0.0, ""
    found = of_messages(*(each.put(command_of(payload)) for each, payload in zip(channels, (a, b))), "")
    # Different bytes may hold the same values, or fields that this version does not know.
    return found if found[0] or unknown(a) == unknown(b) else (math.inf, "a field that is not known here")


def unknown(payload):
    """Returns the serialized command if it has fields, at any depth, that this version does not know; else None."""
    message = command_of(payload)
    kept = message.SerializeToString(deterministic=True)
    message.DiscardUnknownFields()
    return None if kept == message.SerializeToString(deterministic=True) else kept


def of_messages(one, two, path):
    worst = (0.0, "")
    fields = {field.name: field for message in (one, two) for field, _ in message.ListFields()}
    for name, field in fields.items():
        here = f"{path}.{name}" if path else name
        if field.label == field.LABEL_REPEATED:
            a, b = getattr(one, name), getattr(two, name)
            if len(a) != len(b):
                return math.inf, f"{here} ({len(a)} and {len(b)})"
            if field.message_type is not None and field.message_type.GetOptions().map_entry:
                if dict(a) != dict(b):
                    return math.inf, here
                continue
            pairs = ((f"{here}[{i}]", x, y) for i, (x, y) in enumerate(zip(a, b)))
        else:
            if field.has_presence and one.HasField(name) != two.HasField(name):
                return math.inf, here
            pairs = ((here, getattr(one, name), getattr(two, name)),)
        for place, x, y in pairs:
            found = of_values(field, x, y, place)
            if found[0] > worst[0]:
                worst = found
            if worst[0] == math.inf:
                return worst
    return worst


def of_values(field, x, y, place):
    if field.message_type is not None:
        return of_messages(x, y, place)
    if x == y:
        return 0.0, ""
    if field.cpp_type not in (field.CPPTYPE_DOUBLE, field.CPPTYPE_FLOAT):
        return math.inf, place
    if math.isnan(x) and math.isnan(y):
        return 0.0, ""
    gap = abs(x - y)
    return (math.inf if math.isnan(gap) else gap), place
