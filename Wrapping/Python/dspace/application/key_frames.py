"""Camera key frames of a recording, as the track of the timeline shows and changes them."""
import concurrent.futures
import json
import math
import os
import time as clock

import numpy as np

from dspace import Movie, Pose
from dspace._core.fields import file_path, number, reject
from dspace._core.files import atomic_write
from dspace.application import collector
from dspace.errors import Error, InvalidArgument, NotFound, WrongType
from dspace.links.watching import OWN
from dspace.movies.edit import KeyEditor
from dspace.movies.keys import CameraPath, Key
from dspace.movies.movie import SETTINGS, seen_through
from dspace.movies.views import LOOK
from dspace.scene.viewport import Viewport

ENDING = ".movie.toml"  # of the side file of a recording
CAMERA = OWN + "movie"  # of views that follow the path; it stays when the recording moves back
PATH = "movie path"  # names of the ornaments that show it begin so
STILL = 1.0  # [s]: the duration of a movie of one key
TICK = 1 / 30  # [s] between pictures of a preview
SAMPLES = 24  # points of the drawn path a span


class KeyFrames:
    """The movie of a Run: its camera key frames by run time. App.movie is the one of the recording in the docks.

    movie: the dspace.Movie, with all that its file may hold; after changes of one's own call changed(). Every change is
    written to `path`, which is RECORDING.movie.toml, the file that `dspace movie` reads; None where that file was there
    and could not be read, until save() or load() name another one. Keys are numbered from 0 by movie time. The rules of
    changes are those of dspace.movies.edit.KeyEditor."""

    def __init__(self, app, run):
        self._app, self._run, self._host = app, run, app._host
        self.path = self._side = os.fspath(run.file.path) + ENDING
        self._writer = concurrent.futures.ThreadPoolExecutor(1)  # the windows do not wait for the disk
        self._writing, self._looking = [], None
        self._on_disk = None
        self._following = self._previewed = None  # (view, name of its camera before)
        self._timer, self._drawn, self._shows_path = None, [], False
        self._extent_of = self._known_extent = None
        self.movie = Movie()
        if os.path.exists(self.path):
            try:
                self._take(Movie.load(self.path))
                self._on_disk = _state(self.path)
            except Error as error:
                self.path = None  # it stays as it is
                self._host.message(str(error))
        self._tell()

    # --- What there is -------------------------------------------------------------------------

    @property
    def view(self):
        """The dspace.movies View whose keys are changed: the one whose keys state run times, else the first one without
        a camera; None: there is none yet."""
        views = [view for view in self.movie.views.values() if not view.camera]
        return next((view for view in views if any(key.run is not None for key in view.keys)), views[0] if views else None)

    @property
    def keys(self):
        """The keys, each a dspace.movies Key with its run time."""
        return [] if self.view is None else list(self.view.keys)

    def _editor(self):
        if self.view is None:
            self.movie.add_view("main" if "main" not in self.movie.views else "keys")
        return KeyEditor(self.movie, self.view, self._beginning())

    def _beginning(self):
        return self._extent()[0]

    def _extent(self):
        count = len(self._run.times)
        if self._extent_of != count:  # a recording may grow
            steps = [time for _, time in self._run.file.steps()] or self._run.times
            self._extent_of, self._known_extent = count, (min(steps), max(steps))
        return self._known_extent

    def time_at(self, run):
        """The movie time [s] at which the run is at a time [s]: the first one, cut to the movie."""
        keys = self.keys
        if not keys:
            raise NotFound(f"{self._about()}: it has no keys; accepted: one or more", self._about())
        for a, b in zip(keys, keys[1:]):
            if not b.cut and min(a.run, b.run) <= run <= max(a.run, b.run):
                return a.time if a.run == b.run else a.time + (b.time - a.time) * (run - a.run) / (b.run - a.run)
        return min(keys, key=lambda key: abs(key.run - run)).time

    def _about(self):
        return f"movie of {os.path.basename(self._run.file.path)!r}"

    # --- Changes -------------------------------------------------------------------------------

    def add_key(self, view=None, run=None, freeze=None, **values):
        """Adds a key where a view's camera is now. Returns its number.

        view: a dspace.Viewport of the recording (default: App.view). run: time of the run [s] (default: the present
        one). freeze: the run stands still for so many seconds of the movie after the key that is at `run`, while the
        camera moves to the new one. values: see dspace.movies.keys.Key (frame=, easing=, cut=, ...)."""
        view = self._required(view)
        first, last = self._extent()
        if run is None:  # what precedes the first step of the simulation is its beginning
            run = min(max(self._run.time, first), last)
        run = number(run, "the run time", self._about())
        if not first <= run <= last:
            reject(self._about(), "the run time of a key", run, f"{first:g} to {last:g} s")

        def make(time):
            given = {name: value for name, value in values.items() if name != "frame"}
            return Key(time=time, **{**self._seen(view, values), **given})

        with self._changing():
            fresh = not self.keys
            editor = self._editor()
            if fresh:
                self._look_as(view)
            return editor.add(run, make) if freeze is None else editor.add_frozen(run, freeze, make)

    def take_view(self, key, view=None, frame=None):
        """Gives a key the place and the projection of a view's camera. frame: see Movie.add_key (default: the key's)."""
        view = self._required(view)
        with self._changing():
            editor = self._editor()
            frame = editor.key(key).frame if frame is None else frame
            editor.change(key, **seen_through(view, frame or view.scene.root))

    def move_key(self, key, run):
        """Moves a key, with its freeze, to another time of the run [s], between those of its neighbours."""
        with self._changing():
            self._editor().move(key, run)

    def edit_key(self, key, **values):
        """Changes values of a key (see dspace.movies.keys.Key) other than its times."""
        with self._changing():
            self._editor().change(key, **values)

    def freeze(self, key, seconds):
        """Lets the run stand still at a key for `seconds` of the movie; 0: not."""
        with self._changing():
            self._editor().freeze(key, seconds)

    def set_span(self, key, seconds):
        """Lets the span from a key to the next one take `seconds` of the movie."""
        with self._changing():
            self._editor().set_span(key, seconds)

    def delete_key(self, key):
        """Removes a key."""
        with self._changing():
            self._editor().erase(key)

    def set(self, **settings):
        """Changes settings of the movie: size, rate, samples, start, speed, duration (see dspace.Movie)."""
        unknown = sorted(set(settings) - set(SETTINGS))
        if unknown:
            reject(self._about(), "a setting", unknown[0], ", ".join(SETTINGS))
        checked = Movie(**{**self.movie.settings(), **settings})
        with self._changing():
            for name in ("size", "rate", "samples", "start", "speed", "_duration"):
                setattr(self.movie, name, getattr(checked, name))

    def changed(self):
        """After changes of `movie` of one's own: checks it, shows and writes it."""
        with self._changing():
            if self.view is not None:
                self._editor()

    def clear(self):
        """Removes all keys, and the side file where it holds nothing else; another file stays as it is."""
        with self._changing():
            if self.view is not None:
                self.view.keys = []

    def _required(self, view):
        view = self._app.view if view is None else view
        if not isinstance(view, Viewport):
            reject(self._about(), "the view", view, "a dspace.Viewport", WrongType)
        if view._client is not self._run.session._client:
            reject(self._about(), "the view", view, "one of the same recording")
        return view

    def _seen(self, view, values):
        seen = seen_through(view, values.get("frame"))
        if values.get("target") is not None:
            seen.pop("quaternion")
        if any(values.get(name) is not None for name in ("fov_deg", "height", "tangents")):
            seen = {name: value for name, value in seen.items() if name not in ("fov_deg", "height", "tangents")}
        return seen

    def _look_as(self, viewport):
        """The movie's view looks as the viewport does."""
        view = self.view
        view.scene = viewport.scene.name  # the vantage is the one of keys: that of the window is not in the recording
        view.ornaments, view.corner_axes = viewport.ornaments, viewport.corner_axes
        for name in LOOK:
            setattr(view, name, getattr(viewport, name))
        view.__post_init__()

    def _changing(self):
        return _Changing(self)

    def _take(self, movie):
        self.movie = movie
        if self.view is not None:
            self._editor()  # keys get run times

    # --- Its file ------------------------------------------------------------------------------

    def load(self, path=None):
        """Takes a movie from a file (default: `path`, again), and writes later changes to it."""
        path = self.path if path is None else file_path(path, "the path", self._about())
        movie = Movie.load(path)
        self._take(movie)
        self.path, self._on_disk = path, _state(path)
        self._show()

    def save(self, path=None):
        """Writes the file now, completely or not at all, and later changes to it, too."""
        self.flush()
        path = self.path if path is None else file_path(path, "the path", self._about())
        if path is None:
            reject(self._about(), "the path", None, "a path: the side file could not be read and is left as it is")
        self.movie.save(path)
        self.path, self._on_disk = path, _state(path)
        self._tell()

    def flush(self):
        """Waits until changes are in the file. Raises dspace.Io where they are not."""
        writing, self._writing = self._writing, []
        try:
            concurrent.futures.wait(writing)
        finally:
            if writing:
                collector.resume()
        for each in writing:
            each.result()

    def _require_unchanged(self):
        if self.path is not None and not self._writing and _state(self.path) != self._on_disk:
            raise InvalidArgument(f"{self._about()}: another program changed {self.path!r}; accepted: load(), which takes "
                                  "the file, or save(), which replaces it", self.path)

    def _write(self):
        if self.path is None:
            return
        path, words = self.path, self.movie.text.encode() if self.keys else None
        if words is None and (path != self._side or self.movie.overlays or len(self.movie.views) > 1):
            return  # no valid movie, and more than the keys would be lost

        def write():
            if words is not None:
                atomic_write(path, words, f"movie {path!r}")
            elif os.path.exists(path):
                os.unlink(path)
            self._on_disk = _state(path)

        if not self._writing:
            collector.pause()  # while the other thread writes
        self._writing.append(self._writer.submit(write))
        if self._looking is None:
            self._looking = self._host.every(50, self._look)

    def _look(self):
        """Tells what writing failed."""
        done = [each for each in self._writing if each.done()]
        self._writing = [each for each in self._writing if not each.done()]
        if done and not self._writing:
            collector.resume()
        if not self._writing and self._looking is not None:
            self._host.cancel(self._looking)
            self._looking = None
        for each in done:
            if each.exception() is not None:
                self._host.message(f"The movie is not saved: {each.exception()}")

    # --- Seen in a view ------------------------------------------------------------------------

    def preview(self, view=None, begin=0.0):
        """Plays the movie in a view, from a time of the movie [s] on, at its own speed; the run and the timeline follow.
        stop() ends it, and the view has its camera back."""
        view, begin = self._required(view), number(begin, "the beginning", self._about())
        CameraPath(self.keys, self._about())
        self.stop()
        self._run.pause()
        self._previewed = self._look_through(view)
        began = clock.monotonic() - begin
        runs, (first, last) = self.movie.run_time(self._beginning()), self._extent()

        def step():
            time = clock.monotonic() - began
            if time >= self.movie.duration:
                self.stop()
                return
            run = min(max(runs.at(time), first), last)
            self._run.seek(run)
            self._aim(self._previewed[0], time)

        step()
        if self._previewed is not None:
            self._timer = self._host.every(round(1000 * TICK), step)
        self._tell()

    def follow(self, view=None):
        """From now on a view shows what the movie shows at the time of the timeline; stop() ends it."""
        view = self._required(view)
        CameraPath(self.keys, self._about())
        self.stop()
        self._following = self._look_through(view)
        self._aim(view, self.time_at(self._run.time))
        self._tell()

    def stop(self):
        """Ends preview() and follow(): the view has its own camera again."""
        if self._timer is not None:
            self._host.cancel(self._timer)
        looked, self._timer = self._previewed or self._following, None
        self._previewed = self._following = None
        if looked is not None:
            view, camera = looked
            try:
                view.camera = camera
            except Error:  # the view, or its camera, is gone
                pass
        self._tell()

    def show_path(self, shown=True):
        """Draws the camera's path and its keys as ornaments of the scene, or removes them."""
        self._shows_path = bool(shown)
        self._draw_path()
        self._tell()

    def _look_through(self, view):
        before = view.camera
        self._aim(view, self.time_at(self._run.time))
        view.camera = view.scene.vantages[view.vantage].cameras[CAMERA]
        return view, before

    def _aim(self, view, time):
        scene = view.scene
        find = lambda path: scene.frame(path) if path else scene.root
        frame, position, quaternion, projection = CameraPath(self.keys).at(
            time, lambda path, base: find(path).pose_in(find(base)))
        scene.add_camera(CAMERA, frame=find(frame), pose=Pose(position, quaternion), vantage=view.vantage,
                         near=self.view.near, far=self.view.far, **projection)

    def _moved(self):
        """The timeline shows another time."""
        if self._following is not None and self._timer is None:
            try:
                self._aim(self._following[0], self.time_at(self._run.time))
            except Error:  # the scene is not there at that time
                pass
        if self._shows_path and any(each.id not in self._objects() for each in self._drawn):
            self._draw_path()

    def _scene(self):
        return self._run.session.scenes.get(self.view.scene) if self.view is not None else None

    def _objects(self):
        scene = self._scene()
        return set() if scene is None else {each.id for each in scene.objects.values()}

    def _draw_path(self):
        scene = self._scene()
        if scene is not None:
            for name, each in scene.objects.items():
                if name.startswith(PATH):
                    each.remove()
        self._drawn = []
        if not self._shows_path or not self.keys or scene is None:
            return
        find = lambda path: scene.frame(path) if path else scene.root
        relative = lambda path, base: find(path).pose_in(find(base))
        for number_, shot in enumerate(CameraPath(self.keys).shots):
            times = np.unique(np.concatenate([np.linspace(a, b, SAMPLES) for a, b in zip(shot.times, shot.times[1:])]
                                             or [shot.times]))
            places = [shot.at(time, relative) for time in times]
            points = np.array([place for place, _, _ in places])
            settings = {"frame": find(shot.frame), "color": "#ffb020", "ornamental": True}
            length = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
            if length > 0:
                self._drawn.append(scene.add_lines(points, name=f"{PATH} {number_}", **settings))
            size = min(max(0.03 * length, 0.1), 0.3 * (length or 1.0) + 0.1)
            for key, time in zip(shot.keys, shot.times):
                place, quaternion, projection = shot.at(time, relative)
                self._drawn.append(scene.add_frustum(size, self.movie.size, position=place, quaternion=quaternion,
                                                     name=f"{PATH} {number_} key {self.keys.index(key)}", **projection,
                                                     **settings))

    # --- The window ----------------------------------------------------------------------------

    def _show(self):
        if self._shows_path:
            self._draw_path()
        if self._following is not None:
            self._moved() if self.keys else self.stop()
        self._tell()

    def _tell(self):
        """Shows the track of the timeline what there is."""
        keys, editor = self.keys, None if self.view is None else self._editor()
        told = []
        for number_, key in enumerate(keys):
            low, high = editor.limits(number_)
            told.append({"run": key.run, "time": key.time, "cut": key.cut, "rest": key.easing == "rest",
                         "low": low if math.isfinite(low) else None, "high": high if math.isfinite(high) else None,
                         "lens": key.lens, "value": key.fov_deg if key.lens == "fov_deg" else key.height,
                         "frame": key.frame, "position": key.position})
        looked = self._previewed or self._following
        self._host.extend(json.dumps({
            "do": "keys", "of": self._run._player.GetAddressAsString("vtkObject"), "keys": told, "file": self.path or "",
            "size": self.movie.size, "rate": self.movie.rate, "samples": self.movie.samples,
            "duration": self.movie.duration if keys else 0.0,
            "preview": self._previewed is not None, "follows": self._following is not None,
            "view": looked[0].name if looked else "", "path": self._shows_path}))

    def close(self):
        """Waits until changes are written."""
        if self._timer is not None:
            self._host.cancel(self._timer)
            self._timer = None
        if self._looking is not None:
            self._host.cancel(self._looking)
            self._looking = None
        self._writer.shutdown(wait=True)
        self._look()

    def __repr__(self):
        return f"<dspace {self._about()}, {len(self.keys)} keys>"


class _Changing:
    """A change of a movie: where it fails, everything is as before."""

    def __init__(self, frames):
        self._frames = frames

    def __enter__(self):
        self._frames._require_unchanged()
        movie = self._frames.movie
        self._before = [(view, list(view.keys)) for view in movie.views.values()]
        self._duration = movie._duration
        if len(self._frames.keys) == 1 and movie._duration == STILL:
            movie._duration = None
        self._settings = {name: getattr(movie, name) for name in ("size", "rate", "samples", "start", "speed")}

    def __exit__(self, kind, error, trace):
        frames, movie = self._frames, self._frames.movie
        if kind is None:
            try:
                count = len(frames.keys)
                if count == 1 and movie._duration is None:
                    movie._duration = STILL
                if count:
                    movie.check()
            except Error:
                self._back()
                raise
            frames._write()
            frames._show()
        else:
            self._back()
        return False

    def _back(self):
        movie = self._frames.movie
        for name in [name for name in movie.views if all(name != view.name for view, _ in self._before)]:
            del movie.views[name]
        for view, keys in self._before:
            view.keys = keys
        movie._duration = self._duration
        for name, value in self._settings.items():
            setattr(movie, name, value)


def _state(path):
    """What tells whether a file is another one."""
    try:
        status = os.stat(path)
        return status.st_ino, status.st_size, status.st_mtime_ns
    except OSError:
        return None
