"""Starts a server process."""
import os
import select
import signal
import subprocess
import sys
import tempfile
import time

from dspace._core.fields import flag, items, number, path, reject
from dspace.errors import DeadlineExceeded, Io

LISTENING = "dspace serve: listening on "


def _above():
    """Returns the folder for temporary files, or /tmp if a socket's path below that folder would be too long."""
    above = tempfile.gettempdir()
    return above if len(os.fsencode(f"{above}/dspace-serve-12345678/socket")) < 108 else "/tmp"


class ServerProcess:
    """A `dspace serve` process on a Unix socket in a temporary folder, for a `with` statement. The folder is below
    TMPDIR, or below /tmp if the path would be too long for a socket.

        with ServerProcess(["data"]) as server, dspace.connect(server.address) as session: ...

    roots: folders whose files commands may name. record: a new file for a recording of the session; pack: the
    recording includes the files that its commands need. timeout: seconds, above 0, for the start. The server ends
    with the block, and when this process ends for any reason.
    """

    def __init__(self, roots, record=None, pack=False, timeout=60.0):
        self._timeout = number(timeout, "the timeout", "server")
        if not self._timeout > 0:
            reject("server", "the timeout", timeout, "seconds above 0")
        pack = flag(pack, "pack", "server")
        self._record = [] if record is None else [
            "--record", os.path.abspath(path(record, "the recording", "server"))] + ["--pack"] * pack
        self._roots = [path(root, "a root", "server") for root in items(roots, "the roots", "server", "a list of folders")]
        self._folder = self._process = self.address = None

    @property
    def pid(self):
        return self._process.pid

    def __enter__(self):
        self._folder = tempfile.TemporaryDirectory(prefix="dspace-serve-", dir=_above())
        # -P: no module is imported from the working folder, whose files may be a client's.
        command = [sys.executable, "-P", "-m", "dspace", "serve", "--end-with-input",
                   "--listen", f"unix:{self._folder.name}/socket"]
        for root in self._roots:
            command += ["--allow-root", root]
        command += self._record
        # A new process session: Ctrl-C at the terminal reaches only this process, which then stops the server.
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True)
        try:
            line = self._first_line()
        except BaseException:
            self._process.kill()  # it may not react to SIGTERM
            self.__exit__()
            raise
        if not line.startswith(LISTENING):
            self.__exit__()
            raise Io("the server process did not start; see its messages on the error stream", "server")
        self.address = line[len(LISTENING):].rstrip("\n")
        return self

    def _first_line(self):
        pipe = self._process.stdout.fileno()
        data, end = b"", time.monotonic() + self._timeout
        while not data.endswith(b"\n"):
            if not select.select([pipe], [], [], max(0.0, end - time.monotonic()))[0]:
                raise DeadlineExceeded(f"the server process did not start within {self._timeout:g} s", "server")
            piece = os.read(pipe, 4096)
            if not piece:
                break
            data += piece
        return os.fsdecode(data)

    def __exit__(self, *exception):
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGTERM)
            try:  # the server first writes its recording, which may take any time
                self._process.wait(timeout=None if self._record else 90)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
            except BaseException:  # an interrupt ends the wait; the recording stays intact
                self._process.kill()
                self._process.wait()
                raise
        self._process.stdin.close()
        self._process.stdout.close()
        self._folder.cleanup()
