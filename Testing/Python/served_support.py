"""Server processes for tests."""
import os
import signal
import subprocess
import sys


class Served:
    """A `dspace serve` process on a Unix socket, or where `listen` says; ended with the block."""

    def __init__(self, folder, *arguments, listen=None):
        self.listen = listen or f"unix:{folder}/socket"
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
