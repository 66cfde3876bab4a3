"""What is written over a viewport's picture: colour bars, labels of grids."""
from dspace._fields import flag, items, keywords, number, put, put_color, put_given, reject, word
from dspace.errors import InvalidArgument, WrongType
from dspace.proto import commands_pb2 as pb
from dspace.telemetry import Channel

ANCHORS = {"top left": 0, "top right": 1, "bottom left": 2, "bottom right": 3}
UNITS = {"height": "m", "slope": "deg", "aspect": "deg"}


def put_grid_labels(message, look, label):
    """True or a dict into StyleTerrain.GridLabels; nothing for False."""
    label = f"{label}, grid_labels"
    look = look if isinstance(look, dict) else {} if flag(look, "grid_labels", label) else None
    if look is None:
        return
    keywords(look, ("font_size", "color", "background", "background_opacity"), label)
    message.SetInParent()
    put_given(message, label, font_size=look.get("font_size"),
              background_opacity=look.get("background_opacity"))
    for field in ("color", "background"):
        if look.get(field) is not None:
            put_color(getattr(message, field), look[field], field, label)


def put_value(row, value, viewport, table):
    """A value of a text table's row: anything, or a channel of telemetry with or without digits."""
    channel, digits = value if isinstance(value, tuple) and len(value) == 2 else (value, None)
    if not isinstance(channel, Channel):
        row.value = str(value)
        return
    if channel.scene != viewport.scene:
        reject(table, "the scene of " + repr(channel.name), channel.scene.name, "the viewport's")
    row.telemetry = channel.name
    put_given(row, table, digits=digits)


class LegendMaking:
    """The part of Viewport that has legends."""

    def set_color_bar(self, name, colors, low, high, title="", unit="", ticks=None, values=(),
                      horizontal=False, anchor="bottom right", margin=None, length=None, thickness=None,
                      font_size=None, color=None, opacity=None, background=None,
                      background_opacity=None):
        """A bar of colours, evenly spaced from `low` to `high` and linear between, over the picture.

        Creates it or replaces the one of that name; like text tables it is an ornament. ticks: at most
        so many, at round values (6); values: ticks there instead. title and unit stand above it as
        "title [unit]"; of the unit "deg" round values are those of a circle. margin, length,
        thickness, font_size: pixels (8, 200, 16, 14). color and opacity: of texts, ticks and frame."""
        label = f"colour bar {name!r}"
        command = pb.Command()
        message = command.set_color_bar
        put(message, label, viewport=self._name, name=name, title=title, unit=unit, low=low, high=high,
            horizontal=flag(horizontal, "horizontal", label))
        message.anchor = word(anchor, ANCHORS, "anchor", label)
        for each in items(colors, "the colours", label, "colours"):
            put_color(message.color.add(), each, "a colour", label)
        message.value.extend(number(value, "a tick", label)
                             for value in items(values, "the values", label, "numbers"))
        put_given(message, label, ticks=ticks, margin=margin, length=length, thickness=thickness,
                  font_size=font_size, opacity=opacity, background_opacity=background_opacity)
        for field, value in (("text_color", color), ("background", background)):
            if value is not None:
                put_color(getattr(message, field), value, field, label)
        self._client.execute(command)

    def remove_color_bar(self, name):
        self._do("remove_color_bar", name=name)

    def legend_of(self, shown, name=None, **look):
        """A colour bar of what false colour shows: a terrain whose style has a ramp (color_by "height",
        "slope" or "aspect"), or a layer that has `colors`, `range` and `unit`.

        It is a copy: after another style call it again. name: its name (the terrain's or the
        layer's); `look`: keywords of set_color_bar(), title, unit, low, high and colors among them.
        Returns the bar's name."""
        from dspace.terrain import Terrain
        if isinstance(shown, Terrain):
            ramp = shown.style
            if not ramp or ramp["color_by"] == "normal":
                raise InvalidArgument(f"{self._label()}: {shown!r} shows no ramp of colours; accepted: one "
                                      "with set_style(color_by='height', 'slope' or 'aspect')",
                                      self._label())
            by = ramp["color_by"]
            given = {"title": by.capitalize(), "unit": UNITS[by]}
        elif all(hasattr(shown, each) for each in ("colors", "range", "unit", "name")):
            ramp = {"range": shown.range, "colors": shown.colors}
            if ramp["range"] is None or not ramp["colors"]:
                raise InvalidArgument(f"{self._label()}: {shown!r} has no range of colours; accepted: a "
                                      "layer of false colour", self._label())
            given = {"title": shown.name, "unit": shown.unit or ""}
        else:
            reject(self._label, "a legend", shown, "one of a Terrain or of a layer of false colour",
                   WrongType)
        (low, high), colors = ramp["range"], list(ramp["colors"])
        if low > high:  # a ramp may run downwards
            low, high, colors = high, low, colors[::-1]
        given.update(low=low, high=high, colors=colors)
        given.update(look)
        name = shown.name if name is None else name
        self.set_color_bar(name, **given)
        return name
