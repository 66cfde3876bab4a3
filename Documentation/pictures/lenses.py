"""A target board through lenses, a viewport with a lens, exposures, and the closed loop."""
import numpy as np

import dspace
from dspace._core.files import atomic_write
from dspace._core.png import png
from pictures.paths import IMAGES, ROOT

SIZE = (480, 360)
CENTER = (239.5, 179.5)
SQUARE, COLUMNS, ROWS = 0.1, 12, 9  # [m]


def lenses():
    """A checker board 0.45 m ahead of four lenses; red crosses are the corners by the models."""
    models = (
        dspace.CameraModel("pinhole", size=SIZE, focal=(260, 260), center=CENTER),
        dspace.CameraModel("brown", size=SIZE, focal=(260, 260), center=CENTER, radial=(-0.22, 0.06, -0.006)),
        dspace.CameraModel("cahvore", size=SIZE, C=(0, 0, 0), A=(0, 0, 1), H=(170, 0, CENTER[0]), V=(0, 170, CENTER[1]),
                           O=(0, 0, 1), R=(0, -0.03, 0), E=(0.006, 0.002, 0), linearity=0),
        dspace.CameraModel("equidistant", size=SIZE, focal=(110, 110), center=CENTER))
    with dspace.Session() as session:
        scene = session.scene()
        camera = scene.add_camera("eye")
        camera.attach(scene.root)
        add_board(scene)
        add_room(scene)
        x, y = np.meshgrid(SQUARE * (np.arange(COLUMNS + 1) - COLUMNS / 2), SQUARE * (np.arange(ROWS + 1) - ROWS / 2))
        corners = np.column_stack((x.ravel(), y.ravel(), np.full(x.size, 0.45)))
        pictures = [crossed(camera.capture(model, exposure=1.0)["color"][..., :3], model.project(corners)) for model in models]
    rows = [np.hstack((left, np.full((SIZE[1], 6, 3), 255, np.uint8), right)) for left, right in (pictures[:2], pictures[2:])]
    atomic_write(IMAGES / "lenses.png", png(np.vstack((rows[0], np.full((6, rows[0].shape[1], 3), 255, np.uint8), rows[1]))))


def site(session):
    """The shipped rover among the field's rocks, and the ground."""
    scene = session.scene()
    ground = scene.add_terrain(ROOT / "Data/field/field.tif", image=ROOT / "Data/field/field_color.tif")
    ground.focus([(0, 0)])
    rover = scene.load(ROOT / "Data/rover/rover.urdf")
    rover.place(dspace.rover.load_vehicle(ROOT / "Data/rover/rover.urdf").solve((0, 0, 0), ground))
    scene.sun.set(azimuth_deg=240, elevation_deg=35)
    return scene, ground


def live_lens():
    """A camera beside the rover in a viewport: its own projection of 70 degrees, and a fish-eye of 180 degrees."""
    size = (400, 400)
    with dspace.Session() as session:
        scene, ground = site(session)
        camera = scene.add_camera("eye", eye=(1.5, -1.6, ground.height(1.5, -1.6) + 0.7), target=(0, 0, ground.height(0, 0) + 0.6),
                                  fov_deg=70)
        view = scene.add_viewport(size=size, camera=camera, samples=3)
        view.set(shadows=True)
        view.set_background("#c9a98a")
        own = view.image()
        view.lens = dspace.CameraModel("equidistant", size=size, focal=(126, 126), center=(199.5, 199.5))
        shown = view.image()
    atomic_write(IMAGES / "live_lens.png", png(np.hstack((own, np.full((size[1], 6, 3), 255, np.uint8), shown))))


def shutters():
    """A camera that turns by 40 degrees a second: at rest, exposed for 60 ms, and read out row by row in 0.3 s."""
    model = dspace.CameraModel("brown", size=(320, 360), focal=(400, 400), center=(159.5, 179.5), radial=(-0.1,))
    with dspace.Session() as session:
        scene, ground = site(session)
        scene.sun.set(azimuth_deg=160, elevation_deg=30)  # behind the camera
        eye = np.array((3.2, -2.4, ground.height(3.2, -2.4) + 1.0))
        camera = scene.add_camera("eye")

        def at(time):
            angle = np.radians(143 + 40 * time)
            camera.look_at(eye=eye, target=eye + (np.cos(angle), np.sin(angle), 0.0))

        shown = []
        for shutter in (None, dspace.Shutter(0.06, samples=16), dspace.Shutter(0.002, 0.3, samples=1, bands=100)):
            at(0.0)
            shown.append(scene.simulate_image(model, camera, exposure=1.8) if shutter is None else
                         scene.simulate_exposure(shutter, at, model, camera, exposure=1.8))
    gap = np.full((360, 6, 3), 255, np.uint8)
    pictures = [each["color"][..., :3] for each in shown]
    atomic_write(IMAGES / "shutters.png", png(np.hstack((pictures[0], gap, pictures[1], gap, pictures[2]))))


def add_board(scene):
    """In the camera's axes: squares face its eye."""
    scene.sun.set(direction=(0.4, -0.7, -1.0))
    turn = (0.0, 1.0, 0.0, 0.0)  # the plane's normal towards the camera
    scene.add_plane(SQUARE * COLUMNS + 0.04, SQUARE * ROWS + 0.04, position=(0, 0, 0.4502), quaternion=turn, color="white")
    for row in range(ROWS):
        for column in range(row % 2, COLUMNS, 2):
            scene.add_plane(SQUARE, SQUARE, quaternion=turn, color="#202020",
                            position=(SQUARE * (column - (COLUMNS - 1) / 2), SQUARE * (row - (ROWS - 1) / 2), 0.45))


def add_room(scene):
    """Ground below the camera and posts around it, so that the field of the lenses is seen."""
    down = (np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0)  # the plane's normal to -Y: up
    scene.add_plane(60, 60, position=(0, 1.2, 0), quaternion=down, color="#b08b66")
    for azimuth in range(0, 360, 20):
        a = np.radians(azimuth)
        scene.add_box((0.15, 1.6, 0.15), position=(4 * np.sin(a), 0.4, 4 * np.cos(a)),
                      color=("#3a6ea5", "#c8553d", "#588157")[azimuth // 20 % 3])


def crossed(picture, pixels):
    """The picture with a cross of one pixel's width at each of the pixels that lie in it."""
    picture = picture.copy()
    for x, y in pixels[np.isfinite(pixels).all(axis=1)]:
        u, v = int(round(x)), int(round(y))
        if 3 <= u < SIZE[0] - 3 and 3 <= v < SIZE[1] - 3:
            picture[v, u - 3:u + 4] = picture[v - 3:v + 4, u] = (255, 40, 40)
    return picture


def closed_loop():
    """The sheet of Examples/closed_loop on Gale's ground."""
    import subprocess
    import sys
    import tempfile

    from osgeo import gdal
    gdal.UseExceptions()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, ROOT / "Examples" / "closed_loop" / "closed_loop.py", "--out", folder], check=True)
        write_sheet(f"{folder}/closed_loop.png")


def write_sheet(path):
    from osgeo import gdal
    gdal.SetConfigOption("GDAL_PAM_ENABLED", "NO")
    small = gdal.Translate("", str(path), format="MEM", width=768, resampleAlg="average")
    gdal.GetDriverByName("JPEG").CreateCopy(str(IMAGES / "closed_loop.jpg"), small, options=["QUALITY=85"])
