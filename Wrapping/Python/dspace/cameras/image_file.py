"""Files of images that hold how they were made: PNG, TIFF and OpenEXR, by OpenImageIO (Debian: python3-openimageio)."""
import json
import pathlib

import numpy as np

from dspace._core.fields import path as path_of, reject
from dspace._core.files import AtomicFile
from dspace.errors import Corrupt, Io, NotFound, WrongType

FORMATS = {".png": ("png", ("uint8", "uint16")), ".tif": ("tiff", ("uint8", "uint16", "uint32", "float32")),
           ".tiff": ("tiff", ("uint8", "uint16", "uint32", "float32")), ".exr": ("openexr", ("uint32", "float32"))}
KIND = "dspace image"  # what "kind" is in the JSON of the description
CHANNELS = {1: ("Y",), 3: ("R", "G", "B")}
PNG_END = b"\0\0\0\0IEND\xaeB`\x82"  # the last chunk and its checksum
ROWS = 32  # compressed at a time: Ctrl-C is heard between
TIME = "1970:01:01 00:00:00"  # in place of the time of writing: equal images have equal bytes


def _library():
    try:
        import OpenImageIO
    except ModuleNotFoundError:
        raise NotFound("OpenImageIO is not installed; accepted: Debian's package python3-openimageio",
                       "python3-openimageio") from None
    except ImportError as error:
        if isinstance(error.__cause__, KeyboardInterrupt):  # Ctrl-C while it was loaded
            raise error.__cause__
        raise
    return OpenImageIO


def format_of(path, kind=None, about=None):
    """The format of a path's ending. kind: the dtype of an image, which it must be able to hold."""
    ending = pathlib.Path(path).suffix.lower()
    about = f"image {str(path)!r}" if about is None else about
    if ending not in FORMATS:
        reject(about, "its ending", ending, ", ".join(FORMATS))
    name, kinds = FORMATS[ending]
    if kind is not None and np.dtype(kind).name not in kinds:
        able = ", ".join(each for each, (_, held) in FORMATS.items() if np.dtype(kind).name in held)
        reject(about, f"a pixel's type in {ending}", np.dtype(kind).name, f"{', '.join(kinds)}; it fits {able or 'none'}")
    return name


class ImageFile:
    """An image that is written in rows from its top, and is there when it is complete.

    size: (width, height); channels: 1 or 3; kind: uint8 or uint16 (.png, .tif), uint32 or float32 (.tif, .exr).
    metadata: a dict for JSON, or None. Use commit() at the end, and close() in any case."""

    def __init__(self, path, size, channels, kind, metadata=None):
        path = path_of(path, "the path", "image")
        self._about = f"image {path!r}"
        format = format_of(path, kind, self._about)
        if channels not in CHANNELS:
            reject(self._about, "the number of channels", channels, "1 or 3")
        oiio = _library()
        kinds = {"uint8": oiio.UINT8, "uint16": oiio.UINT16, "uint32": oiio.UINT32, "float32": oiio.FLOAT}
        self._kind, self._size, self._channels, self._row = np.dtype(kind), tuple(size), channels, 0
        self._format, self._oiio = format, oiio
        self._spec = spec = oiio.ImageSpec(*size, channels, kinds[self._kind.name])
        spec.channelnames = CHANNELS[channels]
        spec.attribute("ImageDescription", json.dumps({"kind": KIND, **(metadata or {})}, sort_keys=True))
        spec.attribute("DateTime", TIME)
        spec.attribute("compression", "zip")
        self._out = None  # from the first rows on: libraries complain about files without any
        self._file = AtomicFile(path, self._about)

    def _open(self):
        out = self._oiio.ImageOutput.create(self._format)
        if out is None or not out.open(self._file.temporary, self._spec):
            why = self._oiio.geterror() if out is None else out.geterror()
            raise Io(f"{self._about}: it cannot be written: {why}; accepted: an image that {self._format} can hold", self._about)
        self._out = out

    def write_rows(self, rows):
        """Writes the next rows, (n, width) or (n, width, channels)."""
        width, height = self._size
        rows = np.ascontiguousarray(rows)
        if rows.dtype != self._kind or rows.shape[1:] not in ((width,), (width, self._channels)) or rows[:1].size % self._channels \
                or self._row + len(rows) > height:
            reject(self._about, "the shape and type of rows", (rows.shape, rows.dtype.name),
                   f"(n, {width}, {self._channels}) of {self._kind.name}, {height - self._row} rows at most", WrongType)
        if not len(rows):
            return
        if self._out is None:
            self._open()
        rows = rows.reshape(len(rows), width, self._channels)
        for first in range(0, len(rows), ROWS):
            part = rows[first:first + ROWS]
            if not self._out.write_scanlines(self._row, self._row + len(part), 0, part):
                raise Io(f"{self._about}: it cannot be written: {self._out.geterror()}", self._about)
            self._row += len(part)

    def commit(self):
        if self._row != self._size[1]:
            reject(self._about, "the number of rows", self._row, f"all {self._size[1]}")
        out, self._out = self._out, None
        if not out.close():
            raise Io(f"{self._about}: it cannot be written: {out.geterror()}", self._about)
        self._require_complete()
        self._file.commit()

    def _require_complete(self):
        """Reads the file to its end: on a full disk the libraries cut a PNG or an EXR and report no error."""
        image = self._oiio.ImageInput.open(self._file.temporary)
        whole = image is not None
        if whole:
            spec, (width, height) = image.spec(), self._size
            whole = (spec.width, spec.height, spec.nchannels) == (width, height, self._channels) and all(
                image.read_scanlines(first, min(first + ROWS, height), 0, 0, self._channels, spec.format) is not None
                for first in range(0, height, ROWS))
            image.close()
        if self._format == "png":  # its pixels may be whole, and its end missing
            whole = whole and pathlib.Path(self._file.temporary).read_bytes()[-len(PNG_END):] == PNG_END
        if not whole:
            raise Io(f"{self._about}: it cannot be written: it is incomplete; accepted: a folder with free space", self._about)

    def close(self):
        """Removes what was written, unless it was committed."""
        if self._out is not None:
            self._out.close()
            self._out = None
        self._file.close()


def write_image(path, image, metadata=None):
    """Writes an array (h, w), or (h, w, 3), with a dict as JSON. Formats: as for ImageFile. Equal images have equal bytes."""
    image = np.asarray(image)
    if image.ndim not in (2, 3) or not image.size:
        reject(f"image {str(path)!r}", "the shape", image.shape, "(h, w) or (h, w, 3)")
    file = ImageFile(path, image.shape[1::-1], image.shape[2] if image.ndim == 3 else 1, image.dtype, metadata)
    try:
        file.write_rows(image)
        file.commit()
    finally:
        file.close()


def _opened(path):
    path = path_of(path, "the path", "image")
    if not pathlib.Path(path).is_file():
        raise NotFound(f"image {path!r}: there is no such file", path)
    oiio = _library()
    image = oiio.ImageInput.open(path)
    if image is None:
        raise Corrupt(f"image {path!r}: it is damaged, or no image: {oiio.geterror()}; accepted: {', '.join(FORMATS)}", path)
    return path, image


def read_metadata(path):
    """What write_image() or Scene.save_image() wrote about an image, as a dict; None: nothing."""
    path, image = _opened(path)
    words = image.spec().getattribute("ImageDescription")
    image.close()
    try:
        found = json.loads(words)
    except (TypeError, ValueError):
        return None
    return found if isinstance(found, dict) and found.pop("kind", None) == KIND else None


def read_image(path):
    """An image file as an array (h, w) or (h, w, channels), of its own type."""
    path, image = _opened(path)
    spec = image.spec()
    found = image.read_image(spec.format)
    why = image.geterror()
    image.close()
    if found is None or why:
        raise Corrupt(f"image {path!r}: it is damaged: {why}; accepted: a whole file", path)
    return found.reshape(spec.height, spec.width) if spec.nchannels == 1 else found
