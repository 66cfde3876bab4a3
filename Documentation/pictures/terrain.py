"""Pictures of terrain: real data."""
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import dspace
from pictures.paths import DATA, IMAGES

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "Examples" / "polar_site"))
import polar_ground  # noqa: E402

SHADES = ("#3b0f70", "#2c56c8", "#1fa5c9", "#3fbf5f", "#e6d44a", "#e5832f", "#c03a2b", "#a98a84", "#f5f2f0")


def place(terrain, longitude, latitude, height):
    return terrain.from_map([[longitude, latitude, height]])[0]


def axes_at(point):
    """East, north and up there on a body."""
    up = point / np.linalg.norm(point)
    east = np.cross((0.0, 0.0, 1.0), up)
    east /= np.linalg.norm(east)
    return east, np.cross(up, east), up


def light(scene, falls, intensity):
    """falls: the direction in which sunlight falls; intensity: of the Sun at 1 au."""
    scene.sun.set(direction=-np.asarray(falls), irradiance=1361 * intensity)


def picture(scene, name, size, eye, target, up, falls, intensity, fov_deg, sky=0.05):
    """falls: the direction in which sunlight falls; intensity and sky: of the Sun at 1 au."""
    light(scene, falls, intensity)
    scene.add_camera("eye", eye=tuple(eye), target=tuple(target), up=tuple(up), fov_deg=fov_deg, near=10.0)
    view = scene.add_viewport(size, "eye", samples=3)
    view.fill = sky / intensity
    view.set_background((0.02, 0.02, 0.03))
    view.save(IMAGES / f"{name}.png")


def levels():
    """The levels of a clipmap in false colour: Gale crater, heights doubled."""
    with dspace.Session() as session:
        scene = session.scene()
        terrain = scene.add_terrain(f"{DATA}/terrain/mars_gale_mola_128ppd_m.tif", mode="clipmap", level_size=60,
                                    color=(0.8, 0.78, 0.75), vertical_scale=2, vertical_datum="areoid")
        terrain.set_style(levels=0.65)
        x, y, _ = place(terrain, 137.75, -5.1, 0.0)
        eye = (x - 20e3, y - 48e3, terrain.height(x - 20e3, y - 48e3) + 8500)
        target = (x - 6e3, y - 14e3, terrain.height(x, y) - 9500)
        picture(scene, "terrain_levels", (640, 400), eye, target, (0, 0, 1), (0.85, 0.2, -0.4), 1.9, 50, 0.08)


def gale_shapes(folder):
    """Curiosity's way, and 20 km about where it landed, as GeoJSON in degrees."""
    drive = json.loads(pathlib.Path(DATA, "terrain/mars_gale_msl_traverse.json").read_text())
    turn = np.arange(0, 361, 3) * np.pi / 180

    def degrees(east, north):
        metres = np.radians(3396190.0)
        return np.column_stack((137.4417 + east / metres / np.cos(np.radians(4.5895)),
                                -4.5895 + north / metres)).tolist()

    way = degrees(*(np.array([(p["x"], -p["z"]) for p in drive["points"]]).T))
    around = degrees(20e3 * np.cos(turn), 20e3 * np.sin(turn))
    path = pathlib.Path(folder) / "gale.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"stroke": "#ffffff", "fill": "#ffffff", "fill-opacity": 0.12},
         "geometry": {"type": "Polygon", "coordinates": [around]}},
        {"type": "Feature", "properties": {"stroke": "#ff2020"},
         "geometry": {"type": "LineString", "coordinates": way}}]}))
    return path


def layers():
    """Gale crater: heights in false colour, HRSC's image, shapes; heights doubled."""
    with dspace.Session() as session, tempfile.TemporaryDirectory() as folder:
        scene = session.scene()
        path = f"{DATA}/terrain/mars_gale_mola_128ppd_m.tif"
        terrain = scene.add_terrain(path, mode="clipmap", level_size=252, color=(0.8, 0.78, 0.75),
                                    vertical_scale=2, vertical_datum="areoid")
        terrain.add_false_color(path, colors=SHADES, opacity=0.8)
        terrain.add_image(f"{DATA}/textures/mars_gale_hrsc_color_4096.jpg",
                          crs="+proj=eqc +lat_ts=0 +lon_0=0 +R=3396190 +units=m",
                          extent=(8068200, -223600, 8268200, -413600))
        terrain.add_shapes(gale_shapes(folder), crs="IAU_2015:49900", width=900)
        x, y, _ = place(terrain, 137.9, -5.0, 0.0)
        eye = (x - 50e3, y - 175e3, terrain.height(x, y) + 125e3)
        picture(scene, "terrain_layers", (640, 400), eye, (x, y - 10e3, -8000), (0, 0, 1), (0.8, 0.3, -0.5), 1.7,
                48, 0.1)


def normals():
    """Gale crater with a sixteenth of its posts a side, and shaded by the normals of all of them."""
    from osgeo import gdal
    gdal.UseExceptions()
    source = gdal.Open(f"{DATA}/terrain/mars_gale_mola_128ppd_m.tif")
    z = source.ReadAsArray().astype(float)[:896, :896]
    left, step, _, top, _, _ = source.GetGeoTransform()
    north = np.radians(step) * 3396190.0
    latitude = np.radians(top - step * (np.arange(896) + 0.5))[:, None]
    south_slope, east_slope = np.gradient(z)
    n = np.stack([-east_slope / (north * np.cos(latitude)), south_slope / north, np.ones_like(z)])
    n /= np.linalg.norm(n, axis=0)

    def write(path, bands, pixel):
        data = gdal.GetDriverByName("GTiff").Create(str(path), bands.shape[2], bands.shape[1], len(bands),
                                                    gdal.GDT_Float32)
        data.SetGeoTransform((left, pixel, 0, top, 0, -pixel))
        data.SetProjection(source.GetProjection())
        for number, band in enumerate(bands, 1):
            data.GetRasterBand(number).WriteArray(band)
        data.FlushCache()
        return path

    with dspace.Session() as session, tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        scene = session.scene()
        coarse = z.reshape(56, 16, 56, 16).mean(axis=(1, 3))
        terrain = scene.add_terrain(write(folder / "coarse.tif", coarse[None], 16 * step), mode="clipmap",
                                    color=(0.78, 0.62, 0.48), vertical_datum="areoid")
        light(scene, (0.85, 0.2, -0.35), 1.9)
        x, y, _ = place(terrain, 137.85, -5.3, 0.0)
        scene.add_camera(eye=(x - 30e3, y - 160e3, 110e3), target=(x, y, -3000), fov_deg=50, near=10.0)
        view = scene.add_viewport((440, 330), samples=3)
        view.fill = 0.03
        view.save(folder / "heights.png")
        terrain.add_normals(write(folder / "normals.tif", n, step), axes="local")
        view.save(folder / "normals.png")
        subprocess.run(["ffmpeg", "-y", "-loglevel", "error", "-i", folder / "heights.png", "-i",
                        folder / "normals.png", "-filter_complex", "[0]pad=iw+8:ih:0:0:white[a];[a][1]hstack",
                        "-frames:v", "1", IMAGES / "terrain_normals.png"], check=True)


def mars(scene, viking, **settings):
    if viking:
        settings.update(image=f"{DATA}/textures/mars_viking_mdim21_color_2880.jpg", image_crs="IAU_2015:49900",
                        image_extent=(-180, 90, 180, -90))
    return scene.add_terrain(f"{DATA}/terrain/mars_mola_megt90n000cb_4ppd_m.tif", on_body=True, level_size=252,
                             vertical_datum="areoid", **settings)


def far_shadows():
    """Gale with the Sun 4 degrees above the eastern horizon."""
    with dspace.Session() as session:
        scene = session.scene()
        terrain = scene.add_terrain(f"{DATA}/terrain/mars_gale_mola_128ppd_m.tif", mode="clipmap", color=(0.7, 0.5, 0.4),
                                    vertical_datum="areoid")
        x, y, _ = place(terrain, 137.75, -5.1, 0.0)
        ground = terrain.height(x, y)
        scene.sun.set(azimuth_deg=85, elevation_deg=4, terrain=terrain, irradiance=3 * 1361)
        scene.add_camera("eye", eye=(x - 20e3, y - 150e3, ground + 60e3), target=(x, y, ground), fov_deg=50, near=10.0)
        view = scene.add_viewport((960, 540), "eye", samples=2)
        view.set(shadows=True, fill=0.02)
        view.save(IMAGES / "far_shadows.png")


def pole():
    """Generated ground in a polar stereographic projection on the Moon's sphere, the Sun 2 degrees above the horizon of the pole."""
    with dspace.Session() as session, tempfile.TemporaryDirectory() as folder:
        scene = session.scene()
        path = pathlib.Path(folder) / "ground.tif"
        polar_ground.write(path, 2000, 20.0)
        terrain = scene.add_terrain(path, on_body=True, color=(0.62, 0.6, 0.58), vertical_scale=1)
        terrain.set_style(grid={"interval": 0.1, "color": (0.35, 0.65, 1.0), "opacity": 0.9},
                          contours={"interval": 200.0, "color": (0.9, 0.65, 0.2), "opacity": 0.7})
        target = terrain.from_map([[1500.0, 1500.0, 0.0]])[0]
        eye = terrain.from_map([[-9000.0, -13000.0, 9500.0]])[0]
        up = eye / np.linalg.norm(eye)
        scene.sun.set(azimuth_deg=100, elevation_deg=2.5, terrain=terrain, at=(0.0, 0.0), irradiance=5 * 1361)
        scene.add_camera("eye", eye=eye, target=target, up=up, fov_deg=48)
        view = scene.add_viewport((960, 540), "eye", samples=2)
        view.set(shadows=True, fill=0.05)
        view.save(IMAGES / "terrain_pole.png")


def whole_mars():
    with dspace.Session() as session:
        scene = session.scene()
        terrain = mars(scene, True, vertical_scale=1)
        eye = place(terrain, -80, 10, 8.2e6)
        east, _, up = axes_at(eye)
        light = -(0.8 * up - 0.6 * east + (0, 0, 0.25))
        picture(scene, "terrain_mars", (420, 420), eye, (0, 0, 0), (0, 0, 1), light, 1.6, 36, 0.02)


def labels():
    """Mars by height, with a legend and the values of its grid."""
    with dspace.Session() as session:
        scene = session.scene()
        terrain = mars(scene, False, vertical_scale=1)
        terrain.set_style(color_by="height", range=(-8000, 20000), colors=SHADES, grid_labels=True,
                          grid=dict(interval=15, color="white", opacity=0.6))
        light(scene, (0.9, 0.35, -0.25), 1.4)
        scene.add_camera("eye", eye=tuple(place(terrain, -100, 25, 8.2e6)), target=(0, 0, 0), up=(0, 0, 1),
                         fov_deg=36, near=10.0)
        view = scene.add_viewport((720, 560), "eye", samples=3)
        view.fill = 0.1
        view.set_background((0.02, 0.02, 0.03))
        view.legend_of(terrain)
        view.save(IMAGES / "terrain_labels.png")


def valles_marineris():
    """By height and textured; heights tripled."""
    for name, viking in (("terrain_valles_height", False), ("terrain_valles", True)):
        with dspace.Session() as session:
            scene = session.scene()
            terrain = mars(scene, viking, vertical_scale=3)
            if not viking:
                terrain.set_style(color_by="height", range=(-18000, 24000), colors=SHADES)
            eye, target = place(terrain, -72, -23, 6.5e5), place(terrain, -70, -11.3, 0)
            east, north, up = axes_at(target)
            picture(scene, name, (640, 400), eye, target, up, -(0.5 * up + 0.75 * east + 0.3 * north), 1.7, 52)


def two_views():
    """Valles Marineris as a map in false colour and in Viking's colours: one terrain in two viewports."""
    with dspace.Session() as session, tempfile.TemporaryDirectory() as folder:
        scene = session.scene()
        terrain = mars(scene, True, vertical_scale=1)
        target = place(terrain, -68, -11, 0)
        east, north, up = axes_at(target)
        light(scene, -(0.6 * up + 0.75 * east + 0.2 * north), 1.7)
        scene.add_camera("above", eye=tuple(target + 3e6 * up), target=tuple(target), up=tuple(north), fov_deg=36,
                         near=10.0)
        scene.add_camera("oblique", eye=tuple(place(terrain, -72, -30, 1.3e6)), target=tuple(target), up=tuple(up),
                         fov_deg=40, near=10.0)
        chart, natural = (scene.add_viewport((360, 320), camera, samples=3) for camera in ("above", "oblique"))
        chart.fill = natural.fill = 0.06
        terrain.set_style(color_by="height", range=(-6000, 12000), colors=SHADES, contours=dict(interval=2000, opacity=0.5),
                          grid=dict(interval=10, color="white", opacity=0.6), grid_labels=True, viewport=chart)
        chart.legend_of(terrain, anchor="top right", length=150)
        stills = [pathlib.Path(folder) / f"{name}.png" for name in ("chart", "natural")]
        for view, still in zip((chart, natural), stills):
            view.set_background((0.02, 0.02, 0.03))
            view.save(still)
        subprocess.run(["ffmpeg", "-y", "-loglevel", "error", "-i", stills[0], "-i", stills[1], "-filter_complex",
                        "[0]pad=iw+8:ih:0:0:white[a];[a][1]hstack", "-frames:v", "1",
                        IMAGES / "terrain_two_views.png"], check=True)


def flat_earth(folder):
    """Heights of 0 over the whole Earth, in degrees of WGS 84."""
    from osgeo import gdal, osr
    path = pathlib.Path(folder, "earth.tif")
    data = gdal.GetDriverByName("GTiff").Create(str(path), 720, 360, 1, gdal.GDT_Float32)
    data.SetGeoTransform((-180, 0.5, 0, 90, 0, -0.5))
    reference = osr.SpatialReference()
    reference.ImportFromEPSG(4326)
    data.SetProjection(reference.ExportToWkt())
    data.GetRasterBand(1).SetUnitType("m")
    data.GetRasterBand(1).Fill(0.0)
    return path


def earth():
    """The Earth on WGS 84 in Blue Marble's colours, with a grid of geodetic latitudes."""
    with dspace.Session() as session, tempfile.TemporaryDirectory() as folder:
        scene = session.scene()
        terrain = scene.add_terrain(flat_earth(folder), name="earth", on_body=True, vertical_datum="ellipsoid",
                                    level_size=252, image=f"{DATA}/textures/earth_bluemarble.jpg", image_crs="EPSG:4326",
                                    image_extent=(-180, 90, 180, -90))
        terrain.set_style(grid=dict(interval=15, color="white", opacity=0.35), grid_labels=True)
        eye = place(terrain, -60, 25, 1.7e7)
        east, _, up = axes_at(eye)
        light = -(0.85 * up - 0.5 * east + np.array((0, 0, 0.1)))
        picture(scene, "terrain_earth", (420, 420), eye, (0, 0, 0), (0, 0, 1), light, 1.5, 36, 0.03)
