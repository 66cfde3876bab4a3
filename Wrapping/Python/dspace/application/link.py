"""Servers in the windows: views of a simulation in another process."""
import os
import signal
import subprocess
import sys

from dspace import vtk as _vtk
from dspace._core.fields import items, path as path_of, reject, text
from dspace._core.replies import make_error, to_reply
from dspace._core.wire import encode
from dspace.application.run import require
from dspace.errors import Io
from dspace.links.connection import prepare
from dspace.links.serving import LISTENING
from dspace.links.watching import OWN, WatchClient, Watcher

LOOK = 0.1  # [s] between looks at a link
PATIENCE = 20  # looks at a scene without a viewport, before it gets a view
FOREVER = 1e6  # [s]: the user cancels


class LinkClient(WatchClient):
    """Of a watcher whose messages the windows apply."""

    def shown(self):
        return self.watcher()

    def send_event(self, event):
        """Does not wait: later looks send what the connection has not taken."""
        require(self.watcher().QueueEvent(encode(event, "event")))


class Link(Watcher):
    """A dspace.Watcher that the windows keep up to date; App.connect() and App.listen() return it.

    state: "starting" (App.listen() only), "connecting", "connected", "lost" (it connects again by itself), "failed" or
    "closed". failure: why, where it failed. address: of the server; None while it starts. It shows a view for each
    viewport of the simulation, which looks through the simulation's camera until it is moved. update() is needed for
    callbacks of frames only."""

    def __init__(self, app, address, settings, server=None):
        self._app, self._settings, self._server = app, settings, server
        self.address, self.state, self.failure = address, "starting", ""
        self._copied, self._looks, self._simulation = set(), 0, None
        self._watcher = _vtk.vtkDspaceWatcher()
        prepare(self._watcher, address or "", *settings, FOREVER, self._label())
        self._watcher.SetInBackground(True)
        self._watcher.ShareRenderContext(app.session.vtk)
        super().__init__(LinkClient(self._watcher))
        self._task = app._add_task(self.close)
        if server is None:
            self._connect(address)
        self._timer = app._host.every(round(1000 * LOOK), self._look)
        self._tell()

    def _label(self):
        return f"server {self.address!r}"

    def _connect(self, address):
        self.address, self.state = address, "connecting"
        require(self._watcher.BeginConnect(address, "DspaceQt"))

    # --- Looks ---------------------------------------------------------------------------------

    def _look(self):
        try:
            self._advance()
        except Exception as error:
            self.failure = str(error)
            self.close()
            self.state = "failed"
            self._app._host.message(self.failure)
            raise

    def _advance(self):
        if self.state == "starting":
            address = self._server.poll()
            if address:
                self._connect(address)
        elif self.state == "connecting":
            state = self._watcher.WaitForConnect(0.0)
            if state < 0:
                raise make_error(to_reply(self._watcher.TakeReply()).error)
            if state:
                self.state = "connected"
                self._app._host.follow(self._watcher, self._title())
        else:
            self.state = "connected" if self._watcher.GetConnected() else "lost"
            self._show_views()
        self._tell()

    def _title(self):
        return f"{'Simulation at' if self._server is not None else 'Server'} {self.address}"

    def _tell(self):
        words = {"starting": "Starting to listen", "connecting": f"Connecting to {self.address}",
                 "lost": f"{self.address} is lost; connecting again"}.get(self.state, "")
        if not words:
            simulation = self.simulation
            if self._server is not None:
                words = f"Listening on {self.address}: " + (f"{simulation}" if simulation else "no simulation")
            elif simulation is None and self.sequence > 0:
                words = f"{self.address}: the simulation has gone"
        stops = "Stop" if self._server is not None else "Cancel" if self.state == "connecting" else "Disconnect"
        self._app._host.task(self._task, words, -1.0, stops)

    def _show_views(self):
        """Shows what the simulation has made since the last look."""
        viewports = self.viewports
        for name, viewport in viewports.items():
            if name.startswith(OWN) or name in self._copied:
                continue
            own, number = OWN + name, 1
            while own in self._app.views:
                number += 1
                own = f"{OWN}{name} {number}"
            require(self._watcher.CopyViewport(name, own))
            self._copied.add(name)
            self._app.show(self.viewports[own], f"{self._title()}: {name}")
        scenes = self.scenes
        if self._copied or not scenes:
            return
        self._looks += 1
        name, scene = next(iter(scenes.items()))
        if self._looks > PATIENCE and len(scene.objects):
            own = f"{name} {self.address}"
            self._copied.add("")
            view = self.add_view(own, scene, (640, 400), eye=(6, -8, 5), target=(0, 0, 0))
            view.fit()
            self._app.show(view, f"{self._title()}: {name}")

    def close(self):
        """Closes its views, disconnects, and ends the server that App.listen() started. A second call does nothing."""
        if self.state in ("closed", "failed"):
            return
        self.state = "closed"
        self._app._host.cancel(self._timer) if hasattr(self, "_timer") else None
        self._app._host.task(self._task, "", -1.0, "")
        self._app._closed_link(self)
        self._app._host.forget(self._watcher)
        super().close()
        if self._server is not None:
            self._server.end()

    def __repr__(self):
        return f"<dspace.application.Link to {self.address}, {self.state}>"


class ServerApart:
    """A `dspace serve` process, started and ended without waiting."""

    def __init__(self, address, settings, roots=None):
        certificate, key, authority, insecure = settings
        # -P: no module is imported from the working folder, whose files may be a client's.
        command = [sys.executable, "-P", "-m", "dspace", "serve", "--end-with-input", "--name", "DspaceQt",
                   "--listen", address]
        for word, value in (("--cert", certificate), ("--key", key), ("--ca", authority)):
            command += [] if value is None else [word, os.fspath(value)]
        command += ["--insecure"] if insecure else []
        for root in () if roots is None else items(roots, "the roots", "server", "a list of folders"):
            command += ["--allow-root", path_of(root, "a root", "server")]
        self._data = b""
        # Its own process session: Ctrl-C at the terminal reaches only this process, which then ends the server.
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))})
        for pipe in (self._process.stdout, self._process.stderr):
            os.set_blocking(pipe.fileno(), False)

    def poll(self):
        """Returns the address where it listens, or None while it starts. Raises dspace.Io where it has ended."""
        self._data += self._process.stdout.read() or b""
        line, end, _ = self._data.partition(b"\n")
        line = os.fsdecode(line)
        if end and line.startswith(LISTENING):
            return line[len(LISTENING):]
        if self._process.poll() is not None:
            words = os.fsdecode(self._process.stderr.read() or b"").strip().splitlines()
            raise Io(f"server: {words[-1] if words else 'its process did not start'}", "server")
        return None

    def end(self):
        self._process.stdin.close()
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGTERM)

    def wait(self):
        """At the end of the program."""
        self.end()
        try:
            self._process.wait(timeout=5)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


def required_address(address, what):
    address = text(address, "the address", what)
    if not address.strip():
        reject(what, "the address", address, "HOST:PORT or unix:PATH")
    return address.strip()
