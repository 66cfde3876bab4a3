"""The files that a recording's commands need, on the machine that plays it."""
import os
import weakref

from dspace import vtk as _vtk
from dspace._core.replies import make_error, to_bytes, to_reply


class RecordedFiles:
    """The files of a RecordingFile where it is played. Packed ones are unpacked into a folder of their own, at their own
    paths below it; of a recording that is not packed, files on this machine must be what they were (check=False looks
    at none). Raises with the first that is not: dspace.Corrupt, dspace.NotFound, dspace.Io or dspace.Resource, which
    name it. RecordedFiles in C++ does it, for whoever plays there too (RecordedFiles.h); close() removes the folder."""

    def __init__(self, file, check=True):
        self.vtk = _vtk.vtkDspaceRecordedFiles()
        self._remove = weakref.finalize(self, self.vtk.Close)
        self._raise(self.vtk.Open(os.fsencode(file.path), bool(check)))
        self.folder = self._path(self.vtk.GetFolder())  # empty: nothing was packed

    def update(self):
        """Unpacks or checks the files that were noted since."""
        self._raise(self.vtk.Update())
        self.folder = self._path(self.vtk.GetFolder())

    def close(self):
        self._remove()

    def place(self, path):
        """Where a path of the recording's is: below the folder, whatever it holds."""
        return self._path(self.vtk.Locate(os.fsencode(path)))

    def map(self, payload):
        """A serialized command with its paths made those of the folder."""
        return to_bytes(self.vtk.Map(payload)) if self.folder and b"/" in payload else payload

    @staticmethod
    def _raise(answer):
        reply = to_reply(answer)
        if reply.HasField("error"):
            raise make_error(reply.error)

    @staticmethod
    def _path(answer):
        return os.fsdecode(to_bytes(answer))
