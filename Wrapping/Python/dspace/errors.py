"""The exceptions of Dspace. A command that raises one has changed nothing.

`except dspace.Error` catches all of them. It does not catch errors that Python itself raises: for an argument that a
function does not have (TypeError), or an attribute that cannot be set (AttributeError). Each error is also the built-in
exception for its case: an invalid value is a ValueError, a wrong type also a TypeError, an unknown name a KeyError, and
a failure of the operating system an OSError.
"""


def _cut(text):
    # A very long name is shortened, because the end of the message states what is accepted.
    return text if len(text) <= 2000 else f"{text[:1200]} ... {text[-600:]}"


class Error(Exception):
    """Base of all of them. `object` names what it is about."""

    def __init__(self, message, object=""):
        super().__init__(_cut(message))
        self.object = _cut(object)

    def __str__(self):
        return Exception.__str__(self)  # a KeyError would quote it


class InvalidArgument(Error, ValueError):
    """A value outside what is accepted."""


class WrongType(InvalidArgument, TypeError):
    """A value of a type that is not accepted, or an unknown keyword where a function takes `**settings`."""


class NotFound(Error, KeyError):
    """No such frame, object, file, ..."""


class AlreadyExists(Error, ValueError):
    """A name or id that is taken."""


class Unsupported(Error, NotImplementedError):
    """A format, command or feature that Dspace does not support."""


class Unimplemented(Unsupported):
    """A command of the protocol that this version does not implement."""


class Corrupt(Error, ValueError):
    """A file that is damaged or not of its type."""


class Io(Error, OSError):
    """The operating system could not read or write a file."""


class Resource(Error, RuntimeError):
    """A limit of memory, size or graphics was exceeded."""


class DeadlineExceeded(Error, TimeoutError):
    """A timeout expired."""


class Closed(Error, RuntimeError):
    """The session is closed."""


class WrongThread(Error, RuntimeError):
    """The session was made in another thread, which its graphics context belongs to."""


class Internal(Error, RuntimeError):
    """A defect of Dspace."""


class DspaceWarning(UserWarning):
    """A command succeeded, but left something out or had to assume something."""


# By the number of Error.Kind in common.proto.
KINDS = {1: InvalidArgument, 2: NotFound, 3: AlreadyExists, 4: Unsupported, 5: Corrupt, 6: Io,
         7: Resource, 8: DeadlineExceeded, 9: Internal, 10: Unimplemented}
