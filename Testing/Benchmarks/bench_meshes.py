"""Arrays to a picture: a mesh of a million triangles is added, and one of 100,000 is updated, each against a vtkActor
of the same data in the same viewport."""
import statistics
import time

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

import dspace

PAIRS = 5


def grid(n):
    """A wavy sheet of 2 n n triangles: points, unit normals, triangles."""
    line = np.linspace(-1, 1, n + 1)
    x, y = np.meshgrid(line, line)
    points = np.stack((x, y, 0.1 * np.sin(6 * x)), -1).reshape(-1, 3)
    normals = np.stack((-0.6 * np.cos(6 * x), 0 * x, 0 * x + 1), -1).reshape(-1, 3)
    first = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    triangles = np.concatenate([np.stack((first, first + 1, first + n + 2), -1),
                                np.stack((first, first + n + 2, first + n + 1), -1)])
    return points, normals / np.linalg.norm(normals, axis=1)[:, None], triangles


def put(data, points, normals, triangles=None):
    place = vtkPoints()
    place.SetData(numpy_to_vtk(points.astype(np.float32), deep=True))
    data.SetPoints(place)
    data.GetPointData().SetNormals(numpy_to_vtk(normals.astype(np.float32), deep=True))
    if triangles is not None:
        cells = vtkCellArray()
        cells.SetData(3, numpy_to_vtkIdTypeArray(np.ascontiguousarray(triangles.ravel()), deep=True))
        data.SetPolys(cells)
    data.Modified()


def timed(work):
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def report(what, pairs):
    ratios = [a / b for a, b in pairs]
    print(f"{what}: ratio {statistics.median(ratios):.2f} ({min(ratios):.2f}..{max(ratios):.2f}), {len(pairs)} pairs; "
          f"{1e3 * statistics.median(a for a, _ in pairs):.0f} ms against "
          f"{1e3 * statistics.median(b for _, b in pairs):.0f} ms of a vtkActor; picture of 640 x 360 included")


def main():
    with dspace.Session() as session:
        scene = session.scene()
        camera = scene.add_camera(eye=(2, -3, 2), target=(0, 0, 0))
        view = scene.add_viewport((640, 360), camera, samples=1)
        view.image()

        def actor_of(arrays):
            data = vtkPolyData()
            put(data, *arrays)
            mapper = vtkPolyDataMapper()
            mapper.SetInputData(data)
            actor = vtkActor()
            actor.SetMapper(mapper)
            view.run(lambda window, renderer: renderer.AddActor(actor))
            view.image()
            return actor, data

        def remove(actor):
            view.run(lambda window, renderer: renderer.RemoveActor(actor))

        def add(arrays):
            points, normals, triangles = arrays
            mesh = scene.add_mesh(points, triangles, normals=normals)
            view.image()
            return mesh

        pairs = []
        for pair in range(PAIRS + 1):
            points, normals, triangles = grid(707)
            arrays = (points + (0, 0, 1e-3 * pair), normals, triangles)  # other arrays each time
            made = []
            ours = timed(lambda: made.append(add(arrays)))
            made.pop().remove()
            theirs = timed(lambda: made.append(actor_of(arrays)))
            remove(made.pop()[0])
            pairs.append((ours, theirs))
        report("mesh of 999,698 triangles added", pairs[1:])

        points, normals, triangles = grid(224)
        mesh = add((points, normals, triangles))
        pairs = []
        for pair in range(4 * PAIRS + 1):
            moved = points + (0, 0, 1e-3 * pair)
            mesh.visible = True
            ours = timed(lambda: (mesh.update(points=moved), view.image()))
            mesh.visible = False
            actor, data = actor_of((points, normals, triangles))
            theirs = timed(lambda: (put(data, moved, normals), view.run(lambda *_: None), view.image()))
            remove(actor)
            pairs.append((ours, theirs))
        report("mesh of 100,352 triangles updated", pairs[1:])


if __name__ == "__main__":
    main()
