"""`dspace play`: pictures of a recording, with no simulation."""
import math
import os

from dspace.command_line import Failed

ABOUT = (
    "Draws what a recorded session showed, the same to the byte: at one time with --at, at every step of the "
    "simulation, or with --every at most one picture each so many seconds of its time. Without --out it says how "
    "long the recording is and what can be seen.")


def add_arguments(parser):
    parser.description = ABOUT
    parser.add_argument("file", metavar="FILE", help="a recording (.dspace)")
    parser.add_argument("--at", type=float, metavar="T", help="simulation time [s]: one picture")
    parser.add_argument("--viewport", metavar="NAME", help="absent: the recording's only one")
    parser.add_argument("--out", metavar="DIR", help="folder for the pictures, PNG; made if it is not there")
    parser.add_argument("--every", type=float, metavar="DT", help="seconds of simulation time between pictures")
    parser.add_argument("--reverse", action="store_true", help="from the last step to the first")
    parser.set_defaults(run=run)


def run(options):
    from dspace.playback import Playback  # needs the compiled part

    if options.every is not None and not (options.every > 0 and math.isfinite(options.every)):
        raise Failed(f"--every {options.every:g}; accepted: more than 0 s")
    with Playback(options.file) as playback:
        if options.at is not None:
            playback.seek(options.at)
        elif options.reverse:
            playback.step(len(playback.times))
        if options.out is None:
            names = ", ".join(repr(name) for name in playback.session.viewports) or "none"
            print(f"{len(playback.times)} steps, {playback.times[0]:g} to {playback.times[-1]:g} s; "
                  f"at {playback.time:g} s viewports: {names}")
            return 0
        os.makedirs(options.out, exist_ok=True)
        print(save(playback, options, 0))
        if options.at is not None:
            return 0
        count, drawn = 1, playback.time
        begin = playback.index
        for index in range(begin - 1, -1, -1) if options.reverse else range(begin + 1, len(playback.times)):
            if options.every is None or abs(playback.times[index] - drawn) >= options.every * (1 - 1e-9):
                playback.step(index - playback.index)  # steps between are not gone to: back, each takes long
                print(save(playback, options, count))
                count, drawn = count + 1, playback.time
    return 0


def save(playback, options, count):
    viewports = playback.session.viewports
    name = options.viewport
    if name is None:
        if len(viewports) != 1:
            names = ", ".join(repr(each) for each in viewports) or "none"
            raise Failed(f"at {playback.time:g} s the viewports are {names}; accepted: --viewport with one of them")
        name = next(iter(viewports))
    path = os.path.join(options.out, f"{count:06d}.png")
    viewports[name].save(path)
    return path
