"""Checks of arguments. A rejected value raises an error that names the object, the value and what is accepted."""
import os

import numpy as np
from google.protobuf.descriptor import FieldDescriptor as _Field

from dspace._core import traits
from dspace.errors import Error, InvalidArgument, NotFound, WrongType

_INTEGERS = {_Field.TYPE_UINT32: (0, 2**32 - 1), _Field.TYPE_INT32: (-2**31, 2**31 - 1),
             _Field.TYPE_FIXED64: (0, 2**64 - 1), _Field.TYPE_UINT64: (0, 2**64 - 1)}
_OTHERS = {_Field.TYPE_BOOL: "True or False", _Field.TYPE_STRING: "a str",
           _Field.TYPE_DOUBLE: "a number"}


def shown(value):
    """Returns the repr of a value for a message, shortened if it is long."""
    full = repr(value)
    return full if len(full) <= 80 else f"{full[:77]}..."


def named(about, message):
    """`message` about an object: a name, a function that gives one, or None."""
    about = about() if callable(about) else about
    return f"{about}: {message}" if about else message


def reject(about, what, value, accepted, kind=InvalidArgument):
    """Raises an error: `what` is `value`, which is not `accepted`."""
    about = about() if callable(about) else about
    raise kind(named(about, f"{what} is {shown(value)}; accepted: {accepted}"), about or "")


class about:
    """In a `with` statement: an Error that names no object names this one."""

    def __init__(self, name):
        self._name = name

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        if isinstance(error, Error) and not error.object:
            name = self._name() if callable(self._name) else self._name
            raise type(error)(f"{name}: {error}", name) from None
        return False


def text(value, what, about=None, accepted="a str"):
    """A str that UTF-8 can encode, that is, without lone surrogates."""
    try:
        if isinstance(value, str):
            value.encode()
            return value
    except UnicodeEncodeError:
        reject(about, what, value, f"{accepted} of whole characters")
    reject(about, what, value, accepted, WrongType)


def flag(value, what, about=None):
    """A bool. Other values, such as "no" or None, are rejected although Python gives them a truth value."""
    if not isinstance(value, (bool, np.bool_)):
        reject(about, what, value, "True or False", WrongType)
    return bool(value)


def number(value, what, about=None):
    """A float, finite or not."""
    try:
        if isinstance(value, (str, bytes, bool, np.bool_)):
            raise TypeError
        return float(value)
    except (TypeError, ValueError, OverflowError):
        reject(about, what, value, "a number", WrongType)


def real(value, what, about=None, accepted="a number"):
    """A float, finite or infinite, but not NaN."""
    value = number(value, what, about)
    if value != value:
        reject(about, what, value, accepted)
    return value


def path(value, what, about=None, accepted="a path"):
    """A path, of a str or a path object, as a str."""
    value = text(os.fspath(value) if isinstance(value, os.PathLike) else value, what, about, accepted)
    if not value or "\0" in value:
        reject(about, what, value, f"{accepted} that is not empty and holds no zero bytes")
    return value


def file_path(value, what, about=None):
    """The path of a file as a str."""
    try:
        path = os.fspath(value)
    except TypeError:
        path = None
    if not isinstance(path, str):
        reject(about, what, value, "a path", WrongType)
    return text(path, what, about, "a path")


def numbers(value, count, what, about=None, accepted=None):
    """`count` numbers as an array of floats, finite or not."""
    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        array = None
    if array is None or array.shape != (count,) or isinstance(value, str):
        reject(about, what, value, accepted or f"{count} numbers", WrongType)
    return array


def array_of(value, what, accepted, about=None):
    """Anything as an array of floats."""
    try:
        return np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        reject(about, what, value, accepted, WrongType)


def integers(value, count, what, about=None, accepted=None):
    """`count` integers, such as a size in pixels."""
    try:
        values = list(value)
    except TypeError:
        values = []
    if len(values) != count or not all(isinstance(v, (int, np.integer))
                                       and not isinstance(v, bool) for v in values):
        reject(about, what, value, accepted or f"{count} integers", WrongType)
    return [int(v) for v in values]


def integer(value, what, about=None, accepted="an integer"):
    """One integer."""
    if not isinstance(value, (int, np.integer)) or isinstance(value, bool):
        reject(about, what, value, accepted, WrongType)
    return int(value)


def items(value, what, about, accepted):
    """The items of an iterable as a list. A str is rejected."""
    try:
        if hasattr(value, "__iter__") and not isinstance(value, (str, bytes)):
            return list(value)
    except TypeError:
        pass
    reject(about, what, value, accepted, WrongType)


def word(value, words, what, about=None):
    """Returns the value of a word in the dict `words`. Rejects other words."""
    try:  # an unhashable value is not a word
        return words[value]
    except (KeyError, TypeError):
        reject(about, what, value, ", ".join(map(repr, words)))


def keywords(values, accepted, about=None):
    """Rejects unknown keywords. `accepted` has the public names."""
    unknown = sorted(set(values) - set(accepted))
    if unknown:
        raise WrongType(named(about, f"unknown keyword {', '.join(map(repr, unknown))}; accepted: "
                                     f"{', '.join(accepted)}"))


def color(value, what="the colour", about=None):
    """Three numbers of an sRGB triple, "#rrggbb" or a CSS name such as "red"."""
    accepted = "red, green and blue from 0 to 1, '#rrggbb', or a CSS name such as 'red'"
    if isinstance(value, str):
        from vtkmodules.vtkCommonColor import vtkNamedColors
        if len(value) == 7 and value[0] == "#":
            try:
                return np.array([int(value[i:i + 2], 16) / 255 for i in (1, 3, 5)])
            except ValueError:
                reject(about, what, value, accepted)
        names = vtkNamedColors()
        # CSS accepts both spellings of grey, VTK only one for each color. VTK ends the process for invalid UTF-8.
        plain = value.isascii() and value.replace("_", "").isalnum()
        for name in () if not plain else (value, value.replace("grey", "gray"), value.replace("gray", "grey")):
            if names.ColorExists(name):
                c = names.GetColor3d(name)
                return np.array([c.GetRed(), c.GetGreen(), c.GetBlue()])
        reject(about, what, value, accepted)
    return numbers(value, 3, what, about, accepted)


def put(message, about=None, **values):
    """Sets fields of a message; `about` as in `named`."""
    for name, value in values.items():
        field = message.DESCRIPTOR.fields_by_name[name]
        if field.type == _Field.TYPE_BOOL:
            value = flag(value, name, about)
        elif field.type == _Field.TYPE_DOUBLE:
            value = number(value, name, about)
        elif field.type in _INTEGERS:
            low, high = _INTEGERS[field.type]
            whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
            if not whole or not low <= value <= high:
                reject(about, name, value, traits.accepted(field) or f"an integer from {low} to {high}",
                       InvalidArgument if whole else WrongType)
            value = int(value)
        try:
            setattr(message, name, value)
        except (TypeError, ValueError):
            kind = InvalidArgument if isinstance(value, str) else WrongType
            reject(about, name, value, _OTHERS.get(field.type, "another type"), kind)


def put_given(message, about=None, **values):
    """Sets the fields whose values are not None."""
    put(message, about, **{name: value for name, value in values.items() if value is not None})


def put_vector(message, value, what, about=None):
    """Three numbers into a Vector3."""
    message.x, message.y, message.z = numbers(value, 3, what, about)


def put_color(message, value, what="the colour", about=None):
    """A colour into a Color."""
    message.r, message.g, message.b = color(value, what, about)


class Named(dict):
    """A dict of things of one kind by name. A missing name raises dspace.NotFound, which lists the existing names."""

    def __init__(self, kind, things):
        super().__init__(things)
        self._kind = kind

    def __missing__(self, name):
        others = list(self)
        near = self._near(name) if len(others) > self._FEW else []
        what = "near matches" if near else "there are"
        raise NotFound(f"{self._kind} {shown(name)}: there is no such {self._kind}; {what}: "
                       + (", ".join(map(repr, (near or others)[:50])) or "none")
                       + (f"; there are {len(others)}" if near else ", ..." if len(others) > 50 else ""),
                       f"{self._kind} {shown(name)}")

    _FEW = 12  # are all listed

    def _near(self, name):
        # Names that hold it, then those that differ little; of paths, their last parts.
        from difflib import get_close_matches
        if not isinstance(name, str) or not name:
            return []
        last = {other: str(other).split("/")[-1].lower() for other in self}
        wanted = name.split("/")[-1].lower()
        close = get_close_matches(wanted, set(last.values()), 5, 0.6)
        return [other for other in self if wanted in last[other] or last[other] in close][:8]
