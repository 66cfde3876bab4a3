"""The VTK classes of Dspace, to be mixed with vtkmodules; changes on them are not recorded."""
import vtkmodules.vtkCommonCore  # noqa: F401 - the classes that ours derive from
import vtkmodules.vtkCommonTransforms  # noqa: F401
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401

# The messages are imported before the compiled part, which contains the same messages. Protobuf would give a module
# that is imported later other classes for them.
from dspace.proto import recordings_pb2, service_pb2  # noqa: F401

from .vtkDspaceCore import *  # noqa: F401,F403
from .vtkDspaceSession import *  # noqa: F401,F403
