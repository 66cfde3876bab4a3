"""What is raised when a command is refused; nothing of it was done.

`except dspace.Error` catches all of them, but not what Python itself refuses: a keyword or argument that a function's
fixed parameters do not take (TypeError), an attribute that cannot be set (AttributeError). Each is also the built-in
exception that Python would raise for such a thing: a value that is refused is a ValueError, one of a wrong type a
TypeError as well, a name that there is not a KeyError, what the operating system refuses an OSError. dspace.rover,
which works without the compiled part, raises these themselves.
"""


def _cut(text):
    # Whoever passes a book for a name need not read it twice; what is accepted stands at the end.
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
    """A format, command or feature that is not known."""


class Unimplemented(Unsupported):
    """A command that is typed, and that this version does not carry out yet."""


class Corrupt(Error, ValueError):
    """A file that is damaged or not of its type."""


class Io(Error, OSError):
    """The operating system refused a file."""


class Resource(Error, RuntimeError):
    """Memory, size or graphics limits."""


class DeadlineExceeded(Error, TimeoutError):
    """A wait ran out."""


class Closed(Error, RuntimeError):
    """The session is closed."""


class WrongThread(Error, RuntimeError):
    """A session serves the thread that made it, as its graphics context does."""


class Internal(Error, RuntimeError):
    """A defect of Dspace."""


class DspaceWarning(UserWarning):
    """What a command left out or took for granted."""


# By the number of Error.Kind in common.proto.
KINDS = {1: InvalidArgument, 2: NotFound, 3: AlreadyExists, 4: Unsupported, 5: Corrupt, 6: Io,
         7: Resource, 8: DeadlineExceeded, 9: Internal, 10: Unimplemented}
