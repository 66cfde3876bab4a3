"""Pictures to a movie file through ffmpeg: H.264 in MP4, VP9 in WebM."""
import os
import shutil
import subprocess
import tempfile

import numpy as np

from dspace._core.fields import path as path_of
from dspace._core.files import AtomicFile
from dspace.errors import InvalidArgument, Io, NotFound

CODECS = {
    ".mp4": ["-c:v", "libx264", "-preset", "medium", "-crf", "18", "-movflags", "+faststart", "-f", "mp4"],
    ".webm": ["-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1", "-f", "webm"],
}
# What players take a video for that is told nothing; told all the same.
_COLORS = ["-vf", "scale=out_color_matrix=bt709:out_range=tv", "-pix_fmt", "yuv420p", "-colorspace", "bt709",
           "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv"]


def codec_of(path, size):
    """ffmpeg's words for a file; None for a folder of PNGs. Refuses other endings and odd sizes."""
    path = path_of(path, "the file", "movie", "a path")
    ending = os.path.splitext(path)[1].lower()
    if not ending or path.endswith(os.sep) or os.path.isdir(path):
        return None
    if ending not in CODECS:
        raise InvalidArgument(f"movie {path!r}: its ending is {ending!r}; accepted: {', '.join(CODECS)}, or a folder: "
                              "a name without a dot, with a slash at its end, or of one that is there", path)
    if size[0] % 2 or size[1] % 2:
        raise InvalidArgument(f"movie {str(path)!r}: its size is {size[0]} x {size[1]}; accepted: even numbers "
                              f"for {ending}, any for a folder of PNGs", str(path))
    return CODECS[ending]


def programs():
    """The paths of ffmpeg, which writes, and ffprobe, which looks at what was written."""
    found = [shutil.which(name) for name in ("ffmpeg", "ffprobe")]
    if None in found:
        name = ("ffmpeg", "ffprobe")[found.index(None)]
        raise NotFound(f"{name} is not installed; accepted: Debian's package ffmpeg", name)
    return found


class _Part:
    """The file that ffmpeg writes, until it is whole."""

    def __init__(self, path):
        self.label = os.fspath(path)
        self.said = tempfile.TemporaryFile()  # a pipe that nobody reads would stop it
        self.file = AtomicFile(path, f"movie {self.label!r}")
        self.part = self.file.temporary  # absolute: of "12:30.mp4" and "-x.mp4" ffmpeg thinks otherwise

    def start(self, words, codec, **settings):
        ffmpeg, _ = programs()
        # Without -xerror ffmpeg calls a file done whose end it could not write.
        return subprocess.Popen([ffmpeg, "-y", "-xerror", "-nostats", "-loglevel", "error", *words, "-an", *_COLORS,
                                 *codec, self.part], stderr=self.said, **settings)

    def failed(self, words):
        self.said.seek(0)
        said = " ".join(self.said.read().decode(errors="replace").split())
        return Io(f"movie {self.label!r}: {words}" + (f": {said}" if said else ""), self.label)

    def finish(self, process, count):
        """The file under its own name, if ffmpeg had nothing to complain of and all `count` pictures are in it."""
        if process.wait() != 0 or self.said.seek(0, os.SEEK_END):
            raise self.failed("ffmpeg failed")
        _, ffprobe = programs()
        seen = subprocess.run([ffprobe, "-v", "error", "-count_packets", "-select_streams", "v:0", "-show_entries",
                               "stream=nb_read_packets", "-of", "csv=p=0", self.part], stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, errors="replace")
        held = seen.stdout.strip().rstrip(",")
        if seen.returncode != 0 or seen.stderr.strip() or held != str(count):
            raise self.failed(f"of {count} pictures it holds {held or 'none'} {' '.join(seen.stderr.split())}".strip())
        self.file.commit()

    def close(self):
        self.said.close()
        self.file.close()


class Encoder:
    """A movie file that pictures are added to, in a `with` statement: arrays (h, w, 3) of sRGB bytes, one
    after the other, `rate` a second. The file is there when all is written, never half of it; without a
    picture there is none, and an error. quick: for pictures that are drawn meanwhile; the file is larger."""

    def __init__(self, path, size, rate, quick=False):
        codec = codec_of(path, size)
        if codec is None:
            raise InvalidArgument(f"movie {str(path)!r}: accepted: a file that ends with {' or '.join(CODECS)}",
                                  str(path))
        if quick:
            codec = ["veryfast" if word == "medium" else word for word in codec]
            codec = codec + ["-deadline", "realtime", "-cpu-used", "6"] if "libvpx-vp9" in codec else codec
        self._size, self._count = tuple(size), 0
        self._part = _Part(path)
        try:
            self._process = self._part.start(["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{size[0]}x{size[1]}",
                                              "-r", repr(float(rate)), "-i", "-"], codec, stdin=subprocess.PIPE)
        except BaseException:
            self._part.close()
            raise

    def __enter__(self):
        return self

    def add(self, picture):
        if picture.shape[:2] != self._size[::-1] or picture.dtype != np.uint8:
            raise InvalidArgument(f"movie {self._part.label!r}: a picture is {picture.shape} of {picture.dtype}; "
                                  f"accepted: {self._size[::-1] + (3,)} of uint8", self._part.label)
        try:
            self._process.stdin.write(np.ascontiguousarray(picture[..., :3]).tobytes())
        except BrokenPipeError:
            self._process.wait()
            raise self._part.failed("ffmpeg ended early") from None
        self._count += 1

    def __exit__(self, kind, error, trace):
        try:
            try:
                self._process.stdin.close()
            except BrokenPipeError:  # what it says is told below
                pass
            if kind is not None:
                self._process.kill()
                self._process.wait()
            elif not self._count:
                self._process.wait()
                raise InvalidArgument(f"movie {self._part.label!r}: it has no picture; accepted: one or more",
                                      self._part.label)
            else:
                self._part.finish(self._process, self._count)
        finally:
            self._part.close()


def encode(pattern, path, size, rate, count, tell=lambda done: None):
    """A movie file of `count` numbered PNGs from 0, such as "work/frame_%06d.png"; tell(done): called as it
    goes on."""
    # A folder's % signs are no numbers.
    folder, name = os.path.split(os.path.abspath(pattern))
    part = _Part(path)
    process = None
    try:
        process = part.start(["-progress", "pipe:1", "-stats_period", "0.2", "-framerate", repr(float(rate)),
                              "-start_number", "0", "-i", name], codec_of(path, size), cwd=folder,
                             stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
        for line in process.stdout:
            name, _, value = line.strip().partition("=")
            if name == "frame" and value.strip().isdigit():
                tell(min(int(value), count))
        part.finish(process, count)
    finally:
        if process is not None:
            process.kill()
            process.wait()
            process.stdout.close()
        part.close()
