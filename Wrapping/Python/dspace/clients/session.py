"""Sessions, which own scenes and viewports."""
from dspace import vtk
from dspace._core.delegates import delegate
from dspace._core.fields import Named, file_path, flag, reject, text
from dspace._core.traits import DEFAULT_SCENE
from dspace.clients.local import LocalClient
from dspace.errors import AlreadyExists, InvalidArgument, WrongType
from dspace.proto import commands_pb2 as pb
from dspace.recording.recording import Recording
from dspace.scene.scene import Scene
from dspace.scene.sheet import sheet_of
from dspace.scene.viewport import Viewport
from dspace.telemetry.viewer_events import ViewerEvents


class Session:
    """Scenes and viewports in this process. Use it in a `with` statement, or close() it.

        with dspace.Session() as session:
            scene = session.scene()

    A session belongs to the thread that made it, because of its graphics context; calls from another thread raise
    dspace.WrongThread. Several sessions may be used at the same time, each in its own thread.
    """

    def __init__(self):
        self._client = LocalClient()

    @classmethod
    def around(cls, vtk_session):
        """The Session of a vtkDspaceSession that a program in C++ has made, in the thread that draws it."""
        if not isinstance(vtk_session, vtk.vtkDspaceSession):
            reject("session", "the session", vtk_session, "a dspace.vtk.vtkDspaceSession", WrongType)
        made = cls.__new__(cls)
        made._client = LocalClient(vtk_session)
        return made

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.close()

    def close(self):
        """Releases all scenes, viewports and the graphics context. A second call does nothing."""
        self._client.close()

    def reset(self):
        """Removes all viewports and scenes, so that a script can run again in the same session or server.

        Scenes, Frames, objects and viewports of before can no longer be used. A recording in progress goes on."""
        for name in self.viewports:
            command = pb.Command()
            command.remove_viewport.viewport = name
            self._client.execute(command)
        for name in self.scenes:
            command = pb.Command(scene=name)
            command.remove_scene.SetInParent()
            self._client.execute(command)

    def execute(self, command):
        """Executes a dspace.proto.commands_pb2.Command and returns its Reply."""
        if not isinstance(command, pb.Command):
            reject("session", "the command", command, "a dspace.proto.commands_pb2.Command", WrongType)
        return self._client.execute(command)

    def scene(self, name=DEFAULT_SCENE, lights=True):
        """Returns the scene of that name. It is made if it does not exist.

        lights: whether a new scene has the light "sun" (Scene.sun).
        """
        text(name, "the scene's name", "session")
        if not name:
            reject("session", "the scene's name", name, "any that is not empty")
        command = pb.Command(scene=name)
        command.create_scene.no_lights = not flag(lights, "lights", f"scene {name!r}")
        try:
            self._client.execute(command)
        except AlreadyExists as error:
            if not error.object.startswith("scene"):
                raise  # another client has taken the server over
        return Scene(self._client, name)

    @property
    def scenes(self):
        """All scenes, by name."""
        command = pb.Command()
        command.list_scenes.SetInParent()
        names = self._client.execute(command).scenes.name
        return Named("scene", {name: Scene(self._client, name) for name in names})

    @property
    def viewports(self):
        """All viewports, by name."""
        command = pb.Command()
        command.list_viewports.SetInParent()
        names = self._client.execute(command).viewports.name
        return Named("viewport", {name: Viewport(self._client, name) for name in names})

    @property
    def frames(self):
        """Rotations between reference frames, with the kernels of the scene "scene": see dspace.ReferenceFrames."""
        return self.scene().reference_frames

    def sky(self, *arguments, **keywords):
        """Where bodies stand over a place, with the kernels of the scene "scene": see Scene.sky."""
        return self.scene().sky(*arguments, **keywords)

    def render(self):
        """Draws every visible viewport whose picture changed. Returns their number."""
        command = pb.Command()
        command.render.SetInParent()
        return self._client.execute(command).render.drawn

    def sheet(self, viewports=None, size=None, background=(0, 0, 0), path=None, physical_only=False):
        """Draws viewports into one picture, each at its Viewport.position: (h, w, 3) uint8, sRGB.

        viewports: Viewports, later ones over earlier ones; None: all visible ones, by name. size: (width, height) in
        pixels, into which all must fit; None: as large as they need. background: sRGB, 0 to 1, '#rrggbb' or a CSS
        name, where no viewport is. path: also writes the picture to this file (.png). physical_only: as in
        Viewport.image. Raises dspace.InvalidArgument for a viewport at a negative position or beyond the size, and
        then writes nothing."""
        if viewports is None:
            viewports = [each for each in self.viewports.values() if each.visible]
        return sheet_of(viewports, size, background, path, flag(physical_only, "physical_only", "sheet"))

    def record(self, path, commit_every=0.1, pack=False):
        """Records into a new file, beginning with the present state. Returns the Recording. It ends with its `with`
        statement, with stop(), or with the session.

            with session.record("run.dspace"):
                ...

        commit_every: seconds between commits, 0.001 to 60. A process that dies loses at most the commands since the
        last commit, and data that the operating system had not written yet.

        pack: the files that its commands need (models with their textures, rasters with their side files, ...)
        become part of it, so that it replays anywhere. `dspace log pack` does the same later.
        """
        return Recording(self._client, path, commit_every, pack)

    @property
    def recording(self):
        """The Recording in progress, or None."""
        recording = self._client.recording
        return recording if recording is not None and recording.active else None

    def load_plugin(self, path):
        """Loads a shared library that registers drawers of user-defined objects, for Scene.add_drawn.

        The library stays loaded until the process ends."""
        path = file_path(path, "the path", "plug-in")
        problem = self._client.local().LoadPlugIn(path)
        if problem:
            raise InvalidArgument(problem, f"plug-in {path!r}")

    # --- Events of viewers ---------------------------------------------------------------------

    on_event = delegate(ViewerEvents, "on_event")
    on_edited = delegate(ViewerEvents, "on_edited")
    process_events = delegate(ViewerEvents, "process_events")
    send_event = delegate(ViewerEvents, "send_event")
    answer = delegate(ViewerEvents, "answer")
    edited = delegate(ViewerEvents, "edited")
    select = delegate(ViewerEvents, "select")
    dragged = delegate(ViewerEvents, "dragged")

    # --- The rest ------------------------------------------------------------------------------

    @property
    def statistics(self):
        """Counters of the render context: what reached the GPU, by whom."""
        command = pb.Command()
        command.get_statistics.SetInParent()
        reply = self._client.execute(command).statistics
        return {field.name: getattr(reply, field.name) for field in reply.DESCRIPTOR.fields}

    @property
    def vtk(self):
        """The vtkDspaceSession behind it."""
        return self._client.vtk

    def __repr__(self):
        if self._client.vtk is None:
            return "<dspace.Session, closed>"
        try:
            return f"<dspace.Session with scenes {sorted(self.scenes)}>"
        except Exception:  # a repr never raises
            return "<dspace.Session of another thread>"
