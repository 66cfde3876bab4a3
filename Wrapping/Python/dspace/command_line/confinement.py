"""Confines a command by the operating system: the program `dspace-confine` takes the place of this process, gives up the
rights that the command does not need, and executes the same command line again.

The rules must be there before the threads of gRPC, Mesa and GDAL begin; so this module imports nothing compiled.
"""
import contextlib
import glob
import os
import re
import subprocess
import sys
import tempfile

from dspace.command_line import Failed
from dspace.errors import Error

# "landlock N" or "no landlock" where `dspace-confine` executed this process; else None. No child takes it for its own.
STATE = os.environ.pop("DSPACE_CONFINED", None)
SAFEST_FORMATS = "; of rasters and shapes only formats whose files name no others are read"
_TO_LIST = 60.0  # [s] for the names of a recording's files

# Programs, libraries and their data.
_PROGRAMS = ("/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64")
# What libraries read beside them: names and addresses, time zones, certificates, fonts, drivers of graphics.
_SYSTEM = ("/etc/ld.so.cache", "/etc/localtime", "/etc/timezone", "/etc/nsswitch.conf", "/etc/hosts", "/etc/host.conf",
           "/etc/resolv.conf", "/etc/gai.conf", "/etc/services", "/etc/protocols", "/etc/passwd", "/etc/group",
           "/etc/ssl", "/etc/fonts", "/etc/glvnd", "/etc/egl", "/etc/drirc", "/etc/nvidia", "/var/cache/fontconfig",
           "/run/systemd/resolve", "/proc", "/sys")
_DEVICES = ("/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom", "/dev/dri", "/dev/kfd", "/dev/nvidia*")
# Environment variables with folders or files that libraries read.
_PLACES = ("PROJ_DATA", "PROJ_LIB", "GDAL_DATA", "LD_LIBRARY_PATH", "LD_PRELOAD", "LIBGL_DRIVERS_PATH",
           "__EGL_VENDOR_LIBRARY_DIRS", "__EGL_VENDOR_LIBRARY_FILENAMES", "SSL_CERT_FILE", "SSL_CERT_DIR",
           "FONTCONFIG_FILE", "FONTCONFIG_PATH")


class Rules:
    """What a command may do. Paths that do not exist are left out, so that the command itself says so."""

    def __init__(self, listen=None, connect=False):
        """listen: "listen" (TCP and Unix sockets) or "listen-unix"."""
        abi = os.environ.get("DSPACE_LANDLOCK_ABI")  # for tests: as an older kernel
        self.words = (["--" + listen] if listen else []) + ["--connect"] * connect + (["--abi", abi] if abi else [])
        for place in _PROGRAMS:
            self.add("program", place)
        for place in _SYSTEM:
            self.add("read", place)
        for pattern in _DEVICES:
            for place in glob.glob(pattern):
                self.add("device", place)
        for name in _PLACES:
            for place in os.environ.get(name, "").split(os.pathsep):
                self.add("program", place)
        self.add("read", os.environ.get("PROJ_USER_WRITABLE_DIRECTORY") or os.path.join(
            os.environ.get("XDG_DATA_HOME") or os.path.expanduser("~/.local/share"), "proj"))
        for place in _package_places():
            self.add("program", place)

    def add(self, kind, path):
        if path and os.path.exists(path):
            self.words += ["--" + kind, os.path.realpath(path)]

    def add_recording(self, path):
        """A recording, with the files of SQLite beside it where it was not closed. Nothing can be made beside it: SQLite
        finds the index of the log there, and fills it."""
        log, index = path + "-wal", path + "-shm"
        if os.path.exists(log) and os.path.getsize(log) > 0:
            try:
                open(index, "ab").close()
            except OSError:
                pass  # where nobody may write, the reader says so
        self.add("read", path)
        self.add("read", log)
        self.add("write", index)

    def add_played(self, path):
        """A recording that is played: also the files that it names."""
        if os.path.isfile(path):
            self.add_recording(os.path.abspath(path))
            for file in recorded_files(os.path.abspath(path)):
                self.add("read", file)
        self.add_cache()

    def add_cache(self):
        """The folder of overviews (ElevationCache::DefaultFolder)."""
        above = os.environ.get("XDG_CACHE_HOME", "")
        folder = os.path.join(above if above.startswith("/") else os.path.expanduser("~/.cache"), "dspace", "terrain")
        try:
            os.makedirs(folder, exist_ok=True)
        except OSError:
            return  # then no overviews are kept
        self.add("write", folder)


def _package_places():
    """Where Python and this package lie. In a build tree the package's files are links."""
    package = os.path.realpath(_package())
    yield os.path.normpath(os.path.join(package, "..", "..", ".."))  # with the libraries
    yield package
    for depth in ("*", os.path.join("*", "*")):
        yield from filter(os.path.islink, glob.glob(os.path.join(glob.escape(package), depth)))
    yield from (sys.prefix, sys.base_prefix)
    yield sys.argv[0]  # the script of an installation
    yield from (place for place in sys.path if os.path.basename(place) in ("dist-packages", "site-packages"))


def _package():
    return os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def program():
    """The path of `dspace-confine`. Raises Failed."""
    places = [os.path.normpath(os.path.join(os.path.realpath(_package()), *[".."] * up, "bin", "dspace-confine"))
              for up in (4, 5)]  # the libraries' folder may have two names, such as lib/x86_64-linux-gnu
    path = next(filter(os.path.exists, places), places[0])
    if not os.access(path, os.X_OK):
        raise Failed(f"{path!r}, which confines this command, is missing; accepted: a complete installation, or "
                     "--no-confinement")
    return path


def add_argument(parser, what):
    parser.add_argument("--no-confinement", action="store_true",
                        help=f"let {what} do what you may do: by default the operating system restricts it to the files "
                        "that it needs (see SECURITY.md)")


def confine(options, rules, otherwise=""):
    """Restricts this process: executes the command line again with the rules that rules() returns, where it runs without.
    Returns False where the system should restrict files and cannot; `otherwise` says what the command does then. A command
    that a program calls (`main` with arguments) is left as it is."""
    if not options.is_process:
        return True
    if options.no_confinement:
        note("--no-confinement: a file that misuses an error of a library may do what you may do")
        return True
    if STATE is None:
        _become(rules())
    if STATE == "no landlock":
        note("this system has no Landlock (Linux 5.13 or later) and does not restrict files" + otherwise)
    return STATE != "no landlock"


@contextlib.contextmanager
def explaining(options):
    """In a `with` statement: an error that names a file on a server is followed by the option that allows connections."""
    try:
        yield
    except Error as error:
        if STATE is not None and not options.allow_network and re.search(r"https?://|/vsi", str(error)):
            note("connections are not allowed; accepted: --allow-network")
        raise


def note(text):
    print(f"dspace: note: {text}", file=sys.stderr, flush=True)


def _become(rules):
    launcher = program()
    rules.add("temporary", tempfile.gettempdir())
    environment = {**os.environ, "MESA_SHADER_CACHE_DISABLE": "true", "__GL_SHADER_DISK_CACHE": "0"}
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "XAUTHORITY", "DBUS_SESSION_BUS_ADDRESS"):
        environment.pop(name, None)  # no desktop can be reached
    sys.stdout.flush()
    sys.stderr.flush()
    try:
        os.execve(launcher, [launcher, "--rules", str(rules_file(rules)), "--", sys.executable, *sys.orig_argv[1:]],
                  environment)
    except OSError as error:
        raise Failed(f"{launcher!r}: {error.strerror}") from None


def rules_file(rules):
    """The descriptor of a file with the rules: they may be longer than a command line."""
    file = os.memfd_create("rules", 0)
    os.write(file, b"".join(os.fsencode(word) + b"\0" for word in rules.words))
    os.lseek(file, 0, os.SEEK_SET)
    return file


# Tables only: a view could run without end. A path is of a file that was read and is not in the recording.
_LISTING = r"""
import os, sqlite3, sys, urllib.parse
path = sys.argv[1]
mode = "mode=ro" if os.path.exists(path + "-wal") and os.path.getsize(path + "-wal") else "immutable=1"
base = sqlite3.connect("file:" + urllib.parse.quote(path) + "?" + mode, uri=True)
base.execute("PRAGMA trusted_schema = OFF")
if base.execute("SELECT type FROM sqlite_schema WHERE name = 'asset'").fetchall() == [("table",)]:
    for name, in base.execute("SELECT path FROM asset WHERE state = 'read' AND packed = 0"):
        if isinstance(name, str) and name.startswith("/") and "\0" not in name:
            sys.stdout.buffer.write(os.fsencode(name) + b"\0")
"""


def recorded_files(path):
    """Paths of the files that a recording's commands read on this machine: a process that may read nothing but the
    recording lists them. Empty where it cannot: playback then says what is wrong."""
    rules = Rules()
    rules.add_recording(path)
    command = [program(), "--rules", "", "--", sys.executable, "-I", "-c", _LISTING, path]
    with open(rules_file(rules), "rb") as file:
        command[2] = str(file.fileno())
        try:
            done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                  pass_fds=[file.fileno()], timeout=_TO_LIST)
        except subprocess.TimeoutExpired:
            return []
    return [os.fsdecode(name) for name in done.stdout.split(b"\0") if name]
