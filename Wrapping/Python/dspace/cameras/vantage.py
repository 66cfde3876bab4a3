"""Vantages: a scene seen through one of several cameras."""
from dspace._core.fields import Named
from dspace._core.strict import Strict
from dspace.cameras.camera import Camera
from dspace.errors import NotFound


class Vantage(Strict):
    """The scene seen through one of its cameras; one is active."""

    def __init__(self, scene, name):
        self._scene = scene
        self._name = name

    @property
    def name(self):
        return self._name

    def _info(self):
        for vantage in self._scene._ask("list_vantages").vantages.vantage:
            if vantage.name == self._name:
                return vantage
        raise NotFound(f"vantage {self._name!r}: it is in scene {self._scene.name!r} no more",
                       f"vantage {self._name!r}")

    @property
    def cameras(self):
        """By name."""
        return Named("camera", {name: Camera(self._scene, self._name, name)
                                for name in self._info().camera})

    @property
    def active(self):
        """The active camera, or None."""
        name = self._info().active
        return Camera(self._scene, self._name, name) if name else None

    def remove(self):
        self._scene._do("remove_vantage", name=self._name)

    def __repr__(self):
        return f"<dspace.Vantage {self._name!r}>"
