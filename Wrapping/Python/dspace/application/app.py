"""The object `app`: opens files, makes views, calls functions again and again."""
import json
import os
import pathlib

from dspace import errors
from dspace._core.fields import integer, real, reject, text, word
from dspace._core.replies import to_reply
from dspace.application import layouts, measuring, views
from dspace.application.export import begin
from dspace.application.files import around
from dspace.application.key_frames import KeyFrames
from dspace.application.layouts import Layouts
from dspace.application.link import Link, ServerApart, required_address
from dspace.application.overlays import Overlay
from dspace.application.plots import Plot, Shown
from dspace.application.plugins import PlugIns
from dspace.application.run import Run
from dspace.proto import commands_pb2 as pb
from dspace.scene.navigation import NAVIGATION

MODELS = (".glb", ".gltf", ".wrl", ".wrl.gz", ".wrz", ".vrml", ".iv", ".obj", ".stl", ".ply", ".urdf", ".json")
RASTERS = (".tif", ".tiff", ".img", ".lbl", ".cub", ".vrt", ".asc", ".dem", ".hgt", ".nc", ".jp2", ".xml")
SIZE = (640, 400)  # of a viewport until its widget has one


class App:
    """The program that the prompt belongs to.

    session, scene: where files are opened. views: the viewports of its windows, by name. runs:
    the recordings that were opened, as dspace.application.run.Run. plots: the plots that were made, by number. links: the
    servers, as dspace.application.link.Link. measured: what measure() returned last; None before."""

    def __init__(self, host):
        self._host = host
        self.session = around(host)
        self.scene = self.session.scene()
        self.views = {}
        self._latest = None
        self.runs = []
        self.links = []
        self._servers = []
        self._tasks = {}
        self.plots = {}
        self.exports = []
        self.map_links = []
        self.measured = None
        self._watched = {}  # by view: what is called after its pictures
        self.plugins = PlugIns(host)
        self.layouts = Layouts(host)
        self._view_defaults = {}
        self._own_cameras = {}  # that new_view() made, by view
        self._timers = set()
        self._follow = lambda: None  # the prompt's `view` is the current one from now on

    # --- Views ---------------------------------------------------------------------------------

    @property
    def view(self):
        """The view that had the focus last; of new ones the latest. None: no view is open."""
        name = json.loads(self._host.extend(json.dumps({"do": "views", "what": "current"}))).get("view")
        return self.views.get(name, self._latest)

    def show(self, viewport, title=None):
        """Shows a viewport in the window. Returns it."""
        client = viewport._client
        self._host.show(client.shown(), viewport.name, viewport.name if title is None else text(title, "the title"))
        self.views[viewport.name] = self._latest = viewport
        self._follow()
        return viewport

    def new_view(self, camera=None, title=None, name=None):
        """A new viewport of the scene with a camera of its own, or with the given one; shown. Where the present view is of a
        recording or a server and nothing is given, the new one is of the same scene and looks as that one does. name: by default
        the next free one of "view 1", "view 2", ..."""
        present = self.view
        if camera is None and name is None and present is not None and present._client is not self.session._client:
            return self.show(views.copy(self, present), title)
        number = 1 + len(self.views)
        while f"view {number}" in self.session.viewports or f"camera {number}" in self.scene.cameras:
            number += 1
        own = self._camera(f"camera {number}") if camera is None else None
        camera = own if camera is None else camera
        made = self.scene.add_viewport(SIZE, camera, name=f"view {number}" if name is None else name,
                                       samples=self._view_defaults.get("samples"))
        if "navigation" in self._view_defaults:
            made.navigation = self._view_defaults["navigation"]
        if own is not None:
            self._own_cameras[made.name] = own
        return self.show(made, title)

    def set_view_defaults(self, samples=2, navigation="orbit"):
        """What new_view() gives views from now on: samples a pixel along each side (1 to 8), and how input moves the
        camera (Viewport.navigation)."""
        if not 1 <= integer(samples, "samples", "new views") <= 8:
            reject("new views", "samples", samples, "1 to 8")
        word(navigation, NAVIGATION, "navigation", "new views")
        self._view_defaults = {"samples": samples, "navigation": navigation}

    def _camera(self, name):
        before = self.view.camera if self.view is not None and self.view._client is self.session._client else None
        if before is not None:
            place = before.pose
            camera = self.scene.add_camera(name)
            camera.pose = place
            return camera
        return self.scene.add_camera(name, eye=(6, -8, 5), target=(0, 0, 0))

    def act(self, action, frame="/", object=None):
        """Does what the menu of the scene tree does, in the scene in the docks: "chase" or "focus" (with its camera "main"),
        "show" or "hide" (all objects on a frame and below), "trail" or "axes" (adds them, or removes them).

        frame: its path. object: the name or id of an object on this frame; None: the frame. Raises dspace.NotFound for one that
        is not there."""
        number_or_name = object if object is None or isinstance(object, str) else integer(object, "the object", "act")
        self._host.extend(json.dumps({"do": "tree", "action": text(action, "the action", "act"),
                                      "frame": text(frame, "the frame", "act"), "object": number_or_name}))

    def close_view(self, viewport):
        """Closes the view and removes its viewport."""
        for link in [link for link in self.map_links if viewport in (link.map, link.view)]:
            link.close()
        self._host.close(viewport._client.shown(), viewport.name)
        self.views.pop(viewport.name, None)
        if self._latest == viewport:
            self._latest = next(reversed(self.views.values()), None)
        viewport.remove()
        own = self._own_cameras.pop(viewport.name, None)
        if own is not None and own.name in self.scene.cameras:
            try:
                own.remove()
            except errors.Error:  # another view looks through it
                pass

    def show_dialog(self, name):
        """Opens the dialog "preferences", "guide", "keys", "messages" or "about"; nothing waits for it."""
        layouts.show_dialog(self._host, name)

    def show_dock(self, name):
        """Shows a dock and brings it to the front: "scene", "terrain", "measure", "time", "telemetry", "messages", "console", "view
        NAME" of a viewport, "plot N". Raises dspace.NotFound for another name."""
        layouts.show_dock(self._host, name)

    def set_theme(self, name):
        """The colours of all windows, also at the next start: "system", "dark" or "light"."""
        layouts.set_theme(self._host, name)

    def split_view(self, view=None, side="right"):
        """A new view that looks as `view` (default: App.view) does, "right" of it or "below" it."""
        view = self._one(view)
        made = views.copy(self, view)
        self.show(made)
        self._arrange("split", made, beside=view.name, side=side)
        return made

    def maximize_view(self, view=None):
        """Gives a view the whole window; restore_views() brings the docks back."""
        self._arrange("maximize", self._one(view))

    def restore_views(self):
        """All docks are as they were before maximize_view()."""
        self._arrange("restore")

    def tile_views(self):
        """Puts the docks of all views into a grid."""
        self._arrange("tile")

    def copy_picture(self, view=None):
        """Copies a view's picture to the clipboard."""
        self._arrange("copy", self._one(view))

    def fit(self, view=None, things=None):
        """Fills a view with objects or frames (default: all that is visible), without turning its camera. A view of a
        recording or a server gets a camera of its own, and so in chase()."""
        views.fit(self._one(view), things)

    def chase(self, view=None, frame=None, distance=None):
        """Lets the camera of a view follow a frame from behind, at `distance` [m] (default: three and a half times the
        size of what is on it). Without a frame it stands still where it is."""
        views.chase(self._one(view), frame, distance)

    def open_map(self, view=None):
        """A new view from above, orthographic and north up, kept in step with `view`. Returns a
        dspace.application.views.MapLink, whose close() ends that."""
        view = self._one(view)
        made = views.copy(self, view)
        link = self.link_map(made, view)
        self.show(made, f"map of {view.name}")
        self._arrange("split", made, beside=view.name, side="right")
        return link

    def link_map(self, map_view, view):
        """Makes a view a map and keeps it in step with another one of its scene: it follows where the other one looks, and
        a pan of the map moves the other one. Returns a dspace.application.views.MapLink."""
        for link in [link for link in self.map_links if link.map == map_view]:
            link.close()
        link = views.MapLink(self, map_view, view)
        self.map_links.append(link)
        return link

    def _one(self, view):
        return views.required(self.view if view is None else view)

    def _arrange(self, what, view=None, **fields):
        self._host.extend(json.dumps({"do": "views", "what": what, "view": "" if view is None else view.name, **fields}))

    def _watch_pictures(self, view, function):
        """Calls function() after each new picture of a view."""
        self._watched.setdefault(view.name, []).append(function)
        self._arrange("watch", view, on=True)

    def _unwatch_pictures(self, view, function):
        functions = self._watched.get(view.name, [])
        if function in functions:
            functions.remove(function)
        if not functions:
            self._watched.pop(view.name, None)
            self._arrange("watch", view, on=False)

    def _drawn(self, name):
        """A view that is watched has a new picture."""
        for function in list(self._watched.get(name, ())):
            function()

    # --- Plug-ins ------------------------------------------------------------------------------

    def add_dock(self, title, area="right"):
        """A new dock for values and controls, as a dspace.application.plugins.Panel. area: "left", "right", "top",
        "bottom"."""
        return self.plugins.add_dock(title, area)

    def add_action(self, menu, text, function, key="", tip=""):
        """A new entry of a menu, which is made if there is none; it calls function(). key: such as "F6"."""
        self.plugins.add_action(menu, text, function, key, tip)

    def on_key(self, key, function):
        """Calls function() when the key is pressed anywhere in the window: "F7", "Ctrl+Shift+D"."""
        self.plugins.on_key(key, function)

    def add_overlay(self, view=None):
        """Texts, lines and circles over the pictures of a view (default: of all views), as a
        dspace.application.overlays.Overlay. Captures and movies do not have them."""
        return Overlay(self.plugins._ask, None if view is None else views.required(view))

    def add_read_out(self, name, text="", tip=""):
        """A value in the status bar, "name text", as a dspace.application.plugins.ReadOut."""
        return self.plugins.add_read_out(name, text, tip)

    def load_plugin(self, name):
        """Loads a Python file or module and calls its plugin(app). Returns the module."""
        return self.plugins.load(name, self)

    # --- Telemetry -----------------------------------------------------------------------------

    def plot(self, *channels, of=None, title=None):
        """A new plot of channels of telemetry against time, in a dock; without any, an empty one to drag channels into.

        of: a Run, whose whole recording is plotted, or a dspace.Scene, whose values are plotted from now on; by default
        the one in the docks. Returns a dspace.application.plots.Plot."""
        made = Plot(self._host, self._plotted(of), channels, title)
        self.plots[made.number] = made
        return made

    def _plotted(self, of):
        if of is not None:
            return of
        shown, scene = self._host.active()
        for run in self.runs:
            if run._player is shown:
                return run
        return Shown(shown, scene)

    # --- Measurements --------------------------------------------------------------------------

    def measure(self, kind, points, terrain=None):
        """Measures in the scene in the docks, and shows the results in the Measure dock and the points in the views: a "line"
        (Scene.measure_line), an "area" (Scene.measure_area), or the "angle" at the second of three points.

        points: (n, 3) in the scene's root [m]; terrain: the name of the terrain on whose ground is measured. Returns the
        dspace.MeasuredLine, MeasuredArea, or degrees; `measured` keeps it."""
        self.measured = measuring.measure(self, kind, points, terrain)
        return self.measured

    # --- The operator --------------------------------------------------------------------------

    def answer(self, question, text):
        """Answers an open question of the scene in the docks (scene.ask), and returns at once: the simulation of this
        window, or that of a server, hears it. Raises dspace.NotFound if the server has no simulation,
        dspace.Unsupported for a recording."""
        self._send(f"question {question!r}", lambda session, scene: session.answer(question, text))

    def send_goal(self, position, goal="goal"):
        """Sends a point of the scene in the docks (root, [m]) to its simulation as the position of a goal, and returns
        at once: on_event(callback, "dragged") hears it, as from session.dragged(). Nothing in the scene moves. Raises
        dspace.NotFound if the server has no simulation, dspace.Unsupported for a recording."""
        self._send("goal", lambda session, scene: session.dragged(goal, position, scene=scene))

    def _send(self, about, send):
        """Calls `send` with the session, or Link, and the name of the scene in the docks."""
        shown, scene = self._host.active()
        if any(run._player is shown for run in self.runs):
            raise errors.Unsupported("nobody hears what is sent to a recording; accepted: a live scene or a server",
                                     about)
        for link in self.links:
            if link._client.shown() is shown:
                send(link, scene)
                return
        send(self.session, scene)
        self.session.process_events()

    # --- Movies --------------------------------------------------------------------------------

    @property
    def movie(self):
        """The camera key frames of the recording in the docks, as dspace.application.key_frames.KeyFrames; those of any
        recording: Run.movie. Raises dspace.NotFound where no recording is there."""
        shown, _ = self._host.active()
        for run in self.runs:
            if run._player is shown:
                return run.movie
        raise errors.NotFound("the scene in the docks is no recording; accepted: one opened by app.open()", "movie")

    def export_movie(self, out, movie=None, size=None, rate=None, samples=None, jobs=1):
        """Makes a movie in a process of its own and returns at once, with a dspace.application.export.Export.

        out: .mp4 (H.264), .webm (VP9), or a folder of PNGs (a name without a dot). movie: that of a Run (default:
        App.movie). size, rate, samples: in place of the movie's. jobs: number of processes that draw, 1 to 64. A file
        that is there stays whole until the new one is complete; a cancelled or failed export goes on from its pictures
        (OUT.work) when it is asked for again."""
        made = begin(self, out, movie, size, rate, samples, jobs)
        self.exports = [each for each in self.exports if each.state == "working"] + [made]
        return made

    def _moved(self):
        """The timeline shows another time."""
        shown, _ = self._host.active()
        for run in self.runs:
            if run._player is shown:
                run.movie._moved()

    # --- Files ---------------------------------------------------------------------------------

    def open(self, path):
        """Opens a model, robot, raster of heights, recording, or runs a Python script in the prompt's name space.

        Returns what it made: an object, Robot, Terrain or Run (a dspace.Playback); None for a script."""
        path = os.path.abspath(os.fspath(path))
        name = os.path.basename(path).lower()
        if not os.path.exists(path):
            raise errors.NotFound("there is no such file", f"file {path!r}")
        if name.endswith(".py"):
            import __main__
            exec(compile(pathlib.Path(path).read_text(encoding="utf-8"), path, "exec"), __main__.__dict__)
            return None
        if name.endswith(".dspace"):
            return self._open_run(path)
        if name.endswith(MODELS) or os.path.isdir(path):
            made = self._load(path)
            self._look_at()
            return made
        if name.endswith(RASTERS):
            return self._open_terrain(path)
        raise errors.Unsupported(f"its name says no format; accepted: {' '.join(MODELS + RASTERS)} .dspace .py",
                                 f"file {path!r}")

    def _load(self, path):
        """As Scene.load; a robot whose name is taken is numbered by its file's name: "rover 2"."""
        number = 1
        while True:
            try:
                if number == 1:
                    return self.scene.load(path)
                return self.scene.load(path, name=f"{pathlib.Path(path).stem} {number}")
            except errors.AlreadyExists:
                if not path.lower().endswith(".urdf"):
                    raise
                number += 1

    def _look_at(self):
        if not self.views:
            self.new_view()
        try:
            self.view.fit()
        except errors.Error as error:  # nothing that has a size
            self._host.message(str(error))

    def _open_terrain(self, path):
        terrain = self.scene.add_terrain(path, mode="clipmap")
        west, east, south, north = terrain.extent
        x, y, reach = 0.5 * (west + east), 0.5 * (south + north), max(east - west, north - south)
        heights = terrain.height([x], [y])
        z = float(heights[0]) if heights[0] == heights[0] else 0.0
        if not self.views:
            self.new_view()
        self.view.set(shadows=True)
        self.scene.sun.set(azimuth_deg=300, elevation_deg=25)  # low, so that the ground shows its shape
        self.view.camera.look_at(eye=(x - 0.15 * reach, y - 0.5 * reach, z + 0.3 * reach), target=(x, y, z))
        return terrain

    def _open_run(self, path):
        run = Run(path, self)
        try:
            views = run.own_views(self.views)
            if not views and len(run.times) > 1:  # they may come later
                run._go(len(run.times) - 1)
                views = run.own_views(self.views)
                run._go(0)
            for name, viewport in views.items():
                self.show(viewport, f"{os.path.basename(path)}: {name}")
        except BaseException:
            run.close()
            raise
        self.runs.append(run)
        run.movie = KeyFrames(self, run)
        if not views:
            self._host.message(f"{path} has no viewport; add one: app.runs[-1].session.scenes[...].add_viewport()")
        return run

    def _closed(self, run):
        """Forgets a recording that is closed."""
        if run.movie is not None:
            run.movie.close()
        if run in self.runs:
            self.runs.remove(run)
        self._forget(run.session._client if run.session is not None else None)

    def _forget(self, gone):
        for link in [link for link in self.map_links if link.view._client is gone]:
            link.close()
        self.views = {name: view for name, view in self.views.items() if view._client is not gone}
        if self._latest is not None and self._latest._client is gone:
            self._latest = next(reversed(self.views.values()), None)

    def demo(self):
        """The scene of the first start: a rover drives over the shipped field."""
        from dspace.application.demo import Drive
        return Drive(self)

    # --- Servers -------------------------------------------------------------------------------

    def connect(self, address, certificate=None, key=None, authority=None, insecure=False):
        """Shows the scene of a server (`dspace serve`), drawn here. Returns a Link at once; it connects, and connects
        again after a loss, by itself. The arguments are those of dspace.connect."""
        address = required_address(address, "connect")
        link = Link(self, address, (certificate, key, authority, insecure))
        self.links.append(link)
        return link

    def listen(self, address="127.0.0.1:0", certificate=None, key=None, authority=None, insecure=False, roots=None):
        """Serves at an address: a simulation that connects there (dspace.connect) drives views of this window.

        port 0: any that is free; Link.address has it. roots: folders whose files the simulation may name (default:
        the working folder). The server is a process of its own, so that a fast simulation does not hold the windows."""
        address = required_address(address, "listen")
        settings = (certificate, key, authority, insecure)
        server = ServerApart(address, settings, roots)
        self._servers.append(server)
        link = Link(self, None, settings, server)
        self.links.append(link)
        return link

    def _closed_link(self, link):
        if link in self.links:
            self.links.remove(link)
        self._tasks.pop(link._task, None)
        self._forget(link._client)

    # --- Tasks ---------------------------------------------------------------------------------

    def _add_task(self, cancel):
        """Returns a number for the host's task(). cancel(): what its button does."""
        number = max(self._tasks, default=0) + 1
        self._tasks[number] = cancel
        return number

    def _cancelled(self, number):
        if number in self._tasks:
            self._tasks[number]()

    # --- Time ----------------------------------------------------------------------------------

    def every(self, seconds, function):
        """Calls function() every `seconds` (0.001 to 3600) while the window is open. Returns a number for cancel().

        A function that raises is not called again."""
        seconds = real(seconds, "seconds", "every")
        if not 0.001 <= seconds <= 3600.0:
            reject("every", "seconds", seconds, "0.001 to 3600")
        if not callable(function):
            reject("every", "the function", function, "one without arguments", errors.WrongType)
        number = self._host.every(round(1000 * seconds), function)
        self._timers.add(number)
        return number

    def cancel(self, number):
        """Ends what every() began; nothing happens if it has ended."""
        self._timers.discard(number)
        self._host.cancel(number)

    # --- For the program -----------------------------------------------------------------------

    def _told(self, name, event, reply):
        """A reply to an event of a view, which callbacks may want."""
        viewport = self.views.get(name)
        if viewport is None:
            return
        command = pb.Command()
        command.viewport_event.ParseFromString(event)
        client = viewport._client
        client.inputs.tell(viewport, command.viewport_event, client.finish(command, to_reply(reply)))

    def close(self):
        for number in list(self._timers):
            self.cancel(number)
        for each in (*self.exports, *self.runs, *self.links):
            each.close()
        for server in self._servers:
            server.wait()
        self.session.close()
