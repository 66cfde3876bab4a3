"""Pictures through lenses, pixels of points and rays of pixels, in a scene."""
import json
from typing import NamedTuple

import numpy as np

from dspace._core import wire
from dspace._core.fields import array_of, file_path, flag, integer, items, put, put_given, real, reject
from dspace._core.files import AtomicFile
from dspace._core.signals import check_signals
from dspace.cameras.image_planes import ImageState, ground_of, image_state, motion_of, points_of
from dspace.cameras.line_scan import scanned_image
from dspace.cameras.model import put_model
from dspace.cameras.shutter import exposed_image
from dspace.errors import WrongType

TILE = 512  # pixels a side, drawn between two checks for Ctrl-C
PLANES = {"color": (np.uint8, (4,)), "radiance": (np.float32, (3,)), "depth": (np.float32, ()), "range": (np.float32, ()),
          "label": (np.uint32, ()), "lit_fraction": (np.float32, ()), "incidence": (np.float32, ()),
          "emission": (np.float32, ()), "phase": (np.float32, ()), "normal": (np.float32, (3,))}
UNITS = {"color": "sRGB", "radiance": "W/m^2/sr", "depth": "m", "range": "m", "incidence": "deg", "emission": "deg",
         "phase": "deg", "lit_fraction": "1", "label": "", "counts": "counts", "normal": "1"}


def _plane_of(name, about):
    """The name of a plane that an image file may hold."""
    if not isinstance(name, str) or name not in (*PLANES, "counts"):
        reject(about, "the plane", name, ", ".join(map(repr, (*PLANES, "counts"))))
    return name


class LensPicture(NamedTuple):
    """How a picture through a lens was made."""
    source_views: int  # that were drawn
    source_pixels: int
    without_ray: int  # pixels that see nothing: the lens has no ray for them
    half_angle_deg: float  # the widest angle between a pixel's ray and the axis
    pupil_shift: float  # the greatest distance of a pixel's entrance pupil from the eye of the source views [m]
    pupil_pixels: float  # the greatest distance by which that moved a pixel's place in a source view [source pixels]
    pupil_beyond: int  # pixels whose place left the drawn source block: they show its edge


class SceneImages:
    """Draws through lenses for a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def _put_camera(self, message, model, camera, vantage, frame, size, scale, about):
        from dspace.cameras.camera import Camera
        put_model(message, model, size, scale, about)
        if frame is not None:
            if camera is not None or vantage is not None:
                reject(about, "a frame with a camera", (frame, camera), "one of them")
            if model is None:
                reject(about, "a frame without a model", frame, "a model with it")
            message.own_pose = True
            message.frame = self._scene._frame_id(frame)
        else:
            if isinstance(camera, Camera):
                vantage = camera.vantage if vantage is None else vantage
            message.camera = self._scene._name_of(camera, Camera, "camera", about)
            message.vantage = "" if vantage is None else self._scene._vantage_name(vantage, about)

    def simulate_image(self, model=None, camera=None, vantage=None, frame=None, size=None, scale=False, color=True,
                       radiance=False, depth=False, range=False, label=False, lit_fraction=False, incidence=False,
                       emission=False, phase=False, normal=False, point=False, ground=None, geographic=None, motion=None,
                       samples=2, exposure=1.0, ornaments=False, hide=(), tile=TILE, progress=None):
        """The image that a camera with a lens takes: a dict of planes (h, w, ...), row 0 on top, and "lens", a
        LensPicture.

        model: a CameraModel; None: the camera's own projection. Its pose is that of `camera` (or the active one of
        `vantage`), whose axes the model's axes become; or with `frame` the model's own pose in that frame, such as a
        rover's body. size: (width, height), needed where the model has none; another size than the model's is rejected
        unless scale=True. Planes: as Viewport.capture, of physical objects; "color" is the sRGB of the radiance times
        `exposure`, 1 at 1361 / pi W/m^2/sr (white in full Sun); "range" is from the pixel's own entrance pupil.
        "normal" (h, w, 3) is the surface's as it is lit, unit, in the root. Planes of doubles, from the range along the
        pixel's own ray: "point" (h, w, 3) in the root [m]; "ground" (h, w, 3): map x, y and height of a Terrain, given as
        ground=terrain; "geographic" (h, w, 3): longitude, latitude [deg] and height, geographic=terrain. Heights are above the
        terrain's vertical datum. "motion" (h, w, 2): where the pixel's surface is in a state, given as motion=image_state()
        at another time, less where it is now [pixels], by the motion of camera and objects; NaN: not seen, or nothing there.
        Joints inside one object do not count. NaN where there is nothing.
        ornaments=True: labels, depths and angles also of ornaments. Pixels that the lens has no ray for are black, 0,
        +infinity or NaN. samples: n x n per pixel of the source views, 1 to 8. hide: fragments left out.

        The image is drawn in tiles of `tile` pixels a side (64 to 4096), with the same bytes as in one; Ctrl-C stops
        between two. progress: called with the fraction that is done, 0 to 1.

        Light of a lens wider than 100 degrees comes from up to six views, and is interpolated; all other planes take
        the nearest source pixel. A CAHVORE's moving pupil is followed, with what only it would see left out.

        Raises dspace.InvalidArgument for a camera more than a millimetre below the ground of a terrain that is shown and not
        hidden by `hide`."""
        about = "simulated image"
        wanted = dict(color=color, radiance=radiance, depth=depth, range=range, label=label, lit_fraction=lit_fraction,
                      incidence=incidence, emission=emission, phase=phase, normal=normal)
        terrains = {"ground": ground, "geographic": geographic}
        for name, terrain in terrains.items():
            if terrain is not None and not (hasattr(terrain, "to_map") and hasattr(terrain, "locate")):
                reject(about, name, terrain, "a dspace.Terrain", WrongType)
        if motion is not None and not (isinstance(motion, ImageState) and motion._scene._name_ == self._scene._name_):
            reject(about, "motion", motion, "an ImageState of this scene", WrongType)
        derived = flag(point, "point", about) or motion is not None or ground is not None or geographic is not None
        sought = {name for name, asked in wanted.items() if flag(asked, name, about)}
        wanted["range"] = flag(range, "range", about) or derived
        wanted["label"] = flag(label, "label", about) or motion is not None
        planes = {}

        def take(x, y, width, height, part):
            for name, values in part.items():
                if name not in planes:
                    planes[name] = np.empty((height, width) + values.shape[2:], values.dtype)
                planes[name][y:y + values.shape[0], x:x + values.shape[1]] = values

        command = self._command(wanted, model, camera, vantage, frame, size, scale, samples, exposure, ornaments, hide)
        lens = self._draw(command, take, tile, progress, size, model)
        if derived:
            points = points_of(self, planes, (model, camera, vantage, frame, size, scale))
            if point:
                planes["point"] = points
            for name, terrain in terrains.items():
                if terrain is not None:
                    planes[name] = ground_of(terrain, points, name == "geographic")
            if motion is not None:
                planes["motion"] = motion_of(self._scene, planes, points, motion)
            for name in ("range", "label"):
                if name not in sought:
                    planes.pop(name, None)
        return {**planes, "lens": lens}

    def simulate_exposure(self, shutter, at, model=None, camera=None, vantage=None, frame=None, size=None, scale=False, color=True,
                          radiance=False, depth=False, range=False, label=False, lit_fraction=False, incidence=False,
                          emission=False, phase=False, normal=False, samples=2, exposure=1.0, ornaments=False, hide=(), tile=TILE,
                          progress=None):
        """The image that a camera takes while the scene moves: motion blur, and rows that are exposed one after another. A dict
        as of simulate_image().

        shutter: a dspace.Shutter. at: a function that puts the scene, and the camera with it, where it is at a time [s]; 0 is the
        middle of the whole image's exposure. It steps a simulation, seeks in a playback, or moves frames. It is called for each
        instant of each band of rows, not in the order of time where the shutter rolls, and last with 0.0, also after an error or
        Ctrl-C.
        Radiance is the mean over the instants, summed in double precision; color is its sRGB, within a step of what
        simulate_image() makes of such light. All other planes are those in the middle of their row's exposure. Other arguments:
        as for simulate_image(); `size` is needed where the model has none.

            shutter = dspace.Shutter(exposure_s=0.02, readout_s=0.03)
            start = playback.time
            planes = scene.simulate_exposure(shutter, lambda t: playback.seek(start + t), model, frame=body, radiance=True)
            counts = sensor.expose(planes["radiance"], model)                                  # its exposure_s: the shutter's"""
        planes = dict(depth=depth, range=range, label=label, lit_fraction=lit_fraction, incidence=incidence, emission=emission,
                      phase=phase, normal=normal)
        return exposed_image(self, shutter, at, color, radiance, planes, model, camera, vantage, frame, size, scale, samples,
                             exposure, ornaments, hide, tile, progress)

    def simulate_lines(self, model, frame, at=None, color=True, radiance=False, depth=False, range=False, label=False,
                       lit_fraction=False, incidence=False, emission=False, phase=False, normal=False, samples=2, exposure=1.0,
                       ornaments=False, hide=(), progress=None):
        """The image of a push-broom camera: a dict of planes (h, w, ...), as of simulate_image(), each line from its own pose.

        model: a CameraModel of type line_scan, at least 3 pixels wide; its poses are in `frame`, such as the body's fixed axes for
        a USGS ISD. at: a function that puts the scene where it is when a line is taken, by the line's number from 0; None: the
        scene stands still. The camera's own motion is the model's. Lines before the first and after the last pose are black, 0,
        +infinity or NaN. Other arguments: as for simulate_image(). One picture of a row is drawn for each line."""
        planes = dict(color=color, radiance=radiance, depth=depth, range=range, label=label, lit_fraction=lit_fraction,
                      incidence=incidence, emission=emission, phase=phase, normal=normal)
        return scanned_image(self, model, at, frame, planes, samples, exposure, ornaments, hide, progress)

    def save_image(self, path, model=None, camera=None, vantage=None, frame=None, size=None, scale=False, plane="color",
                   sensor=None, seed=0, number=0, samples=2, exposure=1.0, ornaments=False, hide=(), tile=TILE, progress=None):
        """Writes one plane of the image that simulate_image() makes, tile by tile: the memory that it takes grows with the
        width of the image, not with its height. Returns a LensPicture.

        path: .png (color, counts), .tif (every plane) or .exr (every plane but color and counts); planes of floats are 32
        bits, labels 32 bit integers, counts 16 bits. The file is there when it is complete; an interrupted call leaves an
        earlier one. It holds the camera's model, its pose in the scene's root, the time and the sensor: `dspace camera info
        FILE`, or image_file.read_metadata(). plane="counts": of a `sensor`, a Sensor, with the bytes of Sensor.expose(); seed
        and number: its noise's seed and frame. Other arguments: as for simulate_image(). Needs Debian's python3-openimageio."""
        from dspace.cameras.image_file import ImageFile, format_of
        from dspace.cameras.sensor import Exposure, Sensor
        about = "simulated image"
        path = file_path(path, "the path", about)
        counted = _plane_of(plane, about) == "counts"
        if counted != isinstance(sensor, Sensor):
            reject(about, "the sensor", sensor, "a dspace.Sensor with the plane 'counts', and None without it", WrongType)
        format_of(path, np.uint16 if counted else PLANES[plane][0])
        AtomicFile(path, f"image {str(path)!r}").close()  # a place that cannot be written is told before drawing
        metadata = self.image_metadata(plane, model, camera, vantage, frame, exposure, sensor)
        if counted:
            metadata.update(seed=integer(seed, "the seed", about), number=integer(number, "the number", about))
        command = self._command({"radiance" if counted else plane: True}, model, camera, vantage, frame, size, scale, samples,
                                exposure, ornaments, hide)
        band, file, exposed = None, None, None
        try:
            def take(x, y, width, height, part):
                nonlocal band, file, exposed
                values, = part.values()
                values = values[..., :3] if plane == "color" else values
                if file is None:
                    if counted:
                        exposed = Exposure(sensor, (width, height), model, seed, number)
                    channels = exposed.channels if counted else values.shape[2] if values.ndim == 3 else 1
                    file = ImageFile(path, (width, height), channels, np.uint16 if counted else values.dtype, metadata)
                if x == 0:
                    band = np.empty((values.shape[0], width) + values.shape[2:], values.dtype)
                band[:, x:x + values.shape[1]] = values
                if x + values.shape[1] >= width:
                    file.write_rows(exposed.add(band) if counted else band)

            lens = self._draw(command, take, tile, progress, size, model)
            file.commit()
        finally:
            if file is not None:
                file.close()
        return lens

    def image_metadata(self, plane, model=None, camera=None, vantage=None, frame=None, exposure=1.0, sensor=None):
        """What a file tells about an image that simulate_image() makes: a dict for JSON, with the plane and its unit, the scene
        and its time [s], the model, its pose in the root, and the Sensor's numbers. plane: a plane's name, "counts", or
        None (neither plane nor unit). Other arguments: as for simulate_image().

            write_image("left.png", counts, scene.image_metadata("counts", model, frame=rover, sensor=sensor))"""
        from dspace.cameras.sensor import Sensor
        about = "simulated image"
        scene = self._scene
        if plane is not None:
            _plane_of(plane, about)
        self._put_camera(scene._command().simulate_image.camera, model, camera, vantage, frame, None, False, about)
        if sensor is not None and not isinstance(sensor, Sensor):
            reject(about, "the sensor", sensor, "a dspace.Sensor, or None", WrongType)
        if frame is not None:
            pose = scene._frame_of(scene._frame_id(frame)).world_pose @ model.pose
        else:
            pose = self._camera_pose(camera, vantage)
        found = {} if plane is None else {"plane": plane, "unit": UNITS[plane]}
        found.update(scene=scene.name, time_s=scene.time,
                     pose={"position": pose.position.tolist(), "quaternion": pose.quaternion.tolist()})
        if plane == "color":
            found["exposure"] = real(exposure, "the exposure", about)
        if model is not None:
            found["camera"] = json.loads(model.json)
        if sensor is not None:
            found["sensor"] = sensor.settings
        return found

    def _camera_pose(self, camera, vantage):
        from dspace.cameras.camera import Camera
        if isinstance(camera, Camera):
            return camera.pose_in()
        about = "simulated image"
        vantages = self._scene.vantages
        name = "main" if vantage is None else self._scene._vantage_name(vantage, about)
        chosen = vantages[name]
        found = chosen.active if camera is None else chosen.cameras[camera]
        if found is None:
            reject(about, "the active camera", None, "a camera, or a vantage that has one")
        return found.pose_in()

    def _command(self, wanted, model, camera, vantage, frame, size, scale, samples, exposure, ornaments, hide):
        """The command of a picture, without its tile."""
        about = "simulated image"
        command = self._scene._command()
        message = command.simulate_image
        self._put_camera(message.camera, model, camera, vantage, frame, size, scale, about)
        put(message, about, ornaments=ornaments, **wanted)
        put_given(message, about, samples=samples, exposure=exposure)
        hide = hide if isinstance(hide, (list, tuple, set, frozenset)) else [hide]
        message.hidden_fragment.extend(self._scene._fragment_name(each, None)
                                       for each in items(hide, "hide", about, "fragments or their names"))
        return command

    def _draw(self, command, take, tile, progress, size, model, rows=None):
        """Draws all tiles, row by row; rows: from the first to before the last of these. take: called with (x, y, width and height of the image, {plane: array}) for each; the
        arrays are good until it returns. Returns a LensPicture."""
        about = "simulated image"
        tile = integer(tile, "the tile", about)
        if not 64 <= tile <= 4096:
            reject(about, "the tile", tile, "64 to 4096 pixels")
        if progress is not None and not callable(progress):
            reject(about, "progress", progress, "a function of one number", WrongType)
        message = command.simulate_image
        counts, first, pupil = np.zeros(4, dtype=np.int64), None, 0.0
        width, height = size if size is not None else (model.size if model is not None and model.size else (0, 0))
        x, y = 0, rows[0] if rows else 0
        while True:
            message.x, message.y = x, y
            end = rows[1] if rows else height
            message.tile_width, message.tile_height = (min(tile, max(width - x, 0)), min(tile, max(end - y, 0)))
            reply = self._scene._execute(command).capture
            lens = reply.lens
            if first is None:
                width, height = lens.image_width, lens.image_height
                first = lens
            take(x, y, width, height, {plane.name: self._plane(plane, reply) for plane in reply.plane})
            counts += (lens.source_views, lens.source_pixels, lens.without_ray, lens.pupil_beyond)
            pupil = max(pupil, lens.pupil_pixels)
            x += reply.width
            if x >= width:
                x, y = 0, y + reply.height
            if progress is not None:
                progress(min((y * width + x * reply.height) / (width * height), 1.0))
            if y >= (rows[1] if rows else height):
                break
            check_signals()
        return LensPicture(int(counts[0]), int(counts[1]), int(counts[2]), first.half_angle_deg, first.pupil_shift, pupil,
                           int(counts[3]))

    def _plane(self, plane, reply):
        kind, channels = PLANES[plane.name]
        shape = (reply.height, reply.width) + channels
        if plane.data:
            return np.frombuffer(plane.data, kind).reshape(shape)
        from vtkmodules.util.numpy_support import vtk_to_numpy
        return vtk_to_numpy(self._scene._client.vtk.GetPlane(plane.name)).reshape(shape)

    def image_state(self, model, camera=None, vantage=None, frame=None, size=None, scale=False):
        """Where the camera and all objects are now: an ImageState, for the plane "motion" of pictures at another time. The
        camera is given as for simulate_image(), with a model.

            before = scene.image_state(model, frame=body)
            ...                                                       # the simulation's next step
            planes = scene.simulate_image(model, frame=body, motion=before)"""
        return image_state(self, model, camera, vantage, frame, size, scale, "image state")

    def project_points(self, points, model=None, camera=None, vantage=None, frame=None, size=None, scale=False, points_in=None):
        """Pixels (..., 2) of points (..., 3) [m] in the frame `points_in` (default: the root); NaN where the lens sees
        nothing. Things in between do not count. The camera is given as for simulate_image()."""
        reply, shape = self._ask("project_points", "point", points, 3, (model, camera, vantage, frame, size, scale), points_in,
                                 "projected points")
        return wire.get_array(reply.project, "pixel").reshape(shape + (2,)).copy()

    def pixel_rays(self, pixels, model=None, camera=None, vantage=None, frame=None, size=None, scale=False, rays_in=None):
        """Origins (..., 3) [m] and unit directions (..., 3) in the frame `rays_in` (default: the root) of the rays of
        pixels (..., 2); NaN where there is none. The camera is given as for simulate_image()."""
        reply, shape = self._ask("unproject_pixels", "pixel", pixels, 2, (model, camera, vantage, frame, size, scale), rays_in,
                                 "rays of pixels")
        rays = wire.get_array(reply.unproject, "ray").reshape(shape + (6,))
        return rays[..., :3].copy(), rays[..., 3:].copy()

    def _ask(self, request, field, values, columns, camera, frame, about):
        """The reply to a request on `values` (..., columns) in `frame`, and their shape without the columns. camera: what
        _put_camera() takes."""
        what, accepted = f"the {field}s", f"an array (..., {columns})"
        array = array_of(values, what, accepted, about)
        if array.ndim < 1 or array.shape[-1] != columns:
            reject(about, what, values, accepted)
        command = self._scene._command()
        message = getattr(command, request)
        self._put_camera(message.camera, *camera, about)
        message.frame = self._scene._frame_id(frame)
        wire.put_array(message, field, array)
        return self._scene._execute(command), array.shape[:-1]
