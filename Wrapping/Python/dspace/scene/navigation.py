"""How a person moves the camera of a viewport."""
from dspace._core.fields import word
from dspace._core.strict import Strict

NAVIGATION = {"orbit": 0, "walk": 1, "map": 2}


class ViewportNavigation(Strict):
    """A part of Viewport."""

    @property
    def navigation(self):
        """How event() and windows move the camera; "orbit" in a new viewport.

        "orbit": a left drag turns the camera about the point under the pointer, a middle drag pans, the wheel goes
        nearer. "walk": the eye is at eye_height above the ground; the keys w, a, s, d and the arrows walk, a drag looks
        around. "map": a left drag pans, nothing turns. Near the ground of a terrain the eye stays above it and the
        horizon is level, in each of them."""
        return list(NAVIGATION)[self._info().navigation]

    @navigation.setter
    def navigation(self, navigation):
        self._do("set_viewport", navigation=word(navigation, NAVIGATION, "navigation", self._label))
        if navigation == "walk":
            self.event("wheel")  # onto the ground

    @property
    def eye_height(self):
        """[m] above the ground at which a person walks, 0.01 to 1e6; 1.7 in a new viewport."""
        return self._info().eye_height

    @eye_height.setter
    def eye_height(self, eye_height):
        self._do("set_viewport", eye_height=eye_height)

    @property
    def walk_speed(self):
        """[m/s] at which a person walks, four times that with Shift, 0.001 to 1e6; 1.5 in a new viewport."""
        return self._info().walk_speed

    @walk_speed.setter
    def walk_speed(self, walk_speed):
        self._do("set_viewport", walk_speed=walk_speed)
