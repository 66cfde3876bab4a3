"""Objects of VTK's polydata, and polydata of objects."""
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints, vtkScalarsToColors, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkTriangleFilter

from dspace._core.fields import flag, number, put, reject, text
from dspace._core.replies import warn
from dspace.errors import InvalidArgument, NotFound, WrongType
from dspace.objects import arrays
from dspace.objects.arrays import LINES, POINTS, TRIANGLES
from dspace.objects.graphics import GraphicsObject, put_settings
from dspace.objects.meshes import levels_of
from dspace.objects.pipelines import Source, guarded

_CELLS = "dspace cells"  # an array that is added to a copy: the cell that a triangle is of


class Coloring:
    """How scalars become colors: the arguments of Scene.add_polydata."""

    def __init__(self, array, lookup_table, low, high, about):
        self.array = None if array is None else text(array, "the array", about)
        if lookup_table is not None and not isinstance(lookup_table, vtkScalarsToColors):
            reject(about, "the lookup table", lookup_table, "a vtkScalarsToColors", WrongType)
        self.table = lookup_table
        self.low = None if low is None else number(low, "low", about)
        self.high = None if high is None else number(high, "high", about)
        if not all(np.isfinite([each for each in (self.low, self.high) if each is not None])):
            raise InvalidArgument(f"{about}: low is {low} and high {high}; accepted: finite numbers", about)

    def stamp(self):
        return 0 if self.table is None else self.table.GetMTime()

    def _find(self, data, about):
        """The array and whether it is of the points; None: there is none."""
        points, cells = data.GetPointData(), data.GetCellData()
        if self.array == "":
            return None, True
        if self.array is None:
            found = points.GetScalars()
            return (found, True) if found is not None else (cells.GetScalars(), False)
        for each, of_points in ((points, True), (cells, False)):
            found = each.GetAbstractArray(self.array)
            if found is not None:
                return found, of_points
        names = [each.GetArrayName(i) for each in (points, cells) for i in range(each.GetNumberOfArrays())]
        raise NotFound(f"{about}: there is no array {self.array!r}; accepted: "
                       + (", ".join(map(repr, names)) or "the data has none"), about)

    def colors(self, data, about):
        """The colors (n, 4), bytes, of the points or else of the cells of a vtkPolyData: (colors, of_points)."""
        scalars, of_points = self._find(data, about)
        if scalars is None:
            return None, True
        count = data.GetNumberOfPoints() if of_points else data.GetNumberOfCells()
        if scalars.GetNumberOfTuples() != count:
            reject(about, f"the number of values of array {scalars.GetName()!r}", scalars.GetNumberOfTuples(),
                   f"{count}, one for each {'point' if of_points else 'cell'}")
        low, high = self.low, self.high
        if self.table is None:
            table = vtkLookupTable()
            table.SetVectorModeToMagnitude()
            table.Build()
            if hasattr(scalars, "GetRange"):
                known = scalars.GetFiniteRange(0 if scalars.GetNumberOfComponents() == 1 else -1)
                low = known[0] if low is None else low
                high = known[1] if high is None else high
        elif low is not None or high is not None:
            table = self.table.NewInstance()
            table.DeepCopy(self.table)
        else:
            table = self.table
        if low is not None or high is not None:
            before = table.GetRange()
            low, high = before[0] if low is None else low, before[1] if high is None else high
            if low > high:
                raise InvalidArgument(f"{about}: low is {low:g} and high {high:g}; accepted: low <= high", about)
            table.SetRange(low, high)
            table.Build()
        mapped = guarded(about, lambda: table.MapScalars(scalars, 0, -1))
        if mapped is None:
            reject(about, f"array {scalars.GetName()!r}", scalars.GetClassName(), "one that the lookup table maps")
        colors = vtk_to_numpy(mapped).reshape(count, -1)
        return (np.array(colors) if colors.shape[1] == 4 else arrays.colors_of(colors, (count,), about)), of_points


def _normals(array, what, about):
    """Unit normals (n, 3) of a VTK array; None, with a warning, if one has no direction."""
    if array is None:
        return None
    normals = vtk_to_numpy(array).astype(float)
    lengths = np.linalg.norm(normals, axis=1) if normals.ndim == 2 and normals.shape[1] == 3 else np.zeros(1)
    if not (np.isfinite(lengths) & (lengths > 0)).all():
        warn(f"{about}: the normals of its {what} hold some without a direction; normals are computed instead")
        return None
    return normals / lengths[:, None]


def _indices(cells, corners):
    """The indices (m, corners) of a vtkCellArray whose cells all have this number of corners."""
    return vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, corners)


def put_polydata(level, data, coloring, part, about):
    """Writes a vtkPolyData into a MeshLevel message."""
    if data.GetNumberOfPoints() == 0:
        raise InvalidArgument(f"{about}: the polydata has no points; accepted: 1 or more", about)
    if data.GetNumberOfCells() == 0:
        raise InvalidArgument(f"{about}: the polydata has no cells; accepted: 1 or more vertices, lines, strips or "
                              "polygons (vtkVertexGlyphFilter makes vertices of points)", about)
    points = arrays.points_of(vtk_to_numpy(data.GetPoints().GetData()), about)
    colors, of_points = coloring.colors(data, about)
    point_normals = _normals(data.GetPointData().GetNormals(), "points", about)
    cell_normals = _normals(data.GetCellData().GetNormals(), "cells", about) if point_normals is None else None
    tcoords = data.GetPointData().GetTCoords()
    if tcoords is not None:
        tcoords = vtk_to_numpy(tcoords).reshape(len(points), -1)
        tcoords = arrays.vectors_of(tcoords[:, :2], len(points), 2, "texture coordinates", about)
    plain = vtkPolyData()  # without arrays, which the filter would copy
    plain.ShallowCopy(data)
    plain.GetPointData().Initialize()
    plain.GetCellData().Initialize()
    numbers = numpy_to_vtkIdTypeArray(np.arange(data.GetNumberOfCells(), dtype=np.int64), deep=True)
    numbers.SetName(_CELLS)
    plain.GetCellData().AddArray(numbers)

    def triangulate():
        filter = vtkTriangleFilter()
        filter.SetInputData(plain)
        filter.Update()
        return filter.GetOutput()

    made = guarded(about, triangulate)
    of = vtk_to_numpy(made.GetCellData().GetArray(_CELLS))
    at = 0
    for primitive, cells in ((POINTS, made.GetVerts()), (LINES, made.GetLines()), (TRIANGLES, made.GetPolys())):
        count = cells.GetNumberOfCells()
        here = of[at:at + count]
        at += count
        if count == 0:
            continue
        triangles = primitive == TRIANGLES
        arrays.fill(level.mesh.add(), points, primitive, _indices(cells, {POINTS: 1, LINES: 2, TRIANGLES: 3}[primitive]),
                    part, point_normals if triangles else None, tcoords, colors if of_points else None,
                    None if colors is None or of_points else colors[here],
                    cell_normals[here] if triangles and cell_normals is not None else None, about)
    if not level.mesh:
        raise InvalidArgument(f"{about}: the polydata has no cell that can be drawn; accepted: 1 or more vertices, lines, "
                              "strips or polygons", about)


class PolyData(GraphicsObject):
    """An object of VTK's polydata, from Scene.add_polydata."""

    def __init__(self, scene, id, sources, coloring, part):
        super().__init__(scene, id)
        self._sources, self._coloring, self._part = sources, coloring, part

    def update(self, source=None):
        """Reads the data again, after updating the algorithms. source: what replaces the finest level's source."""
        about = self._label()
        sources = list(self._sources)
        if source is not None:
            sources[0] = (Source(source, about), sources[0][1])
        self._send(sources, about)
        self._sources = sources
        pipelines = self._scene._client.pipelines
        if self in pipelines:
            pipelines.add(self, self.stamp())

    def stamp(self):
        """Changes when a pipeline or the lookup table has changed."""
        return tuple(source.stamp() for source, _ in self._sources) + (self._coloring.stamp(),)

    def refresh(self):
        """Sends what the pipelines make now."""
        self._send(self._sources, self._label())

    def _send(self, sources, about):
        command = self._scene._command()
        command.set_mesh.object = self._id
        put_sources(command.set_mesh, sources, self._coloring, self._part, about)
        self._scene._execute(command)

    def remove(self):
        super().remove()
        self._scene._client.pipelines.remove(self)


def put_sources(message, sources, coloring, part, about):
    """Writes the data of sources, [(Source, pixels)], into a CreateMesh or SetMesh message."""
    for source, pixels in sources:
        level = message.level.add()
        put(level, about, minimum_pixels=pixels)
        put_polydata(level, source.read(about), coloring, part, about)


def make_polydata(scene, source, settings, array, lookup_table, low, high, part, live, pixels, levels):
    """See ObjectFactory.add_polydata."""
    command = scene._command()
    label = put_settings(scene, command.create_mesh.object, "polydata", **settings)
    coloring = Coloring(array, lookup_table, low, high, label)
    sources = [(Source(source, label), pixels)]
    sources += [(Source(each, label), minimum) for each, minimum in levels_of(levels, label, "(source, pixels)")]
    live = flag(live, "live", label) and any(each.is_pipeline for each, _ in sources)
    put_sources(command.create_mesh, sources, coloring, text(part, "the part", label), label)
    made = PolyData(scene, scene._execute(command).object.object, sources, coloring, part)
    if live:
        scene._client.pipelines.add(made, made.stamp())
    return made


def polydata_of(meshes):
    """A vtkPolyData of MeshData messages."""
    out = vtkPolyData()
    kinds = {POINTS: [], LINES: [], TRIANGLES: []}
    points, normals, tcoords, colors = [], [], [], []
    start = 0
    for data in meshes:
        mesh = arrays.to_arrays(data)
        count = len(mesh["points"])
        kinds[data.primitive].append((data.part, mesh["cells"].astype(np.int64) + start))
        for to, values, missing in ((points, mesh["points"], None), (normals, mesh["normals"], np.zeros((count, 3), "f4")),
                                    (tcoords, mesh["tcoords"], np.zeros((count, 2), "f4")),
                                    (colors, mesh["colors"], np.full((count, 4), 255, np.uint8))):
            to.append((values is not None, missing if values is None else values))
        start += count
    if not points:
        return out

    def whole(each):
        return np.ascontiguousarray(np.concatenate([values for _, values in each])) if any(g for g, _ in each) else None

    place = vtkPoints()
    place.SetDataTypeToDouble()
    place.SetData(numpy_to_vtk(whole(points), deep=True))
    out.SetPoints(place)
    for values, name, setter in ((whole(normals), "Normals", out.GetPointData().SetNormals),
                                 (whole(tcoords), "Texture Coordinates", out.GetPointData().SetTCoords),
                                 (whole(colors), "Colors", out.GetPointData().SetScalars)):
        if values is not None:
            array = numpy_to_vtk(values, deep=True)
            array.SetName(name)
            setter(array)
    names = vtkStringArray()
    names.SetName("Part")
    for kind, setter in ((POINTS, out.SetVerts), (LINES, out.SetLines), (TRIANGLES, out.SetPolys)):
        if not kinds[kind]:
            continue
        cells = np.concatenate([each for _, each in kinds[kind]])
        array = vtkCellArray()
        array.SetData(numpy_to_vtkIdTypeArray(np.arange(0, cells.size + 1, cells.shape[1], dtype=np.int64), deep=True),
                      numpy_to_vtkIdTypeArray(np.ascontiguousarray(cells.ravel()), deep=True))
        setter(array)
        for part, each in kinds[kind]:
            for _ in range(len(each)):
                names.InsertNextValue(part)
    if any(data.part for data in meshes):
        out.GetCellData().AddArray(names)
    return out
