"""What is raised when a command is refused; nothing of it was done."""


class Error(Exception):
    """Base of all of them. `object` names what it is about."""

    def __init__(self, message, object=""):
        super().__init__(message)
        self.object = object


class InvalidArgument(Error, ValueError):
    """A value outside what is accepted."""


class NotFound(Error, LookupError):
    """No such frame, object, file, ..."""


class AlreadyExists(Error, ValueError):
    """A name or id that is taken."""


class Unsupported(Error, NotImplementedError):
    """A format, command or feature that is not known."""


class Corrupt(Error, ValueError):
    """A file that is damaged or not of its type."""


class Io(Error, OSError):
    """The operating system refused a file."""


class Resource(Error, RuntimeError):
    """Memory, size or graphics limits."""


class DeadlineExceeded(Error, TimeoutError):
    """A wait ran out."""


class Internal(Error, RuntimeError):
    """A defect of Dspace."""


class DspaceWarning(UserWarning):
    """What a command left out or took for granted."""


# By the number of Error.Kind in common.proto.
KINDS = {1: InvalidArgument, 2: NotFound, 3: AlreadyExists, 4: Unsupported, 5: Corrupt, 6: Io,
         7: Resource, 8: DeadlineExceeded, 9: Internal}
