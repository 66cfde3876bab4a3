"""Draws single pictures of a movie: moves the run to its time and the cameras to their poses, combines the views."""
import contextlib
import importlib.util
import os
import re
import secrets
import warnings

import numpy as np

from dspace._core.fields import shown
from dspace.errors import Error, InvalidArgument, NotFound, WrongType
from dspace.frames.poses import Pose
from dspace.movies.keys import CameraPath
from dspace.movies.views import FIELD
from dspace.playback.spans import spans_of, when
from dspace.playback.steps import StepTimes
from dspace.telemetry.telemetry import overlay_value


INNER = re.compile("movie .* [0-9a-f]{8}", re.DOTALL)  # a movie's own viewports and cameras; see Stage


class Source:
    """The source of a movie's pictures: a session, and how its run moves to a time.

    session: a dspace.Session. advance(time): moves the run to a time [s]; called with the times of the pictures,
    in their order. telemetry(): returns the present values for overlays, a dict of names to numbers or texts.
    close(): called at the end. beginning: the run's first time [s]. extent: the first and the last time of the run
    [s]; the run stands still outside. playback: the Playback, if the run is a recording."""

    def __init__(self, session, advance=None, telemetry=None, close=None, beginning=0.0, extent=None, playback=None):
        self.session, self.beginning, self.playback = session, beginning, playback
        self.extent = extent or (-np.inf, np.inf)
        self.advance = advance or (lambda time: None)
        self.telemetry = telemetry or dict
        self.close = close or (lambda: None)
        self.closes = close is not None


def open_run(run):
    """Returns the Source of a run. A run is a recording's path; "FILE.py:NAME", a function that returns one of the
    following or a tuple of Source's arguments; a Source; a Playback (it has a session and seek(time)); an object with
    a session and advance(time); or a Session, which stands still."""
    if isinstance(run, Source):
        return run
    if isinstance(run, (str, os.PathLike)):
        script, _, name = os.fspath(run).rpartition(":")
        if script.endswith(".py") and name.isidentifier():
            return _made_by(script, name)
        try:
            from dspace.playback.playback import Playback
        except ImportError:
            raise NotFound(f"run {shown(run)}: recordings are not played back here; accepted: FILE.py:NAME, a "
                           "function that returns a Source", shown(run)) from None
        playback = Playback(os.fspath(run))
        source = _of_playback(playback)
        source.close = getattr(playback, "close", source.close)
        return source
    require_run(run)
    if hasattr(run, "session") and hasattr(run, "seek"):
        return _of_playback(run)
    if hasattr(run, "session"):
        return Source(run.session, run.advance, getattr(run, "telemetry", None))
    return Source(run)


def require_run(run):
    """Raises dspace.WrongType for a run that open_run() does not accept."""
    if isinstance(run, (str, os.PathLike, Source)) or all(hasattr(run, name) for name in ("execute", "scene")):
        return
    if hasattr(run, "session") and (hasattr(run, "seek") or hasattr(run, "advance")):
        return
    raise WrongType(f"the run is {shown(run)}; accepted: a recording's path, FILE.py:NAME, a Source, a Playback "
                    "or a Session")


def _of_playback(playback):
    # The telemetry of a recording belongs to its scenes.
    telemetry = None if hasattr(playback, "file") else getattr(playback, "telemetry", None)
    times = StepTimes(playback.times)
    # Commands before the first step have time 0, which the simulation did not set; the steps give the true extent.
    steps = [time for _, time in playback.file.steps()] if hasattr(playback, "file") else []
    steps = steps or times.times
    return Source(playback.session, lambda time: playback.seek(times.step_at(time)),
                  telemetry if callable(telemetry) else None, beginning=steps[0] if steps else 0.0,
                  extent=(min(steps), max(steps)) if steps else None,
                  playback=playback if hasattr(playback, "file") else None)


def _made_by(path, name):
    if not os.path.exists(path):
        raise NotFound(f"run {path!r}: there is no such file", path)
    spec = importlib.util.spec_from_file_location("dspace_movie_run", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    if not callable(getattr(module, name, None)):
        raise NotFound(f"run {path!r}: it has no function {name!r}", path)
    source = getattr(module, name)()
    source = Source(*source) if isinstance(source, tuple) else open_run(source)
    if not source.closes:
        source.close = source.session.close
    return source


@contextlib.contextmanager
def naming(part):
    """In a `with` statement: prefixes errors with the part of the movie that they concern."""
    try:
        yield
    except Error as error:
        if str(error).startswith(part):
            raise
        raise type(error)(f"{part}: {error}", part) from None


class Stage:
    """A movie and a run, ready to be drawn."""

    def __init__(self, movie, source):
        movie.check()
        self.movie, self.source = movie, source
        self.runs = movie.run_time(source.beginning)
        self.paths = {name: CameraPath(view.keys, f"view {name!r}")
                      for name, view in movie.views.items() if view.keys}
        self.shown = {name: [] for name in movie.views}
        # Names of its viewports and cameras. The random mark keeps them apart from those of other movies, which may
        # be in the session, or in the recording, or appear while this movie is drawn.
        mark = secrets.token_hex(4)
        self.names = {name: f"movie {name} {mark}" for name in movie.views}
        self.hidden, self.unseen = set(), True  # fragments that were found and hidden; whether no picture is drawn yet

    def close(self):
        """Removes its viewports and cameras from the session."""
        for view in self.movie.views.values():
            try:
                session, name = self.source.session, self.names[view.name]
                if name in session.viewports:
                    session.viewports[name].remove()
                cameras = session.scenes[view.scene].vantages[view.vantage].cameras
                if name in cameras:
                    cameras[name].remove()
            except Error:  # the session is closed, or the scene was removed
                pass
            unknown = [fragment for fragment in view.hide if fragment not in self.hidden]
            if unknown and not self.unseen:
                warnings.warn(f"view {view.name!r}: hide names {unknown[0]!r}, but no picture that was drawn now has "
                              "such a fragment", stacklevel=2)

    def _advance(self, run):
        """Moves the run to a time [s]. A recording may remove a scene or camera that a view uses, which a session
        rejects; then the views' viewports are removed first. _viewport() creates them again."""
        try:
            self.source.advance(run)
        except Error:
            ours = [name for name in self.names.values() if name in self.source.session.viewports]
            if self.source.playback is None or not ours:
                raise
            for name in ours:
                self.source.session.viewports[name].remove()
            self.source.advance(run)

    def _find(self, view, run, things, kind, name, *within):
        """Returns the scene, vantage or camera that a view names, or raises dspace.NotFound."""
        if name in things:
            return things[name]
        about = f"view {view.name!r}, {kind}"
        what = f"{about}: at {run:g} s of the run there is no {kind} {name!r}"
        if self.source.playback is not None and kind != "vantage":
            ranges = spans_of(self.source.playback).get((kind, *within, name))
            if ranges:
                raise NotFound(f"{what}, which is there {when(self.source.playback, ranges)}; accepted: times of the "
                               "run (start, or run of a key) when it is there", about)
            what += ", nor at any other time"
        named = [each for each in things if kind != "camera" or not INNER.fullmatch(each)]
        raise NotFound(f"{what}; there are: {', '.join(map(repr, named[:50])) or 'none'}", about)

    def _viewport(self, view, run):
        """Returns the viewport of a view. Creates it if it is missing; a playback that seeks may have removed it."""
        session, name = self.source.session, self.names[view.name]
        viewport = session.viewports.get(name)
        if viewport is not None:
            return viewport
        scene = self._find(view, run, session.scenes, "scene", view.scene)
        vantage = self._find(view, run, scene.vantages, "vantage", view.vantage)
        left, top, right, bottom = view.pixels(self.movie.size)
        camera = name
        if view.keys:
            scene.add_camera(name, vantage=view.vantage)
        else:
            camera = self._find(view, run, vantage.cameras, "camera", view.camera, view.scene, view.vantage).name
        viewport = scene.add_viewport((right - left, bottom - top), camera, name=name, vantage=view.vantage,
                                      samples=self.movie.samples)
        viewport.ornaments = view.ornaments
        viewport.corner_axes = view.corner_axes
        viewport.set(**view.look)
        if view.background is not None:
            viewport.set_background(view.background, top=view.background_top)
        self.shown[view.name] = []
        return viewport

    def picture(self, number):
        """Returns picture `number`, counted from 0: (h, w, 3) uint8, sRGB."""
        time = number / self.movie.rate
        first, last = self.source.extent
        run = min(max(self.runs.at(time), first), last)
        self._advance(run)
        width, height = self.movie.size
        out = np.zeros((height, width, 3), np.uint8)
        for number_, (name, view) in enumerate(self.movie.views.items()):
            with naming(f"view {name!r}"):
                viewport = self._viewport(view, run)
                scene = viewport.scene
                if view.keys:
                    self._aim(view, scene, time, run)
            self._write(viewport, scene, view, number_ == 0, time, run)
            left, top, right, bottom = view.pixels(self.movie.size)
            out[top:bottom, left:right] = viewport.image(hide=self._hide(view, scene))
        self.unseen = False
        return out

    def _hide(self, view, scene):
        """Returns the fragments to hide that exist now. Some may appear later in the run."""
        there = scene.fragments if view.hide else ()
        hide = [fragment for fragment in view.hide if fragment in there]
        self.hidden.update(hide)
        return hide

    def _aim(self, view, scene, time, run):
        def find(path):
            try:
                return scene.frame(path) if path else scene.root
            except NotFound as error:
                number, field = next((number, "frame" if key.frame == path else "target_frame")
                                     for number, key in enumerate(view.keys, 1)
                                     if path in (key.frame, key.target_frame))
                raise NotFound(f"view {view.name!r}, key {number}, {field}: at {run:g} s of the run: {error}; "
                               "accepted: a frame that is there then", path) from None

        def relative(path, base):
            return find(path).pose_in(find(base))

        path, position, quaternion, projection = self.paths[view.name].at(time, relative)
        scene.add_camera(self.names[view.name], frame=find(path), pose=Pose(position, quaternion),
                         near=view.near, far=view.far, vantage=view.vantage, **projection)

    def _write(self, viewport, scene, view, first, time, run):
        """Updates the tables of the overlays that this view shows at this time."""
        now = []
        for number, overlay in enumerate(self.movie.overlays):
            if overlay.view not in ((view.name, "") if first else (view.name,)) or not overlay.shows(time):
                continue
            name = f"movie {number}"
            values = lambda key: self._value(key, scene, time, run)
            with naming(f"overlay {number + 1}" + (f" {overlay.title!r}" if overlay.title else "")):
                rows = [(label, fill(value, values)) for label, value in overlay.rows]
                viewport.set_table(name, rows, title=overlay.title, anchor=overlay.anchor,
                                   font_size=overlay.pixels(self.movie.size))
            now.append(name)
        for name in set(self.shown[view.name]) - set(now):
            viewport.remove_table(name)
        self.shown[view.name] = now

    def _value(self, key, scene, time, run):
        if key in ("movie", "run"):
            return time if key == "movie" else run
        telemetry = self.source.telemetry()
        if key in telemetry:
            return telemetry[key]
        value = overlay_value(scene, key)
        if value is not None:
            return value
        path, _, axis = key.rpartition(".")
        if path and axis in ("x", "y", "z"):
            return float(scene.frame(path).world_pose.position["xyz".index(axis)])
        raise InvalidArgument(f"there is no value {key!r}; accepted: movie, run, FRAME.x of y and z, "
                              + (", ".join(map(repr, [*telemetry, *scene.telemetry][:50])) or "telemetry"), key)


def fill(text, values):
    """Returns a text in which values(name) replaces each {name:format}, and one brace replaces {{ and }}."""
    def put(match):
        if match[0] in ("{{", "}}"):
            return match[0][0]
        value = values(match[1])
        try:
            return format(value, match[2] or "")
        except (ValueError, TypeError):
            raise InvalidArgument(f"{match[0]} cannot format {shown(value)}; accepted: a format "
                                  "such as {run:.2f}", match[1]) from None

    return FIELD.sub(put, text)
