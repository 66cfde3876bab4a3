"""Dspace: 3D visualization and measurement for spacecraft and rover simulations.

    import dspace
    with dspace.Session() as session:
        scene = session.scene()
        rover = scene.load("rover.urdf")
        camera = scene.add_camera(eye=(4, -4, 3), target=(0, 0, 0))
        scene.add_viewport(size=(1280, 720), camera=camera).save("rover.png")

Metres, seconds, degrees. Quaternions are unit, scalar first (w, x, y, z). A camera's axes are X
right, Y down, Z forward; row 0 of an image is its top row.

Invalid input raises a dspace.Error that names the object, the value and what is accepted, and leaves the scene
unchanged. Each error is also the built-in exception for its case: dspace.InvalidArgument is a ValueError
(dspace.WrongType also a TypeError), dspace.NotFound a KeyError, dspace.Io an OSError; see dspace.errors. A session may
be used only in the thread that made it; calls from another thread raise dspace.WrongThread.

Every change through these classes is a command, which a session can record and send; changes made
on the wrapped VTK objects (`frame.vtk`, `dspace.vtk`) are not.
"""
import importlib

_HOMES = {
    "Assembly": "objects.assemblies",
    "Camera": "cameras.camera", "CameraModel": "cameras.model", "ImageState": "cameras.image_planes", "Sensor": "cameras.sensor",
    "Shutter": "cameras.shutter",
    "StereoPair": "cameras.stereo", "Vantage": "cameras.vantage",
    "Error": "errors", "InvalidArgument": "errors", "WrongType": "errors", "NotFound": "errors",
    "AlreadyExists": "errors", "Unsupported": "errors", "Unimplemented": "errors", "Corrupt": "errors", "Io": "errors",
    "Resource": "errors", "DeadlineExceeded": "errors", "Internal": "errors",
    "Closed": "errors", "WrongThread": "errors", "DspaceWarning": "errors",
    "Event": "telemetry.messages", "Question": "telemetry.messages",
    "Channel": "telemetry.telemetry", "Telemetry": "telemetry.telemetry",
    "Fragment": "objects.fragments", "Light": "objects.fragments",
    "Frame": "frames.frame", "FrameEvent": "frames.events", "Pose": "frames.poses",
    "GraphicsObject": "objects.graphics", "Mesh": "objects.meshes", "Part": "objects.parts",
    "PolyData": "objects.polydata", "Primitive": "objects.graphics", "Text": "objects.graphics",
    "Stars": "objects.graphics", "TiltMarker": "objects.graphics", "Trail": "objects.graphics",
    "StarCatalog": "stars.catalog",
    "Footprints": "objects.sensors", "Link": "objects.sensors", "Plume": "objects.plumes",
    "Orbit": "objects.trajectories", "Trajectory": "objects.trajectories",
    "Animation": "objects.models", "Model": "objects.models",
    "Joint": "objects.robots", "Robot": "objects.robots",
    "Battery": "measure.plans", "BodySite": "measure.plans", "Orbiter": "measure.plans", "Panel": "measure.plans",
    "ProjectedAreas": "measure.plans",
    "Contact": "measure.results", "PowerProfile": "measure.results", "SkyTrack": "measure.results",
    "Horizon": "measure.results", "MeasuredArea": "measure.results", "MeasuredLine": "measure.results",
    "Profile": "measure.results", "LinesOfSight": "measure.results", "LitArea": "measure.results",
    "Altimeter": "measure.ranges", "LensFootprint": "measure.lens_ornaments", "Lidar": "measure.ranges",
    "RangeScan": "measure.point_cloud",
    "BestSite": "measure.best_sites", "MapFile": "measure.map_file", "Site": "terrain.site", "Variogram": "measure.variogram",
    "Movie": "movies.movie",
    "Playback": "playback.playback", "Recording": "recording.recording", "RecordingFile": "recording.file",
    "Kernels": "sky.sky", "ReferenceFrames": "sky.sky",
    "Scene": "scene.scene", "Sun": "scene.sun", "SceneActors": "scene.exports",
    "Pick": "scene.viewport", "Viewport": "scene.viewport",
    "Report": "reports.report",
    "Explanation": "scene.explanation", "Input": "scene.inputs",
    "Session": "clients.session", "RemoteSession": "links.remote", "connect": "links.remote",
    "Geodesy": "terrain.geodesy", "Terrain": "terrain.terrain", "TerrainLayer": "terrain.layers",
    "Watcher": "links.watching", "watch": "links.watching",
    "process_events": "clients.windows", "run": "clients.windows",
}

__all__ = sorted(_HOMES)
__version__ = "0.1.0"


def __getattr__(name):
    # Modules are loaded on demand, so that plain Python (dspace.rover) works without the compiled part.
    if name in _HOMES:
        return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)
    if name in ("errors", "limits", "proto", "rover", "stars", "trajectories", "vtk"):
        return importlib.import_module(f"{__name__}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__():
    return __all__ + ["errors", "limits", "proto", "rover", "vtk"]
