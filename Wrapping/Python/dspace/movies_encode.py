"""Pictures to a movie file through ffmpeg: H.264 in MP4, VP9 in WebM."""
import os
import shutil
import subprocess

import numpy as np

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
    ending = os.path.splitext(os.fspath(path))[1].lower()
    if not ending or os.fspath(path).endswith(os.sep) or os.path.isdir(path):
        return None
    if ending not in CODECS:
        raise InvalidArgument(f"movie {str(path)!r}: its ending is {ending!r}; accepted: "
                              f"{', '.join(CODECS)}, or a folder", str(path))
    if size[0] % 2 or size[1] % 2:
        raise InvalidArgument(f"movie {str(path)!r}: its size is {size[0]} x {size[1]}; accepted: even numbers "
                              f"for {ending}, any for a folder of PNGs", str(path))
    return CODECS[ending]


def _ffmpeg():
    program = shutil.which("ffmpeg")
    if program is None:
        raise NotFound("ffmpeg is not installed; accepted: Debian's package ffmpeg", "ffmpeg")
    return program


class Encoder:
    """A movie file that pictures are added to, in a `with` statement: arrays (h, w, 3) of sRGB bytes, one
    after the other, `rate` a second. The file is there when all is written, never half of it. quick: for
    pictures that are drawn meanwhile; the file is larger."""

    def __init__(self, path, size, rate, quick=False):
        codec = codec_of(path, size)
        if codec is None:
            raise InvalidArgument(f"movie {str(path)!r}: accepted: a file that ends with {' or '.join(CODECS)}",
                                  str(path))
        if quick:
            codec = ["veryfast" if word == "medium" else word for word in codec]
            codec = codec + ["-deadline", "realtime", "-cpu-used", "6"] if "libvpx-vp9" in codec else codec
        self._path, self._size = os.fspath(path), tuple(size)
        self._part = self._path + ".part"
        self._process = subprocess.Popen(
            [_ffmpeg(), "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s",
             f"{size[0]}x{size[1]}", "-r", repr(float(rate)), "-i", "-", "-an", *_COLORS, *codec, self._part],
            stdin=subprocess.PIPE, stderr=subprocess.PIPE)

    def __enter__(self):
        return self

    def add(self, picture):
        if picture.shape[:2] != self._size[::-1] or picture.dtype != np.uint8:
            raise InvalidArgument(f"movie {self._path!r}: a picture is {picture.shape} of {picture.dtype}; "
                                  f"accepted: {self._size[::-1] + (3,)} of uint8", self._path)
        try:
            self._process.stdin.write(np.ascontiguousarray(picture[..., :3]).tobytes())
        except BrokenPipeError:
            self._finish()
            raise Io(f"movie {self._path!r}: ffmpeg ended early", self._path) from None

    def __exit__(self, kind, error, trace):
        try:
            self._finish()
            if kind is None:
                os.replace(self._part, self._path)
        finally:
            if os.path.exists(self._part):
                os.unlink(self._part)

    def _finish(self):
        _, message = self._process.communicate()
        if self._process.returncode != 0:
            words = " ".join(message.decode(errors="replace").split())
            raise Io(f"movie {self._path!r}: ffmpeg failed: {words}", self._path)


def encode(pattern, path, size, rate):
    """A movie file of numbered PNGs, such as "work/frame_%06d.png"."""
    part = os.fspath(path) + ".part"
    # A folder's % signs are no numbers.
    folder, name = os.path.split(os.path.abspath(pattern))
    done = subprocess.run([_ffmpeg(), "-y", "-loglevel", "error", "-framerate", repr(float(rate)), "-i", name,
                           "-an", *_COLORS, *codec_of(path, size), os.path.abspath(part)], cwd=folder,
                          stdin=subprocess.DEVNULL, capture_output=True)
    if done.returncode != 0:
        if os.path.exists(part):
            os.unlink(part)
        raise Io(f"movie {str(path)!r}: ffmpeg failed: {' '.join(done.stderr.decode(errors='replace').split())}",
                 str(path))
    os.replace(part, path)
