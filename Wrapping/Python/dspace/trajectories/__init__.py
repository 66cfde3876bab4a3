"""States with time, the axes in which trajectories are drawn, and rules by which a craft points."""
from dspace.trajectories.axes import Axes, Pointing, about_body, local, rotating, turning
from dspace.trajectories.states import Conic, Path, States, Xyzv, Oem, put_path, read_states

__all__ = ["Axes", "Conic", "Oem", "Path", "Pointing", "States", "Xyzv", "about_body", "local", "put_path", "read_states",
           "rotating", "turning"]
