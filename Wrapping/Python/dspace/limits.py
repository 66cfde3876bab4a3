"""Limits on what one file or one message may cost in memory and time, in this process.

    dspace.limits.set(image_pixels=400_000_000)

A file or message beyond a limit raises a dspace.Resource that names the limit and its value.
"""
from dspace import vtk
from dspace._core.fields import flag, integer, reject
from dspace.errors import InvalidArgument


def get():
    """The present limits: {name: value}.

    image_pixels: width times height of one image that is decoded. block_bytes: the decoded bytes of one block (tile,
    strip) of a raster. message_elements: fields, items and messages in one command of another process or a recording.
    import_memory: bytes of the process that reads a model. import_seconds: its processor time, and its time by the
    clock. raster_pixels: columns times rows of one raster. mosaic_files: files that a mosaic (VRT) makes be opened in all,
    each as often as it is named, in `dspace serve` and playback; mosaic_bytes: of its document.
    open_memory: bytes that opening a netCDF or HDF5 file takes, which is tried in a process apart first.
    texture_bytes: of all textures of one model, decoded. open_seconds: that a raster of `dspace serve` or of a
    recording is read while it is opened, for its range of heights or values.
    """
    lines = vtk.vtkDspaceSession.GetLimits().splitlines()
    return {name: int(value) for name, value in (line.split() for line in lines)}


def set(**limits):
    """Sets the limits of these names; the others stay as they are. Either all of them are set or none."""
    known = get()
    for name, value in limits.items():
        if name not in known:
            reject("limits", "the name", name, ", ".join(known), InvalidArgument)
        if not 0 <= integer(value, name, "limits") < 1 << 63:
            reject("limits", name, value, "0 to 9223372036854775807")
    for done, (name, value) in enumerate(limits.items()):
        trouble = vtk.vtkDspaceSession.SetLimit(name, int(value))
        if trouble:
            for earlier in list(limits)[:done]:
                vtk.vtkDspaceSession.SetLimit(earlier, known[earlier])
            raise InvalidArgument(trouble, f"limit '{name}'")


def read_models_apart(apart=True):
    """Whether model files of all formats are read in processes of their own, with the limits import_memory and
    import_seconds, so that a damaged file cannot end this process. Default: only VRML and Inventor files, and in
    `dspace serve` and playback everything."""
    vtk.vtkDspaceSession.SetImportsApart(flag(apart, "apart", "limits"))
