"""Pictures of VTK's objects in a scene."""
import subprocess
import sys

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPiecewiseFunction, vtkPolyData
from vtkmodules.vtkFiltersSources import vtkConeSource
from vtkmodules.vtkRenderingCore import (vtkActor, vtkColorTransferFunction, vtkGlyph3DMapper, vtkImageSlice, vtkVolume,
                                         vtkVolumeProperty)
from vtkmodules.vtkRenderingImage import vtkImageResliceMapper
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - its factories
import vtkmodules.vtkRenderingVolumeOpenGL2  # noqa: F401
from vtkmodules.vtkRenderingVolume import vtkGPUVolumeRayCastMapper

import dspace
from pictures.paths import IMAGES, ROOT


def pipeline():
    subprocess.run([sys.executable, ROOT / "Examples" / "vtk_pipeline" / "vtk_pipeline.py", "--seconds", "2", "--out",
                    IMAGES / "vtk_pipeline.png"], check=True)


def grid(side):
    x = np.linspace(-1, 1, side)
    return np.meshgrid(x, x, x, indexing="ij")


def image(values, width):
    """A cube of values about the origin, `width` metres wide."""
    side = values.shape[0]
    data = vtkImageData()
    data.SetDimensions(side, side, side)
    data.SetSpacing(*[width / (side - 1)] * 3)
    data.SetOrigin(*[-width / 2] * 3)
    data.GetPointData().SetScalars(numpy_to_vtk(values.ravel(order="F").astype(np.float32), deep=True))
    return data


def plume():
    """A cone of gas behind the nozzle, as a volume."""
    x, y, z = grid(64)
    along = (1 - z) / 2
    density = np.exp(-(x ** 2 + y ** 2) / (0.06 + 0.4 * along) ** 2) * np.exp(-2.0 * along)
    mapper = vtkGPUVolumeRayCastMapper()
    mapper.SetInputData(image(density, 3.0))
    colors, opacity = vtkColorTransferFunction(), vtkPiecewiseFunction()
    for value, color in ((0.0, (0.2, 0.3, 0.9)), (0.3, (0.9, 0.6, 0.3)), (1.0, (1.0, 1.0, 0.9))):
        colors.AddRGBPoint(value, *color)
    for value, alpha in ((0.0, 0.0), (0.02, 0.0), (0.1, 0.35), (1.0, 0.95)):
        opacity.AddPoint(value, alpha)
    look = vtkVolumeProperty()
    look.SetColor(colors)
    look.SetScalarOpacity(opacity)
    look.SetScalarOpacityUnitDistance(0.4)
    look.SetInterpolationTypeToLinear()
    volume = vtkVolume()
    volume.SetMapper(mapper)
    volume.SetProperty(look)
    return volume


def arrows():
    """A field of directions about the craft, as glyphs."""
    turn, up = np.meshgrid(np.arange(0, 360, 30), np.linspace(-0.8, 0.8, 5))
    turn = np.radians(turn.ravel())
    places = np.column_stack((2.1 * np.cos(turn), 2.1 * np.sin(turn), up.ravel()))
    data, points = vtkPolyData(), vtkPoints()
    points.SetData(numpy_to_vtk(places, deep=True))
    data.SetPoints(points)
    field = numpy_to_vtk(np.column_stack((-np.sin(turn), np.cos(turn), 0.4 * up.ravel())), deep=True)
    field.SetName("field")
    data.GetPointData().AddArray(field)
    cone = vtkConeSource()
    cone.SetHeight(0.3)
    cone.SetRadius(0.07)
    cone.SetResolution(16)
    mapper = vtkGlyph3DMapper()
    mapper.SetInputData(data)
    mapper.SetSourceConnection(cone.GetOutputPort())
    mapper.SetOrientationArray("field")
    mapper.SetScaling(False)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.95, 0.75, 0.2)
    return actor


def section():
    """A section through the plume's densities, as an image slice."""
    x, y, z = grid(64)
    mapper = vtkImageResliceMapper()
    mapper.SetInputData(image(np.hypot(x, y) + 0.3 * np.sin(6 * z), 2.6))
    mapper.SliceAtFocalPointOff()
    mapper.SliceFacesCameraOff()
    mapper.GetSlicePlane().SetNormal(1, 0, 0)
    mapper.GetSlicePlane().SetOrigin(0, 0, 0)
    table = vtkLookupTable()
    table.SetRange(0, 1.5)
    table.SetHueRange(0.66, 0.0)
    table.Build()
    slice_ = vtkImageSlice()
    slice_.SetMapper(mapper)
    slice_.GetProperty().SetLookupTable(table)
    slice_.GetProperty().UseLookupTableScalarRangeOn()
    return slice_


def props():
    """A volume, glyphs and an image slice about a craft of ordinary objects."""
    with dspace.Session() as session:
        scene = session.scene()
        craft = scene.add_frame("craft")
        scene.add_box((1.2, 1.2, 1.6), frame=craft, color="#b8bcc4")
        scene.add_cylinder(0.35, 0.5, frame=craft, position=(0, 0, -1.0), color="#70747c")
        for side in (-1, 1):
            scene.add_box((0.04, 2.6, 1.0), frame=craft, position=(0, side * 2.1, 0.2), color="#24407a")
        scene.add_prop(plume(), frame=craft, position=(0, 0, -2.75), name="plume")
        scene.add_prop(arrows(), frame=craft, position=(0, 0, 0), name="field")
        scene.add_prop(section(), frame=craft, position=(-2.6, 0, 0.6), name="section")
        scene.sun.set(direction=(0.7, -0.5, 0.5), irradiance=1.3 * 1361)
        scene.add_camera(eye=(7.5, -5.2, 2.2), target=(-0.3, 0, -1.0), fov_deg=36)
        view = scene.add_viewport((640, 440), samples=3)
        view.set_background((0.02, 0.02, 0.04))
        view.save(IMAGES / "vtk_props.png")


def own_object():
    """The solar sail of Examples/own_object, built with this tree."""
    import tempfile
    from pathlib import Path
    with tempfile.TemporaryDirectory() as folder:
        installed, build = Path(folder, "installed"), Path(folder, "build")
        for command in (["cmake", "--install", ROOT / "build/release", "--prefix", installed],
                        ["cmake", "-S", ROOT / "Examples/own_object", "-B", build, "-DCMAKE_BUILD_TYPE=Release",
                         f"-DCMAKE_PREFIX_PATH={installed}"], ["cmake", "--build", build]):
            subprocess.run([str(part) for part in command], check=True, stdout=subprocess.DEVNULL)
        subprocess.run([sys.executable, ROOT / "Examples/own_object/own_object.py", build / "libsolar_sail.so",
                        IMAGES / "own_object.png"], check=True)
