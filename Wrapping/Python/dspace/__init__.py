"""Dspace: 3D visualization and measurement for spacecraft and rover simulations.

    import dspace
    with dspace.Session() as session:
        scene = session.scene()
        rover = scene.load("rover.urdf")
        camera = scene.add_camera(eye=(4, -4, 3), target=(0, 0, 0))
        scene.add_viewport(size=(1280, 720), camera=camera).save("rover.png")

Metres, seconds, degrees. Quaternions are unit, scalar first (w, x, y, z). A camera's axes are X
right, Y down, Z forward; row 0 of an image is its top row.

What is refused raises a dspace.Error that names the object, the value and what would be accepted, and
changes nothing. Each is also what Python itself would raise: dspace.InvalidArgument a ValueError (for
a wrong type, dspace.WrongType, a TypeError as well), dspace.NotFound a KeyError, dspace.Io an OSError;
see dspace.errors. A session serves the thread that made it; another one gets dspace.WrongThread.

Every change through these classes is a command, which a session can record and send; changes made
on the wrapped VTK objects (`frame.vtk`, `dspace.vtk`) are not.
"""
import importlib

_HOMES = {
    "Assembly": "assemblies",
    "Camera": "cameras", "Vantage": "cameras",
    "Error": "errors", "InvalidArgument": "errors", "WrongType": "errors", "NotFound": "errors",
    "AlreadyExists": "errors", "Unsupported": "errors", "Unimplemented": "errors", "Corrupt": "errors", "Io": "errors",
    "Resource": "errors", "DeadlineExceeded": "errors", "Internal": "errors",
    "Closed": "errors", "WrongThread": "errors", "DspaceWarning": "errors",
    "FrameEvent": "events",
    "Event": "messages", "Question": "messages", "Channel": "telemetry", "Telemetry": "telemetry",
    "Fragment": "fragments", "Light": "fragments",
    "Frame": "frames",
    "GraphicsObject": "objects", "Primitive": "objects", "Text": "objects", "TiltMarker": "objects",
    "Trail": "objects",
    "Movie": "movies",
    "Pose": "poses",
    "Joint": "robots", "Robot": "robots",
    "Playback": "playback", "Recording": "recordings", "RecordingFile": "recording_file",
    "Scene": "scenes",
    "Session": "sessions", "RemoteSession": "remote", "connect": "remote",
    "Watcher": "watching", "watch": "watching",
    "Terrain": "terrain", "TerrainLayer": "layers",
    "Pick": "viewports", "Viewport": "viewports",
}

__all__ = sorted(_HOMES)
__version__ = "0.1.0"


def __getattr__(name):
    # On demand, so that what is plain Python (dspace.rover) works without the compiled part.
    if name in _HOMES:
        return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)
    if name in ("rover", "session", "vtk"):
        return importlib.import_module(f"{__name__}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__():
    return __all__ + ["rover", "session", "vtk"]
