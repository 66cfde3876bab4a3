"""Objects of VTK's polydata: against VTK's own mapper with the same camera, live pipelines, recordings, the wire."""
import subprocess
import sys
import warnings

import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkContourFilter, vtkPolyDataNormals, vtkStripper, vtkTriangleFilter
from vtkmodules.vtkFiltersProgrammable import vtkProgrammableFilter
from vtkmodules.vtkFiltersSources import vtkPlaneSource, vtkSphereSource
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

import dspace
from served_support import Served


@pytest.fixture
def view(scene):
    camera = scene.add_camera(eye=(3, -4, 3), target=(0, 0, 0), fov_deg=40)
    view = scene.add_viewport((300, 240), camera, samples=1)
    view.set_background((0.1, 0.2, 0.3))
    return view


def polydata(points, scalars=None, cell_scalars=None, **cells):
    """cells: verts, lines, polys, strips as lists of lists of indices."""
    data = vtkPolyData()
    place = vtkPoints()
    place.SetDataTypeToDouble()
    for point in points:
        place.InsertNextPoint(point)
    data.SetPoints(place)
    for kind, setter in (("verts", data.SetVerts), ("lines", data.SetLines), ("polys", data.SetPolys),
                         ("strips", data.SetStrips)):
        if kind in cells:
            array = vtkCellArray()
            for each in cells[kind]:
                array.InsertNextCell(len(each), each)
            setter(array)
    for values, to in ((scalars, data.GetPointData()), (cell_scalars, data.GetCellData())):
        if values is not None:
            array = numpy_to_vtk(np.asarray(values, float), deep=True)
            array.SetName("values")
            to.SetScalars(array)
    return data


def rainbow(low, high):
    table = vtkLookupTable()
    table.SetHueRange(0.66, 0.0)
    table.SetRange(low, high)
    table.Build()
    return table


def by_vtk(view, data, table=None, **look):
    """The picture with a vtkActor of the data in the same viewport, lighting off."""
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    if table is not None:
        mapper.SetLookupTable(table)
        mapper.UseLookupTableScalarRangeOn()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    actor.GetProperty().SetColor(0.8, 0.8, 0.8)
    actor.GetProperty().SetPointSize(look.get("point_size", 3))
    actor.GetProperty().SetLineWidth(look.get("line_width", 1))
    view.run(lambda window, renderer: renderer.AddActor(actor))
    image = view.image().astype(int)
    view.run(lambda window, renderer: renderer.RemoveActor(actor))
    return image


def by_dspace(scene, view, data, table=None, **look):
    made = scene.add_polydata(data, lookup_table=table, lit=False, **look)
    image = view.image().astype(int)
    made.remove()
    return image


def interior(image, background):
    """Pixels whose neighbors all are of the object: edges may be sampled otherwise."""
    drawn = (np.abs(image - background).max(axis=2) > 0)
    inner = drawn.copy()
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            inner &= np.roll(drawn, (dy, dx), (0, 1))
    return inner


def expect_the_same(scene, view, data, table=None, least=2000, **look):
    background = view.image().astype(int)
    ours, theirs = by_dspace(scene, view, data, table, **look), by_vtk(view, data, table, **look)
    inner = interior(theirs, background) & interior(ours, background)
    assert inner.sum() >= least
    assert np.abs(ours - theirs)[inner].max() <= 1
    drawn = [(np.abs(each - background).max(axis=2) > 0).sum() for each in (ours, theirs)]
    assert abs(drawn[0] - drawn[1]) <= 0.02 * drawn[1]  # the same shape, but for pixels at edges


def sphere(theta=24, phi=16):
    source = vtkSphereSource()
    source.SetThetaResolution(theta)
    source.SetPhiResolution(phi)
    source.Update()
    data = vtkPolyData()
    data.DeepCopy(source.GetOutput())
    return data


def test_point_scalars_equal_vtk(scene, view):
    data = sphere()
    z = vtk_to_numpy(data.GetPoints().GetData())[:, 2].astype(float)
    array = numpy_to_vtk(z, deep=True)
    array.SetName("z")
    data.GetPointData().SetScalars(array)
    expect_the_same(scene, view, data, rainbow(-0.5, 0.5))


def test_cell_scalars_equal_vtk(scene, view):
    data = sphere(7, 5)
    array = numpy_to_vtk(np.random.default_rng(1).uniform(0, 1, data.GetNumberOfCells()), deep=True)
    array.SetName("c")
    data.GetCellData().SetScalars(array)
    # The interior of faces: a pixel near another face's edge may be of the other one.
    background = view.image().astype(int)
    ours, theirs = by_dspace(scene, view, data, rainbow(0, 1)), by_vtk(view, data, rainbow(0, 1))
    same = np.ones(theirs.shape[:2], bool)
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            same &= (np.roll(theirs, (dy, dx), (0, 1)) == theirs).all(axis=2)
    same &= (theirs != background).any(axis=2)
    assert same.sum() > 1000 and np.abs(ours - theirs)[same].max() <= 1


def test_strips_and_cell_scalars_of_mixed_cells_equal_vtk(scene, view):
    data = sphere()
    stripper = vtkStripper()
    stripper.SetInputData(data)
    stripper.Update()
    strips = stripper.GetOutput()
    assert strips.GetNumberOfStrips() > 0
    expect_the_same(scene, view, strips)
    points = [(-1, -1, 0), (0, -1, 0), (0, 0, 0), (-1, 0, 0), (0.2, -1, 0), (1.2, -1, 0), (0.2, 0, 0), (1.2, 0, 0),
              (0, 0.5, 0.5)]
    mixed = polydata(points, verts=[[8]], lines=[[0, 5], [3, 2, 7]], polys=[[0, 1, 2, 3]], strips=[[4, 5, 6, 7]],
                     cell_scalars=[0, 0.2, 0.4, 0.6, 1.0])
    expect_the_same(scene, view, mixed, rainbow(0, 1), point_size=9, line_width=5)


def test_lines_and_vertices_with_point_scalars_equal_vtk(scene, view):
    points = [(-1, 0, 0), (1, 0, 0), (0, 1, 0), (0.5, 0.5, 1)]
    data = polydata(points, scalars=[0, 1, 0.5, 0.25], verts=[[0], [3, 2]], lines=[[0, 1, 2]])
    expect_the_same(scene, view, data, rainbow(0, 1), least=200, point_size=15, line_width=9)


CONCAVE = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (1, 0.5, 0), (0, 2, 0)]
DART = [(0, 0, 0), (2, -1, 0), (0.5, 0, 0), (2, 1, 0)]


@pytest.mark.parametrize("points", (CONCAVE, DART, DART[1:] + DART[:1], DART[::-1]))
def test_concave_polygons_cover_what_they_enclose(scene, points):
    """Against the polygon's own area by the shoelace formula."""
    camera = scene.add_camera(eye=(1, 0.5, 5), target=(1, 0.5, 0), up=(0, 1, 0), height=4)
    view = scene.add_viewport((400, 400), camera, samples=1)
    scene.add_polydata(polydata(points, polys=[list(range(len(points)))]), lit=False, color="white")
    p = np.array(points)
    area = 0.5 * abs(np.sum(p[:, 0] * np.roll(p[:, 1], -1) - p[:, 1] * np.roll(p[:, 0], -1)))
    assert (view.image()[..., 0] == 255).sum() / 1e4 == pytest.approx(area, rel=0.01)


def test_normals_of_points_and_cells_are_used(scene, view):
    """A lit plane whose normals say that it faces elsewhere."""
    plane = vtkPlaneSource()
    plane.Update()
    down = vtkPolyData()
    down.DeepCopy(plane.GetOutput())
    lit = scene.add_polydata(down)
    bright = view.image()[120, 150].astype(int)
    down.GetPointData().SetNormals(numpy_to_vtk(np.tile([[3.0, 0, 0]], (down.GetNumberOfPoints(), 1)), deep=True))
    lit.update()  # of length 3: they are made unit
    dim = view.image()[120, 150].astype(int)
    assert np.abs(bright - dim).max() > 20
    down.GetPointData().SetNormals(None)
    down.GetCellData().SetNormals(numpy_to_vtk(np.array([[1.0, 0, 0]]), deep=True))
    lit.update()
    assert np.abs(view.image()[120, 150].astype(int) - dim).max() <= 1
    down.GetCellData().SetNormals(numpy_to_vtk(np.array([[0.0, 0, 0]]), deep=True))
    with pytest.warns(dspace.DspaceWarning, match="normals of its cells hold some without a direction"):
        lit.update()
    assert np.abs(view.image()[120, 150].astype(int) - bright).max() <= 1


def test_vectors_and_bytes_color_as_vtk_does(scene, view):
    data = sphere()
    vectors = np.random.default_rng(4).normal(size=(data.GetNumberOfPoints(), 3))
    for name, values in (("vectors", vectors), ("lengths", np.linalg.norm(vectors, axis=1)),
                         ("bytes", np.clip(100 * vectors + 128, 0, 255).astype(np.uint8))):
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    assert np.array_equal(by_dspace(scene, view, data, array="vectors"), by_dspace(scene, view, data, array="lengths"))
    assert not np.array_equal(by_dspace(scene, view, data, array="vectors"), by_dspace(scene, view, data, array=""))
    data.GetPointData().SetActiveScalars("bytes")
    expect_the_same(scene, view, data)


def test_to_polydata_gives_back_what_was_drawn(scene):
    data = sphere()
    got = scene.add_polydata(data, part="ball").to_polydata()
    assert got.GetNumberOfPoints() == data.GetNumberOfPoints() and got.GetNumberOfPolys() == data.GetNumberOfPolys()
    assert np.array_equal(vtk_to_numpy(got.GetPoints().GetData()), vtk_to_numpy(data.GetPoints().GetData()))
    assert np.allclose(vtk_to_numpy(got.GetPointData().GetNormals()), vtk_to_numpy(data.GetPointData().GetNormals()), atol=1e-6)
    assert got.GetCellData().GetAbstractArray("Part").GetValue(0) == "ball"
    box = scene.add_box((1, 2, 3)).to_polydata()
    assert np.allclose(box.GetBounds(), (-0.5, 0.5, -1, 1, -1.5, 1.5))


# --- Pipelines -------------------------------------------------------------------------------------

@pytest.fixture
def contour():
    source = vtkRTAnalyticSource()
    source.SetWholeExtent(-5, 5, -5, 5, -5, 5)
    contour = vtkContourFilter()
    contour.SetInputConnection(source.GetOutputPort())
    contour.SetValue(0, 200)
    return contour


def test_a_changed_pipeline_is_drawn_without_a_call(scene, view, contour):
    made = scene.add_polydata(contour.GetOutputPort(), stretch=0.2)
    before, triangles = view.image(), made.triangles
    contour.SetValue(0, 230)
    assert not np.array_equal(view.image(), before) and made.triangles != triangles
    contour.GetInputConnection(0, 0).GetProducer().SetMaximum(300)  # upstream
    changed = view.image()
    assert not np.array_equal(changed, before)
    updates = []
    contour.AddObserver("EndEvent", lambda *_: updates.append(1))
    for _ in range(5):
        view.image()
    assert updates == []  # nothing changed
    still = scene.add_polydata(contour, live=False, name="still")
    triangles = still.triangles
    contour.SetValue(0, 150)
    assert still.triangles == triangles
    still.update()
    assert still.triangles != triangles
    made.remove()
    contour.SetValue(0, 151)
    view.image()  # nothing is left to update


def test_a_pipeline_that_fails_is_an_exception_and_changes_nothing(scene, view, refused, tmp_path):
    sphere = vtkSphereSource()
    wrong = vtkProgrammableFilter()
    wrong.SetInputConnection(sphere.GetOutputPort())

    def work():
        wrong.GetPolyDataOutput().ShallowCopy(wrong.GetPolyDataInput())
        if fails:
            raise ZeroDivisionError("no data")

    fails = True
    wrong.SetExecuteMethod(work)
    with refused(dspace.InvalidArgument, "polydata 'p': the pipeline raised ZeroDivisionError: no data"):
        scene.add_polydata(wrong, name="p")
    fails = False
    wrong.Modified()
    made = scene.add_polydata(wrong, name="p")
    before = view.image()
    fails = True
    wrong.Modified()
    with refused(dspace.InvalidArgument, "object 'p': the pipeline raised ZeroDivisionError: no data"):
        view.image()  # also what `refused` compares: the object as it was
    assert np.array_equal(view.image(), before)  # told once
    with refused(dspace.InvalidArgument, "ZeroDivisionError"):
        made.update(wrong)
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(tmp_path / "missing.vtp"))
    with refused(dspace.InvalidArgument, "Error opening file"):
        scene.add_polydata(reader)

    class Wrong(VTKPythonAlgorithmBase):
        def __init__(self):
            super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkPolyData")

        def RequestData(self, request, inputs, outputs):
            raise KeyError("nothing")

    with refused(dspace.InvalidArgument, "nothing"):
        scene.add_polydata(Wrong())


def test_a_warning_of_a_pipeline_is_a_warning(scene):
    from vtkmodules.vtkCommonCore import vtkOutputWindow
    sphere = vtkSphereSource()
    wordy = vtkProgrammableFilter()
    wordy.SetInputConnection(sphere.GetOutputPort())

    def work():
        wordy.GetPolyDataOutput().ShallowCopy(wordy.GetPolyDataInput())
        vtkOutputWindow.GetInstance().DisplayWarningText("Warning: of doubtful quality\n")

    wordy.SetExecuteMethod(work)
    with pytest.warns(dspace.DspaceWarning, match="polydata 'p': VTK warned: .*of doubtful quality"):
        scene.add_polydata(wordy, name="p")


def test_an_output_that_is_no_polydata_is_refused(scene, refused):
    with refused(dspace.WrongType, "the output of the source is 'vtkImageData'; accepted: vtkPolyData"):
        scene.add_polydata(vtkRTAnalyticSource())


def test_a_warning_in_run_is_a_warning(view):
    from vtkmodules.vtkCommonCore import vtkOutputWindow
    with pytest.warns(dspace.DspaceWarning, match="VTK reported: .*of doubt"):
        view.run(lambda *_: vtkOutputWindow.GetInstance().DisplayWarningText("Warning: of doubt"))
    with pytest.raises(dspace.Internal, match="VTK reported: .*of failure"):
        view.run(lambda *_: vtkOutputWindow.GetInstance().DisplayErrorText("Error: of failure"))


class Pyvistalike:
    """A mesh of PyVista that is no PolyData."""
    def extract_surface(self):
        return sphere()


def test_a_mesh_with_extract_surface_is_taken(scene):
    assert scene.add_polydata(Pyvistalike()).triangles == 24 * 14 * 2


BAD = [
    (lambda: 5, {}, "the source is 5; accepted: a vtkPolyData, a VTK algorithm"),
    (vtkPolyData, {}, "the polydata has no points; accepted: 1 or more"),
    (lambda: polydata([(0, 0, 0)]), {}, "the polydata has no cells"),
    (lambda: polydata([(0, 0, float("nan"))], verts=[[0]]), {}, "point 0 is [0.0, 0.0, nan]; accepted: finite numbers"),
    (sphere, {"array": "density"}, "there is no array 'density'; accepted: 'Normals'"),
    (sphere, {"array": 3}, "the array is 3; accepted: a str"),
    (sphere, {"lookup_table": "jet"}, "the lookup table is 'jet'; accepted: a vtkScalarsToColors"),
    (sphere, {"array": "Normals", "low": 2, "high": 1}, "low is 2 and high 1; accepted: low <= high"),
    (sphere, {"low": float("nan")}, "accepted: finite numbers"),
    (sphere, {"live": 1}, "live is 1; accepted: True or False"),
    (sphere, {"part": 1}, "the part is 1; accepted: a str"),
    (sphere, {"levels": [sphere()]}, "a level is"),
    (lambda: polydata([(0, 0, 0)], verts=[[0]], scalars=[0, 1, 2]), {}, "the number of values of array 'values' is 3; "
     "accepted: 1, one for each point"),
]


@pytest.mark.parametrize("source, given, text", BAD, ids=[text[:40] for _, _, text in BAD])
def test_bad_input_is_refused_by_name(scene, refused, source, given, text):
    with refused(dspace.Error, text):
        scene.add_polydata(source(), name="bad", **given)
    made = scene.add_polydata(sphere(), name="good")
    if not given:
        with refused(dspace.Error, text):
            made.update(source())


def test_recorded_and_served_pictures_are_equal_to_the_byte(session, scene, view, contour, tmp_path):
    def simulate(session, contour, record=None):
        scene = session.scene()
        frame = scene.add_frame("craft")
        scene.add_polydata(contour, stretch=0.2, frame=frame)
        camera = scene.add_camera(eye=(3, -4, 3), target=(0, 0, 0), fov_deg=40)
        view = scene.add_viewport((200, 160), camera, name="main", samples=1)
        pictures = []
        for step in range(3):
            scene.time = step
            contour.SetValue(0, 180 + 20 * step)
            frame.pose = dspace.Pose(position=(0.1 * step, 0, 0))
            pictures.append(view.image())
        return pictures

    path = tmp_path / "run.dspace"
    with dspace.Session() as local, local.record(path):
        expected = simulate(local, contour)
    assert not np.array_equal(expected[0], expected[2])
    with dspace.Playback(path) as run:
        for step in (2, 0, 1):
            run.seek(step)
            assert np.array_equal(run.session.viewports["main"].image(), expected[step])
    with Served(tmp_path) as server, dspace.connect(server.address) as remote:
        assert all(np.array_equal(a, b) for a, b in zip(simulate(remote, contour), expected))


def test_the_example_makes_its_pictures(tmp_path):
    import pathlib
    example = pathlib.Path(__file__).resolve().parents[3] / "Examples" / "vtk_pipeline" / "vtk_pipeline.py"
    out, run = tmp_path / "plasma.png", tmp_path / "run.dspace"
    done = subprocess.run([sys.executable, "-W", "error", example, "--seconds", "0.2", "--size", "160x120", "--out", out,
                           "--record", run], capture_output=True, text=True)
    assert done.returncode == 0 and not done.stderr, done.stderr
    assert "triangles of contours" in done.stdout
    with dspace.Playback(run) as playback:
        playback.seek(0.2)
        shown, hidden = (playback.session.viewports[name].image().astype(int) for name in ("analyst", "camera"))
        plain = playback.session.viewports["analyst"].image(hide="plasma").astype(int)
    assert np.array_equal(plain, hidden) and (np.abs(shown - hidden).max(axis=2) > 10).mean() > 0.1
