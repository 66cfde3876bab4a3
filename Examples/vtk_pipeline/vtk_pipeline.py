"""Contours and streamlines of a VTK source ride on a moving spacecraft. One viewport shows them, another hides them.

    ./dspace python Examples/vtk_pipeline/vtk_pipeline.py --out plasma.png
    ./dspace python Examples/vtk_pipeline/vtk_pipeline.py --out plasma.mp4 --seconds 8
    ./dspace python Examples/vtk_pipeline/vtk_pipeline.py --model probe.glb --scale 0.5 --record run.dspace

VTK's analytic source stands for the density of a plasma about the craft; a simulation would read its own data. The
pipelines are ordinary VTK. Dspace draws their output as objects on the craft's frame and updates them by itself when a
filter changes: here the densities of the contours.
"""
import argparse
import contextlib

import numpy as np
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersCore import vtkContourFilter, vtkTubeFilter
from vtkmodules.vtkFiltersFlowPaths import vtkStreamTracer
from vtkmodules.vtkFiltersGeneral import vtkGradientFilter, vtkTransformPolyDataFilter
from vtkmodules.vtkFiltersSources import vtkPointSource
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource

import dspace

RATE = 25  # pictures per second of the movie
EXTENT = 10  # cells of the source on each side of the craft
CELL = 0.6  # edge of a cell [m]
ORBIT, PERIOD = 40.0, 60.0  # radius [m] and time of a turn [s]


class Plasma:
    """Two pipelines on one source: surfaces of equal density, and lines along its gradient as tubes."""

    def __init__(self):
        self.source = vtkRTAnalyticSource()
        self.source.SetWholeExtent(*(EXTENT * np.array([-1, 1] * 3)).tolist())
        self.contours = vtkContourFilter()
        self.contours.SetInputConnection(self.source.GetOutputPort())
        gradient = vtkGradientFilter()
        gradient.SetInputConnection(self.source.GetOutputPort())
        gradient.SetInputScalars(0, "RTData")
        gradient.SetResultArrayName("Gradient")
        seeds = vtkPointSource()
        seeds.SetRadius(0.8 * EXTENT)
        seeds.SetNumberOfPoints(60)
        self.lines = vtkStreamTracer()
        self.lines.SetInputConnection(gradient.GetOutputPort())
        self.lines.SetSourceConnection(seeds.GetOutputPort())
        self.lines.SetInputArrayToProcess(0, 0, 0, 0, "Gradient")
        self.lines.SetMaximumPropagation(EXTENT)
        self.lines.SetIntegrationDirectionToBoth()
        tubes = vtkTubeFilter()
        tubes.SetInputConnection(self.lines.GetOutputPort())
        tubes.SetRadius(0.08)
        tubes.SetNumberOfSides(8)
        self.surfaces, self.tubes = self._in_metres(self.contours), self._in_metres(tubes)
        self.colors = vtkLookupTable()
        self.colors.SetHueRange(0.66, 0.0)
        self.colors.SetRange(90, 280)
        self.colors.Build()
        self.set_density(190)

    @staticmethod
    def _in_metres(filter):
        scale = vtkTransform()
        scale.Scale(CELL, CELL, CELL)
        scaled = vtkTransformPolyDataFilter()
        scaled.SetTransform(scale)
        scaled.SetInputConnection(filter.GetOutputPort())
        return scaled

    def set_density(self, density):
        self.contours.SetValue(0, density)
        self.contours.SetValue(1, density + 40)


class Flight:
    """A craft on a circle about a globe, with the plasma on its frame, seen in two viewports."""

    def __init__(self, session, size=(640, 480), model=None, scale=1.0):
        self.scene = scene = session.scene()
        self.plasma = Plasma()
        scene.sun.direction = (0.5, -0.7, 0.6)
        scene.add_sphere(25, resolution=128, color=(0.45, 0.55, 0.7), name="globe")
        self.craft = scene.add_frame("craft")
        if model:
            scene.load(model, frame=self.craft, scale=scale, up="y", name="craft")
        else:
            self._build()
        self.fragment = scene.add_fragment("plasma", ornamental=True)
        look = dict(frame=self.craft, ornamental=True, fragment=self.fragment, lookup_table=self.plasma.colors)
        self.surfaces = scene.add_polydata(self.plasma.surfaces, array="RTData", name="density", opacity=0.35, **look)
        self.tubes = scene.add_polydata(self.plasma.tubes, array="RTData", name="streamlines", **look)
        camera = scene.add_camera("follow", frame=self.craft, chase=dict(offset=(-10, -16, 9), target=(0, 0, 0)))
        self.views = [scene.add_viewport(size, camera, name=name) for name in ("analyst", "camera")]
        for view in self.views:
            view.set_background((0.01, 0.01, 0.02))
        self.views[1].hide(self.fragment)  # as a camera would see the craft
        self.move(0.0)

    def _build(self):
        """A box with two solar arrays, which are parts of one mesh."""
        scene = self.scene
        scene.add_box((1.6, 1.6, 2.4), frame=self.craft, color="goldenrod", name="bus")
        scene.add_cylinder(0.6, 0.5, frame=self.craft, position=(0, 0, 1.4), color="lightgrey", name="antenna")
        panel = np.array([[0.8, -0.9, 0], [4.5, -0.9, 0], [4.5, 0.9, 0], [0.8, 0.9, 0]])
        arrays = scene.add_mesh(np.concatenate((panel, panel * (-1, -1, 1))),
                                {"solar_left": [[0, 1, 2], [0, 2, 3]], "solar_right": [[4, 5, 6], [4, 6, 7]]},
                                frame=self.craft, name="arrays", color="midnightblue")
        arrays.part("solar_left").set(emissive=(0.05, 0.05, 0.2))

    def move(self, at):
        """The state at a time [s]."""
        self.scene.time = at
        angle = 2 * np.pi * at / PERIOD
        q = dspace.frames.poses.quaternion_of_axis("z", np.degrees(angle) + 90)
        self.craft.pose = dspace.Pose(position=(ORBIT * np.cos(angle), ORBIT * np.sin(angle), 0), quaternion=q)
        self.plasma.set_density(190 + 30 * np.sin(2 * angle))  # the objects follow before the next picture

    def picture(self):
        """Both viewports side by side."""
        return np.concatenate([view.image() for view in self.views], axis=1)


def save(picture, path):
    """Writes a PNG with VTK's own writer."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkIOImage import vtkPNGWriter
    image = vtkImageData()
    image.SetDimensions(picture.shape[1], picture.shape[0], 1)
    image.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(picture[::-1].reshape(-1, 3)), deep=True))
    writer = vtkPNGWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(image)
    writer.Write()
    if writer.GetErrorCode():
        raise OSError(f"{path} cannot be written")


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--out", default="plasma.png", help="a .png of the end, or a .mp4 or .webm of all (default: %(default)s)")
    parser.add_argument("--seconds", type=float, default=4.0, help="length of the flight (default: %(default)s)")
    parser.add_argument("--size", default="640x480", help="of each of the two pictures (default: %(default)s)")
    parser.add_argument("--model", help="a glTF file instead of the built-in craft")
    parser.add_argument("--scale", type=float, default=1.0, help="metres per unit of the model (default: %(default)s)")
    parser.add_argument("--record", help="a new recording, which plays without this program and without its pipelines")
    options = parser.parse_args(words)
    width, height = (int(word) for word in options.size.split("x"))
    steps = max(1, round(options.seconds * RATE))
    movie = options.out.rpartition(".")[2] in ("mp4", "webm")
    with dspace.Session() as session, contextlib.ExitStack() as stack:
        flight = Flight(session, (width, height), options.model, options.scale)
        if options.record:
            stack.enter_context(session.record(options.record))
        if movie:
            from dspace.movies.encode import Encoder
            encoder = stack.enter_context(Encoder(options.out, (2 * width, height), RATE))
        for step in range(steps + 1):
            flight.move(step / RATE)
            if movie:
                encoder.add(flight.picture())
        if not movie:
            save(flight.picture(), options.out)
        print(f"{options.out}: {flight.surfaces.triangles} triangles of contours, {flight.tubes.triangles} of streamlines")


if __name__ == "__main__":
    main()
