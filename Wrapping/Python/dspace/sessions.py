"""Sessions own scenes and viewports."""
from dspace._client import LocalClient
from dspace._fields import Named, flag, reject, text
from dspace._traits import DEFAULT_SCENE
from dspace.errors import AlreadyExists, WrongType
from dspace.recordings import Recording
from dspace.scenes import Scene
from dspace.proto import commands_pb2 as pb
from dspace.viewer_events import ViewerEvents
from dspace.viewports import Viewport


class Session(ViewerEvents):
    """Scenes and viewports in this process. Use it in a `with` statement, or close() it.

        with dspace.Session() as session:
            scene = session.scene()

    It serves the thread that made it, as its graphics context does: from another one, everything raises
    dspace.WrongThread. Several sessions may be used side by side, each in its thread.
    """

    def __init__(self):
        self._client = LocalClient()

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.close()

    def close(self):
        """Releases all scenes, viewports and the graphics context. Twice is no error."""
        self._client.close()

    def execute(self, command):
        """Carries out a message of dspace.proto.commands_pb2.Command; returns the Reply."""
        if not isinstance(command, pb.Command):
            reject("session", "the command", command, "a dspace.proto.commands_pb2.Command", WrongType)
        return self._client.execute(command)

    def scene(self, name=DEFAULT_SCENE, lights=True):
        """The scene of that name, made now if there is none.

        lights: whether a new one begins with the lights "sun" and "sky".
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
                raise  # that somebody else has taken a server over
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

    def render(self):
        """Draws every visible viewport in which something changed; returns how many."""
        command = pb.Command()
        command.render.SetInParent()
        return self._client.execute(command).render.drawn

    def record(self, path, commit_every=0.1, pack=False):
        """Records from the present state on into a new file; returns the Recording, which ends with its
        `with` statement, with stop(), or with the session.

            with session.record("run.dspace"):
                ...

        commit_every: seconds, 0.001 to 60. A process that dies loses at most what it did in the last so many,
        and what the disk was behind.

        pack: the files that its commands need (models with their textures, rasters with their side files, ...)
        become part of it, so that it replays anywhere. `dspace log pack` does the same later.
        """
        return Recording(self._client, path, commit_every, pack)

    @property
    def recording(self):
        """The Recording that is under way, or None."""
        recording = self._client.recording
        return recording if recording is not None and recording.active else None

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
