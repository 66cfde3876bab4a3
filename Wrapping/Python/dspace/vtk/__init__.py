"""The VTK classes of Dspace, to be mixed with vtkmodules; changes on them are not recorded."""
import contextlib
import ctypes
import os
import threading


def _libraries():
    # Not libDspaceLink: it holds the messages, which Python must load first (below).
    folder = os.path.realpath(os.path.join(__path__[0], *4 * [".."]))
    return [os.path.join(folder, f"libDspace{name}.so") for name in ("Elevation", "Import")]


def _load_libraries():
    # Loaded all at once, each symbol of some 230 libraries (GDAL's alone are 100) is looked for in all of them. One by one,
    # with what it needs, takes half the time, in which the main thread imports numpy, VTK and the messages.
    for path in _libraries():
        with contextlib.suppress(OSError):  # the import of the classes says what is missing
            ctypes.CDLL(path)


_loading = threading.Thread(target=_load_libraries, name="dspace libraries")
_loading.start()
try:
    import numpy  # noqa: F401 - which the rest of the package needs
    import vtkmodules.vtkCommonCore  # noqa: F401 - the classes that ours derive from
    import vtkmodules.vtkCommonTransforms  # noqa: F401
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401

    # The messages are imported before the compiled part, which contains the same messages. Protobuf would give a module
    # that is imported later other classes for them.
    from dspace.proto import recordings_pb2, service_pb2  # noqa: F401
finally:
    _loading.join()

from .vtkDspaceCore import *  # noqa: E402,F401,F403
from .vtkDspaceSession import *  # noqa: E402,F401,F403
