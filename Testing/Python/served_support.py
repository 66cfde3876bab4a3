"""Server processes for tests."""
import atexit
import functools
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time


@functools.lru_cache(maxsize=None)
def socket_folder(folder):
    """Where the sockets of a test lie whose folder is `folder`: a socket's path ends after 107 bytes, and that of the
    test's own folder may be longer. The same one whenever it is asked for."""
    made = tempfile.mkdtemp(prefix="dspace-test-", dir="/tmp")
    atexit.register(shutil.rmtree, made, ignore_errors=True)
    return pathlib.Path(made)


def stand_still(pid):
    """Stops a process. The signal is on its way when kill() returns: until it is there, threads of it go on."""
    os.kill(pid, signal.SIGSTOP)
    end = time.monotonic() + 60
    while not all(state in "TX" for state in states_of(pid)):  # X: a thread that has ended
        assert time.monotonic() < end, f"process {pid} does not stand still"
        time.sleep(0.001)


def states_of(pid):
    """Of a process's threads, as /proc names them."""
    for thread in os.listdir(f"/proc/{pid}/task"):
        try:
            with open(f"/proc/{pid}/task/{thread}/stat") as file:
                yield file.read().rpartition(")")[2].split()[0]
        except (FileNotFoundError, ProcessLookupError):
            yield "X"


class Served:
    """A `dspace serve` process on a Unix socket, or where `listen` says; ended with the block. For the same folder,
    the socket is the same."""

    def __init__(self, folder, *arguments, listen=None):
        self.listen = listen or f"unix:{socket_folder(folder)}/socket"
        self.arguments = arguments
        self.process = None
        self.folder = folder

    def __enter__(self):
        # Its error stream goes to a file: a pipe that nobody reads would stop it.
        self.errors = open(os.path.join(self.folder, "serve.log"), "ab")
        self.process = subprocess.Popen(
            [sys.executable, "-W", "ignore", "-m", "dspace", "serve", "--listen", self.listen,
             *self.arguments], stdout=subprocess.PIPE, stderr=self.errors, text=True)
        line = self.process.stdout.readline()
        assert line.startswith("dspace serve: listening on "), self.log()
        self.address = line.split()[-1]
        return self

    def __exit__(self, *exception):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        try:
            self.code = self.process.wait(timeout=60)
        finally:
            if self.process.poll() is None:
                self.process.kill()
                self.process.wait()
            self.process.stdout.close()
            self.errors.close()

    def kill(self):
        self.process.kill()
        self.process.wait()

    def log(self):
        return open(os.path.join(self.folder, "serve.log")).read()
