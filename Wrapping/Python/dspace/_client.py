"""Where commands go, and what comes back: replies, warnings, exceptions."""
import sys
import warnings

from dspace import vtk as _vtk
from dspace.errors import KINDS, DspaceWarning, Internal
from dspace.session import commands_pb2 as pb


def make_error(error):
    """The exception of an Error message."""
    return KINDS.get(error.kind, Internal)(error.message, error.object)


def _warn(message):
    # Points at the first caller outside this package, however deep it was called.
    level = 1
    frame = sys._getframe()
    while frame is not None and frame.f_globals.get("__name__", "").split(".")[0] == "dspace":
        frame = frame.f_back
        level += 1
    warnings.warn(message, DspaceWarning, stacklevel=level)


class LocalClient:
    """Hands commands to an interpreter in this process."""

    def __init__(self):
        self.vtk = _vtk.vtkDspaceSession()

    def local(self):
        """The vtkDspaceSession; raises when it is closed."""
        if self.vtk is None:
            raise RuntimeError("the session is closed")
        return self.vtk

    def execute(self, command):
        """The Reply to a Command; raises what its error says."""
        answer = self.local().Execute(command.SerializeToString())
        # VTK makes a str of bytes that happen to be UTF-8.
        reply = pb.Reply.FromString(answer.encode() if isinstance(answer, str) else answer)
        if reply.HasField("error"):
            raise make_error(reply.error)
        for warning in reply.warning:
            _warn(warning)
        return reply

    def close(self):
        self.vtk = None
