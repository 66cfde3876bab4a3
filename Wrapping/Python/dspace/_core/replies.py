"""Replies of commands, and the warnings and exceptions that they stand for."""
import sys
import warnings

from dspace._core.wire import decode
from dspace.errors import KINDS, DspaceWarning, Internal
from dspace.proto import commands_pb2 as pb


def make_error(error):
    """The exception of an Error message."""
    return KINDS.get(error.kind, Internal)(error.message, error.object)


def warn(message):
    # The warning names the line of the first caller outside this package.
    level = 1
    frame = sys._getframe()
    while frame is not None and frame.f_globals.get("__name__", "").split(".")[0] == "dspace":
        frame = frame.f_back
        level += 1
    warnings.warn(message, DspaceWarning, stacklevel=level)


def to_bytes(answer):
    """The bytes that a wrapped method returned. VTK returns a str if the bytes are valid UTF-8."""
    return answer.encode() if isinstance(answer, str) else answer


def to_reply(answer):
    return decode(pb.Reply, to_bytes(answer), "reply", Internal)
