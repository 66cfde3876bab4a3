"""Generates the pictures of the documentation: ./dspace python Documentation/make_pictures.py

Those of real data are made where DSPACE_DATA names it, and left as they are otherwise."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import dspace
from dspace.links.serving import ServerProcess

ROOT = pathlib.Path(__file__).resolve().parents[1]
IMAGES = ROOT / "Documentation" / "images"
DEMO = ROOT / "Examples" / "rover_drive"
sys.path.insert(0, str(DEMO))


def first_picture():
    with dspace.Session() as session:
        scene = session.scene()
        ground = scene.add_terrain(ROOT / "Data/field/field.tif",
                                   image=ROOT / "Data/field/field_color.tif")
        ground.focus([(0, 0)])
        rover = scene.load(ROOT / "Data/rover/rover.urdf")
        rover.place(dspace.rover.load_vehicle(ROOT / "Data/rover/rover.urdf").solve((0, 0, 0), ground))
        scene.add_camera(eye=(3, -3, ground.height(3, -3) + 1),
                         target=(0, 0, ground.height(0, 0) + 0.5))
        scene.add_viewport(size=(720, 405), samples=3).save(IMAGES / "first.png")


def demo(name, seconds, *arguments):
    """One drive; its four stills tiled."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, DEMO / "rover_drive.py", "--out", folder, "--seconds",
                        str(seconds), "--size", "960x540", *arguments], check=True)
        stills = [pathlib.Path(folder) / f"{view}.png" for view in ("chase", "mast", "overhead", "free")]
        inputs = [part for still in stills for part in ("-i", str(still))]
        subprocess.run(["ffmpeg", "-y", "-loglevel", "error", *inputs, "-filter_complex",
                        "[0][1]hstack[a];[2][3]hstack[b];[a][b]vstack,scale=960:-1", "-frames:v", "1",
                        str(IMAGES / f"{name}.png")], check=True)


def movie():
    """A picture of the reference simulation's movie, 1.6 s after its start."""
    sys.path.insert(0, str(ROOT / "Examples" / "rover_mobility"))
    from dspace.movies.draw import Stage, open_run, png
    import rover_mobility
    flight = dspace.Movie.load(ROOT / "Examples" / "rover_mobility" / "flight.toml", size=(960, 540), samples=3)
    simulation = rover_mobility.run()
    with simulation.session:
        (IMAGES / "movie.png").write_bytes(png(Stage(flight, open_run(simulation)).picture(40)))


def banner():
    """What a viewer shows of a simulation that was killed."""
    drive = ("import sys, time, dspace, rover_mobility\n"
             "session = dspace.connect(sys.argv[1], name='rover mobility')\n"
             "simulation = rover_mobility.Simulation(session, folder=sys.argv[2])\n"
             "simulation.scene.add_camera('side', frame='rover', eye=(1.6, -2.6, 1.1), target=(0, 0, 0), fov_deg=38)\n"
             "view = simulation.scene.add_viewport((640, 360), 'side', name='side', samples=3)\n"
             "view.set_background((0.75, 0.6, 0.5), top=(0.45, 0.4, 0.4))\n"
             "simulation.advance(4.0)\n"
             "view.set_table('state', {'time': '4.00 s', 'speed': '0.40 m/s'}, anchor='bottom left')\n"
             "print('driven', flush=True)\n"
             "time.sleep(600)\n")
    with tempfile.TemporaryDirectory() as folder, ServerProcess([folder]) as server:
        path = os.pathsep.join([str(ROOT / "Examples" / "rover_mobility"), os.environ.get("PYTHONPATH", "")])
        simulation = subprocess.Popen([sys.executable, "-c", drive, server.address, folder], stdout=subprocess.PIPE,
                                      env={**os.environ, "PYTHONPATH": path})
        simulation.stdout.readline()
        with dspace.watch(server.address) as watcher:
            simulation.kill()
            simulation.communicate()
            while watcher.simulation is not None:
                watcher.update(1.0)
            watcher.viewports["side"].save(IMAGES / "banner.png")


# --- Terrain ---------------------------------------------------------------------------------------

SHADES = ("#3b0f70", "#2c56c8", "#1fa5c9", "#3fbf5f", "#e6d44a", "#e5832f", "#c03a2b", "#a98a84", "#f5f2f0")


def place(terrain, longitude, latitude, height):
    return terrain.from_map([[longitude, latitude, height]])[0]


def axes_at(point):
    """East, north and up there on a body."""
    up = point / np.linalg.norm(point)
    east = np.cross((0.0, 0.0, 1.0), up)
    east /= np.linalg.norm(east)
    return east, np.cross(up, east), up


def picture(scene, name, size, eye, target, up, light, intensity, fov_deg, sky=0.05):
    """light: the direction in which it falls."""
    scene.lights["sun"].set(direction=tuple(light), intensity=intensity)
    scene.lights["sky"].set(intensity=sky)
    scene.add_camera("eye", eye=tuple(eye), target=tuple(target), up=tuple(up), fov_deg=fov_deg, near=10.0)
    view = scene.add_viewport(size, "eye", samples=3)
    view.set_background((0.02, 0.02, 0.03))
    view.save(IMAGES / f"{name}.png")


def levels(data):
    """The levels of a clipmap in false colour: Gale crater, heights doubled."""
    with dspace.Session() as session:
        scene = session.scene()
        terrain = scene.add_terrain(f"{data}/terrain/mars_gale_mola_128ppd_m.tif", mode="clipmap", level_size=60,
                                    color=(0.8, 0.78, 0.75), vertical_scale=2, vertical_datum="areoid")
        terrain.set_style(levels=0.65)
        x, y, _ = place(terrain, 137.75, -5.1, 0.0)
        eye = (x - 20e3, y - 48e3, terrain.height(x - 20e3, y - 48e3) + 8500)
        target = (x - 6e3, y - 14e3, terrain.height(x, y) - 9500)
        picture(scene, "terrain_levels", (640, 400), eye, target, (0, 0, 1), (0.85, 0.2, -0.4), 1.9, 50, 0.08)


def gale_shapes(data, folder):
    """Curiosity's way, and 20 km about where it landed, as GeoJSON in degrees."""
    drive = json.loads(pathlib.Path(data, "terrain/mars_gale_msl_traverse.json").read_text())
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


def layers(data):
    """Gale crater: heights in false colour, HRSC's image, shapes; heights doubled."""
    with dspace.Session() as session, tempfile.TemporaryDirectory() as folder:
        scene = session.scene()
        path = f"{data}/terrain/mars_gale_mola_128ppd_m.tif"
        terrain = scene.add_terrain(path, mode="clipmap", level_size=252, color=(0.8, 0.78, 0.75),
                                    vertical_scale=2, vertical_datum="areoid")
        terrain.add_false_color(path, colors=SHADES, opacity=0.8)
        terrain.add_image(f"{data}/textures/mars_gale_hrsc_color_4096.jpg",
                          crs="+proj=eqc +lat_ts=0 +lon_0=0 +R=3396190 +units=m",
                          extent=(8068200, -223600, 8268200, -413600))
        terrain.add_shapes(gale_shapes(data, folder), crs="IAU_2015:49900", width=900)
        x, y, _ = place(terrain, 137.9, -5.0, 0.0)
        eye = (x - 50e3, y - 175e3, terrain.height(x, y) + 125e3)
        picture(scene, "terrain_layers", (640, 400), eye, (x, y - 10e3, -8000), (0, 0, 1), (0.8, 0.3, -0.5), 1.7,
                48, 0.1)


def mars(scene, data, viking, **settings):
    if viking:
        settings.update(image=f"{data}/textures/mars_viking_mdim21_color_2880.jpg", image_crs="IAU_2015:49900",
                        image_extent=(-180, 90, 180, -90))
    return scene.add_terrain(f"{data}/terrain/mars_mola_megt90n000cb_4ppd_m.tif", on_body=True, level_size=252,
                             vertical_datum="areoid", **settings)


def whole_mars(data):
    with dspace.Session() as session:
        scene = session.scene()
        terrain = mars(scene, data, True, vertical_scale=1)
        eye = place(terrain, -80, 10, 8.2e6)
        east, _, up = axes_at(eye)
        light = -(0.8 * up - 0.6 * east + (0, 0, 0.25))
        picture(scene, "terrain_mars", (420, 420), eye, (0, 0, 0), (0, 0, 1), light, 1.6, 36, 0.02)


def labels(data):
    """Mars by height, with a legend and the values of its grid."""
    with dspace.Session() as session:
        scene = session.scene()
        terrain = mars(scene, data, False, vertical_scale=1)
        terrain.set_style(color_by="height", range=(-8000, 20000), colors=SHADES, grid_labels=True,
                          grid=dict(interval=15, color="white", opacity=0.6))
        scene.lights["sun"].set(direction=(0.9, 0.35, -0.25), intensity=1.4)
        scene.lights["sky"].set(intensity=0.15)
        scene.add_camera("eye", eye=tuple(place(terrain, -100, 25, 8.2e6)), target=(0, 0, 0), up=(0, 0, 1),
                         fov_deg=36, near=10.0)
        view = scene.add_viewport((720, 560), "eye", samples=3)
        view.set_background((0.02, 0.02, 0.03))
        view.legend_of(terrain)
        view.save(IMAGES / "terrain_labels.png")


def valles_marineris(data):
    """By height and textured; heights tripled."""
    for name, viking in (("terrain_valles_height", False), ("terrain_valles", True)):
        with dspace.Session() as session:
            scene = session.scene()
            terrain = mars(scene, data, viking, vertical_scale=3)
            if not viking:
                terrain.set_style(color_by="height", range=(-18000, 24000), colors=SHADES)
            eye, target = place(terrain, -72, -23, 6.5e5), place(terrain, -70, -11.3, 0)
            east, north, up = axes_at(target)
            picture(scene, name, (640, 400), eye, target, up, -(0.5 * up + 0.75 * east + 0.3 * north), 1.7, 52)


def main():
    IMAGES.mkdir(exist_ok=True)
    first_picture()
    demo("demo", 9)
    movie()
    banner()
    data = os.environ.get("DSPACE_DATA", "")
    if pathlib.Path(data, "models").is_dir():
        demo("m2020_gale", 1, "--terrain", f"{data}/terrain/mars_gale_mola_128ppd_m.tif", "--model",
             f"{data}/models/m2020_rover/m2020.urdf")
        demo("rocky7_apollo15", 2, "--terrain", f"{data}/terrain/moon_apollo15_nac_dtm_257.png",
             "--vertical-scale", "0.19216", "--pixel-size", "2", "--model", f"{data}/models/rocky7_vrml")
        demo("viper_north_pole", 2, "--terrain", f"{data}/terrain/moon_npole_stereo_33.tif", "--model",
             f"{data}/models/viper_obj")
    if pathlib.Path(data, "terrain").is_dir():
        levels(data)
        layers(data)
        whole_mars(data)
        labels(data)
        valles_marineris(data)


if __name__ == "__main__":
    main()
