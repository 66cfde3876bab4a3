"""Plots of telemetry in the window."""
import collections

import numpy as np

from dspace._core.fields import reject, text
from dspace._core.traits import DEFAULT_SCENE
from dspace.application.run import Run
from dspace.errors import WrongType
from dspace.scene.scene import Scene

# A scene of anything that the window shows.
Shown = collections.namedtuple("Shown", "object scene")


def _title_of(names):
    """Two names at most: a dock's title and its tab are short."""
    if len(names) > 2:
        return f"{names[0]} and {len(names) - 1} more"
    return ", ".join(names) or "Plot"


class Plot:
    """Channels against time in a dock of the window; App.plot() makes it."""

    def __init__(self, host, of, channels=(), title=None):
        self._host, self._of = host, of
        if isinstance(of, Run):
            shown, scene = of._player, of._scene
        elif isinstance(of, Scene):
            shown, scene = of._client.shown(), of.name
        elif isinstance(of, Shown):
            shown, scene = of
        else:
            reject("plot", "of", of, "a Run or a dspace.Scene", WrongType)
        names = [text(channel, "a channel", "plot") for channel in channels]
        series = [self._series(name) for name in names]  # errors before a dock is there
        title = _title_of(names) if title is None else text(title, "the title", "plot")
        self.number = host.plot(shown, scene or DEFAULT_SCENE, title)
        for name, found in zip(names, series):
            self._put(name, found)

    def add(self, *channels):
        """Adds channels to it."""
        for name in [text(channel, "a channel", "plot") for channel in channels]:
            self._put(name, self._series(name))

    def _series(self, name):
        if not isinstance(self._of, Run):
            return None
        series = self._of.telemetry(name)
        if series.kind == "text":
            reject("plot", f"telemetry {name!r}", "a text", "numbers and choices")
        return series

    def _put(self, name, series):
        if series is None:
            self._host.plot_channel(self.number, name)
        else:
            times, values = (np.ascontiguousarray(each, "<f8").tobytes() for each in series)
            self._host.plot_series(self.number, name, series.unit, times, values)

    def __repr__(self):
        return f"<dspace plot {self.number}>"
