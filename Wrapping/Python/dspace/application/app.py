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


def _compiled(path):
    """The code of a script. Raises dspace.Corrupt for what is no text, and SyntaxError."""
    try:
        return compile(pathlib.Path(path).read_text(encoding="utf-8"), path, "exec")
    except ValueError as error:  # no UTF-8, or null bytes
        raise errors.Corrupt(f"script {path!r}: {error}", f"script {path!r}") from None


class App:
    """The program that the prompt belongs to: `app` in the Python dock, in scripts, and in plug-ins.

    session, scene: the dspace.Session of the window and its scene, where files are opened.
    views: the dspace.Viewports that are shown, by name.
    runs: the recordings that are open, as dspace.application.run.Run.
    links: the servers, as dspace.application.link.Link.
    plots: the plots that were made, by number, as dspace.application.plots.Plot.
    exports: movies that are being made, as dspace.application.export.Export.
    map_links: maps in step with views, as dspace.application.views.MapLink.
    measured: what measure() returned last; None before.
    layouts: the named layouts, as dspace.application.layouts.Layouts.
    plugins: the plug-ins; plugins.loaded has their modules by name.

    Its methods belong into the thread of the windows, as all of Python there. Those that read files let the windows live
    meanwhile."""

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
        """Shows a viewport in a dock of the window, and gives it the focus. One that is shown comes to the front.

        viewport: a dspace.Viewport of this session, of a Run or of a Link. title: of the dock (default: the viewport's name).
        Returns the viewport, which `views` has by its name."""
        client = viewport._client
        self._host.show(client.shown(), viewport.name, viewport.name if title is None else text(title, "the title"))
        self.views[viewport.name] = self._latest = viewport
        self._follow()
        return viewport

    def new_view(self, camera=None, title=None, name=None):
        """Adds a viewport of the scene and shows it. Returns the dspace.Viewport.

        camera: a dspace.Camera; default: a new one that stands where that of the present view stands. title: of the dock
        (default: the name). name: of the viewport (default: the next free one of "view 1", "view 2", ...). Where the present view
        is of a recording or a server and nothing is given, the new one is of the same scene and looks as that one does.
        Raises dspace.AlreadyExists for a name that is taken."""
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
        """What new_view() gives views from now on.

        samples: a pixel along each side, 1 to 8. navigation: how input moves the camera, "orbit", "walk" or "map"
        (Viewport.navigation). Raises dspace.InvalidArgument."""
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
        """Does what the menu of the scene tree does, in the scene in the docks.

        action: "chase" or "focus" (with the scene's camera "main"), "show" or "hide" (all objects on the frame and below), "trail"
        or "axes" (adds them, or removes them where they are). frame: its path, such as "rover/mast"; "/": the root. object: the
        name or id of an object on this frame; None: the frame itself. Raises dspace.NotFound for a frame or object that is not
        there, dspace.InvalidArgument for another action."""
        number_or_name = object if object is None or isinstance(object, str) else integer(object, "the object", "act")
        self._host.extend(json.dumps({"do": "tree", "action": text(action, "the action", "act"),
                                      "frame": text(frame, "the frame", "act"), "object": number_or_name}))

    def close_view(self, viewport):
        """Closes a view and removes its viewport from the session, with the camera that new_view() made for it. Maps in step
        with it become views of their own. viewport: one of `views`."""
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
        """Opens a dialog, "preferences", "guide", "keys", "messages" or "about", and returns at once. Raises
        dspace.InvalidArgument for another name."""
        layouts.show_dialog(self._host, name)

    def show_dock(self, name):
        """Shows a dock and brings it to the front: "scene", "terrain", "measure", "time", "telemetry", "messages", "console", "view
        NAME" of a viewport, "plot N". Raises dspace.NotFound for another name."""
        layouts.show_dock(self._host, name)

    def set_theme(self, name):
        """Sets the colours of all windows, also at the next start: "system" (those of the desktop), "dark" or "light". Raises
        dspace.InvalidArgument for another name."""
        layouts.set_theme(self._host, name)

    def split_view(self, view=None, side="right"):
        """Adds a view beside another one, which looks as that one does, with a camera of its own. Returns its viewport.

        view: default: App.view. side: "right" or "below". Raises dspace.NotFound without a camera in the view."""
        view = self._one(view)
        made = views.copy(self, view)
        self.show(made)
        self._arrange("split", made, beside=view.name, side=side)
        return made

    def maximize_view(self, view=None):
        """Gives a view (default: App.view) the whole window. restore_views() brings the docks back."""
        self._arrange("maximize", self._one(view))

    def restore_views(self):
        """Puts all docks where they were before maximize_view(); nothing happens without it."""
        self._arrange("restore")

    def tile_views(self):
        """Puts the docks of all views into a grid of equal cells. Floating ones stay where they are."""
        self._arrange("tile")

    def copy_picture(self, view=None):
        """Copies the picture of a view (default: App.view) to the clipboard, at the size at which it is shown, without
        overlays."""
        self._arrange("copy", self._one(view))

    def fit(self, view=None, things=None):
        """Fills a view with things, without turning its camera.

        view: default: App.view. things: objects, frames, or a list of them; default: all that is visible. A view of a recording
        or a server gets a camera of its own, and so in chase(). Raises dspace.NotFound where nothing has a size."""
        views.fit(self._one(view), things)

    def chase(self, view=None, frame=None, distance=None):
        """Lets the camera of a view follow a frame from behind.

        view: default: App.view. frame: a dspace.Frame or its path; None: the camera stands still where it is. distance [m]:
        default: so far away that what is on the frame fills the picture. Raises dspace.NotFound for a path that is not there."""
        views.chase(self._one(view), frame, distance)

    def open_map(self, view=None):
        """Adds a view from above, orthographic and north up, right of another one and in step with it.

        view: default: App.view. Returns a dspace.application.views.MapLink: its `map` is the new viewport, and its close() ends
        the step; the map stays."""
        view = self._one(view)
        made = views.copy(self, view)
        link = self.link_map(made, view)
        self.show(made, f"map of {view.name}")
        self._arrange("split", made, beside=view.name, side="right")
        return link

    def link_map(self, map_view, view):
        """Makes a view a map and keeps it in step with another one: it follows where the other one looks, and a pan of the map
        moves the other one along the ground.

        map_view, view: two views of one scene, else dspace.InvalidArgument. Returns a dspace.application.views.MapLink, whose
        close() ends that. A map that was in step with another view no longer is."""
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
        """Adds a dock for values and controls.

        title: of its bar. area: where it is at first, "left", "right", "top" or "bottom"; a saved layout comes before it. Returns
        a dspace.application.plugins.Panel, which is empty; its close() removes the dock. Raises dspace.InvalidArgument for
        another area."""
        return self.plugins.add_dock(title, area)

    def add_action(self, menu, text, function, key="", tip=""):
        """Adds an entry to a menu; it calls function().

        menu: the menu's title, such as "Mission"; it is made if there is none. text: of the entry; "&" stands before the letter
        for Alt. key: one that does the same anywhere in the window, such as "F6" or "Ctrl+Shift+D"; "": none. tip: the entry's
        tool tip (default: the text). What the function raises is reported in the Python dock, and the window goes on. Raises dspace.WrongType
        for a function that cannot be called, dspace.InvalidArgument for a key that is none or is taken."""
        self.plugins.add_action(menu, text, function, key, tip)

    def on_key(self, key, function):
        """Calls function() when a key is pressed anywhere in the window.

        key: such as "F7" or "Ctrl+Shift+D". What the function raises is reported in the Python dock. Viewport.on_key() hears the
        keys of one view. Raises dspace.WrongType for a function that cannot be called, dspace.InvalidArgument for a key that
        is none or is taken."""
        self.plugins.on_key(key, function)

    def add_overlay(self, view=None):
        """Adds a layer of texts, lines and circles over pictures.

        view: over which; default: over all views, also over later ones. Returns a dspace.application.overlays.Overlay, which is
        empty; its close() removes it. Captures and movies do not have overlays."""
        return Overlay(self.plugins._ask, None if view is None else views.required(view))

    def add_read_out(self, name, text="", tip=""):
        """Adds a value to the status bar, as "name text".

        text: the value, which ReadOut.set(text=, state=) changes. tip: its tool tip (default: the name).
        Returns a dspace.application.plugins.ReadOut; its close() removes it. Raises dspace.AlreadyExists for a name that is
        there."""
        return self.plugins.add_read_out(name, text, tip)

    def load_plugin(self, name):
        """Loads a plug-in: imports a Python file or module and calls its plugin(app), or loads a library (.so) of C++.

        name: a path that ends with ".py" or ".so", or the name of a module. Returns the module; None for a library. Raises
        dspace.NotFound for one that is not there, dspace.InvalidArgument for one without plugin(app) or of another version,
        and what plugin(app) raises."""
        return self.plugins.load(name, self)

    # --- Telemetry -----------------------------------------------------------------------------

    def plot(self, *channels, of=None, title=None):
        """Adds a plot of channels of telemetry against time, in a dock; without any, an empty one to drag channels into.

        channels: names. of: a Run, whose whole recording is plotted, or a dspace.Scene, whose values are plotted from now on; by
        default the one in the docks. title: of the dock (default: the names of up to two channels, or the first and how many more).
        Returns a dspace.application.plots.Plot, whose add() adds channels. Raises dspace.NotFound for a
        channel that is not there, dspace.InvalidArgument for one of texts."""
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
        window, or that of a server, hears it.

        question: its name. text: one of its choices, or any text if it has none. Raises dspace.NotFound if the server has no
        simulation, dspace.Unsupported for a recording."""
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
            raise errors.Unsupported(f"{about}: nobody hears what is sent to a recording; accepted: a live scene or a server",
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
        raise errors.NotFound("movie: the scene in the docks is no recording; accepted: one opened by app.open()", "movie")

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

        path: a file, whose ending says what it is (Documentation/Formats.md), or the folder of a frames.json. Other threads read
        it, and the windows live meanwhile. Returns what it made: an object, Robot, Terrain or Run (a dspace.Playback); None for a
        script. Raises dspace.NotFound, dspace.Unsupported, dspace.Corrupt or dspace.Io with the file's name, dspace.Resource
        if the user cancels, and what a script raises; then nothing has changed, but for what the script did."""
        path = os.path.abspath(os.fspath(path))
        name = os.path.basename(path).lower()
        if not os.path.exists(path):
            raise errors.NotFound(f"file {path!r}: there is no such file", f"file {path!r}")
        if name.endswith(".py"):
            import __main__
            exec(_compiled(path), __main__.__dict__)
            return None
        if name.endswith(".dspace"):
            return self._open_run(path)
        if name.endswith(MODELS) or os.path.isdir(path):
            made = self._load(path)
            self._look_at()
            return made
        if name.endswith(RASTERS):
            return self._open_terrain(path)
        about = f"file {path!r}"
        raise errors.Unsupported(f"{about}: its name says no format; accepted: {' '.join(MODELS + RASTERS)} .dspace .py", about)

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
        """Adds the scene of the first start: a rover drives over the shipped field, in two views. Returns a
        dspace.application.demo.Drive, whose stop() ends it."""
        from dspace.application.demo import Drive
        return Drive(self)

    # --- Servers -------------------------------------------------------------------------------

    def connect(self, address, certificate=None, key=None, authority=None, insecure=False):
        """Shows the scene of a server (`dspace serve`), drawn here.

        address: "HOST:PORT" or "unix:PATH". certificate, key, authority, insecure: as of dspace.connect. Returns a
        dspace.application.link.Link at once; it connects, and connects again after a loss, by itself. Link.state tells how it
        stands, and the status bar shows it. Raises dspace.InvalidArgument for an empty address."""
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
        """Ends what every() began. number: what every() returned; nothing happens if it has ended."""
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
        """Ends timers, exports, recordings, links and servers, and the session. The program calls it when the window closes."""
        for number in list(self._timers):
            self.cancel(number)
        for each in (*self.exports, *self.runs, *self.links):
            each.close()
        for server in self._servers:
            server.wait()
        self.session.close()
