"""Encodes pictures into a movie file with ffmpeg: H.264 in MP4, VP9 in WebM."""
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
# Players assume these color properties for an untagged video. They are stated explicitly all the same.
_COLORS = ["-vf", "scale=out_color_matrix=bt709:out_range=tv", "-pix_fmt", "yuv420p", "-colorspace", "bt709",
           "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv"]


def codec_of(path, size):
    """Returns ffmpeg's arguments for a file, or None for a folder of PNGs. Raises dspace.InvalidArgument for other
    file name extensions and for odd sizes."""
    path = path_of(path, "the file", "movie", "a path")
    ending = os.path.splitext(path)[1].lower()
    if not ending or path.endswith(os.sep) or os.path.isdir(path):
        return None
    if ending not in CODECS:
        raise InvalidArgument(f"movie {path!r}: its ending is {ending!r}; accepted: {', '.join(CODECS)}, or a folder: "
                              "a name without a dot, a name with a slash at its end, or an existing folder", path)
    if size[0] % 2 or size[1] % 2:
        raise InvalidArgument(f"movie {str(path)!r}: its size is {size[0]} x {size[1]}; accepted: even numbers "
                              f"for {ending}, any for a folder of PNGs", str(path))
    return CODECS[ending]


def programs():
    """Returns the paths of ffmpeg, which writes the movie, and ffprobe, which verifies it."""
    found = [shutil.which(name) for name in ("ffmpeg", "ffprobe")]
    if None in found:
        name = ("ffmpeg", "ffprobe")[found.index(None)]
        raise NotFound(f"{name} is not installed; accepted: Debian's package ffmpeg", name)
    return found


class _Part:
    """The temporary file that ffmpeg writes. finish() gives it its final name when it is complete."""

    def __init__(self, path):
        self.label = os.fspath(path)
        self.output = tempfile.TemporaryFile()  # a file: ffmpeg would block on a pipe that is not read
        self.file = AtomicFile(path, f"movie {self.label!r}")
        self.part = self.file.temporary  # absolute: ffmpeg reads "12:30.mp4" as a protocol, "-x.mp4" as an option

    def start(self, words, codec, **settings):
        ffmpeg, _ = programs()
        # Without -xerror ffmpeg reports success even if it could not write the end of the file.
        return subprocess.Popen([ffmpeg, "-y", "-xerror", "-nostats", "-loglevel", "error", *words, "-an", *_COLORS,
                                 *codec, self.part], stderr=self.output, **settings)

    def failed(self, words):
        self.output.seek(0)
        output = " ".join(self.output.read().decode(errors="replace").split())
        return Io(f"movie {self.label!r}: {words}" + (f": {output}" if output else ""), self.label)

    def finish(self, process, count):
        """Gives the file its final name if ffmpeg reported no error and the file holds all `count` pictures. Raises
        dspace.Io otherwise."""
        if process.wait() != 0 or self.output.seek(0, os.SEEK_END):
            raise self.failed("ffmpeg failed")
        _, ffprobe = programs()
        seen = subprocess.run([ffprobe, "-v", "error", "-count_packets", "-select_streams", "v:0", "-show_entries",
                               "stream=nb_read_packets", "-of", "csv=p=0", self.part], stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, errors="replace")
        held = seen.stdout.strip().rstrip(",")
        if seen.returncode != 0 or seen.stderr.strip() or held != str(count):
            raise self.failed(f"it holds {held or 'none'} of {count} pictures {' '.join(seen.stderr.split())}".strip())
        self.file.commit()

    def close(self):
        self.output.close()
        self.file.close()


class Encoder:
    """Writes a movie file, in a `with` statement. add() appends a picture: an array (h, w, 3) of sRGB bytes.

    rate: pictures a second. The file appears when it is complete, never in part. Without a picture there is no file,
    and dspace.InvalidArgument. quick: encodes faster, for pictures that are drawn at the same time; the file is
    larger."""

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
            except BrokenPipeError:  # finish() reports ffmpeg's error below
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
    """Encodes `count` PNGs, numbered from 0, into a movie file. pattern: their path, such as "work/frame_%06d.png".
    tell(done): called with the number of encoded pictures as the work advances."""
    # ffmpeg runs in the folder, so that it does not read % signs in the folder's name as number formats.
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
