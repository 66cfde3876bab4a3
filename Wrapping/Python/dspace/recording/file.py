"""Reads recordings. Documentation/Recording.md describes the file. The reader is in C++ (RecordingReader.h). This
module executes and draws nothing."""
import os
import threading
from typing import NamedTuple

from dspace import vtk as _vtk
from dspace._core.fields import integer, reject, text
from dspace._core.replies import make_error, to_bytes
from dspace._core.signals import SLICE, check_signals
from dspace.errors import Closed, Corrupt, WrongThread
from dspace.proto import recordings_pb2 as pb

LAST = 2 ** 62  # more commands than any recording has
_ARRAYS = "arrays"  # the state of an asset that is no file but the arrays of a mesh


def path_of(path):
    """Returns the absolute path of a str or a path object. Raises dspace.InvalidArgument or dspace.WrongType."""
    path = text(os.fspath(path) if isinstance(path, os.PathLike) else path, "the path", "recording",
                "a str or a path")
    if not path or "\0" in path:
        reject("recording", "the path", path, "one that is not empty and holds no zero bytes")
    return os.path.abspath(path)


class Row(NamedTuple):
    """A command, or a snapshot: the commands that produce the state after command `seq`."""

    seq: int
    time: float  # of the simulation [s]
    wall: float  # seconds past 1970 UTC
    kind: int    # field number in Command; of a snapshot: the number of its commands
    payload: bytes


class Asset(NamedTuple):
    """A file that commands need. state: "read"; or "absent", "unreadable" or "changed", without size and hash."""

    id: int
    path: str
    state: str
    size: int
    sha256: bytes
    packed: bool  # its content is in the recording


def commands_of(snapshot):
    """Returns the serialized commands of a snapshot's payload, in which each follows its length as a varint."""
    data, at, found = snapshot.payload, 0, []
    while at < len(data):
        length = shift = 0
        byte = 128
        while byte >= 128 and at < len(data):
            byte = data[at]
            length |= (byte & 127) << shift
            shift += 7
            at += 1
        if byte >= 128 or length > len(data) - at:
            raise Corrupt(f"snapshot {snapshot.seq}: it is not a list of commands", f"snapshot {snapshot.seq}")
        found.append(data[at:at + length])
        at += length
    return found


def reply_of(answer):
    """Returns the RecordingReply of a method of the wrapped classes. Raises the exception of its error."""
    reply = pb.RecordingReply.FromString(to_bytes(answer))
    if reply.HasField("error"):
        raise make_error(reply.error)
    return reply


def carry_out(name, *arguments):
    """Runs a long task on recordings, such as "Salvage" (vtkDspaceRecordingTask), and returns its RecordingReply.
    Ctrl-C cancels it without leaving a new file."""
    return carry_out_in(_vtk.vtkDspaceRecordingTask(), name, *arguments)


def carry_out_in(task, name, *arguments):
    """Runs the long work `name` of a wrapped object that works in a thread, and returns its RecordingReply. An exception
    meanwhile, such as that of Ctrl-C, cancels it."""
    getattr(task, "Begin" + name)(*arguments)
    try:
        while not task.Wait(SLICE):
            check_signals()
    except BaseException:
        task.Cancel()
        raise
    return reply_of(task.TakeReply())


def unpack_limit_of(limit):
    """Returns the number that the wrapped classes take for a limit of unpacked bytes: 0 for None, the default."""
    if limit is None:
        return 0
    accepted = "a number of bytes, 1 to 2^62"
    if not 1 <= integer(limit, "unpack_limit", "recording", accepted) <= 2 ** 62:
        reject("recording", "unpack_limit", limit, accepted)
    return int(limit)


def _number(seq):
    """Clamps the number of a command to the valid range."""
    return min(max(int(seq), 0), LAST)


class RecordingFile:
    """Reads a recording, also while it is being written. Every row is checked against its checksum when it is read. A
    damaged row raises dspace.Corrupt, which names the file and the command. A file that is not a recording, or that a
    newer Dspace wrote, raises dspace.Unsupported. A file that cannot be opened, or that a process has locked, raises
    dspace.Io."""

    def __init__(self, path):
        self.path = path_of(path)
        self.label = f"recording {self.path!r}"
        self._vtk = _vtk.vtkDspaceRecordingReader()
        self._thread = threading.get_ident()
        self.foreign = set()  # of the rows that were read, "command 17": their text was not UTF-8, but is in the Row
        reply_of(self._vtk.Open(os.fsencode(self.path)))

    def close(self):
        if self._vtk is not None:
            self._vtk.Close()
        self._vtk = None

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.close()

    def _ask(self, name, *values):
        """Calls a method of the reader and returns its RecordingReply."""
        if self._vtk is None:
            raise Closed(f"{self.label}: it is closed; accepted: to open it again", self.label)
        if threading.get_ident() != self._thread:
            raise WrongThread(f"{self.label}: it is read in another thread; accepted: the one that opened it",
                              self.label)
        return reply_of(getattr(self._vtk, name)(*values))

    def corrupt(self, what):
        return Corrupt(f"{self.label}: {what}; `dspace log salvage` recovers what survives", self.label)

    def _rows(self, method, first, last, kinds):
        # Part by part: a recording may be larger than memory.
        following, last = _number(first), _number(last)
        while following <= last:
            reply = self._ask(method, following, last, kinds)
            yield from (self._row(row, "command") for row in reply.row)
            if not reply.next:
                return
            following = reply.next

    def _row(self, row, table):
        if row.foreign_text:
            self.foreign.add(f"{table} {row.seq}")
        return Row(row.seq, row.time_s, row.wall_s, row.kind, row.payload)

    def rows(self, first=1, last=None):
        """Yields the commands first..last in order, with none missing between. last: default: the present last one."""
        return self._rows("ReadRows", first, self.last if last is None else last, "")

    def rows_of(self, kinds, first, last):
        """Yields those of the commands first..last that are of some kinds (field numbers), in order, with none missing
        between. All commands are read and checked, so that a row with a damaged kind cannot hide one."""
        return self._rows("ReadRows", first, last, ",".join(map(str, kinds)))

    def only(self, kinds, first, last):
        """Yields the same commands without reading others. It may skip a command whose kind is damaged."""
        return self._rows("ReadOnly", first, last, ",".join(map(str, kinds)))

    @property
    def first(self):
        """The first command's number: 1, unless it was cut."""
        return self._ask("First").number

    @property
    def last(self):
        """The last command's number; 0 without any."""
        return self._ask("Last").number

    @property
    def begin(self):
        """The number of the snapshot that it begins with: 0, unless it was cut."""
        return self._ask("Begin").number

    def steps(self, scene=None):
        """Returns (seq, time) of every command that set the time, in one scene or in any, in order."""
        reply = self._ask("Steps", scene is not None, scene or "")
        return list(zip(reply.seq, reply.time_s))

    def step_begins(self):
        """Returns (first command, time) of every step after the first snapshot, in order. The first entry is for the
        commands before the time was first set."""
        reply = self._ask("StepBegins")
        return list(zip(reply.seq, reply.time_s))

    def playback_steps(self, scene=None):
        """Returns a RecordingReply with the steps that can be shown, of one scene or of all, and the gaps between."""
        return self._ask("PlaybackSteps", scene is not None, scene or "")

    def blocks(self):
        """Returns the ranges of commands with none missing between: (first, last, snapshot). snapshot is the number of
        the first state from which they can be played, or None."""
        return [(each.first, each.last, each.snapshot if each.HasField("snapshot") else None)
                for each in self._ask("Blocks").range]

    def snapshot(self, seq):
        """Returns the last snapshot at or before a command."""
        return self._row(self._ask("ReadSnapshot", _number(seq)).row[0], "snapshot")

    @property
    def snapshots(self):
        """The numbers of all snapshots."""
        return list(self._ask("Snapshots").seq)

    @property
    def assets(self):
        """The files that its commands need, by path."""
        return [each for each in self._assets() if each.state != _ARRAYS]

    @property
    def arrays(self):
        """The arrays of meshes, each once: Assets whose `sha256` is MeshData.digest in the commands."""
        return [each for each in self._assets() if each.state == _ARRAYS]

    def _assets(self):
        return [Asset(each.id, os.fsdecode(each.path), each.state.decode(errors="replace"), each.size, each.sha256,
                      each.packed) for each in self._ask("Assets").asset]

    @property
    def lost(self):
        """Ranges (first, last) of commands that salvaging it did not recover."""
        return [(each.first, each.last) for each in self._ask("Lost").range]

    @property
    def summary(self):
        """A RecordingSummary (recordings.proto): its size, its times, its commands by kind."""
        return self._ask("Summary").summary

    def reject_no_steps(self):
        """Raises the error of a recording that has no steps."""
        self._ask("NoSteps")

    def check(self, unpack_limit=None):
        """Reads the complete file. Raises dspace.Corrupt at the first damage. Returns a ForeignText
        (recordings.proto): the commands and snapshots whose text is not UTF-8. unpack_limit: the most bytes that packed
        content may have unpacked (default: 1 GiB and 20 times the recording's size; dspace.Resource beyond)."""
        self._ask("First")  # checks that the file is open and the thread is the right one
        return carry_out("Check", os.fsencode(self.path), unpack_limit_of(unpack_limit)).foreign
