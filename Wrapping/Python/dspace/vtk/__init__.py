"""The VTK classes of Dspace, to be mixed with vtkmodules; changes on them are not recorded."""
import vtkmodules.vtkCommonCore  # noqa: F401 - the classes that ours derive from
import vtkmodules.vtkCommonTransforms  # noqa: F401
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401

from .vtkDspaceCore import *  # noqa: F401,F403
from .vtkDspaceSession import *  # noqa: F401,F403
