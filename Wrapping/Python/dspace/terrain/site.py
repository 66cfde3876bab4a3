"""Places above the ground of terrain."""
import numpy as np

from dspace._core.fields import array_of
from dspace._core.strict import Strict
from dspace.errors import InvalidArgument


class Site(Strict):
    """Points above the ground of a terrain: map x and y in the terrain's CRS, and heights above the ground [m], 0 or more.
    Made by Terrain.site(); taken by Scene.line_of_sight() and Scene.horizon(). `shape` is () for one point."""

    def __init__(self, terrain, x, y, height=0.0):
        given = [array_of(value, name, "a number or an array of numbers", terrain._label)
                 for name, value in (("x", x), ("y", y), ("height", height))]
        try:
            given = np.broadcast_arrays(*given)
        except ValueError:
            shapes = ", ".join(str(array.shape) for array in given)
            raise InvalidArgument(f"{terrain._label()}: x, y and height have the shapes {shapes}; accepted: shapes that "
                                  "broadcast", terrain._label()) from None
        self._terrain = terrain
        self._x, self._y, self._height = (np.array(array) for array in given)

    @property
    def terrain(self):
        return self._terrain

    @property
    def x(self):
        """Map x: longitude [deg] of a degree grid."""
        return self._x

    @property
    def y(self):
        """Map y: latitude [deg] of a degree grid."""
        return self._y

    @property
    def height(self):
        """Above the ground [m]."""
        return self._height

    @property
    def shape(self):
        return self._x.shape

    def __repr__(self):
        if self.shape == ():
            return f"<dspace.Site ({float(self._x):.9g}, {float(self._y):.9g}) of terrain {self._terrain.name!r}, " \
                   f"{float(self._height):.9g} m above the ground>"
        return f"<dspace.Site of shape {self.shape} on terrain {self._terrain.name!r}>"
