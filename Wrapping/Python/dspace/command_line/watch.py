"""`dspace watch`: pictures of a simulation that runs, from a server."""
import math
import itertools
import os
import signal
import sys
import time

from dspace.command_line import Failed
from dspace.command_line import terrain as values
from dspace.command_line.play import make_folder

PATIENCE = 2.0  # s without what is to be drawn, until it is said what is waited for
LISTED = 20     # names

ABOUT = (
    "Follows a simulation through its server (dspace serve), draws it here, and saves a picture whenever --every "
    "seconds of wall time have passed and something has changed. It ends when the simulation does, also where that has "
    "gone before, or with Ctrl-C; the last picture is then saved, too. It waits for a first simulation, and for a "
    "viewport, scene or frame that is not there yet, and says so; where the simulation ends without it the exit code "
    "is 1. --viewport is one that the simulation has made; with --eye and --target it "
    "looks from elsewhere, which changes nothing for the simulation and for others.")


def add_arguments(parser):
    parser.description = ABOUT
    parser.add_argument("address", metavar="ADDRESS", help="of the server: unix:PATH or host:port")
    parser.add_argument("--out", required=True, metavar="DIR",
                        help="folder for the pictures, 000000.png and so on; made if it is not there, refused where it "
                             "has such pictures")
    parser.add_argument("--every", type=float, default=1.0, metavar="S",
                        help="seconds of wall time between pictures (1)")
    parser.add_argument("--viewport", metavar="NAME", help="absent: the server's only one")
    parser.add_argument("--count", type=int, metavar="N", help="ends after so many pictures")
    parser.add_argument("--stay", action="store_true",
                        help="goes on when the simulation or the server has gone, for the next")
    view = parser.add_argument_group("a view of one's own, instead of --viewport")
    view.add_argument("--eye", type=values.numbers(3, "X,Y,Z"), metavar="X,Y,Z", help="where the camera stands [m]")
    view.add_argument("--target", type=values.numbers(3, "X,Y,Z"), metavar="X,Y,Z", help="what it looks at [m]")
    view.add_argument("--frame", metavar="PATH", help="the frame that both are in, which it moves with (the root)")
    view.add_argument("--fov", type=float, metavar="DEG", help="vertical field of view (45)")
    view.add_argument("--size", type=values.size, metavar="WxH", help="pixels (1280x720)")
    view.add_argument("--scene", metavar="NAME", help="absent: the server's only one")
    link = parser.add_argument_group("beyond this machine")
    link.add_argument("--cert", metavar="PEM", help="the viewer's certificate")
    link.add_argument("--key", metavar="PEM", help="its key")
    link.add_argument("--ca", metavar="PEM", help="the authority of the server's certificate")
    link.add_argument("--insecure", action="store_true", help="unencrypted, from nobody knows whom")
    parser.set_defaults(run=run)


def check(options):
    if not (options.every > 0 and math.isfinite(options.every)):
        raise Failed(f"--every {options.every:g}; accepted: more than 0 s")
    if options.count is not None and options.count < 1:
        raise Failed(f"--count {options.count}; accepted: 1 and more")
    if (options.eye is None) != (options.target is None):
        raise Failed("--eye and --target: one is given; accepted: both, or none of them")
    own = [word for word in ("frame", "fov", "size", "scene") if getattr(options, word) is not None]
    if options.eye is None and own:
        raise Failed(f"--{own[0]} belongs to a view of one's own; accepted: with --eye and --target")
    if options.eye is not None and options.viewport is not None:
        raise Failed("--viewport and --eye are given; accepted: one or the other")


class Pictures:
    """Saves them, numbered from 0."""

    def __init__(self, watcher, options):
        self.watcher, self.options = watcher, options
        self.count = 0
        self._own = None
        self._seen = None  # what the last picture shows

    def view(self):
        """The viewport, or None while there is none."""
        options, viewports = self.options, self.watcher.viewports
        if options.eye is not None:
            if self._own is None or self._own.name not in viewports:
                self._own = self._make()
            return self._own
        if options.viewport is not None:
            return viewports.get(options.viewport)
        if len(viewports) > 1:
            raise Failed(f"the viewports are {', '.join(map(repr, viewports))}; accepted: --viewport with one of them")
        return next(iter(viewports.values()), None)

    def _make(self):
        options, scene = self.options, self._scene()
        if scene is None or options.frame is not None and options.frame not in scene.frames:
            return None  # it will come
        return self.watcher.add_view("watch", scene, options.size or (1280, 720), frame=options.frame, eye=options.eye,
                                     target=options.target, fov_deg=options.fov)

    def _scene(self):
        """The scene that a view of one's own is of, or None while it is not there."""
        options, scenes = self.options, self.watcher.scenes
        if options.scene is None and len(scenes) > 1:
            raise Failed(f"the scenes are {', '.join(map(repr, scenes))}; accepted: --scene with one of them")
        return next(iter(scenes.values()), None) if options.scene is None else scenes.get(options.scene)

    def lack(self):
        """What there is no picture without, and the names that there are, while view() is None."""
        options, kind, name, there = self.options, "viewport", self.options.viewport, self.watcher.viewports
        if options.eye is not None:
            scene = self._scene()
            kind, name, there = "scene", options.scene, self.watcher.scenes
            if scene is not None:
                kind, name, there = "frame", options.frame, scene.frames
        names = list(map(repr, itertools.islice(there, LISTED))) + ["..."] * (len(there) > LISTED)
        return f"a {kind}" if name is None else f"{kind} {name!r}", ", ".join(names) or "none"

    def save(self):
        """Whether there was something new to save."""
        view = self.view()
        state = (self.watcher.sequence, self.watcher.connected, self.watcher.simulation)
        if view is None or state == self._seen:
            return False
        path = os.path.join(self.options.out, f"{self.count:06d}.png")
        view.save(path)
        self._seen = state
        self.count += 1
        print(f"{path}: {view.scene.time:.3f} s", flush=True)
        return True


def run(options):
    check(options)
    from dspace.links.watching import watch  # needs the compiled part

    stop, connected = [], []

    def hear(*_):
        stop.append(True)
        if not connected and len(stop) == 1:  # one more while this is told ends nothing else
            raise KeyboardInterrupt

    try:
        for number in (signal.SIGTERM, signal.SIGINT):
            signal.signal(number, hear)
        watcher = watch(options.address, options.cert, options.key, options.ca, options.insecure)
        connected.append(True)
    except KeyboardInterrupt:
        return end(0, options, "ended while it was connecting")
    with watcher:
        make_folder(options.out)
        pictures, waiting = Pictures(watcher, options), Waiting()
        presence, due, told = Presence(watcher), time.monotonic(), ""
        began = time.monotonic()
        while not stop and pictures.count != options.count:
            watcher.update(min(0.2, max(0.0, due - time.monotonic())))
            if watcher.error != told:
                told = watcher.error
                if told:
                    print(f"dspace: note: the pictures lack what could not be done here: {told}", file=sys.stderr)
            why = presence.disconnected()
            # Not at once: its link may be about to be made again.
            if not (why or options.stay) and time.monotonic() - began > PATIENCE and presence.disconnected_before():
                why = "the simulation had gone before"
            if why:
                watcher.update()  # its picture says so
            if why or time.monotonic() >= due:
                pictures.save()
                due = max(due + options.every, time.monotonic())
            if not why or options.stay:
                waiting.tell(pictures, presence)
            if why:
                if not options.stay:
                    if pictures.count == 0:
                        raise Failed("{}; there was no {}; there are: {}".format(
                            why, *(word.removeprefix("a ") for word in pictures.lack())))
                    return end(pictures.count, options, why)
                print(f"dspace watch: {why}; waiting", flush=True)
        if pictures.count != options.count:
            pictures.save()
        return end(pictures.count, options, "ended")


class Waiting:
    """Says what is waited for, once it has not been there for a while, and again when what there is has changed."""

    def __init__(self):
        self._since = self._told = None
        self._due = 0.0

    def tell(self, pictures, presence):
        now = time.monotonic()
        if now < self._due:
            return
        self._due = now + 0.25 * PATIENCE
        if pictures.view() is not None:
            self._since = self._told = None
            return
        self._since = now if self._since is None else self._since
        if now - self._since < PATIENCE:
            return
        what, there = pictures.lack()
        words = f"{presence.words()}waiting for {what}; there are: {there}"
        if words != self._told:
            print(f"dspace: note: {words}", file=sys.stderr, flush=True)
            self._told, self._due = words, now + PATIENCE  # one that comes to be bit by bit is not told each time


class Presence:
    """Whether the server and a simulation were connected at the last look."""

    def __init__(self, watcher):
        self._watcher, self._driver, self._served = watcher, watcher.simulation, True

    def disconnected_before(self):
        """Whether a simulation drove the server before the first look, and none does now: the state has its commands."""
        return self._driver is None and self._watcher.sequence > 0

    def words(self):
        """The first words of a note about waiting."""
        if self._driver is not None:
            return ""
        return "the simulation has gone; " if self._watcher.sequence > 0 else "no simulation has begun; "

    def disconnected(self):
        """Says what disconnected since the last look; None if nothing did."""
        # Each value is read once, because the link may break at any time. A break between the two reads is the server's.
        driver, served = self._watcher.simulation, self._watcher.connected
        was_driver, was_served = self._driver, self._served
        self._driver, self._served = driver or was_driver, served
        if served and (was_driver is None or driver is not None):
            return None
        if not served and not was_served:
            return None
        self._driver = None
        return f"simulation {was_driver!r} has gone" if served else "the server has gone"


def end(count, options, why):
    print(f"dspace watch: {why}; {count} pictures in {options.out}", flush=True)
    return 0
