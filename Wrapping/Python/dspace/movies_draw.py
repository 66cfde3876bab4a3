"""Single pictures of a movie: the run is taken to its time, cameras to their places, views put together."""
import importlib.util
import os
import re
import struct
import zlib

import numpy as np

from dspace._fields import shown
from dspace.errors import InvalidArgument, NotFound, WrongType
from dspace.movies_keys import CameraPath
from dspace.poses import Pose

_FIELD = re.compile(r"\{([^{}:]*)(?::([^{}]*))?\}")


class Source:
    """What a movie is drawn of: a session, and how its run is taken to a time.

    session: a dspace.Session. advance(time): takes the run to a time [s]; called with the times of the
    pictures, in their order. telemetry(): a dict of names to numbers or texts for overlays, now. close():
    called at the end. beginning: the run's first time [s]."""

    def __init__(self, session, advance=None, telemetry=None, close=None, beginning=0.0):
        self.session, self.beginning = session, beginning
        self.advance = advance or (lambda time: None)
        self.telemetry = telemetry or dict
        self.close = close or (lambda: None)
        self.closes = close is not None


def open_run(run):
    """A Source of what was given as a run: a recording's path; "FILE.py:NAME", a function that returns one of
    the following or a tuple of what Source takes; a Source; a Playback (has a session and seek(time)); what
    has a session and advance(time); or a Session, which stands still."""
    if isinstance(run, Source):
        return run
    if isinstance(run, (str, os.PathLike)):
        script, _, name = os.fspath(run).rpartition(":")
        if script.endswith(".py") and name.isidentifier():
            return _made_by(script, name)
        try:
            from dspace import Playback
        except ImportError:
            raise NotFound(f"run {shown(run)}: recordings are not played back here; accepted: FILE.py:NAME, a "
                           "function that returns a Source", shown(run)) from None
        playback = Playback(os.fspath(run))
        source = _of_playback(playback)
        source.close = getattr(playback, "close", source.close)
        return source
    if hasattr(run, "session") and hasattr(run, "seek"):
        return _of_playback(run)
    if hasattr(run, "session") and hasattr(run, "advance"):
        return Source(run.session, run.advance, getattr(run, "telemetry", None))
    if hasattr(run, "execute") and hasattr(run, "scene"):
        return Source(run)
    raise WrongType(f"the run is {shown(run)}; accepted: a recording's path, FILE.py:NAME, a Source, a Playback "
                    "or a Session")


def _of_playback(playback):
    telemetry = getattr(playback, "telemetry", None)

    def seek(time):
        # The last step that is not after it: a simulation that adds up its steps is a rounding off.
        playback.seek(time + max(1e-9, 8 * np.spacing(abs(time))))

    return Source(playback.session, seek, telemetry if callable(telemetry) else None,
                  beginning=_first_time(playback))


def _first_time(playback):
    """The first time that the simulation set: what was there before it has the time 0 that nobody set."""
    steps = playback.file.steps() if hasattr(playback, "file") else []
    return steps[0][1] if steps else min(playback.times, default=0.0)


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


class Stage:
    """A movie and a run, ready to be drawn."""

    def __init__(self, movie, source):
        movie.check()
        self.movie, self.source = movie, source
        self.runs = movie.run_time(source.beginning)
        self.paths = {name: CameraPath(view.keys, f"view {name!r}")
                      for name, view in movie.views.items() if view.keys}
        self.shown = {name: [] for name in movie.views}

    def _viewport(self, view):
        """Its viewport, made where there is none (any more: a playback that seeks may begin anew)."""
        session, name = self.source.session, f"movie {view.name}"
        viewport = session.viewports.get(name)
        if viewport is not None:
            return viewport
        scene = session.scenes[view.scene]
        left, top, right, bottom = view.pixels(self.movie.size)
        camera = name
        if view.keys:
            scene.add_camera(name, vantage=view.vantage)
        else:
            camera = scene.vantages[view.vantage].cameras[view.camera].name
        viewport = scene.add_viewport((right - left, bottom - top), camera, name=name, vantage=view.vantage,
                                      samples=self.movie.samples)
        viewport.ornaments = view.ornaments
        viewport.corner_axes = view.corner_axes
        for fragment in view.hide:
            viewport.hide(fragment)
        if view.background is not None:
            viewport.set_background(view.background, top=view.background_top)
        self.shown[view.name] = []
        return viewport

    def picture(self, number):
        """Picture `number`, from 0: (h, w, 3) uint8, sRGB."""
        time = number / self.movie.rate
        run = self.runs.at(time)
        self.source.advance(run)
        width, height = self.movie.size
        out = np.zeros((height, width, 3), np.uint8)
        for number_, (name, view) in enumerate(self.movie.views.items()):
            viewport = self._viewport(view)
            scene = viewport.scene
            if view.keys:
                self._aim(view, scene, viewport, time)
            self._write(viewport, scene, view, number_ == 0, time, run)
            left, top, right, bottom = view.pixels(self.movie.size)
            out[top:bottom, left:right] = viewport.image()
        return out

    def _aim(self, view, scene, viewport, time):
        def find(path):
            return scene.frame(path) if path else scene.root

        def relative(path, base):
            return find(path).pose_in(find(base))

        path, position, quaternion, fov_deg = self.paths[view.name].at(time, relative)
        scene.add_camera(f"movie {view.name}", frame=find(path), pose=Pose(position, quaternion),
                         fov_deg=fov_deg, near=view.near, far=view.far, vantage=view.vantage)

    def _write(self, viewport, scene, view, first, time, run):
        """Tables of the overlays that this view has now."""
        now = []
        for number, overlay in enumerate(self.movie.overlays):
            if overlay.view not in ((view.name, "") if first else (view.name,)) or not overlay.shows(time):
                continue
            name = f"movie {number}"
            values = lambda key: self._value(key, scene, time, run)
            rows = [(label, fill(value, values)) for label, value in overlay.rows]
            viewport.set_table(name, rows, title=overlay.title, anchor=overlay.anchor,
                               font_size=overlay.font_size or max(8, round(self.movie.size[1] / 40)))
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
        path, _, axis = key.rpartition(".")
        if path and axis in ("x", "y", "z"):
            return float(scene.frame(path).world_pose.position["xyz".index(axis)])
        raise InvalidArgument(f"overlay: there is no value {key!r}; accepted: movie, run, FRAME.x of y and z, "
                              + (", ".join(map(repr, telemetry)) or "and the source's telemetry"), key)


def fill(text, values):
    """A text whose {name:format} are replaced by what values(name) gives."""
    def put(match):
        value = values(match[1])
        try:
            return format(value, match[2] or "")
        except (ValueError, TypeError):
            raise InvalidArgument(f"overlay: {match[0]} cannot be written of {shown(value)}; accepted: a format "
                                  "such as {run:.2f}", match[1]) from None

    return _FIELD.sub(put, text)


# --- PNG -------------------------------------------------------------------------------------------

_MAGIC = b"\x89PNG\r\n\x1a\n"
_END = b"\x00\x00\x00\x00IEND\xaeB`\x82"


def png(picture):
    """The bytes of a PNG file of an array (h, w, 3) of sRGB bytes; equal pictures have equal bytes."""
    height, width = picture.shape[:2]
    rows = np.ascontiguousarray(picture[..., :3]).reshape(height, width * 3)
    filtered = np.empty((height, width * 3 + 1), np.uint8)
    filtered[:, 0] = 2  # each row less the one above
    filtered[0, 1:] = rows[0]
    filtered[1:, 1:] = rows[1:] - rows[:-1]

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return (_MAGIC + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"sRGB", b"\0") + chunk(b"IDAT", zlib.compress(filtered.tobytes(), 1)) + _END)


def is_whole(path):
    """Whether a file is a PNG whose parts all have their checksums."""
    try:
        with open(path, "rb") as file:
            data = file.read()
    except OSError:
        return False
    if not data.startswith(_MAGIC) or not data.endswith(_END):
        return False
    at = len(_MAGIC)
    while at + 12 <= len(data):
        length, = struct.unpack(">I", data[at:at + 4])
        end = at + 12 + length
        if end > len(data) or struct.unpack(">I", data[end - 4:end])[0] != zlib.crc32(data[at + 4:end - 4]):
            return False
        at = end
    return at == len(data)
