"""Pictures of scenes, views, demos, movies and viewers."""
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import dspace
from dspace.links.serving import ServerProcess
from pictures.paths import DATA, IMAGES, ROOT

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


def demo_drive():
    demo("demo", 9)


def drives():
    """The demo's drive with real terrain and vehicles."""
    demo("m2020_gale", 1, "--terrain", f"{DATA}/terrain/mars_gale_mola_128ppd_m.tif", "--model",
         f"{DATA}/models/m2020_rover/m2020.urdf")
    demo("rocky7_apollo15", 2, "--terrain", f"{DATA}/terrain/moon_apollo15_nac_dtm_257.png",
         "--vertical-scale", "0.19216", "--pixel-size", "2", "--model", f"{DATA}/models/rocky7_vrml")
    demo("viper_north_pole", 2, "--terrain", f"{DATA}/terrain/moon_npole_stereo_33.tif", "--model",
         f"{DATA}/models/viper_obj")


def movie():
    """A picture of the reference simulation's movie, 1.6 s after its start."""
    sys.path.insert(0, str(ROOT / "Examples" / "rover_mobility"))
    from dspace._core.png import png
    from dspace.movies.draw import Stage, open_run
    import rover_mobility
    flight = dspace.Movie.load(ROOT / "Examples" / "rover_mobility" / "flight.toml", size=(960, 540), samples=3)
    simulation = rover_mobility.run()
    with simulation.session:
        (IMAGES / "movie.png").write_bytes(png(Stage(flight, open_run(simulation)).picture(40)))


def views():
    """Four viewports in one sheet: an orthographic one, one of a camera that points, one that was fitted, its ranges."""
    from dspace._core.png import png
    with dspace.Session() as session:
        scene = session.scene()
        ground = scene.add_terrain(ROOT / "Data/field/field.tif", image=ROOT / "Data/field/field_color.tif")
        ground.focus([(0, 0)])
        rover = scene.load(ROOT / "Data/rover/rover.urdf")
        rover.place(dspace.rover.load_vehicle(ROOT / "Data/rover/rover.urdf").solve((0, 0, 0), ground))
        base = rover.frame
        mast = scene.add_frame("mast", position=(-6, -4, ground.height(-6, -4)))
        cameras = (scene.add_camera("above", eye=(0, 0, 2e5), target=(0, 0, 0), up=(0, 1, 0), height=20),
                   scene.add_camera("mast", frame=mast, point_at=dict(aim=base, eye=(0, 0, 2)), fov_deg=25),
                   scene.add_camera("fit", eye=(3, -3, ground.height(3, -3) + 2), target=(0, 0, ground.height(0, 0)),
                                    fov_deg=40))
        made = []
        for number, camera in enumerate(cameras):
            made.append(scene.add_viewport((480, 300), camera, samples=3))
            made[-1].position = (480 * (number % 2), 300 * (number // 2))
        made[2].fit(base, margin=0.05)
        sheet = session.sheet(made, size=(960, 600))
        ranges = made[2].range(physical_only=False)
        seen = np.isfinite(ranges)
        low, high = ranges[seen].min(), np.percentile(ranges[seen], 95)
        gray = np.where(seen, np.clip(40 + 200 * (ranges - low) / (high - low), 0, 255), 0)
        sheet[300:, 480:] = gray[..., None].astype(np.uint8)
        (IMAGES / "views.png").write_bytes(png(sheet))


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
