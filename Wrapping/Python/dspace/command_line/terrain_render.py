"""`dspace terrain render`."""
import math
import pathlib
import sys

import numpy as np

from dspace._core.files import atomic_write
from dspace.command_line import Failed, terrain_layers
from dspace.command_line.terrain_map import BRIGHTNESS, draw_disc, draw_map, light_view
from dspace.command_line.terrain_rasters import add, check, degrees, gdal_modules, open_raster

LONGER_SIDE = 1024
GROUND = (0.72, 0.69, 0.65)
SKY = (0.0, 0.0, 0.0)


def run(options):
    import dspace
    check(options)
    terrain_layers.check(options)
    out = pathlib.Path(options.out)
    if out.suffix.lower() not in (".png", ".jpg", ".jpeg", ".tif", ".tiff"):
        raise Failed(f"'{out}': the picture's format is unknown; accepted: .png, .jpg, .tif")
    if not out.resolve().parent.is_dir():
        raise Failed(f"'{out}': there is no folder {out.resolve().parent}")
    if options.view == "map" and (options.eye or options.target):
        raise Failed("--eye and --target apply to perspective views; accepted: --view perspective with them")
    if options.exaggeration not in (None, 1.0) and (options.view == "perspective" or options.shadows):
        raise Failed(f"--exaggeration {options.exaggeration:g}; accepted on maps without --shadows")
    if options.color_by_height is None:
        options.color_by_height = options.view == "map" and not options.layers
    options.level_size = options.level_size or 252
    with dspace.Session() as session:
        scene = session.scene()
        ground = Ground(scene, options)
        set_sun(scene, ground, options)
        if options.view == "perspective":
            picture, told = draw_perspective(session, scene, ground, options)
        else:
            draw = draw_disc if options.on_body else draw_map
            picture, told = draw(session, scene, ground, options, LONGER_SIDE)
        save(out, picture)
    print(f"{out}: {picture.shape[1]} x {picture.shape[0]} pixels, {told}")


def save(path, picture):
    gdal, _ = gdal_modules()
    driver = {".png": "PNG", ".jpg": "JPEG", ".jpeg": "JPEG"}.get(path.suffix.lower(), "GTiff")
    height, width = picture.shape[:2]
    memory = gdal.GetDriverByName("MEM").Create("", width, height, 3, gdal.GDT_Byte)
    memory.WriteArray(np.ascontiguousarray(np.moveaxis(picture[..., :3], -1, 0)))
    gdal.SetConfigOption("GDAL_PAM_ENABLED", "NO")  # no metadata file beside the picture
    name = f"/vsimem/dspace-render-{id(memory)}"
    try:
        gdal.GetDriverByName(driver).CreateCopy(name, memory).FlushCache()
        atomic_write(path, bytes_of(gdal, name))
    finally:
        gdal.Unlink(name)


def bytes_of(gdal, name):
    """Returns the contents of a file in GDAL's memory."""
    file = gdal.VSIFOpenL(name, "rb")
    try:
        return bytes(gdal.VSIFReadL(1, gdal.VSIStatL(name).size, file))
    finally:
        gdal.VSIFCloseL(file)


class Ground:
    """The terrains of a picture in one frame."""

    def __init__(self, scene, options):
        gdal, osr = gdal_modules()
        look = {"color": GROUND}
        if options.color_by_height:
            look = {"relief": {"color_by_height": True}}
        self.on_body = options.on_body
        self.terrains, self.maps = [], []
        for number, path in enumerate(options.files):
            more = {}
            if number and not self.on_body:
                more["origin"] = tuple(self.terrains[0].to_map([[0.0, 0.0, 0.0]])[0])
            terrain, warned = add(scene, path, options, name=f"terrain {number}", on_body=self.on_body,
                                  **look, **more)
            if self.terrains and terrain.crs != self.terrains[0].crs:
                raise Failed(f"'{path}': its CRS differs from that of '{options.files[0]}'; accepted: rasters "
                             "of one CRS")
            for warning in warned:
                print(f"dspace: note: {path}: {warning}", file=sys.stderr)
            self.terrains.append(terrain)
            self.maps.append(map_extent(*open_raster(gdal, path, options)))
        terrain_layers.paint(self.terrains, options)
        self.crs = degrees(osr, self.terrains[0].crs)
        self.heights = (min(terrain.height_range[0] for terrain in self.terrains),
                        max(terrain.height_range[1] for terrain in self.terrains))
        info = self.terrains[0]._info()
        self.levels = info.levels
        x0, x1, _, _ = self.maps[0]
        if self.on_body:
            self.radius = float(np.linalg.norm(self.place((*self.middle, 0.0))))
            metres_per_unit = math.radians(self.radius) if self.crs[0].IsGeographic() else self.crs[0].GetLinearUnits()
        else:
            west, east, _, _ = self.terrains[0].extent
            metres_per_unit = (east - west) / (x1 - x0) if x1 > x0 else 1.0
        self.post = info.pixel_width * metres_per_unit / 2 ** info.subdivisions  # [m]

    @property
    def extent(self):
        """(west, east, south, north) of all posts, in the frame of a plane."""
        every = np.array([terrain.extent for terrain in self.terrains])
        return every[:, 0].min(), every[:, 1].max(), every[:, 2].min(), every[:, 3].max()

    @property
    def middle(self):
        """Map x and y of the middle of all rasters."""
        every = np.array(self.maps)
        return (0.5 * (every[:, 0].min() + every[:, 1].max()), 0.5 * (every[:, 2].min() + every[:, 3].max()))

    def place(self, point):
        """Returns the position, in the frame, of map x, y and height."""
        return self.terrains[0].from_map(np.array([point], float))[0]

    def place_of_degrees(self, point):
        """Returns the position, in the frame, of longitude, latitude and height, or of map x, y and height without a
        CRS."""
        if self.crs and not self.crs[0].IsGeographic():
            _, osr = gdal_modules()
            x, y, _ = osr.CoordinateTransformation(self.crs[1], self.crs[0]).TransformPoint(*point[:2])
            point = (x, y, point[2])
        place = self.place(point)
        if not np.isfinite(place).all():
            raise Failed(f"the point {point} is not on the map of '{self.terrains[0].name}'")
        return place

    def grid(self, count=25):
        """Returns a grid of points on the ground, in the frame, (n, 3)."""
        points = []
        for terrain, (x0, x1, y0, y1) in zip(self.terrains, self.maps):
            x, y = (a.ravel() for a in np.meshgrid(np.linspace(x0, x1, count), np.linspace(y0, y1, count)))
            heights = terrain.height(x, y, map=True)
            heights = np.where(np.isfinite(heights), heights, self.heights[1])
            points.append(terrain.from_map(np.column_stack((x, y, heights))))
        return np.concatenate(points)

    def above_body(self, points):
        """Returns the heights of points of the frame (..., 3) above the body's own surface, and the normals there."""
        equator, pole = (float(np.linalg.norm(self.terrains[0].from_map(np.array([[*place, 0.0]]))))
                         if self.crs[0].IsGeographic() else self.radius for place in ((0.0, 0.0), (0.0, 90.0)))
        distance = np.linalg.norm(points, axis=-1)
        scaled = points / (equator, equator, pole)
        surface = distance / np.linalg.norm(scaled, axis=-1)
        normals = points / (equator**2, equator**2, pole**2)
        normals = np.nan_to_num(normals / np.linalg.norm(normals, axis=-1, keepdims=True), nan=0.0)
        normals[~np.isfinite(distance)] = (0.0, 0.0, 1.0)
        return distance - surface, normals

    def axes(self, place):
        """Returns the directions east, north and up at a position of the frame, as rows."""
        if not self.on_body:
            return np.eye(3)
        up = place / np.linalg.norm(place)
        east = np.cross((0.0, 0.0, 1.0), up)
        if np.linalg.norm(east) < 1e-9:
            east = np.array([0.0, 1.0, 0.0])
        east /= np.linalg.norm(east)
        return np.array([east, np.cross(up, east), up])


def map_extent(data, to_map):
    """Returns map x0, x1, y0, y1 of the centres of the outermost pixels."""
    g = to_map
    corners = np.array([(u, v) for u in (0.5, data.RasterXSize - 0.5) for v in (0.5, data.RasterYSize - 0.5)])
    x, y = g[0] + corners @ g[1:3], g[3] + corners @ g[4:6]
    return x.min(), x.max(), y.min(), y.max()


def set_sun(scene, ground, options):
    """Sets the sun's direction. Its angles hold at the target, or at the middle of the ground without one."""
    place = ground.place((*ground.middle, 0.0)) if options.target is None else ground.place_of_degrees(options.target)
    azimuth, elevation = np.radians(options.sun)
    toward = np.array([np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation),
                       np.sin(elevation)]) @ ground.axes(place)
    scene.sun.set(direction=toward, irradiance=BRIGHTNESS * 1361)
    ground.sun = toward


def draw_perspective(session, scene, ground, options):
    """Draws a picture from the eye, or from the south with all of the ground visible if no eye is given."""
    width, height = options.size or (LONGER_SIDE, LONGER_SIDE * 9 // 16)
    points = ground.grid()
    middle = ground.place((*ground.middle, 0.5 * sum(ground.heights)))
    target = middle if options.target is None else ground.place_of_degrees(options.target)
    east, north, up = ground.axes(middle)
    if options.eye is None:
        # Move back along the line of sight until every point is within the picture.
        slope = math.radians(90 if ground.on_body and np.ptp(points, axis=0).max() > ground.radius else 35)
        back = -math.cos(slope) * north + math.sin(slope) * up
        right, down = east, np.cross(-back, east)
        tangent = math.tan(math.radians(options.fov) / 2)
        across = np.maximum(np.abs((points - target) @ right) * height / width, np.abs((points - target) @ down))
        eye = target + back * 1.03 * np.max((points - target) @ back + across / tangent)
    else:
        eye = ground.place_of_degrees(options.eye)
    towards = (target - eye) / np.linalg.norm(target - eye)
    above = ground.axes(eye)[2]
    vertical = north if abs(above @ towards) > 0.9999 else above
    if abs(vertical @ towards) > 0.9999:
        raise Failed("the eye and the target are the same point; accepted: two different points")
    near = max(0.05, 1e-6 * float(np.linalg.norm(target - eye)))
    scene.add_camera("eye", eye=tuple(eye), target=tuple(target), up=tuple(vertical), fov_deg=options.fov,
                     near=near)
    view = scene.add_viewport((width, height), "eye", samples=3 if width * height < 3_000_000 else 2)
    view.set_background(SKY)
    light_view(view, options)
    picture = view.image().copy()
    place = ground.terrains[0].to_map(np.array([eye]))[0]
    triangles = session.statistics["triangles_drawn"]
    if not triangles:
        print("dspace: note: no ground is in view; --eye and --target are LON,LAT,H", file=sys.stderr)
    return picture, (f"seen from map {place[0]:.9g}, {place[1]:.9g}, height {place[2]:.6g} m; "
                     f"{triangles} triangles")
