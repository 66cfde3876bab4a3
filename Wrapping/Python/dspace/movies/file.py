"""The text file of a movie: TOML that a person may edit. It has a fixed order and omits default values."""
import json
import tomllib
from dataclasses import fields

from dspace._core.fields import text
from dspace.errors import Corrupt, InvalidArgument, Io


def _value(value):
    """Returns a value as TOML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        # TOML has the escapes of JSON, except for DEL.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007F")
    if isinstance(value, (tuple, list)):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, int):
        return str(value)
    return repr(float(value))


def table_of(thing, skip=()):
    """Returns the fields of a dataclass, as a dict, that differ from their defaults."""
    return {each.name: getattr(thing, each.name) for each in fields(thing)
            if each.name not in skip and getattr(thing, each.name) not in (None, each.default)}


def _lines(values):
    return [f"{name} = {_value(value)}" for name, value in values.items()]


def write(movie):
    """Returns the text of a Movie. Equal movies have equal texts."""
    parts = [["# A movie of Dspace: see Documentation/Movies.md. Seconds, metres, degrees."]
             + _lines(movie.settings())]
    for view in movie.views.values():
        parts.append(["[[view]]"] + _lines(table_of(view, ("keys",))))
        parts += [["[[view.key]]"] + _lines(table_of(key)) for key in view.keys]
    parts += [["[[overlay]]"] + _lines(table_of(overlay)) for overlay in movie.overlays]
    return "\n\n".join("\n".join(part) for part in parts) + "\n"


def load(path):
    """Returns the contents of a file as dicts. Raises dspace.Io, or dspace.Corrupt if it is not TOML."""
    try:
        with open(path, "rb") as file:
            data = file.read()
    except OSError as error:
        raise Io(f"movie {str(path)!r}: {error.strerror}; accepted: a file that can be read",
                 str(path)) from None
    try:
        return parse(data.decode())
    except (UnicodeDecodeError, Corrupt) as error:
        raise Corrupt(f"movie {str(path)!r}: {error}; accepted: TOML", str(path)) from None


def parse(words):
    """Returns the contents of a TOML text as dicts. Raises dspace.Corrupt if it is not TOML."""
    try:
        return tomllib.loads(text(words, "the text of a movie"))
    except tomllib.TOMLDecodeError as error:
        raise Corrupt(str(error)) from None


def take(kind, values, about, also=()):
    """Returns a dataclass from a dict. Raises dspace.InvalidArgument that names an unknown or a missing field."""
    if not isinstance(values, dict):
        raise InvalidArgument(f"{about}: it is {values!r}; accepted: a table", about)
    accepted = [each.name for each in fields(kind) if each.name != "keys"]
    unknown = sorted(set(values) - set(accepted) - set(also))
    if unknown:
        raise InvalidArgument(f"{about}: unknown {', '.join(map(repr, unknown))}; accepted: "
                              f"{', '.join([*accepted, *also])}", about)
    from dataclasses import MISSING
    missing = [each.name for each in fields(kind) if each.name in accepted and each.name not in values
               and each.default is MISSING]
    if missing:
        raise InvalidArgument(f"{about}: {missing[0]!r} is missing; accepted: {', '.join(accepted)}", about)
    try:
        return kind(**{name: values[name] for name in values if name in accepted})
    except InvalidArgument as error:
        raise InvalidArgument(str(error) if str(error).startswith(about) else f"{about}: {error}", about) from None
