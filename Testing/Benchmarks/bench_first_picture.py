"""From the start of the process to the first picture on disk, against importing VTK and numpy alone.

Python files are compiled, as they are after the first run and in an installed tree."""
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PICTURE = f"""
import dspace
with dspace.Session() as session:
    scene = session.scene()
    ground = scene.add_terrain({str(ROOT / "Data/field/field.tif")!r})
    scene.load({str(ROOT / "Data/rover/rover.urdf")!r})
    scene.add_camera(eye=(5, -5, 2.5), target=(0, 0, 0.5))
    scene.add_viewport(size=(640, 360)).save(r"%s")
"""
IMPORTS = "import numpy, vtkmodules.vtkRenderingOpenGL2"


def seconds(code):
    began = time.perf_counter()
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
    return time.perf_counter() - began


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.environ["PYTHONPYCACHEPREFIX"] = folder
        os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
        picture = PICTURE % (pathlib.Path(folder) / "first.png")
        pairs = [(seconds(picture), seconds(IMPORTS)) for _ in range(6)][1:]
    ratios = [a / b for a, b in pairs]
    print(f"first picture: ratio {statistics.median(ratios):.2f} ({min(ratios):.2f}..{max(ratios):.2f}), "
          f"{len(pairs)} pairs; {statistics.median(a for a, _ in pairs):.2f} s against "
          f"{statistics.median(b for _, b in pairs):.2f} s; terrain of 1001 x 1001 posts and rover, "
          "640 x 360, 4 samples a pixel")


if __name__ == "__main__":
    main()
