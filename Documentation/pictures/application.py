"""Screenshots of DspaceQt, each on a display of its own."""
import os
import subprocess
import tempfile

from pictures.paths import DATA, IMAGES, ROOT


def _screenshot(name, *arguments):
    program = ROOT / "build" / "release" / "bin" / "DspaceQt"
    if not program.exists():
        print(f"{name} is left as it is: DspaceQt is not built (Qt 6)")
        return
    subprocess.run([ROOT / "Testing" / "Tools" / "with_display", program, "--screenshot", IMAGES / f"{name}.png", "--size",
                    "1280x800", *arguments], check=True)


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
