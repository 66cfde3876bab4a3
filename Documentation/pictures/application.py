"""Screenshots of DspaceQt, each on a display of its own."""
import os
import pathlib
import subprocess
import sys
import tempfile

from pictures.paths import DATA, IMAGES, ROOT


def _screenshot(name, *arguments, size="1280x800", folder=IMAGES):
    program = ROOT / "build" / "release" / "bin" / "DspaceQt"
    if not program.exists():
        print(f"{name} is left as it is: DspaceQt is not built (Qt 6)")
        return
    subprocess.run([ROOT / "Testing" / "Tools" / "with_display", program, "--screenshot", folder / f"{name}.png", "--size",
                    size, *arguments], check=True,
                   env={**os.environ, "XDG_CONFIG_HOME": tempfile.mkdtemp()})  # not the user's settings


def application():
    """The first start."""
    _screenshot("application", "--after", "4")


def application_telemetry():
    """Plots of the demo's telemetry beside its views."""
    with tempfile.NamedTemporaryFile("w", suffix=".py") as script:
        script.write('app.demo()\napp.plot("rover/tilt", "rover/roll", "rover/pitch", title="Attitude")\n')
        script.flush()
        _screenshot("application_telemetry", "--after", "30", script.name)


def application_console():
    """The example of a plug-in: a console of three docks."""
    with tempfile.NamedTemporaryFile("w", suffix=".py") as script:
        script.write("app.demo()\napp.console.send()\napp.console.checks[0].set(value=True)\n")
        script.flush()
        _screenshot("application_console", "--after", "10", "--load-plugin",
                    str(ROOT / "Examples" / "mission_console" / "mission_console.py"), script.name)


def application_terrain():
    """A raster of heights in a view, and the prompt."""
    _screenshot("application_terrain", "--after", "6", os.path.join(DATA, "terrain", "mars_gale_mola_128ppd_m.tif"))


# Gale crater by MOLA: the layers are HRSC's picture, and slopes that a rover does not climb.
TERRAIN = """
import pathlib
data = pathlib.Path({data!r})
path = data / "terrain" / "mars_gale_mola_128ppd_m.tif"
ground = scene.add_terrain(path, name="Gale", mode="clipmap", color=(0.8, 0.78, 0.75), vertical_datum="areoid")
ground.add_image(data / "textures" / "mars_gale_hrsc_color_4096.jpg", name="HRSC",
                 crs="+proj=eqc +lat_ts=0 +lon_0=0 +R=3396190 +units=m", extent=(8068200, -223600, 8268200, -413600))
ground.add_false_color(path, name="MOLA heights", opacity=0.5)
ground.set_style(contours=dict(interval=500, color="black", width=1), grid=1, grid_labels=True)
scene.sun.set(azimuth_deg=300, elevation_deg=35, terrain=ground)
x, y, _ = ground.from_map([[137.8, -5.0, 0.0]])[0]
view = app.new_view()
view.camera.look_at(eye=(x - 30e3, y - 190e3, 130e3), target=(x, y - 10e3, -4000))
app.show_dock("terrain")
"""


def application_terrain_dock():
    """The layers, the legend and the style of real terrain."""
    with tempfile.NamedTemporaryFile("w", suffix=".py") as script:
        script.write(TERRAIN.format(data=os.fspath(DATA)))
        script.flush()
        _screenshot("application_terrain_dock", "--after", "8", "--empty", script.name)


# A traverse over Gale's floor and up Mount Sharp.
MEASURE = TERRAIN + """
app.measure("line", [ground.locate([place], map=True).root[0] for place in
                     [(137.44, -4.59, -4500), (137.38, -4.73, -4400), (137.48, -5.0, -2000), (137.8, -5.08, 0)]], terrain="Gale")
app.show_dock("measure")
"""


def application_measure():
    """Distances, slopes and the profile of a traverse."""
    with tempfile.NamedTemporaryFile("w", suffix=".py") as script:
        script.write(MEASURE.format(data=os.fspath(DATA)))
        script.flush()
        _screenshot("application_measure", "--after", "8", "--empty", script.name)


# --- A tour: each stop is a script, a name, and seconds; at both sizes ---------------------------------

TOUR = {
    "tour_start": ("app.demo()", 5),
    "tour_empty": ("pass", 1),
    "tour_dark": ("app.set_theme('dark'); app.demo(); app.plot('rover/tilt', 'rover/roll', title='Attitude')", 12),
    "tour_light": ("app.set_theme('light'); app.demo(); app.plot('rover/tilt', 'rover/roll', title='Attitude')", 12),
    "tour_preferences": ("app.set_theme('dark'); app.demo(); app.show_dialog('preferences')", 4),
    "tour_keys": ("app.set_theme('light'); app.demo(); app.show_dialog('keys')", 4),
    "tour_guide": ("app.set_theme('dark'); app.demo(); app.show_dialog('guide')", 4),
    "tour_about": ("app.set_theme('light'); app.demo(); app.show_dialog('about')", 4),
    "tour_four": ("app.demo(); app.new_view(); app.new_view()", 6),
}


def tour(folder=None):
    """Pictures of the stops at 1280 x 800 and 2560 x 1440, to be looked at, in out/tour."""
    folder = ROOT / "out" / "tour" if folder is None else folder
    folder.mkdir(parents=True, exist_ok=True)
    for name, (lines, seconds) in TOUR.items():
        with tempfile.NamedTemporaryFile("w", suffix=".py") as script:
            script.write(lines)
            script.flush()
            for size in ("1280x800", "2560x1440"):
                _screenshot(f"{name}_{size}", "--after", str(seconds), script.name, size=size, folder=folder)


def application_dark():
    """The dark theme, with a plot."""
    lines, seconds = TOUR["tour_dark"]
    with tempfile.NamedTemporaryFile("w", suffix=".py") as script:
        script.write(lines)
        script.flush()
        _screenshot("application_dark", "--after", str(seconds), script.name)


# What a plug-in paints over a view and shows in the status bar, in the dark theme.
OVERLAY = """
app.set_theme("dark")
app.demo()
ground = scene.terrains["terrain"]
def at(x, y, above=0.0):
    return (x, y, float(ground.height(x, y)) + above)
over = app.add_overlay()
route = [at(-14 + 2.0 * k, -4 + 0.35 * k, 0.05) for k in range(12)]
over.line(points=route, color="#4fc3f7", width=3)
over.circle(points=route[-1], radius=12, color="#ffd23f", width=3)
over.text("waypoint 7", points=at(route[-1][0], route[-1][1], 0.8), size=16, align="center", color="#ffd23f")
clock = over.text("", at=(14, 28), size=16)
over.text("autonomous, guarded", at=(-14, 28), size=16, align="right", color="#9ccc65")
bus = app.add_read_out("bus", "28.1 V")
heat = app.add_read_out("motor 3", "71 C")
heat.set(state="amber")
app.every(0.2, lambda: clock.set(text=f"sol 312   {scene.time:.1f} s"))
app.show_dock("terrain")
"""


def application_overlay():
    """Overlays and read-outs of a plug-in."""
    with tempfile.NamedTemporaryFile("w", suffix=".py") as script:
        script.write(OVERLAY)
        script.flush()
        _screenshot("application_overlay", "--after", "8", script.name)


# A drive on the shipped field, 20 s, in steps of 0.1 s.
RECORD = """
import math, sys
import dspace
from dspace.shipped.data import shipped_data
data = shipped_data()
with dspace.Session() as session, session.record(sys.argv[1]):
    scene = session.scene()
    ground = scene.add_terrain(data / "field" / "field.tif", mode="clipmap", image=data / "field" / "field_color.tif")
    ground.focus([(0, 0)], radius=16)
    vehicle = dspace.rover.load_vehicle(data / "rover" / "rover.urdf")
    rover = scene.load(data / "rover" / "rover.urdf")
    scene.sun.set(direction=(-0.35, 0.80, 0.48))
    camera = scene.add_camera("chase", eye=(-8, -7, 6), target=(0, 0, 0.3), fov_deg=45)
    view = scene.add_viewport((640, 400), camera, name="main")
    view.set(shadows=True, fill=0.05)
    for step in range(201):
        angle = 0.03 * step
        rover.place(vehicle.solve((4 * math.cos(angle), 4 * math.sin(angle), math.degrees(angle) + 90), ground))
        scene.time = 0.1 * step
"""
KEYS = """
run = app.open({path!r})
from dspace.application.views import own_camera
def key(time, eye, target, **values):
    own_camera(app.view).look_at(eye=eye, target=target)
    return app.movie.add_key(app.view, time, **values)
key(1, (-8, -7, 6), (2, 1, 0))
key(8, (2, -9, 4), (0, 2, 0))
key(8, (8, -3, 3), (-1, 2, 0), freeze=2)
key(15, (7, 7, 5), (0, 0, 0))
app.movie.set_span(2, 14)
app.movie.edit_key(3, easing="rest")
run.seek(8)
own_camera(app.view).look_at(eye=(-9, -16, 11), target=(1, 0, 0))
app.movie.show_path()
"""


def application_keys():
    """Camera keys of a recording, with their path."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "drive.dspace")
        subprocess.run([sys.executable, "-c", RECORD, path], check=True)
        script = os.path.join(folder, "keys.py")
        pathlib.Path(script).write_text(KEYS.format(path=path))
        _screenshot("application_keys", "--after", "8", script)


def application_map():
    """A map in step with a view."""
    with tempfile.NamedTemporaryFile("w", suffix=".py") as script:
        script.write("drive = app.demo()\napp.close_view(app.views['mast'])\ndrive.stop()\n"
                     "view = app.views['chase']\nlink = app.open_map(view)\n"
                     "link.map.set(shadows=True, fill=0.05)\n")
        script.flush()
        _screenshot("application_map", "--after", "8", script.name)


def application_messages():
    """Messages of the simulation, and a question that it asks."""
    with tempfile.NamedTemporaryFile("w", suffix=".py") as script:
        script.write("drive = app.demo()\napp.close_view(app.views['mast'])\ndrive.stop()\n"
                     "scene.log_event('mode', 'drive mode', severity='caution')\n"
                     "scene.log_event('fault', 'wheel 3 is stuck', severity='alarm')\n"
                     "scene.ask('drive', 'The slope ahead is 18 degrees. Go on?', ['Yes', 'No', 'Turn left'], severity='warning')\n")
        script.flush()
        _screenshot("application_messages", "--after", "8", script.name)
