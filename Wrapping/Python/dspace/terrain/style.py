"""The style of a clipmap: false color, lines, details and noise over its own color."""
from dspace._core.fields import file_path, flag, items, keywords, numbers, put, put_color, put_given, reject, word
from dspace.terrain.members import MEMBER, put_member
from dspace.errors import InvalidArgument, WrongType

KEEP = object()  # of change_style()
COLOR_BY = {"height": 0, "slope": 1, "aspect": 2, "normal": 3}  # StyleTerrain.Ramp.By


class TerrainStyle:
    """The style of a Terrain, which delegates to it."""

    def __init__(self, terrain):
        self._terrain, self._scene, self._name = terrain, terrain._scene, terrain.name

    def set_style(self, color_by=None, range=None, colors=None, opacity=1.0, levels=None,
                  contours=None, grid=None, details=(), tracks=None, noise=None, grid_labels=False,
                  fragment=None, ornamental=None, viewport=None, shaded=False):
        """Sets what is drawn over a clipmap's own color. Each call replaces the previous style; set_style() removes it.

        color_by: "height", "slope" (degrees from level), "aspect" (azimuth of steepest descent in degrees clockwise
        from north; level ground keeps its color), or "normal" (the color is 0.5 + 0.5 n, where n is the normal in
        local east, north, up). range: (low, high) of the ramp (default: the terrain's heights, 0 to 45, 0 to 360).
        colors: of the ramp, evenly spaced (default: green through ochre to white; a ramp for the aspect is circular and
        should end with its first color). opacity: of the ramp, 0 to 1. shaded: False shows the colors of the legend,
        whatever the lights; with True the lights shade the ramp, and what lies over it (levels, contours, grid). levels:
        opacity of a color for each clipmap level, or a dict of opacity.

        contours: metres of height between lines, or a dict of interval, width (pixels), color, opacity. grid: the same
        for lines along the map's axes, in map units; on a body meridians and parallels, in degrees. grid_labels: their
        values in the picture ("12°E"; "4,500 E", "-200 N" on projected maps), True or a dict of font_size (13), color,
        background, background_opacity (0.5). details: up to two tiling images that add structure finer than the posts,
        on a plane: dicts of image (a file), size (metres for each tile), slope (low, high; degrees), height (low, high;
        metres), opacity (0.5). tracks: the color of ground where wheels have rolled (see track()), or a dict of color
        and opacity (black, 0.35).

        noise: changes the drawn shape of the ground where posts are closer than the data's pixels (on a plane: see
        `subdivisions` of add_terrain). It is a dict of wavelength (metres, of the longest octave; up to two data pixels
        leaves the data's posts unchanged), amplitude (the largest change in metres), octaves of halved wavelength (4),
        gain of each octave relative to the one before (0.5), seed (0). Pictures, depth images, contours and ramps
        include the noise. Queries such as height(), analyses, ruts and robots do not, so do not use it where you
        measure in pictures.

        fragment: the Fragment with which the ramp, levels, contours and grid are shown and hidden (default:
        "ornamental"). ornamental: whether they are ornaments, which physical pictures leave out (default: True). The
        dicts of levels, contours, grid, tracks and details may have a `fragment` and `ornamental` of their own; tracks
        and details are physical unless theirs say otherwise. A grid's labels are ornaments and shown with the grid.

        viewport: a Viewport or its name. The style is then drawn in that viewport instead of the terrain's own, except
        for details and noise, which are the same in all viewports. set_style(viewport=view) shows the terrain there
        without a style; remove_style(view) shows the terrain's own style there again."""
        label = self._terrain._label()
        command = self._scene._command()
        if viewport is None:
            style = command.style_terrain
            put(style, label, terrain=self._name)
        else:
            message = command.style_terrain_in_viewport
            put(message, label, terrain=self._name, viewport=self._scene._viewport_name(viewport, label))
            style = message.style
            style.SetInParent()
        common = {"fragment": fragment, "ornamental": ornamental}
        _put_ramp(style, self._scene, common, label, color_by, range, colors, opacity, shaded)
        self._fill(style, label, common, levels, contours, grid, details, tracks, noise, grid_labels)
        self._scene._execute(command)

    def change_style(self, color_by=KEEP, range=KEEP, colors=KEEP, opacity=KEEP, levels=KEEP, contours=KEEP, grid=KEEP,
                     details=KEEP, tracks=KEEP, noise=KEEP, grid_labels=KEEP, shaded=KEEP):
        """Changes parts of the terrain's own style, and keeps all that is not given.

        The arguments are those of set_style(). range, colors, opacity and shaded alone change the false color that is
        there; None is the default of range and colors. Another color_by has the defaults of its own. A dict of contours or grid changes what it
        names. None removes a part (details: (), grid_labels: False); the labels go with their grid."""
        label = self._terrain._label()
        command = self._scene._command()
        style = command.style_terrain
        reply = self._scene._ask("describe_terrain_style", terrain=self._name, viewport="").terrain_style
        if reply.HasField("given"):
            style.CopyFrom(reply.given)
        elif reply.HasField("ramp"):  # a terrain without an image has it from the start
            style.ramp.CopyFrom(reply.ramp)
        put(style, label, terrain=self._name)
        taken = {"levels": levels, "contours": contours, "grid": grid, "detail": details, "tracks": tracks,
                 "noise": noise, "grid_labels": grid_labels}
        kept = type(style)()
        kept.CopyFrom(style)
        for field in ("contours", "grid"):
            if style.HasField(field) and not (taken[field] is KEEP or taken[field] is None):
                taken[field] = _with_kept(taken[field], getattr(kept, field))
        for field, value in taken.items():
            if value is not KEEP:
                style.ClearField(field)
        if levels is not KEEP:
            style.ClearField("levels_member")
        if grid is None and grid_labels is KEEP:
            style.ClearField("grid_labels")  # they need a grid
        given = {field: None if value is KEEP else value for field, value in taken.items()}
        self._fill(style, label, {}, given["levels"], given["contours"], given["grid"], given["detail"] or (),
                   given["tracks"], given["noise"], given["grid_labels"] or False)
        for field in ("contours", "grid"):
            if isinstance(given[field], dict) and not any(word in given[field] for word in MEMBER):
                getattr(style, field).member.CopyFrom(getattr(kept, field).member)
        self._change_ramp(style, label, color_by, range, colors, opacity, shaded)
        self._scene._execute(command)

    def _change_ramp(self, style, label, color_by, range, colors, opacity, shaded):
        """The false color of change_style()."""
        if all(value is KEEP for value in (color_by, range, colors, opacity, shaded)):
            return
        old = type(style.ramp)()
        old.CopyFrom(style.ramp)
        there = style.HasField("ramp")
        same = there and (color_by is KEEP or color_by is not None and word(color_by, COLOR_BY, "color_by", label) == old.by)
        if color_by is KEEP:
            color_by = list(COLOR_BY)[old.by] if there else None
        if color_by is None and not (opacity is KEEP and shaded is KEEP):
            raise InvalidArgument(f"{label}: an opacity or shading needs color_by, which is not given; "
                                  f"accepted: color_by {', '.join(map(repr, COLOR_BY))}", label)
        style.ClearField("ramp")
        _put_ramp(style, self._scene, {}, label, color_by, None if range is KEEP else range,
                  None if colors is KEEP else colors, (old.opacity if same else 1.0) if opacity is KEEP else opacity,
                  (old.shaded if same else False) if shaded is KEEP else shaded)
        if color_by is None or not there:
            return
        style.ramp.member.CopyFrom(old.member)
        if same and range is KEEP:
            put_given(style.ramp, label, low=old.low if old.HasField("low") else None,
                      high=old.high if old.HasField("high") else None)
        if same and colors is KEEP:
            style.ramp.color.extend(old.color)

    def _fill(self, style, label, common, levels, contours, grid, details, tracks, noise, grid_labels):
        """Writes the parts that are given, other than the false color, into a StyleTerrain."""
        for detail in items(details, "details", label, "a list of dicts"):
            _put_detail(style.detail.add(), detail, self._scene, f"{label}, a detail")
        if tracks is not None:
            look = tracks if isinstance(tracks, dict) else {"color": tracks, "opacity": 1.0}
            keywords(look, ("color", "opacity", *MEMBER), f"{label}, tracks")
            put_color(style.tracks.color, look.get("color", (0, 0, 0)), "the colour of its tracks", label)
            put(style.tracks, f"{label}, tracks", opacity=look.get("opacity", 0.35))
            put_member(style.tracks.member, self._scene, look, {}, f"{label}, tracks")
        if levels is not None:
            look = levels if isinstance(levels, dict) else {"opacity": levels}
            keywords(look, ("opacity", *MEMBER), f"{label}, levels")
            put(style, f"{label}, levels", levels=look.get("opacity", 1.0))
            put_member(style.levels_member, self._scene, look, common, f"{label}, levels")
        for what, lines in (("contours", contours), ("grid", grid)):
            _put_lines(getattr(style, what), lines, what, self._scene, common, label)
        _put_grid_labels(style.grid_labels, grid_labels, label)
        if noise is not None:
            _put_noise(style.noise, noise, f"{label}, noise")

    def remove_style(self, viewport):
        """Shows the terrain's own style in the viewport again. Does nothing if the viewport has no style of its own."""
        label = self._terrain._label()
        command = self._scene._command()
        put(command.style_terrain_in_viewport, label, terrain=self._name,
            viewport=self._scene._viewport_name(viewport, label))
        self._scene._execute(command)

    @property
    def style(self):
        """The false color of a clipmap as it is drawn: a dict of color_by, range (None for "normal"), colors (r, g, b),
        opacity, fragment (a name), ornamental and shaded; {} without false color."""
        return self.style_in(None)

    def style_in(self, viewport):
        """The false color in one viewport: a dict as `style`. The terrain's own, if the viewport has no style."""
        name = "" if viewport is None else self._scene._viewport_name(viewport, self._terrain._label())
        reply = self._scene._ask("describe_terrain_style", terrain=self._name, viewport=name).terrain_style
        if not reply.HasField("ramp"):
            return {}
        ramp = reply.ramp
        return {"color_by": list(COLOR_BY)[ramp.by],
                "range": (ramp.low, ramp.high) if ramp.HasField("low") else None,
                "colors": [(color.r, color.g, color.b) for color in ramp.color], "opacity": ramp.opacity,
                "fragment": ramp.member.fragment, "ornamental": ramp.member.nature == 1, "shaded": ramp.shaded}


def _put_ramp(style, scene, common, label, color_by, range, colors, opacity, shaded):
    """Writes the false color into a StyleTerrain. Does nothing for None."""
    if color_by is not None:
        style.ramp.by = word(color_by, COLOR_BY, "color_by", label)
        put(style.ramp, label, opacity=opacity, shaded=flag(shaded, "shaded", label))
        put_member(style.ramp.member, scene, {}, common, f"{label}, color_by")
        if range is not None:
            low, high = numbers(range, 2, "the range", label, "low, high")
            put(style.ramp, label, low=low, high=high)
        for value in items(() if colors is None else colors, "colors", label, "a list of colours, such as ['black', 'white']"):
            put_color(style.ramp.color.add(), value, "a colour of the ramp", label)
    elif range is not None or colors is not None:
        raise InvalidArgument(f"{label}: a range and colours need color_by, which is not given; "
                              f"accepted: color_by {', '.join(map(repr, COLOR_BY))}", label)


def _with_kept(lines, kept):
    """A number or a dict of lines, with what it does not name as it was."""
    color = kept.color
    return {"interval": kept.interval, "width": kept.width, "opacity": kept.opacity, "color": (color.r, color.g, color.b),
            **(lines if isinstance(lines, dict) else {"interval": lines})}


def _put_detail(message, detail, scene, label):
    """Writes a dict into a Detail."""
    if not isinstance(detail, dict):
        reject(label, "it", detail, "a dict of image, size, slope, height, opacity", WrongType)
    keywords(detail, ("image", "size", "slope", "height", "opacity", *MEMBER), label)
    put_member(message.member, scene, detail, {}, label)
    for needed in ("image", "size"):
        if needed not in detail:
            reject(label, "it", detail, f"a dict with {needed!r}", WrongType)
    low, high = numbers(detail.get("slope", (0, 90)), 2, "its slope", label, "low, high")
    put(message, label, path=file_path(detail["image"], "its image", label), size=detail["size"],
        slope_low=low, slope_high=high, opacity=detail.get("opacity", 0.5))
    if "height" in detail:
        low, high = numbers(detail["height"], 2, "its height", label, "low, high")
        put(message, label, height_low=low, height_high=high)


def _put_noise(message, noise, label):
    """Writes a dict into a Noise."""
    accepted = ("wavelength", "amplitude", "octaves", "gain", "seed")
    if not isinstance(noise, dict):
        reject(label, "it", noise, f"a dict of {', '.join(accepted)}", WrongType)
    keywords(noise, accepted, label)
    for needed in accepted[:2]:
        if needed not in noise:
            reject(label, "it", noise, f"a dict with {needed!r}", WrongType)
    put(message, label, **{"octaves": 4, "gain": 0.5, "seed": 0, **noise})


def _put_lines(message, lines, what, scene, common, label):
    """Writes a number or a dict into Lines. Does nothing for None."""
    if lines is None:
        return
    lines = lines if isinstance(lines, dict) else {"interval": lines}
    keywords(lines, ("interval", "width", "color", "opacity", *MEMBER), f"{label}, {what}")
    put_member(message.member, scene, lines, common, f"{label}, {what}")
    if "interval" not in lines:
        reject(label, what, lines, "an interval, or a dict with one", WrongType)
    put(message, f"{label}, {what}", interval=lines["interval"], width=lines.get("width", 1.0),
        opacity=lines.get("opacity", 1.0))
    put_color(message.color, lines.get("color", (0, 0, 0)), f"the colour of its {what}", label)


def _put_grid_labels(message, look, label):
    """Writes True or a dict into StyleTerrain.GridLabels. Does nothing for False."""
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
