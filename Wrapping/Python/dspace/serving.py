"""A server process of one's own."""
import os
import signal
import subprocess
import sys
import tempfile

from dspace.errors import Io


class ServerProcess:
    """A `dspace serve` process on a Unix socket in a folder of its own, in a `with` statement.

        with ServerProcess(["data"]) as server, dspace.connect(server.address) as session: ...

    roots: folders whose files commands may name. record: a new file that the session is recorded into; pack: with
    the files that its commands need. Leaving the block ends it.
    """

    def __init__(self, roots, record=None, pack=False):
        self._record = [] if record is None else ["--record", os.path.abspath(record)] + ["--pack"] * bool(pack)
        self._roots = [os.fspath(root) for root in roots]
        self._folder = self._process = self.address = None

    @property
    def pid(self):
        return self._process.pid

    def __enter__(self):
        self._folder = tempfile.TemporaryDirectory(prefix="dspace-serve-")
        command = [sys.executable, "-m", "dspace", "serve", "--listen", f"unix:{self._folder.name}/socket"]
        for root in self._roots:
            command += ["--allow-root", root]
        command += self._record
        self._process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        line = self._process.stdout.readline()
        if not line.startswith("dspace serve: listening on "):
            self.__exit__()
            raise Io("the server process did not start; see what it said on the error stream", "server")
        self.address = line.split()[-1]
        return self

    def __exit__(self, *exception):
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGTERM)
            try:
                self._process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        self._process.stdout.close()
        self._folder.cleanup()
