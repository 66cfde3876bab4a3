"""The files that a recording's commands need, on the machine that plays it."""
import os
import weakref

from dspace import vtk as _vtk
from dspace._core.replies import to_bytes
from dspace.recording.file import carry_out_in, unpack_limit_of


class RecordedFiles:
    """The files of a RecordingFile on the machine that plays it.

    Packed files are unpacked into a temporary folder, at their own paths below it; close() removes the folder. Other
    files on this machine must be unchanged (check=False: not checked). unpack_limit: as in RecordingFile.check. Raises
    dspace.Corrupt, dspace.NotFound, dspace.Io or dspace.Resource, which names the first file that is not. The C++ class
    RecordedFiles (RecordedFiles.h) implements it."""

    def __init__(self, file, check=True, unpack_limit=None):
        self.vtk = _vtk.vtkDspaceRecordedFiles()
        self._remove = weakref.finalize(self, self.vtk.Close)
        carry_out_in(self.vtk, "Open", os.fsencode(file.path), bool(check), unpack_limit_of(unpack_limit))
        self.folder = self._path(self.vtk.GetFolder())  # empty: nothing was packed

    def update(self):
        """Unpacks or checks the files that were recorded since the last call."""
        carry_out_in(self.vtk, "Update")
        self.folder = self._path(self.vtk.GetFolder())

    def close(self):
        self._remove()

    def place(self, path):
        """Returns the path, below the folder, of a path in the recording."""
        return self._path(self.vtk.Locate(os.fsencode(path)))

    def map(self, payload):
        """Returns a serialized command whose paths point into the folder."""
        return to_bytes(self.vtk.Map(payload)) if self.folder and b"/" in payload else payload

    @staticmethod
    def _path(answer):
        return os.fsdecode(to_bytes(answer))
