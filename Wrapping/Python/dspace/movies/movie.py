"""Movies: cameras that follow key frames, several views in one picture, and text overlays."""
import math

from dspace._core.fields import Named, integer, integers, number, path as path_of, reject
from dspace._core.files import atomic_write
from dspace._core.traits import DEFAULT_SAMPLES, SAMPLES, SIDE
from dspace.cameras.camera import Camera
from dspace.errors import AlreadyExists, Error, InvalidArgument, NotFound, WrongType
from dspace.movies import file as movie_file
from dspace.movies.keys import CameraPath, Key, RunTime, in_order
from dspace.movies.views import Overlay, View
from dspace.scene.viewport import Viewport

SETTINGS = {"size": (1280, 720), "rate": 30.0, "samples": DEFAULT_SAMPLES, "start": None, "speed": 1.0, "duration": None}
LENSES = ("fov_deg", "height", "tangents")  # of a key: one of them


class Movie:
    """A movie of a run. make() draws it.

        movie = dspace.Movie(size=(1920, 1080), rate=30)
        movie.add_key(viewport, 0.0)                # where the viewport's camera is now
        movie.add_key(viewport, 4.0, easing="rest")
        movie.save("flight.toml")
        movie.make("drive.dspace", "flight.mp4")

    size: (width, height) in pixels; rate: pictures a second, 0.01 to 1000; samples: n x n for each pixel, 1 to 8.
    Picture n shows the movie time n / rate. The movie ends before `duration` [s] (default: the last key's time; at
    most 1e6). Where no key states it, the run's time is `start` [s] (default: the beginning of the run) + `speed` x
    movie time. Only the keys of one view may state run times. Raises dspace.InvalidArgument for other values."""

    def __init__(self, size=SETTINGS["size"], rate=SETTINGS["rate"], samples=SETTINGS["samples"],
                 start=SETTINGS["start"], speed=SETTINGS["speed"], duration=SETTINGS["duration"]):
        about = "movie"
        accepted = f"(width, height), whole numbers from {SIDE[0]} to {SIDE[1]}"
        self.size = tuple(integers(size, 2, "the size", about, accepted))
        if not all(SIDE[0] <= each <= SIDE[1] for each in self.size):
            reject(about, "the size", self.size, accepted)
        self.rate = number(rate, "the rate", about)
        if not 0.01 <= self.rate <= 1000:
            reject(about, "the rate", rate, "0.01 to 1000 pictures a second")
        accepted = f"an integer from {SAMPLES[0]} to {SAMPLES[1]}"
        self.samples = integer(samples, "samples", about, accepted)
        if not SAMPLES[0] <= self.samples <= SAMPLES[1]:
            reject(about, "samples", samples, accepted)
        self.start = None if start is None else number(start, "start", about)
        self.speed = number(speed, "speed", about)
        if not (math.isfinite(self.start or 0.0) and math.isfinite(self.speed)):
            reject(about, "start and speed", (start, speed), "finite numbers")
        self._duration = None if duration is None else number(duration, "the duration", about)
        if self._duration is not None and not 0 < self._duration <= 1e6:
            reject(about, "the duration", duration, "above 0, up to 1e6 seconds")
        self.views, self.overlays = Named("view", {}), []
        self.label = ""  # names its file in errors

    # --- What it shows -------------------------------------------------------------------------

    def add_view(self, name="main", **settings):
        """Adds a View, which is a part of the picture, and returns it. settings: see View. Raises
        dspace.AlreadyExists if the movie has a view of that name."""
        if name in self.views:
            raise AlreadyExists(f"view {name!r}: there is one; accepted: another name", name)
        view = movie_file.take(View, {"name": name, **settings}, f"view {name!r}")
        self.views[name] = view
        return view

    def add_key(self, viewport=None, time=0.0, view=None, **values):
        """Adds a Key at a movie time [s] and returns it. The key has the present pose and projection of a
        viewport's camera (or of a Camera); values replace them.

        view: a view's name (default: the first view, which is created if the movie has none). values: see Key;
        frame: a Frame or its path that replaces the frame of the camera."""
        if not isinstance(viewport, (Viewport, Camera, type(None))):
            reject("movie", "what the key sees", viewport, "a dspace.Viewport, a dspace.Camera, or None", WrongType)
        if view is None:
            view = next(iter(self.views), None)
        elif view not in self.views:
            raise NotFound(f"view {view!r}: there is no such view; there are: {', '.join(map(repr, self.views))}",
                           view)
        if viewport is not None:
            seen = seen_through(viewport, values.pop("frame", None))
            if any(name in values for name in LENSES):
                seen = {name: value for name, value in seen.items() if name not in LENSES}
            values = {**seen, **values}
        key = movie_file.take(Key, {"time": time, **values}, f"the key at {time!r} s")
        target = self._view_of(viewport) if view is None else self.views[view]
        target.keys = in_order([*target.keys, key], f"view {target.name!r}")
        return key

    def _view_of(self, viewport):
        settings = {}
        if viewport is not None and not isinstance(viewport, Camera):
            settings["scene"] = viewport.scene.name
        elif viewport is not None:
            settings["scene"] = viewport._scene.name
        return self.add_view(**settings)

    def add_overlay(self, title="", rows=(), **settings):
        """Adds an Overlay, a title or a table, and returns it. settings: see Overlay."""
        overlay = movie_file.take(Overlay, {"title": title, "rows": rows, **settings}, f"overlay {title!r}")
        self.overlays.append(overlay)
        return overlay

    # --- Its time ------------------------------------------------------------------------------

    @property
    def duration(self):
        """The duration [s]: the given one, or the time of the last key."""
        last = max((key.time for view in self.views.values() for key in view.keys), default=0.0)
        if self._duration is None and not last:
            raise InvalidArgument("movie: it has no end; accepted: a duration in seconds (duration = ...), or a key after 0 s", "movie")
        return last if self._duration is None else self._duration

    @property
    def frames(self):
        """The number of pictures."""
        return max(1, round(self.duration * self.rate))

    def run_time(self, beginning=0.0):
        """Returns a RunTime, whose at(movie time) is the time of the run. beginning: of the run [s]."""
        stating = [view for view in self.views.values() if any(key.run is not None for key in view.keys)]
        if len(stating) > 1:
            raise InvalidArgument(f"view {stating[1].name!r}: its keys state run times, as those of view "
                                  f"{stating[0].name!r} do; accepted: keys of one view", stating[1].name)
        start = beginning if self.start is None else self.start
        return RunTime(stating[0].keys if stating else [], start, self.speed)

    def check(self):
        """Validates the movie as a whole and returns the number of pictures. A movie needs at least one view, and each
        view needs keys or a camera. Raises dspace.Error."""
        if not self.views:
            raise InvalidArgument("movie: it has no view; accepted: one or more")
        for each in (*self.views.values(), *self.overlays):
            each.__post_init__()  # validates values that were changed after construction
        for view in self.views.values():
            if bool(view.camera) == bool(view.keys):
                raise InvalidArgument(f"view {view.name!r}: it has " + ("a camera and keys" if view.camera else
                                      "neither keys nor a camera") + "; accepted: one of them", view.name)
            view.pixels(self.size)
            if view.keys:
                CameraPath(view.keys, f"view {view.name!r}")
        for overlay in self.overlays:
            if overlay.view and overlay.view not in self.views:
                raise NotFound(f"overlay {overlay.title!r}: there is no view {overlay.view!r}; there are: "
                               f"{', '.join(map(repr, self.views))}", overlay.view)
        self.run_time()
        return self.frames

    # --- Its file ------------------------------------------------------------------------------

    def settings(self):
        """Returns the settings other than views and overlays that differ from their defaults, as a dict."""
        values = {**{name: getattr(self, name) for name in SETTINGS}, "duration": self._duration}
        return {name: value for name, value in values.items() if value != SETTINGS[name]}

    @property
    def text(self):
        """The text of the movie's file."""
        return movie_file.write(self)

    def save(self, path):
        """Writes the movie's file (TOML), completely or not at all. Raises dspace.Error."""
        self.check()
        path = path_of(path, "the path", "movie")
        atomic_write(path, self.text.encode(), f"movie {path!r}")

    @classmethod
    def load(cls, path, **settings):
        """Returns the movie of a file. settings (size, rate, samples, ...) replace those of the file. Raises
        dspace.Error that names the file."""
        path = path_of(path, "the path", "movie", "the path of a TOML file")
        about = f"movie {path!r}"
        values = movie_file.load(path)
        try:
            movie = cls._of(values, about, settings)
            movie.label = about
            return movie
        except Error as error:  # the error names the file
            if str(error).startswith(about):
                raise
            raise type(error)(f"{about}: {str(error).removeprefix('movie: ')}", about) from None

    @classmethod
    def of_text(cls, words):
        """Returns the movie of a file's text."""
        return cls._of(movie_file.parse(words), "movie", {})

    @classmethod
    def _of(cls, values, about, settings):
        unknown = sorted(set(values) - set(SETTINGS) - {"view", "overlay"})
        if unknown:
            raise InvalidArgument(f"{about}: unknown {unknown[0]!r}; accepted: {', '.join(SETTINGS)}, [[view]], "
                                  "[[overlay]]", about)
        movie = cls(**{**{name: value for name, value in values.items() if name in SETTINGS}, **settings})
        for number_, each in enumerate(_tables(values, "view", about), 1):
            view = movie_file.take(View, each, f"{about}, view {number_}", ("key",))
            if view.name in movie.views:
                raise InvalidArgument(f"{about}: two views {view.name!r}; accepted: other names", about)
            where = f"{about}, view {view.name!r}"
            keys = [movie_file.take(Key, key, f"{where}, key {count}")
                    for count, key in enumerate(_tables(each, "key", where), 1)]
            view.keys = in_order(keys, where)
            movie.views[view.name] = view
        movie.overlays = [movie_file.take(Overlay, each, f"{about}, overlay {count}")
                          for count, each in enumerate(_tables(values, "overlay", about), 1)]
        movie.check()
        return movie

    def make(self, run, out, **options):
        """Draws the movie into a file (.mp4, .webm) or a folder of PNGs; see dspace.movies.make.make."""
        from dspace.movies.make import make
        return make(self, run, out, **options)

    def __repr__(self):
        return (f"<dspace.Movie of {self.size[0]} x {self.size[1]}, {len(self.views)} views, "
                f"{sum(len(view.keys) for view in self.views.values())} keys>")


def _tables(values, name, about):
    tables = values.get(name, [])
    if not isinstance(tables, list) or not all(isinstance(each, dict) for each in tables):
        raise InvalidArgument(f"{about}: {name} is {tables!r}; accepted: tables, [[{name}]]", about)
    return tables


def seen_through(viewport, frame=None):
    """Returns the values of a key at the present pose of a Camera or of a viewport's camera, in `frame` (default: that of
    the camera)."""
    camera = viewport if isinstance(viewport, Camera) else viewport.camera
    if camera is None:
        camera = viewport.scene.vantages[viewport.vantage].active
    if camera is None:
        raise NotFound(f"{viewport!r}: it looks through no camera; accepted: one with a camera")
    scene, lens = camera._scene, camera.projection
    lens = {name: lens[name] for name in LENSES if name in lens}
    base, pose = camera.frame, camera.pose
    if pose is None:  # a camera that chases or points: its present pose, in a frame that does not move with its target
        base = scene.root if frame is None else frame
        pose = camera.pose_in(base)
    elif frame is not None:
        base, pose = frame, camera.pose_in(frame)
    base = base if isinstance(base, str) else base.path
    return {"position": tuple(pose.position), "quaternion": tuple(pose.quaternion), **lens,
            "frame": "" if base == "/" else base}
