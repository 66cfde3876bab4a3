"""`dspace watch`: draws pictures of a running simulation through its server."""
import math
import itertools
import os
import signal
import sys
import time

from dspace.command_line import Failed
from dspace.command_line import terrain as values
from dspace.command_line.play import make_folder

PATIENCE = 2.0  # time [s] without anything to draw before a note states what is missing
LISTED = 20     # largest number of names in a note

ABOUT = (
    "Follows a simulation through its server (dspace serve), draws it on this machine, and saves a picture whenever "
    "--every seconds of wall time have passed and something has changed. It ends when the simulation ends, or at once "
    "if the simulation has already ended, or with Ctrl-C. It then saves the last picture. It waits for a first "
    "simulation, and for a viewport, scene or frame that does not exist yet, and prints a note. If the simulation ends "
    "without it, the exit code is 1. --viewport names a viewport of the simulation. --eye and --target make a separate "
    "view, which does not affect the simulation or other viewers.")


def add_arguments(parser):
    parser.description = ABOUT
    parser.add_argument("address", metavar="ADDRESS", help="address of the server: unix:PATH or host:port")
    parser.add_argument("--out", required=True, metavar="DIR",
                        help="folder for the pictures, 000000.png and so on; created if it does not exist, rejected "
                             "if it has such pictures")
    parser.add_argument("--every", type=float, default=1.0, metavar="S",
                        help="seconds of wall time between pictures (1)")
    parser.add_argument("--viewport", metavar="NAME", help="absent: the server's only one")
    parser.add_argument("--count", type=int, metavar="N", help="end after N pictures")
    parser.add_argument("--stay", action="store_true",
                        help="keep waiting for the next simulation or server after one has ended")
    view = parser.add_argument_group("a separate view, instead of --viewport")
    view.add_argument("--eye", type=values.numbers(3, "X,Y,Z"), metavar="X,Y,Z", help="where the camera stands [m]")
    view.add_argument("--target", type=values.numbers(3, "X,Y,Z"), metavar="X,Y,Z", help="what it looks at [m]")
    view.add_argument("--frame", metavar="PATH",
                      help="the frame of --eye and --target, with which the camera moves (the root)")
    view.add_argument("--fov", type=float, metavar="DEG", help="vertical field of view (45)")
    view.add_argument("--size", type=values.size, metavar="WxH", help="pixels (1280x720)")
    view.add_argument("--scene", metavar="NAME", help="absent: the server's only one")
    link = parser.add_argument_group("beyond this machine")
    link.add_argument("--cert", metavar="PEM", help="the viewer's certificate")
    link.add_argument("--key", metavar="PEM", help="the private key of the certificate")
    link.add_argument("--ca", metavar="PEM", help="the authority that signed the server's certificate")
    link.add_argument("--insecure", action="store_true",
                      help="connect without encryption and without checking the server's identity")
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
        raise Failed(f"--{own[0]} belongs to a separate view; accepted: with --eye and --target")
    if options.eye is not None and options.viewport is not None:
        raise Failed("--viewport and --eye are given; accepted: one or the other")


class Pictures:
    """Saves pictures, numbered from 0."""

    def __init__(self, watcher, options):
        self.watcher, self.options = watcher, options
        self.count = 0
        self._own = None
        self._seen = None  # the state that the last picture shows

    def view(self):
        """Returns the viewport to save, or None while it does not exist."""
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
            return None  # it may be created later
        return self.watcher.add_view("watch", scene, options.size or (1280, 720), frame=options.frame, eye=options.eye,
                                     target=options.target, fov_deg=options.fov)

    def _scene(self):
        """Returns the scene of the separate view, or None while it does not exist."""
        options, scenes = self.options, self.watcher.scenes
        if options.scene is None and len(scenes) > 1:
            raise Failed(f"the scenes are {', '.join(map(repr, scenes))}; accepted: --scene with one of them")
        return next(iter(scenes.values()), None) if options.scene is None else scenes.get(options.scene)

    def lack(self):
        """Returns, while view() is None, the missing thing and the existing names, as texts."""
        options, kind, name, there = self.options, "viewport", self.options.viewport, self.watcher.viewports
        if options.eye is not None:
            scene = self._scene()
            kind, name, there = "scene", options.scene, self.watcher.scenes
            if scene is not None:
                kind, name, there = "frame", options.frame, scene.frames
        names = list(map(repr, itertools.islice(there, LISTED))) + ["..."] * (len(there) > LISTED)
        return f"a {kind}" if name is None else f"{kind} {name!r}", ", ".join(names) or "none"

    def save(self):
        """Saves a picture if something has changed since the last one. Returns whether it did."""
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
        if not connected and len(stop) == 1:  # a second signal does not interrupt the report
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
                    print(f"dspace: note: the pictures lack commands that failed here: {told}", file=sys.stderr)
            why = presence.disconnected()
            # Only after a delay, because the simulation may be reconnecting.
            if not (why or options.stay) and time.monotonic() - began > PATIENCE and presence.disconnected_before():
                why = "the simulation had gone before"
            if why:
                watcher.update()  # the viewport then shows the disconnection
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
    """Prints a note about what is missing after a while, and again when the existing names change."""

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
            self._told, self._due = words, now + PATIENCE  # limits the rate of notes


class Presence:
    """Remembers whether the server and a simulation were connected at the last check."""

    def __init__(self, watcher):
        self._watcher, self._driver, self._served = watcher, watcher.simulation, True

    def disconnected_before(self):
        """Returns whether a simulation drove the server before the first check and none does now. The state then has
        commands."""
        return self._driver is None and self._watcher.sequence > 0

    def words(self):
        """Returns the first words of a note about waiting."""
        if self._driver is not None:
            return ""
        return "the simulation has gone; " if self._watcher.sequence > 0 else "no simulation has begun; "

    def disconnected(self):
        """Returns what disconnected since the last check, as text, or None."""
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
