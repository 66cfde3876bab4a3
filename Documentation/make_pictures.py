"""Makes the pictures of the documentation anew: ./dspace python Documentation/make_pictures.py

Those of real data are made where DSPACE_DATA names it, and left as they are otherwise."""
import os
import pathlib
import subprocess
import sys
import tempfile

import dspace

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


def main():
    IMAGES.mkdir(exist_ok=True)
    first_picture()
    demo("demo", 9)
    data = os.environ.get("DSPACE_DATA", "")
    if pathlib.Path(data, "models").is_dir():
        demo("m2020_gale", 1, "--terrain", f"{data}/terrain/mars_gale_mola_128ppd_m.tif", "--model",
             f"{data}/models/m2020_rover/m2020.urdf")
        demo("rocky7_apollo15", 2, "--terrain", f"{data}/terrain/moon_apollo15_nac_dtm_257.png",
             "--vertical-scale", "0.19216", "--pixel-size", "2", "--model", f"{data}/models/rocky7_vrml")
        demo("viper_north_pole", 2, "--terrain", f"{data}/terrain/moon_npole_stereo_33.tif", "--model",
             f"{data}/models/viper_obj")


if __name__ == "__main__":
    main()
