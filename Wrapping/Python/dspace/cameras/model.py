"""Camera models with real lenses: point to pixel and back, files, conversion. No session is needed."""
import json
from typing import NamedTuple

import numpy as np

from dspace._core.fields import array_of, file_path, flag, integers, numbers, reject, text
from dspace._core.replies import make_error, to_bytes, to_reply
from dspace._core.strict import Strict
from dspace.errors import NotFound, WrongType


class LensCheck(NamedTuple):
    """What a lens does to its image."""
    limit_deg: float  # every direction within this angle of the axis has a pixel of its own
    end: str  # what ends the field: "a fold", "the plane of the lens", "the end of the model", "parallel rays", "" (nothing)
    without_ray: float  # the fraction of the image's pixels that see nothing
    half_angle_deg: float  # the widest angle between a pixel's ray and the axis
    least_density: float  # pixels per degree, of all directions in the image
    greatest_density: float
    pupil_shift: float  # the greatest distance of a ray's origin from the camera's [m]
    round_trip: float  # the greatest error of pixel to ray to pixel [pixels]


class Conversion(NamedTuple):
    """A converted model, and what it lost."""
    model: object  # CameraModel
    rms: float  # distance between the pixels of the two models [pixels]
    greatest: float  # the same, the greatest
    covered: float  # the fraction of the image that was fitted: of a type that distorts a plane, 80 degrees about the axis
    pupil_shift: float  # of the source, which the new model lacks [m]


def _vtk():
    from dspace import vtk
    return vtk


def _doubles():
    from vtkmodules.vtkCommonCore import vtkDoubleArray
    return vtkDoubleArray()


def _check(answer):
    """Raises the error of a wrapped method's answer."""
    data = to_bytes(answer)
    if data:
        raise make_error(to_reply(data).error)


def _size(size, label):
    """(width, height) of an image, checked."""
    width, height = integers(size, 2, "the size", label, "(width, height) in pixels")
    if not (1 <= width <= 10**6 and 1 <= height <= 10**6):
        reject(label, "the size", size, "1 to 1000000 pixels a side")
    return width, height


def _array(values, columns, what, label):
    """Values (..., columns) as an array (n, columns) of finite doubles, and their shape without the columns."""
    accepted = f"an array (n, {columns}) or (..., {columns}) of finite numbers"
    array = array_of(values, what, accepted, label)
    if array.ndim < 1 or array.shape[-1] != columns or not np.isfinite(array).all():
        reject(label, what, values, accepted)
    return np.ascontiguousarray(array.reshape(-1, columns)), array.shape[:-1]


def _wrapped(array):
    from vtkmodules.util.numpy_support import numpy_to_vtk
    return numpy_to_vtk(array)


def _numpy(array, columns):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    return vtk_to_numpy(array).reshape(-1, columns)


class CameraModel(Strict):
    """A camera with its lens. Immutable.

        model = dspace.CameraModel.read("cameras.json", "NCAML")
        pixels = model.project(points)  # NaN where the lens sees nothing
        origins, directions = model.rays(pixels)

    The camera's axes C are X right, Y down, Z forward; pixel (0, 0) is the centre of the top-left pixel. The model's
    frame M is the one that its file speaks of, such as a rover's; a model without a pose has M = C.

    CameraModel("pinhole", focal=(fx, fy), center=(cx, cy), size=(w, h)) makes one from numbers; Documentation/Cameras.md
    lists the types and their numbers. position [m] and quaternion (w, x, y, z): of C in M; of types cahv, cahvor and
    cahvore C, A, H, V, O, R, E in M give the pose. Raises dspace.InvalidArgument and dspace.Unsupported, which name
    the number and what is accepted."""

    def __init__(self, type, size=None, name="", frame="", position=None, quaternion=None, **values):
        label = "camera model"
        lens = {"type": text(type, "the type", label)}
        if size is not None:
            lens["width"], lens["height"] = _size(size, label)
        for key, value in values.items():
            array = array_of(value, key, "numbers", label)
            if not np.isfinite(array).all():
                reject(label, key, value, "finite numbers")
            lens[key] = array.tolist()
        if position is not None:
            lens["position"] = numbers(position, 3, "the position", label).tolist()
        if quaternion is not None:
            lens["rotation"] = numbers(quaternion, 4, "the quaternion", label).tolist()
        self._from_json(json.dumps({"name": text(name, "the name", label), "frame": text(frame, "the frame", label),
                                    "model": lens}))

    def _from_json(self, data):
        self._vtk = _vtk().vtkDspaceCameraModel()
        _check(self._vtk.Parse(data))
        self._describe()

    def _describe(self):
        self._json = to_bytes(self._vtk.GetJson()).decode()
        self._content = json.loads(self._json)

    @classmethod
    def _of(cls, wrapped):
        model = cls.__new__(cls)
        model._vtk = wrapped
        model._describe()
        return model

    @classmethod
    def from_json(cls, data):
        """A model from JSON text, such as `json`."""
        model = cls.__new__(cls)
        model._from_json(text(data, "the JSON", "camera model"))
        return model

    @classmethod
    def read_all(cls, path):
        """All models of a file, in its order. Formats: JSON, JPL's CAHV, CAHVOR and CAHVORE text, PDS3 and VICAR labels
        (GEOMETRIC_CAMERA_MODEL), OpenCV's and ROS's YAML, mrcal's .cameramodel, USGS ISD, SPICE instrument kernels; the content
        decides.

        Raises dspace.NotFound, dspace.Io, dspace.Corrupt, dspace.Unsupported, dspace.InvalidArgument."""
        path = file_path(path, "the path", "camera model")
        first = _vtk().vtkDspaceCameraModel()
        _check(first.Read(path))
        models = [cls._of(first)]
        for index in range(1, first.GetNumber()):
            first.Select(index)
            models.append(cls.from_json(to_bytes(first.GetJson()).decode()))
        first.Select(0)
        return models

    @classmethod
    def read(cls, path, name=None):
        """The model of a name in a file; without a name the only one. As read_all()."""
        models = cls.read_all(path)
        found = models if name is None else [m for m in models if m.name == name]
        if len(found) != 1:
            names = ", ".join(m.name or "(no name)" for m in models)
            what = f"it holds {len(models)} cameras" if name is None else f"it has {len(found)} cameras {name!r}"
            raise NotFound(f"file {str(path)!r}: {what}; accepted: one of {names}", str(path))
        return found[0]

    def save(self, path):
        """Writes the model: .json (every model), .cahv, .cahvor, .cahvore, .yaml (OpenCV's) or .cameramodel (mrcal's).
        Raises dspace.Unsupported where the format cannot hold it."""
        _check(self._vtk.Write(file_path(path, "the path", self._label)))

    # --- What it is ----------------------------------------------------------------------------

    def _label(self):
        return f"camera {self.name!r}" if self.name else "camera model"

    @property
    def name(self):
        return self._content.get("name", "")

    @property
    def frame(self):
        """The name of its frame M; may be empty."""
        return self._content.get("frame", "")

    @property
    def type(self):
        return self._content["model"]["type"]

    @property
    def size(self):
        """(width, height) of its image in pixels; None: it does not say."""
        lens = self._content["model"]
        return (lens["width"], lens["height"]) if "width" in lens else None

    @property
    def values(self):
        """Its numbers by name, in the frame M."""
        return {key: value for key, value in self._content["model"].items()
                if key not in ("type", "width", "height", "position", "rotation")}

    @property
    def position(self):
        """Of the camera in M [m]."""
        return np.array(self._content["model"].get("position", self._content["model"].get("C")), dtype=float)

    @property
    def json(self):
        """The model as JSON text."""
        return self._json

    def with_size(self, size):
        """The model with a size of its image, where it has none of its own. See scaled()."""
        if self.size is not None:
            reject(self._label, "the size", size, f"its own, {self.size}, or scaled()")
        content = json.loads(self._json)
        content["model"]["width"], content["model"]["height"] = _size(size, self._label)
        return CameraModel.from_json(json.dumps(content))

    def scaled(self, size):
        """The model for an image of another size (width, height) and the same shape and field of view."""
        model = CameraModel.from_json(self._json)
        _check(model._vtk.Scale(*_size(size, self._label)))
        model._describe()
        return model

    # --- What it does --------------------------------------------------------------------------

    def project(self, points, in_camera=False, derivatives=False):
        """Pixels (..., 2) of points (..., 3) [m], NaN where the lens sees nothing. A pixel may lie outside the image.

        in_camera: the points are in the camera's axes C; default: in the model's frame M. derivatives=True: also the
        derivatives (..., 2, 3) of the pixels by the points."""
        array, shape = _array(points, 3, "the points", self._label)
        pixels, slopes = _doubles(), _doubles() if flag(derivatives, "derivatives", self._label) else None
        _check(self._vtk.Project(_wrapped(array), flag(in_camera, "in_camera", self._label), pixels, slopes))
        found = _numpy(pixels, 2).reshape(shape + (2,))
        return (found, _numpy(slopes, 6).reshape(shape + (2, 3))) if derivatives else found

    def rays(self, pixels, in_camera=False):
        """Origins (..., 3) [m] and unit directions (..., 3) of the rays of pixels (..., 2); NaN where there is none."""
        array, shape = _array(pixels, 2, "the pixels", self._label)
        rays = _doubles()
        _check(self._vtk.Unproject(_wrapped(array), flag(in_camera, "in_camera", self._label), rays))
        found = _numpy(rays, 6)
        return found[:, :3].reshape(shape + (3,)), found[:, 3:].reshape(shape + (3,))

    def check(self):
        """LensCheck: where it folds, what its image covers. The model must have a size."""
        values = _doubles()
        _check(self._vtk.Check(values))
        limit, *others = (float(each) for each in _numpy(values, 1)[:, 0])
        return LensCheck(limit, to_bytes(self._vtk.GetFieldEnd()).decode(), *others)

    def convert(self, type):
        """Conversion: the nearest model of another type, by least squares over the directions of its image, with the
        residual. A moving pupil is lost, which `pupil_shift` states."""
        model = CameraModel.from_json(self._json)
        values = _doubles()
        _check(model._vtk.Convert(text(type, "the type", self._label), values))
        model._describe()
        return Conversion(model, *(float(each) for each in _numpy(values, 1)[:, 0]))

    def __eq__(self, other):
        return isinstance(other, CameraModel) and self._content == other._content

    def __hash__(self):
        return hash(self._json)

    def __repr__(self):
        size = f", {self.size[0]} x {self.size[1]}" if self.size else ""
        return f"<dspace.CameraModel {self.name!r}, {self.type}{size}>"


def put_model(message, model, size=None, scale=False, about=None):
    """Writes a CameraModel, or None, with a size into a CameraModel message."""
    if model is not None:
        if not isinstance(model, CameraModel):
            reject(about, "the model", model, "a dspace.CameraModel", WrongType)
        message.model = model.json
    if size is not None:
        message.width, message.height = _size(size, about)
    message.scale = flag(scale, "scale", about)
