"""`dspace log`: what recordings hold, where two part, what survives damage."""
import datetime
import itertools
import os

from dspace.command_line import Failed
from dspace.command_line.log_pack import pack
from dspace.command_line.log_salvage import salvage
from dspace.command_line.log_telemetry import add_arguments as add_telemetry
from dspace.recording_file import RecordingFile, write_recording
from dspace.session import commands_pb2 as pb

COMMANDS = pb.Command.DESCRIPTOR.fields_by_number


def add_arguments(parser):
    what = parser.add_subparsers(dest="what", metavar="WHAT", required=True)
    info = what.add_parser("info", help="how long it is and what is in it; reads and checks all of it")
    info.add_argument("file", metavar="FILE")
    info.set_defaults(run=show)
    cat = what.add_parser("cat", help="its commands as text")
    cat.add_argument("file", metavar="FILE")
    cat.add_argument("--first", type=int, default=None, metavar="N", help="the command to begin with")
    cat.add_argument("--last", type=int, default=None, metavar="N")
    cat.set_defaults(run=write_out)
    diff = what.add_parser("diff", help="where two runs part; exit code 1 where they do")
    diff.add_argument("file", metavar="FILE")
    diff.add_argument("other", metavar="OTHER")
    diff.add_argument("--tolerance", type=float, default=0.0, metavar="E",
                      help="in any number of a pose [m, or of a quaternion]; absent: 0")
    diff.set_defaults(run=compare)
    cut = what.add_parser("cut", help="a part of it as a recording of its own")
    cut.add_argument("file", metavar="FILE")
    cut.add_argument("--from", dest="begin", type=float, metavar="T", help="simulation time [s]")
    cut.add_argument("--to", dest="end", type=float, metavar="T")
    cut.add_argument("--out", required=True, metavar="FILE")
    cut.set_defaults(run=cut_out)
    packing = what.add_parser("pack", help="takes the files that it needs into it, so that it replays anywhere; exit "
                                           "code 1 where some cannot be had")
    packing.add_argument("file", metavar="FILE")
    packing.add_argument("--out", metavar="FILE", help="the packed recording; absent: FILE itself, which nobody may "
                                                       "be writing or reading")
    packing.set_defaults(run=pack)
    rescue = what.add_parser("salvage", help="every command of a damaged one that its own checksum vouches for; "
                                             "exit code 1 where some are lost")
    rescue.add_argument("file", metavar="FILE")
    rescue.add_argument("--out", required=True, metavar="FILE", help="the new recording")
    rescue.set_defaults(run=salvage)
    add_telemetry(what)


def name_of(kind):
    field = COMMANDS.get(kind)
    return field.name if field else f"number {kind}"


def show(options):
    with RecordingFile(options.file) as file:
        file.check()
        last, first = file.last, file.first
        counts = file.ask("SELECT kind, count(*), sum(length(payload)) FROM command GROUP BY kind ORDER BY 2 DESC")
        ends = file.ask("SELECT min(time), max(time), min(wall), max(wall) FROM command")[0]
        print(f"{options.file}: format 1, commands {first} to {last}, "
              f"{file.ask('SELECT count(*) FROM snapshot')[0][0]} snapshots; every checksum holds")
        if counts:
            when = datetime.datetime.fromtimestamp(ends[2], datetime.timezone.utc)
            print(f"simulation time {ends[0]:g} to {ends[1]:g} s; recorded in {ends[3] - ends[2]:.1f} s "
                  f"from {when:%Y-%m-%d %H:%M:%S} UTC")
        for kind, count, size in counts:
            print(f"{count:10} {name_of(kind):24} {size:12} bytes")
        for asset in file.assets:
            said = f"{asset.size} bytes, SHA-256 {asset.sha256.hex()}" if asset.state == "read" else asset.state
            print(f"file {asset.path}: {said}{', packed' if asset.packed else ''}")
        for first, last in file.lost:
            print(f"lost: commands {first} to {last}")
    return 0


def write_out(options):
    with RecordingFile(options.file) as file:
        first = max(file.first, options.first or 1)
        last = file.last if options.last is None else min(file.last, options.last)
        for row in file.rows(first, last) if last >= first else ():
            command = pb.Command.FromString(row.payload)
            text = str(command).replace("\n", " ") if row.kind != 24 else poses_text(command.set_poses)
            print(f"{row.seq} {row.time!r} {name_of(row.kind)}: {text.strip()}")
    return 0


def poses_text(command):
    return "; ".join(f"{frame}: " + " ".join(f"{value:.9g}" for value in command.pose[8 * i:8 * i + 8])
                     for i, frame in enumerate(command.frame))


def compare(options):
    """Both streams side by side: the same commands in the same order, poses to the tolerance."""
    if not options.tolerance >= 0:
        raise Failed(f"--tolerance {options.tolerance!r}; accepted: 0 and more")
    greatest = 0.0
    with RecordingFile(options.file) as one, RecordingFile(options.other) as two:
        if {one.first, two.first} != {1}:
            raise Failed("a part of a recording cannot be compared; accepted: whole ones")
        if one.snapshot(0).payload != two.snapshot(0).payload:
            print("they begin with different states")
            return 1
        for a, b in itertools.zip_longest(one.rows(), two.rows()):
            if a is None or b is None:
                longer, row = (options.file, a) if b is None else (options.other, b)
                print(f"the same up to command {row.seq - 1}; {longer} goes on with {name_of(row.kind)} "
                      f"at {row.time!r} s")
                return 1
            if a.payload == b.payload and a.time == b.time:
                continue
            gap = difference(a, b)
            if isinstance(gap, float) and gap <= options.tolerance and a.time == b.time:
                greatest = max(greatest, gap)
                continue
            print(f"they part at command {a.seq}, {a.time!r} s and {b.time!r} s: {name_of(a.kind)} and "
                  f"{name_of(b.kind)}" + (f", poses differ by up to {gap:.6g}" if isinstance(gap, float) else ""))
            return 1
        print(f"the same: {one.last} commands" + (f", poses to {greatest:.6g}" if greatest else ""))
    return 0


def difference(a, b):
    """The greatest one of poses of the same frames; None for anything else."""
    if a.kind != b.kind or a.kind != pb.Command.SET_POSES_FIELD_NUMBER:
        return None
    one, two = pb.Command.FromString(a.payload), pb.Command.FromString(b.payload)
    if one.scene != two.scene or one.set_poses.frame != two.set_poses.frame:
        return None
    return max((abs(x - y) for x, y in zip(one.set_poses.pose, two.set_poses.pose)), default=0.0)


def cut_out(options):
    """From the last snapshot before the time to begin with."""
    with RecordingFile(options.file) as file:
        steps = file.steps()
        first, last = file.first, file.last
        if options.begin is not None:
            first = max([seq for seq, at in steps if at <= options.begin], default=first)
        if options.end is not None:
            last = min([seq - 1 for seq, at in steps if at > options.end and seq > first], default=last)
        snapshot = file.snapshot(first - 1)
        rows = list(file.rows(snapshot.seq + 1, last)) if last > snapshot.seq else []
        later = [row for row in file.rows(snapshot.seq + 1, last, "snapshot")]
        write_recording(os.path.abspath(options.out), rows, [snapshot, *later], file.path)
        print(f"{options.out}: commands {snapshot.seq + 1} to {last}")
    return 0
