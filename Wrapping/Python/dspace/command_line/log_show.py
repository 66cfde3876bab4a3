"""`dspace log info`, `cat` and `cut`: what a recording contains, as text or as a new recording."""
import datetime
import math
import os

from dspace._core.wire import command_of
from dspace.command_line import Failed
from dspace.command_line.log_diff import name_of
from dspace.playback.steps import StepTimes
from dspace.recording.file import RecordingFile, carry_out, path_of


def show(options):
    with RecordingFile(options.file) as file:
        foreign = file.check(options.unpack_limit)
        last, first = file.last, file.first
        summary = file.summary
        print(f"{options.file}: format 1, commands {first} to {last}, {summary.snapshots} snapshots; "
              f"{'every checksum holds' if last or summary.snapshots else 'nothing is in it'}")
        if summary.kind:
            when = datetime.datetime.fromtimestamp(summary.first_wall_s, datetime.timezone.utc)
            print(f"simulation time {summary.first_time_s:g} to {summary.last_time_s:g} s; recorded in "
                  f"{summary.last_wall_s - summary.first_wall_s:.1f} s from {when:%Y-%m-%d %H:%M:%S} UTC")
        for each in summary.kind:
            print(f"{each.count:10} {name_of(each.kind):24} {each.bytes:12} bytes")
        for asset in file.assets:
            state = f"{asset.size} bytes, SHA-256 {asset.sha256.hex()}" if asset.state == "read" else asset.state
            print(f"file {asset.path}: {state}{', packed' if asset.packed else ''}")
        arrays = file.arrays
        if arrays:
            print(f"arrays of {len(arrays)} meshes: {sum(each.size for each in arrays)} bytes")
        for first, last in file.lost:
            print(f"lost: commands {first} to {last}")
        if foreign.count:
            print(foreign_text(foreign))
        if not last and not summary.snapshots:
            print("it holds no steps yet: its recording was just begun, or its process ended in its first moments")
    return 0


def foreign_text(foreign):
    """Returns the rows of a ForeignText (recordings.proto) as a line."""
    more = foreign.count - len(foreign.row)
    return (f"text that is not UTF-8: in {', '.join(foreign.row)}{f' and {more} others' if more else ''}; playback reads "
            "it as Windows-1252 (Latin-1)")


def write_out(options):
    with RecordingFile(options.file) as file:
        first = max(file.first, options.first or 1)
        last = file.last if options.last is None else min(file.last, options.last)
        for row in there(file, first, last):
            command = command_of(row.payload)
            text = str(command).replace("\n", " ") if row.kind != 24 else poses_text(command.set_poses)
            print(f"{row.seq} {row.time!r} {name_of(row.kind)}: {text.strip()}")
    return 0


def there(file, first, last):
    """Yields the rows of a range. Prints the ranges of lost commands and skips them."""
    for lost, end in file.lost:
        if first <= end and lost <= last:
            yield from file.rows(first, lost - 1) if lost > first else ()
            print(f"lost: commands {lost} to {end}")
            first = end + 1
    yield from file.rows(first, last) if last >= first else ()


def poses_text(command):
    return "; ".join(f"{frame}: " + " ".join(f"{value:.9g}" for value in command.pose[8 * i:8 * i + 8])
                     for i, frame in enumerate(command.frame))


def cut_out(options):
    """Writes a part of a recording, from the last snapshot before --from."""
    for name, at in (("--from", options.begin), ("--to", options.end)):
        if at is not None and math.isnan(at):
            raise Failed(f"{name} {at!r}; accepted: a time in s")
    if None not in (options.begin, options.end) and options.end < options.begin:
        raise Failed(f"--to {options.end!r}; accepted: {options.begin!r} and later, --from")
    with RecordingFile(options.file) as file:
        first, last = file.first, file.last
        steps = [step for step in file.step_begins() if step[0] <= last]  # the recording may still be growing
        times = StepTimes(at for _, at in steps)
        for name, at, end, side in (("--from", options.begin, max, 1), ("--to", options.end, min, -1)):
            if at is None or not steps or (at - end(times.times)) * side <= 0:
                continue
            if not times.is_at(times.times.index(end(times.times)), at):
                raise Failed(f"{name} {at!r}; accepted: within {file.label}, {min(times.times)!r} to "
                             f"{max(times.times)!r} s")
        after = lambda at: [seq for index, (seq, _) in enumerate(steps) if times.is_after(index, at)]
        if options.begin is not None:
            first = max({seq for seq, _ in steps}.difference(after(options.begin)), default=first)
        if options.end is not None:
            last = min([seq - 1 for seq in after(options.end) if seq > first], default=last)
        begin = carry_out("Cut", os.fsencode(file.path), os.fsencode(path_of(options.out)), first, last).number
        print(f"{options.out}: commands {begin + 1} to {last}")
    return 0
