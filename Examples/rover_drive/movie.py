"""Pictures to files: a movie and images, through ffmpeg."""
import shutil
import subprocess

import numpy as np


def _ffmpeg():
    program = shutil.which("ffmpeg")
    if program is None:
        raise OSError("ffmpeg is not installed; ./dspace setup installs it")
    return program


class Movie:
    """An H.264 file; pictures are arrays (height, width, 3) of sRGB bytes."""

    def __init__(self, path, size, rate):
        self._path = path
        self._size = size
        self._process = subprocess.Popen(
            [_ffmpeg(), "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s",
             f"{size[0]}x{size[1]}", "-r", f"{rate:g}", "-i", "-", "-an", "-c:v", "libx264", "-preset",
             "veryfast", "-crf", "20", "-pix_fmt", "yuv420p", "-movflags", "+faststart", str(path)],
            stdin=subprocess.PIPE, stderr=subprocess.PIPE)

    def __enter__(self):
        return self

    def add(self, picture):
        try:
            self._process.stdin.write(np.ascontiguousarray(picture).tobytes())
        except BrokenPipeError:
            self._finish()

    def __exit__(self, *exception):
        self._finish()

    def _finish(self):
        _, message = self._process.communicate()
        if self._process.returncode != 0:
            raise OSError(f"{self._path}: ffmpeg failed: {message.decode(errors='replace').strip()}")


def save_image(path, picture):
    """`picture`: an array (height, width, 3) of sRGB bytes."""
    height, width = picture.shape[:2]
    run = subprocess.run(
        [_ffmpeg(), "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s",
         f"{width}x{height}", "-i", "-", "-frames:v", "1", str(path)],
        input=np.ascontiguousarray(picture).tobytes(), capture_output=True)
    if run.returncode != 0:
        raise OSError(f"{path}: ffmpeg failed: {run.stderr.decode(errors='replace').strip()}")


def tile(pictures):
    """Four pictures of one size in two rows, with a thin line between them."""
    a, b, c, d = (np.array(p[..., :3]) for p in pictures)
    for picture in (a, c):
        picture[:, -1] = 0
    for picture in (a, b):
        picture[-1] = 0
    return np.vstack((np.hstack((a, b)), np.hstack((c, d))))
