"""The steps of a recording at which its scenes, cameras and viewports exist."""
import bisect

from dspace._core.traits import scene_name
from dspace._core.wire import command_of
from dspace.proto import commands_pb2 as pb
from dspace.recording.file import commands_of

KINDS = sorted(pb.Command.DESCRIPTOR.fields_by_name[name].number for name in (
    "create_scene", "remove_scene", "remove_vantage", "set_camera", "remove_camera", "create_viewport",
    "remove_viewport"))


class _Present:
    """The keys of what exists after the commands so far; see spans_of()."""

    def __init__(self):
        self.now = {}  # keys only, in the order of creation

    def apply(self, command):
        scene, kind = scene_name(command), command.WhichOneof("command")
        if kind == "create_scene":
            self.now.setdefault(("scene", scene))
        elif kind == "remove_scene":
            self._remove(lambda key: key[0] != "viewport" and key[1] == scene)
        elif kind == "remove_vantage":
            gone = ("camera", scene, command.remove_vantage.name)
            self._remove(lambda key: key[:3] == gone)
        elif kind == "set_camera":
            self.now.setdefault(("camera", scene, command.set_camera.vantage or "main", command.set_camera.name))
        elif kind == "remove_camera":
            self.now.pop(("camera", scene, command.remove_camera.vantage or "main", command.remove_camera.name), None)
        elif kind == "create_viewport":
            self.now.setdefault(("viewport", command.create_viewport.name or self._free_name()))
        elif kind == "remove_viewport":
            self.now.pop(("viewport", command.remove_viewport.viewport), None)

    def _remove(self, gone):
        self.now = {key: None for key in self.now if not gone(key)}

    def _free_name(self):
        """Returns the name that the interpreter would choose."""
        name, number = "viewport", 1
        while ("viewport", name) in self.now:
            number += 1
            name = f"viewport {number}"
        return name


def spans_of(playback):
    """Returns {thing: [(begin, end)]}: the ranges [begin, end) of steps of a Playback at which a thing exists. Things
    are ("scene", name), ("camera", scene, vantage, name) and ("viewport", name), in the order of creation. Reads and
    checks only the commands that create and remove them."""
    file, ends = playback.file, playback._ends
    present, spans = _Present(), {}

    def note(index):
        for key, ranges in spans.items():
            if ranges[-1][1] is None and key not in present.now:
                ranges[-1] = (ranges[-1][0], index)
        for key in present.now:
            ranges = spans.setdefault(key, [])
            if not ranges or ranges[-1][1] is not None:
                ranges.append((index, None))

    # After a gap the state is that of the last snapshot.
    begins = sorted({0, *(gap.before for gap in playback.gaps if gap.before < len(ends))})
    for begin, end in zip(begins, [*begins[1:], len(ends)]):
        snapshot = file.snapshot(ends[begin])
        present.now = {}
        for command in commands_of(snapshot):
            present.apply(command_of(command))
        index = begin
        for row in file.only(KINDS, snapshot.seq + 1, ends[end - 1]):
            following = max(begin, bisect.bisect_left(ends, row.seq, begin, end))
            if following != index:
                note(index)
                index = following
            present.apply(command_of(row.payload))
        note(index)
    return {key: [(a, len(ends) if b is None else b) for a, b in ranges if a != b] for key, ranges in spans.items()}


def when(playback, ranges):
    """Returns ranges of steps as text: "from 0 to 3 s, at 4 s, from 5 s on"."""
    times, parts = playback.times, []
    for begin, end in ranges[:5]:
        parts.append(f"from {times[begin]:g} s on" if end == len(times) else
                    f"at {times[begin]:g} s" if times[begin] == times[end - 1] else
                    f"from {times[begin]:g} to {times[end - 1]:g} s")
    return ", ".join(parts) + (", ..." if len(ranges) > 5 else "")
