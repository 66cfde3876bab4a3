"""Screenshots of DspaceQt, each on a display of its own."""
import os
import subprocess
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
