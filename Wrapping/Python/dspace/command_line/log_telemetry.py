"""`dspace log telemetry` and `dspace log events`: the telemetry and events of a recording as tables."""
import csv
import io
import math
import sys

from dspace._core.files import atomic_write
from dspace.errors import InvalidArgument
from dspace.playback.telemetry import History
from dspace.recording.file import RecordingFile


def chosen(series, names):
    """Returns the series with the given names, and those below them."""
    if names is None:
        return list(series.values())
    found = {}
    for name in names:
        below = [each for each in series if each == name or each.startswith(name + "/")]
        if not below:
            series[name]  # raises an error that lists the names
        found.update((each, series[each]) for each in below)
    return list(found.values())


def write(path, head, rows):
    if path == "-":
        out = csv.writer(sys.stdout, lineterminator="\n")
        out.writerow(head)
        out.writerows(rows)
        return
    text = io.StringIO(newline="")
    out = csv.writer(text, lineterminator="\n")
    out.writerow(head)
    out.writerows(rows)
    atomic_write(path, text.getvalue().encode(), f"--csv {path!r}", new=True,
                 accepted="a new file in a folder that may be written and has free space, or '-'")


def cell(series, value):
    """Returns a value as text: numbers exactly, and "" where there is no value."""
    if series.kind == "text":
        return value or ""
    if math.isnan(value):
        return ""
    return series.labels.get(int(value), repr(float(value))) if series.kind == "choice" else repr(float(value))


def list_telemetry(options):
    with RecordingFile(options.file) as file:
        series = chosen(History(file).scene(options.scene).series(), options.name)
    if options.csv is None:
        for each in series:
            unit = each.kind if each.kind != "number" else f"[{each.unit}]" if each.unit else "[]"
            summary = f"{len(each.times):8} values"
            if len(each.times):
                summary += f", {min(each.times):g} to {max(each.times):g} s"
            if each.kind == "number" and any(value == value for value in each.values):
                good = [value for value in each.values if value == value]
                summary += f", {min(good):.6g} to {max(good):.6g}"
            print(f"{each.name:32} {unit:10} {summary}")
        return 0
    rows = []
    for each in series:
        rows += [(time, each.name, cell(each, value), each.unit) for time, value in zip(each.times.tolist(), each.values)]
    if all(a <= b for each in series for a, b in zip(each.times, each.times[1:])):
        rows.sort(key=lambda row: row[0])  # of several channels; stable
    write(options.csv, ("time_s", "name", "value", "unit"), ((repr(row[0]), *row[1:]) for row in rows))
    return 0


def list_events(options):
    with RecordingFile(options.file) as file:
        events = History(file).scene(options.scene).events
    if options.kind is not None:
        unknown = set(options.kind) - {event.kind for event in events}
        if unknown:
            raise InvalidArgument(f"{file.label}: there are no events of kind {', '.join(map(repr, sorted(unknown)))}; "
                                  f"there are: {', '.join(sorted({event.kind for event in events})) or 'none'}")
        events = [event for event in events if event.kind in options.kind]

    def data(event):
        return "; ".join(f"{name}={value if isinstance(value, str) else repr(value)}"
                         + (f" {event.units[name]}" if name in event.units else "")
                         for name, value in event.data.items())

    if options.csv is not None:
        write(options.csv, ("number", "time_s", "severity", "kind", "text", "frame", "data"),
              ((event.number, repr(event.time), event.severity, event.kind, event.text, event.frame_path, data(event))
               for event in events))
        return 0
    for event in events:
        line = event.text.replace("\n", " / ")
        more = [each for each in (event.frame_path, data(event)) if each]
        print(f"{event.number:6} {event.time:14.6f} s  {event.severity:8} {event.kind:12} {line}"
              + (f"  ({'; '.join(more)})" if more else ""))
    return 0
