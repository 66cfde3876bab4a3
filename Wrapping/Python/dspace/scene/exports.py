"""Scenes for other programs: files, and VTK's own objects."""
from dspace._core import wire
from dspace._core.fields import array_of, file_path, flag, integer, items, put, reject
from dspace._core.strict import Strict
from dspace.cameras.camera import Camera
from dspace.errors import InvalidArgument, WrongType
from dspace.frames.frame import put_ids

BUDGET = 200_000  # triangles of a terrain


class SceneExports:
    """Exports of a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def export(self, path, ornaments=False, fragments=(), triangle_budget=BUDGET, times=None, frames=None, poses=None,
               lights=True):
        """Writes the visible objects with their frames into a binary glTF file (.glb), which Blender and web viewers
        open. An existing file is replaced.

        ornaments: ornamental objects too. fragments: only objects in these fragments; default: all. triangle_budget: of
        each terrain, which is written as a mesh. times [s], frames and poses animate the frames: an array
        (len(times), len(frames), 8) of their local poses, as in set_poses. Playback.export takes them from a recording.

        lights: with the directional, point and spot lights that are on (KHR_lights_punctual): an intensity of 1 is pi lux
        or pi candela, with which a white matt surface shows 1 as in the scene.

        Cameras, labels, terrain styles, ambient light and what plug-ins draw are left out; a DspaceWarning names objects
        that are. Documentation/VTK.md states what becomes of materials and lights."""
        path = file_path(path, "the path", "export")
        label = f"file {path!r}"
        scene = self._scene
        command = scene._command()
        message = command.export_scene
        put(message, label, path=path, ornaments=ornaments,
            triangle_budget=integer(triangle_budget, "the triangle budget", label),
            no_lights=not flag(lights, "lights", label))
        if message.triangle_budget == 0:
            raise InvalidArgument(f"{label}: the triangle budget is 0; accepted: 1 or more", label)
        given = [fragments] if isinstance(fragments, str) or hasattr(fragments, "name") else fragments
        message.fragment.extend(scene._fragment_name(each) for each in
                                items(given, "the fragments", label, "fragments or their names"))
        if times is not None or frames is not None or poses is not None:
            self._put_animation(message, times, frames, poses, label)
        scene._execute(command)

    def _put_animation(self, message, times, frames, poses, label):
        if times is None or frames is None or poses is None:
            raise InvalidArgument(f"{label}: some of times, frames and poses are given; accepted: all of them, or none",
                                  label)
        times = array_of(times, "the times", "an array of seconds", label)
        put_ids(message, "frame", self._scene, frames)
        poses = array_of(poses, "the poses", "an array (times, frames, 8)", label)
        shape = (times.size, len(message.frame), 8)
        if times.ndim != 1 or poses.shape != shape:
            raise InvalidArgument(f"{label}: times have shape {times.shape} and poses {poses.shape} for "
                                  f"{len(message.frame)} frames; accepted: (n,) and (n, {len(message.frame)}, 8)", label)
        wire.put_array(message, "time_s", times)
        wire.put_array(message, "pose", poses)

    def to_vtk(self, renderer, fragment=None, camera=None, lights=True, triangle_budget=BUDGET):
        """Adds vtkActors of all visible objects and terrains to a vtkRenderer; returns a SceneActors.

        They follow the scene until SceneActors.release(): frames at once, everything else when the renderer draws.
        fragment: only objects in this one. camera: a Camera that the renderer's camera follows. lights: in place of the
        renderer's, the scene's. Terrains become meshes of at most triangle_budget triangles. Unlit colours are those of
        Dspace's pictures; lit ones follow VTK's own shading. Labels and what plug-ins draw are left out: see
        SceneActors.left_out.

        Only in the session's process: other sessions raise dspace.Unsupported."""
        return SceneActors(self._scene, renderer, fragment, camera, lights, triangle_budget)

    def to_actors(self, fragment=None, triangle_budget=BUDGET):
        """The same actors in no renderer: SceneActors.actors is the vtkActorCollection."""
        return SceneActors(self._scene, None, fragment, None, False, triangle_budget)


class SceneActors(Strict):
    """vtkActors that follow a scene, returned by Scene.to_vtk and Fragment.to_actors. Use it in a with statement, or
    call release()."""

    def __init__(self, scene, renderer, fragment, camera, lights, triangle_budget):
        label = f"scene {scene.name!r}"
        budget = integer(triangle_budget, "the triangle budget", label)
        if budget < 1:
            raise InvalidArgument(f"{label}: the triangle budget is {budget}; accepted: 1 or more", label)
        if renderer is not None and not hasattr(renderer, "AddActor"):
            reject(label, "the renderer", renderer, "a vtkRenderer", WrongType)
        if camera is not None and not isinstance(camera, Camera):
            reject(label, "the camera", camera, "a Camera of the scene, or None", WrongType)
        flag(lights, "lights", label)
        name = "" if fragment is None else scene.fragments[scene._fragment_name(fragment)].name
        self._vtk = scene.vtk.MakeActors(name, min(budget, 2**31 - 1))
        self._raise(scene)
        if renderer is not None:
            if camera is not None:
                self._vtk.SetCamera(camera.vantage, camera.name)
            self._vtk.SetLights(lights)
            self._vtk.SetRenderer(renderer)
            self._raise(scene)

    def _raise(self, scene):
        problem = self._vtk.GetFailure()
        if problem:
            self._vtk.Release()
            raise InvalidArgument(problem, f"scene {scene.name!r}")

    @property
    def vtk(self):
        """The vtkDspaceActors behind it."""
        return self._vtk

    @property
    def actors(self):
        """The vtkActorCollection."""
        return self._vtk.GetActors()

    @property
    def left_out(self):
        """Names of visible objects that no actor shows."""
        return [line for line in self._vtk.GetLeftOut().split("\n") if line]

    def update(self):
        """Takes over changes of objects, materials and visibility. A renderer does so each time it draws."""
        self._vtk.Update()

    def release(self):
        """Removes the actors from the renderer and stops following the scene. A second call does nothing."""
        self._vtk.Release()

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.release()

    def __repr__(self):
        return f"<dspace.SceneActors, {self.actors.GetNumberOfItems()} actors>"
