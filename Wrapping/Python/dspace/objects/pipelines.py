"""VTK pipelines behind objects: updating them, with their errors as exceptions."""
import sys

from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm, vtkAlgorithmOutput

from dspace import vtk as _vtk
from dspace._core.fields import reject
from dspace._core.replies import warn
from dspace.errors import InvalidArgument, WrongType

ACCEPTED = "a vtkPolyData, a VTK algorithm or its output port that makes one, or a PyVista mesh"


class _Run:
    """In a `with` statement: VTK's errors, and exceptions that Python code of the pipeline raises, become
    dspace.InvalidArgument, which names `about`; warnings become Python warnings."""

    def __init__(self, about):
        self._about = about
        self._trap = _vtk.vtkDspaceMessageTrap()
        self._raised = []
        self.done = True  # whether the update succeeded, by VTK's own word

    def __enter__(self):
        self._hook = sys.excepthook
        # VTK prints the exceptions of Python observers with PyErr_Print, which calls the hook, and goes on.
        sys.excepthook = lambda kind, error, trace: self._raised.append(error)
        self._trap.Begin()
        return self

    def __exit__(self, kind, error, trace):
        self._trap.End()
        sys.excepthook = self._hook
        if kind is not None:
            return False
        if self._raised:
            first = self._raised[0]
            raise InvalidArgument(f"{self._about}: the pipeline raised {type(first).__name__}: {first}",
                                  self._about) from first
        why = self._trap.GetError() or ("" if self.done else "the update failed")
        if why:
            raise InvalidArgument(f"{self._about}: VTK reported: {why}; accepted: a pipeline that makes its data without "
                                  "an error", self._about)
        for i in range(self._trap.GetNumberOfWarnings()):
            warn(f"{self._about}: VTK warned: {self._trap.GetWarning(i)}")
        return False


def _execute_again(algorithm):
    """Marks an algorithm and all upstream as changed: VTK takes one that failed for done, and would not try again."""
    algorithm.Modified()
    for port in range(algorithm.GetNumberOfInputPorts()):
        for index in range(algorithm.GetNumberOfInputConnections(port)):
            _execute_again(algorithm.GetInputConnection(port, index).GetProducer())


class Source:
    """What Scene.add_polydata reads: data, or the output of an algorithm."""

    def __init__(self, source, about):
        self._algorithm = self._data = None
        self._port = 0
        if isinstance(source, vtkAlgorithmOutput):
            self._algorithm, self._port = source.GetProducer(), source.GetIndex()
        elif isinstance(source, vtkAlgorithm):
            self._algorithm = source
        elif isinstance(source, vtkPolyData):
            self._data = source
        elif hasattr(source, "extract_surface"):  # PyVista's other meshes
            self._data = source
        else:
            reject(about, "the source", source, ACCEPTED, WrongType)
        if self._algorithm is not None and self._port >= self._algorithm.GetNumberOfOutputPorts():
            reject(about, "the source", source, "an algorithm with an output")

    @property
    def is_pipeline(self):
        return self._algorithm is not None

    def stamp(self):
        """Increases when the algorithm or anything upstream changes; 0 for data. Takes microseconds."""
        if self._algorithm is None:
            return 0
        executive = self._algorithm.GetExecutive()
        executive.UpdatePipelineMTime()
        return executive.GetPipelineMTime()

    def read(self, about):
        """The vtkPolyData, up to date."""
        try:
            with _Run(about) as run:
                if self._algorithm is not None:
                    run.done = bool(self._algorithm.GetExecutive().Update(self._port))
                    data = self._algorithm.GetOutputDataObject(self._port)
                else:
                    data = self._data
                    if not isinstance(data, vtkPolyData):
                        data = data.extract_surface()
        except InvalidArgument:
            if self._algorithm is not None:
                _execute_again(self._algorithm)
            raise
        if not isinstance(data, vtkPolyData):
            reject(about, "the output of the source", "None" if data is None else data.GetClassName(),
                   "vtkPolyData; vtkGeometryFilter makes it from other data", WrongType)
        return data


def guarded(about, work):
    """Calls `work`, which uses VTK, and returns its result. Errors that VTK reports raise dspace.InvalidArgument."""
    with _Run(about):
        return work()
