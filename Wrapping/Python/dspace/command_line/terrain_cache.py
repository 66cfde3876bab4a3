"""`dspace terrain cache`: builds averaged overviews of rasters that have none, in the cache folder."""
import glob
import json
import os
import select
import signal
import sys
import time

from dspace.command_line import Failed, tell
from dspace.command_line.terrain_rasters import mebibytes

ABOUT = (
    "Builds averaged overviews of rasters that have none, so that distant ground shows the mean of all its pixels. "
    "add_terrain reads them from the cache folder. Nothing is written beside a raster. Each file is read once, "
    "completely. A terminal shows the number of compressed bytes written so far; the total is not known in advance. "
    "Ctrl-C cancels and leaves the folder as it was.")
TICK = 0.2  # seconds


def add_arguments(parser):
    parser.add_argument("files", nargs="*", metavar="FILE", help="any raster that GDAL opens")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--list", action="store_true", help="list the contents of the folder")
    what.add_argument("--clear", action="store_true",
                      help="remove the overviews of FILE..., or all of them without FILE")
    what.add_argument("--verify", action="store_true", help="read all overviews; exit code 1 if one is damaged")
    parser.add_argument("--folder", metavar="DIR",
                        help="the cache folder (default: $XDG_CACHE_HOME/dspace/terrain or ~/.cache/dspace/terrain)")
    parser.add_argument("--band", type=int)
    parser.add_argument("--crs", help="CRS of the raster: WKT, PROJ, AUTHORITY:CODE")
    parser.add_argument("--pixel-size", type=float, metavar="P",
                        help="size of a pixel in map units, if the raster has no georeference")
    parser.set_defaults(run=run)


def run(options):
    if options.folder == "":
        raise Failed("--folder ''; accepted: a folder's path")
    if options.list or options.verify:
        if options.files:
            raise Failed(f"--{'list' if options.list else 'verify'} applies to the complete folder; accepted: no FILE")
        return show(options)
    if options.clear:
        return clear(options)
    if not options.files:
        raise Failed("no FILE is given; accepted: FILE ..., --list, --clear or --verify")
    for ending in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(ending, signal.default_int_handler)
    failed = 0
    try:
        folder = folder_of(options)
        for path in options.files:
            failed |= build(path, folder, options)
    except KeyboardInterrupt:
        tell("cancelled; no partial overviews are left")
        return 130
    return failed


def ask(name, options, **values):
    """Executes a cache command and returns its reply: the entries and the folder."""
    import dspace
    from dspace._core.fields import put, put_given
    from dspace.proto import commands_pb2
    command = commands_pb2.Command()
    message = getattr(command, name)
    put(message, "the cache", folder=options.folder or "")
    put_given(message, "the cache", **values)
    with dspace.Session() as session:
        return session.execute(command).terrain_cache


# --- Built -----------------------------------------------------------------------------------------

def build(path, folder, options):
    """Builds the overviews of a file in a child process, which can be killed at any time. Returns the exit code."""
    began = time.monotonic()
    answer, child = in_child(lambda: [
        {"file": entry.file, "bytes": entry.bytes, "levels": entry.levels}
        for entry in ask("build_terrain_cache", options, path=path, band=options.band, crs=options.crs,
                         pixel_size=options.pixel_size).entry])
    try:
        found = wait(answer, lambda: note(f"{path}: {mebibytes(written(folder, child))} written, "
                                          f"{time.monotonic() - began:.0f} s"))
    except BaseException:
        os.kill(child, signal.SIGKILL)
        raise
    finally:
        os.waitpid(child, 0)
        os.close(answer)
        note("")
        for part in parts(folder, child):
            os.remove(part)
    if isinstance(found, str):
        return tell(found if path in found else f"'{path}': {found}")
    if not found:
        print(f"{path}: has its own overviews; none are built")
    for entry in found:
        print(f"{path}: {entry['levels']} levels of overviews, {mebibytes(entry['bytes'])}, "
              f"{time.monotonic() - began:.1f} s: {entry['file']}", flush=True)
    return 0


def folder_of(options):
    answer, child = in_child(lambda: [ask("list_terrain_cache", options).folder])
    found = wait(answer, lambda: None)
    os.close(answer)
    os.waitpid(child, 0)
    if isinstance(found, str):
        raise Failed(found)
    return found[0]


def in_child(work):
    """Starts work() in a child process. Returns the read end of the pipe for its result, and its process id."""
    sys.stdout.flush()
    answer, output = os.pipe()
    child = os.fork()
    if child:
        os.close(output)
        return answer, child
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent kills it
    try:
        text = json.dumps(work())
    except Exception as error:
        text = json.dumps(str(error) or type(error).__name__)
    os.write(output, text.encode())
    os._exit(0)


def wait(answer, each_tick):
    text = b""
    while True:
        if not select.select([answer], [], [], TICK)[0]:
            each_tick()
            continue
        more = os.read(answer, 65536)
        if not more:
            return json.loads(text) if text else "the process that built its overviews ended early"
        text += more


def parts(folder, child):
    """Returns the temporary files of a process. AtomicFile puts the process id into their names."""
    return glob.glob(os.path.join(glob.escape(folder), f".*.overviews.{child:08x}*.part"))


def written(folder, child):
    return sum(os.path.getsize(part) for part in parts(folder, child) if os.path.exists(part))


def note(text):
    """Shows one line on a terminal, which the next call replaces."""
    if sys.stderr.isatty():
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)


# --- Listed, cleared, verified ---------------------------------------------------------------------

def show(options):
    reply = ask("verify_terrain_cache" if options.verify else "list_terrain_cache", options)
    damaged = 0
    for entry in reply.entry:
        line(entry)
        if entry.problem:
            damaged = tell(f"'{entry.file}': {entry.problem}; use --clear, or build it again")
    total(reply, "all intact" if options.verify and not damaged else "")
    return damaged if options.verify else 0


def clear(options):
    failed = 0
    for path in options.files or [None]:
        reply = ask("clear_terrain_cache", options, path=path)
        for entry in reply.entry:
            line(entry)
        if path is not None and not reply.entry:
            failed = tell(f"'{path}': no overviews of it are in '{reply.folder}'")
        else:
            total(reply, "removed")
    return failed


def line(entry):
    print(f"{entry.path or 'unknown'}: {entry.levels} levels, {mebibytes(entry.bytes)}: {entry.file}")


def total(reply, more):
    print(f"{len(reply.entry)} rasters, {mebibytes(sum(entry.bytes for entry in reply.entry))} in {reply.folder}"
          + (f", {more}" if more else ""))
