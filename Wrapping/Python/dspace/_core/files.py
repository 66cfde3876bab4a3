"""The only writer of files in Python: it replaces a file completely or not at all. The rules are those of
dspace::AtomicFile in C++ (Libraries/Core/dspace/AtomicFile.h)."""
import contextlib
import errno
import os
import secrets
import stat

from dspace.errors import AlreadyExists, InvalidArgument, Io

ACCEPTED = "a file in a folder that may be written and has free space"
_NAME_BYTES = 64  # length of the target's name within the name of its temporary file, so that long names fit
_NO_LINKS = (errno.EPERM, errno.ENOSYS, errno.EOPNOTSUPP, errno.EMLINK)


class AtomicFile:
    """A temporary file in the target's folder, which commit() flushes to the disk and renames to the target. Until
    then, and after any failure, an existing target is untouched. In a `with` statement it is committed at the end of
    the block, and removed when the block raises.

    path: the target. A symbolic link is followed, and must lead to a file that exists. about: names the file in errors
    (default: "file 'PATH'"). new: the target must not exist, also not at the time of commit(). accepted: for errors.
    A new file has the mode of an ordinary creation, a replaced one keeps its mode.

    Raises Io with the file and the system's reason, AlreadyExists for a target that is there while `new`, and
    InvalidArgument for a path with a zero byte."""

    def __init__(self, path, about=None, new=False, accepted=ACCEPTED):
        self.path = os.fsdecode(path)
        self.about = f"file {self.path!r}" if about is None else about
        self._new, self._accepted, self._file = new, accepted, None
        if "\0" in self.path:
            raise InvalidArgument(f"{self.about}: its path holds a zero byte", self.path)
        with self._errors():
            self._target, before = self._find()
            folder, name = os.path.split(self._target)
            if before is None and not os.path.isdir(folder):
                raise self._failed(f"there is no folder {folder!r}; accepted: {self._accepted}")
            name = os.fsencode(name)[:_NAME_BYTES].decode(errors="ignore")
            flags = os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC
            while self._file is None:
                self.temporary = os.path.join(folder, f".{name}.{secrets.token_hex(8)}.part")
                with contextlib.suppress(FileExistsError):
                    self._file = os.open(self.temporary, flags, 0o666 if before is None else 0o600)
        try:
            with self._errors():
                self._mode = stat.S_IMODE(os.fstat(self._file).st_mode if before is None else before) & 0o777
                if before is not None:
                    os.fchmod(self._file, self._mode)
        except BaseException:
            self.close()
            raise

    def _find(self):
        """The target without links, absolute, and its mode where it exists."""
        if not self.path or os.path.basename(self.path) in ("", ".", ".."):
            why = "it names a folder" if self.path else "its path is empty"
            raise self._failed(f"{why}; accepted: {self._accepted}")
        target = os.path.join(os.getcwd(), self.path)
        try:
            status = os.lstat(target)
        except FileNotFoundError:
            return target, None
        if self._new:
            raise self._exists()
        if stat.S_ISLNK(status.st_mode):
            target = os.path.realpath(target)
            try:
                status = os.stat(target)
            except OSError as error:
                raise self._failed(f"{error.strerror}; it is a symbolic link; accepted: a link to a file that exists") \
                    from None
        if stat.S_ISDIR(status.st_mode):
            raise self._failed(f"it is a folder; accepted: {self._accepted}")
        if not stat.S_ISREG(status.st_mode):
            raise self._failed("it is a device, a pipe or a socket; accepted: a regular file")
        if not os.access(target, os.W_OK, effective_ids=True):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
        return target, status.st_mode

    def _failed(self, why):
        return Io(f"{self.about}: it cannot be written: {why}", self.path)

    def _exists(self):
        return AlreadyExists(f"{self.about}: there is such a file; accepted: a new file", self.path)

    @contextlib.contextmanager
    def _errors(self):
        try:
            yield
        except Io:
            raise
        except OSError as error:
            raise self._failed(f"{error.strerror}; accepted: {self._accepted}") from None

    def write(self, data):
        """Appends bytes."""
        view = memoryview(data).cast("B")
        with self._errors():
            while view:
                view = view[os.write(self._file, view):]

    def commit(self):
        """Once, at the end; what else writes to the path `temporary` must have closed it."""
        try:
            with self._errors():
                own, named = os.fstat(self._file), os.lstat(self.temporary)
                if (own.st_dev, own.st_ino) != (named.st_dev, named.st_ino):  # another program has replaced it
                    os.close(self._file)
                    self._file = None
                    self._file = os.open(self.temporary, os.O_RDONLY | os.O_NOFOLLOW | os.O_CLOEXEC)
                    os.fchmod(self._file, self._mode)
                os.fsync(self._file)
                file, self._file = self._file, None
                os.close(file)
                if self._new:
                    self._link()
                else:
                    os.rename(self.temporary, self._target)
        finally:
            self.close()

    def _link(self):
        try:
            os.link(self.temporary, self._target, follow_symlinks=False)
        except FileExistsError:
            raise self._exists() from None
        except OSError as error:
            if error.errno not in _NO_LINKS:
                raise
            if os.path.lexists(self._target):
                raise self._exists() from None
            os.rename(self.temporary, self._target)

    def close(self):
        """Removes the temporary file, unless it was committed."""
        if self._file is not None:
            os.close(self._file)
            self._file = None
        with contextlib.suppress(OSError):
            os.unlink(self.temporary)

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        if kind is None:
            self.commit()
        else:
            self.close()


def atomic_write(path, data, about=None, new=False, accepted=ACCEPTED):
    """Writes bytes to a file atomically; see AtomicFile."""
    with AtomicFile(path, about, new, accepted) as file:
        file.write(data)
