"""`dspace play`: draws pictures of a recording, without a simulation."""
import math
import os
import re
import sys

from dspace.command_line import Failed, confinement, set_limits, tidy_end
from dspace.command_line.log import add_unpack_limit

PICTURE = re.compile(r"\d{6,}\.png")
ABOUT = (
    "Draws the pictures of a recorded session, identical to the byte: one picture at the time --at; or one at each "
    "step of the simulation at which the viewport exists, with --every at most one per interval of simulation time. "
    "Without --out it prints the duration of the recording, and its viewports with the times at which they exist.")


def add_arguments(parser):
    parser.description = ABOUT
    parser.add_argument("file", metavar="FILE", help="a recording (.dspace)")
    parser.add_argument("--at", type=float, metavar="T", help="simulation time [s]: one picture")
    parser.add_argument("--viewport", metavar="NAME", help="the viewport to draw; absent: the recording's only one")
    parser.add_argument("--out", metavar="DIR", help="folder for the pictures, 000000.png and so "
                                                                  "on; rejected if it has such pictures")
    parser.add_argument("--every", type=float, metavar="DT", help="seconds of simulation time between pictures; not "
                                                                    "with --at")
    parser.add_argument("--reverse", action="store_true", help="draw from the last step to the first; not with --at")
    parser.add_argument("--allow-network", action="store_true",
                        help="allow connections, for a recording whose rasters are on servers")
    confinement.add_argument(parser, "the recording")
    add_unpack_limit(parser)
    parser.add_argument("--limit", action="append", metavar="NAME=VALUE", default=[],
                        help="a limit of memory or time, see dspace.limits; may be given several times")
    parser.set_defaults(run=run)


def check(options):
    """Rejects options that have no effect together with the others."""
    if options.every is not None and not (options.every > 0 and math.isfinite(options.every)):
        raise Failed(f"--every {options.every:g}; accepted: more than 0 s")
    given = [word for word, value in (("every", options.every is not None), ("reverse", options.reverse)) if value]
    if options.at is not None and given:
        raise Failed(f"--at and --{given[0]} are given; accepted: one or the other")
    if options.viewport is not None:
        given.append("viewport")
    if options.out is None and given:
        raise Failed(f"--{given[0]} applies to pictures; accepted: with --out")


def rules_of(options):
    """What playback may do: read the recording and the files that it names, write the pictures."""
    rules = confinement.Rules(connect=options.allow_network)
    rules.add_played(options.file)
    if options.out is not None and os.path.isfile(options.file):
        make_folder(options.out)
        rules.add("write", options.out)
    return rules


def run(options):
    check(options)
    files_are_restricted = confinement.confine(options, lambda: rules_of(options),
                                                 confinement.SAFEST_FORMATS)
    from dspace import vtk  # needs the compiled part
    from dspace.playback.playback import Playback

    set_limits(options.limit)
    confine = vtk.vtkDspaceSession().ConfineProcess  # it may open only the recording's files
    confine() if files_are_restricted else confine(True)
    with tidy_end(), confinement.explaining(options), \
            Playback(options.file, unpack_limit=options.unpack_limit) as playback:
        if options.at is not None:
            playback.seek(options.at)
        if options.out is None:
            print(f"{len(playback.times)} steps, {playback.times[0]:g} to {playback.times[-1]:g} s; "
                  f"{seen(playback, options)}")
            return 0
        name, steps = chosen(playback, options)
        paths = [os.path.join(options.out, f"{number:06d}.png") for number in range(len(steps))]
        make_folder(options.out)
        for index, path in zip(steps, paths):
            playback.step(index - playback.index)  # directly: a step back is slow
            playback.session.viewports[name].save(path)
            print(path)
    return 0


def seen(playback, options):
    """Returns the names of the viewports as text: those at the time --at; otherwise those of all steps, with their
    times unless they exist at every step."""
    if options.at is not None:
        names = ", ".join(repr(name) for name in playback.session.viewports) or "none"
        return f"at {playback.time:g} s viewports: {names}"
    return f"viewports: {listed(playback, viewports_of(playback))}"


def viewports_of(playback):
    """Returns {name: [(begin, end)]}, the ranges of steps at which each viewport exists."""
    from dspace.playback.spans import spans_of
    return {key[1]: ranges for key, ranges in spans_of(playback).items() if key[0] == "viewport" and ranges}


def listed(playback, viewports):
    from dspace.playback.spans import when
    everywhere = [(0, len(playback.times))]
    return ", ".join(repr(name) + ("" if ranges == everywhere else f" ({when(playback, ranges)})")
                     for name, ranges in viewports.items()) or "none"


def chosen(playback, options):
    """Returns the viewport's name and the steps at which to draw it, in order. Prints the number of steps without
    it, which are skipped."""
    from dspace.playback.spans import when
    viewports = viewports_of(playback)
    if not viewports:
        raise Failed(f"{playback.file.label}: it has no viewport at any step; accepted: one that has")
    name = options.viewport
    if name is None and options.at is not None and len(playback.session.viewports) == 1:
        name = next(iter(playback.session.viewports))
    elif name is None and options.at is None and len(viewports) == 1:
        name = next(iter(viewports))
    at = "" if options.at is None else f"at {playback.time:g} s "
    if name not in viewports or at and name not in playback.session.viewports:
        problem = "the viewport is not stated" if name is None else f"there is no viewport {name!r}"
        raise Failed(f"{playback.file.label}: {at}{problem}; there are: {listed(playback, viewports)}; accepted: "
                     "--viewport with one of them" + (", and a time when it is there" if at else ""))
    if at:
        return name, [playback.index]
    there = [index for begin, end in viewports[name] for index in range(begin, end)]
    missing = len(playback.times) - len(there)
    if missing:
        print(f"dspace: note: {missing} of {len(playback.times)} steps are skipped, without viewport {name!r}, "
              f"which exists {when(playback, viewports[name])}", file=sys.stderr)
    drawn = []
    for index in reversed(there) if options.reverse else there:
        if not drawn or options.every is None or (abs(playback.times[index] - playback.times[drawn[-1]])
                                                  >= options.every * (1 - 1e-9)):
            drawn.append(index)
    return name, drawn


def make_folder(folder):
    """Creates the folder. Raises Failed if it already has pictures, because those of another run would mix with the
    new ones."""
    try:
        os.makedirs(folder, exist_ok=True)
        there = sorted(name for name in os.listdir(folder) if PICTURE.fullmatch(name))
    except OSError as error:
        raise Failed(f"--out {folder!r}: {error.strerror}; accepted: a folder that may be made and written") from None
    if there:
        raise Failed(f"--out {folder!r}: it holds {there[0]!r}; accepted: a new folder, or one without such pictures")
