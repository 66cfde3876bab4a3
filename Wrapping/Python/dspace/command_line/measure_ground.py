"""What the commands that measure on terrain share: the terrain, places on it, and the files that they write."""
import contextlib
import io
import json
import math
import pathlib
import sys

from dspace._core.files import atomic_write
from dspace.command_line import Failed, lazy
from dspace.command_line.measure_page import write_page
from dspace.command_line.recorded import add_recording, recorded_scene
from dspace.command_line.terrain import add_raster_options
from dspace.command_line.terrain_rasters import add, degrees, gdal_modules, given
from dspace.errors import Unsupported

np = lazy("numpy")

ENDINGS = (".json", ".csv", ".png", ".html")


def add_ground(parser, file_help, required=True):
    """Adds the options of the terrain or of a recording, and those of the output."""
    source = parser.add_mutually_exclusive_group(required=required)
    source.add_argument("--terrain", metavar="FILE", help="any raster of heights that GDAL opens")
    add_recording(parser, source)
    parser.add_argument("--on", metavar="NAME", help="of --recording: the terrain of places and maps (default: the scene's only one)")
    parser.add_argument("--plane", action="store_true",
                        help="place the terrain on a plane, without the body's curvature (default: a raster is placed on its "
                        "body if it is in longitude and latitude, or in an equidistant cylindrical or polar stereographic projection of "
                        "a sphere, any other on a plane)")
    add_raster_options(parser)
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("--out", metavar="FILE", help=file_help)


@contextlib.contextmanager
def opened(options):
    """The scene in which the command measures: an empty one, or that of its recording."""
    if options.recording is not None:
        with recorded_scene(options) as scene:
            yield scene
        return
    if options.on is not None or options.at is not None or options.scene is not None:
        raise Failed("--on, --at, --scene: accepted: with --recording")
    import dspace
    with dspace.Session() as session:
        yield session.scene()


def out_of(options):
    """The path of --out, or None. Says what is wrong before the work starts."""
    if options.out is None:
        return None
    out = pathlib.Path(options.out)
    if out.suffix.lower() not in ENDINGS:
        raise Failed(f"--out '{out}': accepted: a name with {', '.join(ENDINGS)}")
    if not out.resolve().parent.is_dir():
        raise Failed(f"--out '{out}': there is no folder {out.resolve().parent}")
    if out.suffix.lower() in (".png", ".html"):
        figures()
    return out


def figures():
    """Matplotlib's Figure, which draws without a display."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise Failed("matplotlib, which draws plots, is not installed (Debian: python3-matplotlib)") from None
    return Figure


class MeasuredGround:
    """The terrain of the command in a scene, and its places: a raster that is opened, or a terrain of a recorded scene. The
    latter may have none: `terrain` is None then."""

    def __init__(self, scene, options):
        _, osr = gdal_modules()
        self.scene = scene
        self._recording = options.recording
        self._to_terrain = np.eye(4)
        if options.recording is None:
            self._open(options, osr)
        else:
            self._find(options)
        self.crs = degrees(osr, self.terrain.crs) if self.terrain is not None else None

    def _open(self, options, osr):
        self.on_body, why = not options.plane, ""
        if self.on_body:
            try:
                self.terrain, warned = add(self.scene, options.terrain, options, name="terrain", on_body=True)
            except Unsupported as error:
                if _is_in_degrees(options, osr):
                    raise
                self.on_body, why = False, f" ({error})"
        if not self.on_body:
            self.terrain, warned = add(self.scene, options.terrain, options, name="terrain", on_body=False)
        self.arguments = {**given(options), "on_body": self.on_body}  # of add_terrain
        for warning in warned:
            print(f"dspace: note: {options.terrain}: {warning}", file=sys.stderr)
        if not self.on_body:
            print(f"dspace: note: {options.terrain}: the terrain is on a plane: the body's curvature is left out{why}",
                  file=sys.stderr)

    def _find(self, options):
        if given(options) or options.plane:
            raise Failed("--recording: accepted: without options of rasters, whose values it has")
        terrains = self.scene.terrains
        if options.on is None and len(terrains) > 1 or options.on is not None and options.on not in terrains:
            raise Failed(f"{options.recording}: the terrain is {options.on!r}; accepted: --on with one of "
                         f"{', '.join(map(repr, terrains)) or 'none'}")
        self.terrain = terrains[options.on] if options.on is not None else next(iter(terrains.values()), None)
        self.on_body = self.terrain is not None and self.terrain.on_body
        if self.terrain is not None:
            self._to_terrain = np.linalg.inv(self.placed(self.terrain.frame))

    @property
    def source(self):
        """What a result says about its ground."""
        name = self.terrain.name if self.terrain is not None else None
        return {"terrain": name, "on_body": self.on_body, "recording": str(self._recording)}

    def place_names(self, prefix=""):
        """What two coordinates of a place are called in results: degrees, or map coordinates of terrain without a CRS."""
        return tuple(prefix + name for name in (("lon_deg", "lat_deg") if self.crs else ("map_x", "map_y")))

    def site(self, place):
        """The Site of longitude, latitude and height above the ground; of map x and y without a CRS."""
        if self.terrain is None:
            raise Failed(f"{self._recording}: the scene has no terrain; accepted: frames as places")
        x, y, height = place
        if not self.crs:
            return self.terrain.site(x, y, height)
        if not (abs(x) <= 360.0 and abs(y) <= 90.0):
            raise Failed(f"place {x:.9g},{y:.9g}: accepted: LON,LAT, longitude (east) -360 to 360 and latitude -90 to 90 [deg]")
        site = self.terrain.site(x, y, height, degrees=True)
        left, top, right, bottom = self.terrain.map_extent
        if not self.crs[0].IsGeographic() and not (min(left, right) <= site.x <= max(left, right)
                                                   and min(top, bottom) <= site.y <= max(top, bottom)):
            raise Failed(f"place {x:.9g},{y:.9g} (LON,LAT) is off the terrain: it lies at map x {float(site.x):.9g}, y {float(site.y):.9g}; "
                         f"accepted: map x {left:.9g} to {right:.9g}, y {bottom:.9g} to {top:.9g}")
        return site

    def below(self, path):
        """The Site below the origin of a frame of the recorded scene, as high above the ground as that is."""
        if self._recording is None:
            raise Failed(f"--frame {path}: accepted: with --recording")
        if self.terrain is None:
            raise Failed(f"{self._recording}: the scene has no terrain; accepted: a recording with terrain")
        point = self.terrain.to_map(self.in_terrain(self.placed(path.lstrip("/"))[:3, 3]))
        above = point[2] - self.terrain.height(point[0], point[1], map=True)
        if not above >= 0.0:
            where = "off the data" if math.isnan(above) else f"{-above:.6g} m below the ground"
            raise Failed(f"--frame {path}: it is {where} of terrain {self.terrain.name!r}; accepted: a frame above its data")
        return self.terrain.site(float(point[0]), float(point[1]), float(above))

    def placed(self, frame):
        """The pose of a frame in the root, as a matrix (4, 4)."""
        from dspace.frames.poses import Pose
        return Pose.from_row(self.scene.poses([frame], relative_to=self.scene.root)[0]).matrix

    def in_terrain(self, points):
        """Points (..., 3) in the root, in the terrain's frame."""
        return np.asarray(points, float) @ self._to_terrain[:3, :3].T + self._to_terrain[:3, 3]

    def degrees_of(self, points):
        """Longitude, latitude [deg] and height above the datum [m] of points (n, 3) in the root; map x, y without a
        CRS; NaN without terrain."""
        points = self.in_terrain(points).reshape(-1, 3)
        found = np.full(points.shape, np.nan)
        known = np.isfinite(points).all(axis=1)
        if known.any() and self.terrain is not None:
            map_points = self.terrain.to_map(points[known])
            if self.crs:
                where = self.terrain.locate(points[known])
                map_points = np.column_stack((where.longitude, where.latitude, map_points[:, 2]))
            found[known] = map_points
        return found


def source_of(options, ground):
    """What a result says about its ground."""
    if options.recording is not None:
        return {**ground.source, "at_s": options.at}
    return {"terrain": str(options.terrain), "on_body": ground.on_body}


def _is_in_degrees(options, osr):
    if options.crs:
        crs = osr.SpatialReference()
        try:
            crs.SetFromUserInput(options.crs)
        except RuntimeError:
            return False  # Dspace names what is wrong with it
        return bool(crs.IsGeographic())
    gdal, _ = gdal_modules()
    name = str(options.terrain)
    data = gdal.Open("/vsicurl/" + name if name.startswith(("http://", "https://")) else name)
    crs = data.GetSpatialRef()
    return bool(crs and crs.IsGeographic())


def unit_of(distances):
    """The unit of an axis of distances [m], and its name."""
    known = np.asarray(distances)[np.isfinite(distances)]
    return (1000.0, "km") if known.size and known.max() > 10000.0 else (1.0, "m")


def place_of(text, names, counts, option):
    """The numbers of "LON,LAT,..."."""
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in counts or not all(map(math.isfinite, numbers)):
        raise Failed(f"{option} {text!r}: accepted: {names}, finite numbers")
    return tuple(numbers)


def plain(value):
    """A value for JSON: null in place of NaN and infinity."""
    if isinstance(value, (list, tuple, np.ndarray)):
        return [plain(each) for each in value]
    if isinstance(value, dict):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    if isinstance(value, (float, np.floating)):
        return float(value) if math.isfinite(value) else None
    return value


def text_of(found):
    return json.dumps(plain(found), indent=2, allow_nan=False) + "\n"


def write(out, found, rows, draw):
    """Writes a file by its ending. found: for JSON; rows: a list of dicts for CSV; draw: a function that draws into a
    Figure, for PNG and HTML, or None. The HTML page also has the numbers, the rows, the command line and the versions."""
    ending = out.suffix.lower()
    if ending == ".json":
        atomic_write(out, text_of(found).encode())
        return
    if ending == ".csv":
        lines = [",".join(rows[0])] + [",".join(_cell(value) for value in row.values()) for row in rows]
        atomic_write(out, ("\n".join(lines) + "\n").encode())
        return
    figure = None
    if draw is not None:
        figure = figures()(figsize=(9.0, 4.5), dpi=100, layout="constrained")
        draw(figure)
    if ending == ".html":
        write_page(out, found, rows, figure)
        return
    data = io.BytesIO()
    figure.savefig(data, format="png", metadata={"Software": None})
    atomic_write(out, data.getvalue())


def _cell(value):
    value = plain(value)
    if value is None:
        return ""
    if isinstance(value, bool):
        return "1" if value else "0"
    text = repr(value) if isinstance(value, float) else str(value)
    return f'"{text}"' if "," in text else text
