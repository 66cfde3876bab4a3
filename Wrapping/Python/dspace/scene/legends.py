"""Colour bars over a viewport's picture."""
from dspace._core.fields import flag, items, number, put, put_color, put_given, reject, word
from dspace.errors import InvalidArgument, WrongType
from dspace.proto import commands_pb2 as pb
from dspace.telemetry.telemetry import Channel
from dspace.terrain.terrain import Terrain

ANCHORS = {"top left": 0, "top right": 1, "bottom left": 2, "bottom right": 3}
UNITS = {"height": "m", "slope": "deg", "aspect": "deg"}


def put_value(row, value, viewport, table):
    """Writes the value of a text table's row: anything with a str, or a telemetry channel with or without digits."""
    channel, digits = value if isinstance(value, tuple) and len(value) == 2 else (value, None)
    if not isinstance(channel, Channel):
        row.value = str(value)
        return
    if channel.scene != viewport.scene:
        reject(table, "the scene of " + repr(channel.name), channel.scene.name, "the viewport's")
    row.telemetry = channel.name
    put_given(row, table, digits=digits)


class ViewportLegends:
    """The legends of a Viewport, which delegates to it."""

    def __init__(self, viewport):
        self._viewport = viewport

    def set_color_bar(self, name, colors, low, high, title="", unit="", ticks=None, values=(),
                      horizontal=False, anchor="bottom right", margin=None, length=None, thickness=None,
                      font_size=None, color=None, opacity=None, background=None,
                      background_opacity=None, terrain=None, layer=None):
        """Shows a bar of colors over the picture, evenly spaced from `low` to `high` and interpolated linearly.

        Creates the bar or replaces the one of that name. Like text tables it is an ornament. ticks: the largest number
        of ticks, at round values (6). values: the values of the ticks instead. title and unit appear above the bar as
        "title [unit]". The unit "deg" gets ticks at round angles. margin, length, thickness, font_size: pixels (8, 200,
        16, 14). color, opacity: of texts, ticks and frame. terrain: a Terrain or its name; the bar is then shown only
        while the ramp of that terrain's style is drawn in this viewport, or with layer (a TerrainLayer or its name) while
        that layer of the terrain is."""
        label = f"colour bar {name!r}"
        command = pb.Command()
        message = command.set_color_bar
        put(message, label, viewport=self._viewport.name, name=name, title=title, unit=unit, low=low, high=high,
            horizontal=flag(horizontal, "horizontal", label))
        message.anchor = word(anchor, ANCHORS, "anchor", label)
        for each in items(colors, "colors", label, "a list of colours, such as ['black', 'white']"):
            put_color(message.color.add(), each, "a colour", label)
        message.value.extend(number(value, "a tick", label)
                             for value in items(values, "the values", label, "numbers"))
        put_given(message, label, ticks=ticks, margin=margin, length=length, thickness=thickness,
                  font_size=font_size, opacity=opacity, background_opacity=background_opacity)
        for field, value in (("text_color", color), ("background", background)):
            if value is not None:
                put_color(getattr(message, field), value, field, label)
        put_given(message, label, terrain=getattr(terrain, "name", terrain), layer=getattr(layer, "name", layer))
        self._viewport._client.execute(command)

    def remove_color_bar(self, name):
        self._viewport._do("remove_color_bar", name=name)

    def legend_of(self, shown, name=None, **look):
        """Shows a color bar for false color: of a terrain whose style has a ramp (color_by "height", "slope" or
        "aspect"), or of a layer that has `colors`, `range` and `unit`.

        The bar shows the colors and values of this moment; call this again after a change of style. It is hidden while
        what it explains is hidden in this viewport. name: the bar's name (default: that of the terrain
        or layer). look: arguments of set_color_bar(), including title, unit, low, high and colors. Returns the bar's
        name."""
        if isinstance(shown, Terrain):
            ramp = shown.style_in(self._viewport)
            if not ramp or ramp["color_by"] == "normal":
                raise InvalidArgument(f"{self._viewport._label()}: {shown!r} shows no ramp of colours; accepted: one "
                                      "with set_style(color_by='height', 'slope' or 'aspect')",
                                      self._viewport._label())
            by = ramp["color_by"]
            given = {"title": by.capitalize(), "unit": UNITS[by], "terrain": shown}
        elif all(hasattr(shown, each) for each in ("colors", "range", "unit", "name")):
            ramp = {"range": shown.range, "colors": shown.colors}
            if ramp["range"] is None or not ramp["colors"]:
                raise InvalidArgument(f"{self._viewport._label()}: {shown!r} has no range of colours; accepted: a "
                                      "layer of false colour", self._viewport._label())
            given = {"title": shown.name, "unit": shown.unit or ""}
            if getattr(shown, "terrain", None) is not None:
                given.update(terrain=shown.terrain, layer=shown)
        else:
            reject(self._viewport._label, "a legend", shown, "one of a Terrain or of a layer of false colour",
                   WrongType)
        (low, high), colors = ramp["range"], list(ramp["colors"])
        if low > high:  # a ramp may run downwards
            low, high, colors = high, low, colors[::-1]
        given.update(low=low, high=high, colors=colors)
        given.update(look)
        name = shown.name if name is None else name
        self.set_color_bar(name, **given)
        return name
