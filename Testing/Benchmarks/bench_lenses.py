"""Lenses: the projection of a million points by Brown's model against OpenCV's projectPoints and by CAHVORE against mrcal's, the
warp of a picture against OpenCV's remap, a picture through a lens against drawing and reading the same source views, and a large
one in tiles against one tile. What is compared is measured in turn."""
import math
import os
import pathlib
import statistics
import time

import numpy as np

import dspace

DATA = pathlib.Path(__file__).resolve().parents[2] / "Data"
COUNT = 1_000_000
STEPS = 7
SIZE = (1000, 750)
RADIAL, TANGENTIAL = (-0.2, 0.05, 0.01), (1e-3, -2e-3)


def timed(work):
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def project():
    random = np.random.default_rng(3)
    points = np.column_stack((random.uniform(-0.5, 0.5, (COUNT, 2)), np.ones(COUNT))) * random.uniform(1, 10, (COUNT, 1))
    model = dspace.CameraModel("brown", size=SIZE, focal=(800, 800), center=(500, 375), radial=RADIAL, tangential=TANGENTIAL)
    try:
        import cv2
    except ImportError:
        print("lenses: OpenCV is absent (python3-opencv); the projection of a million points takes "
              f"{1e3 * min(timed(lambda: model.project(points)) for _ in range(STEPS)):.0f} ms")
        return
    matrix = np.array([[800, 0, 500], [0, 800, 375], [0, 0, 1]], float)
    coefficients = np.array([*RADIAL[:2], *TANGENTIAL, RADIAL[2]])
    cv2.setNumThreads(1)
    times = [(timed(lambda: model.project(points)),
              timed(lambda: cv2.projectPoints(points, np.zeros(3), np.zeros(3), matrix, coefficients))) for _ in range(STEPS)]
    ours, theirs = (statistics.median(each) for each in zip(*times))
    print(f"lenses: Brown's projection of {COUNT:,} points on {os.cpu_count()} cores {1e3 * ours:.0f} ms, OpenCV's projectPoints on "
          f"one, which also computes derivatives, {1e3 * theirs:.0f} ms: {theirs / ours:.2f} times as fast (goal >= 2)")


def project_cahvore():
    try:
        import mrcal
    except ImportError:
        print("lenses: mrcal is absent (python3-mrcal); CAHVORE is not compared")
        return
    random = np.random.default_rng(4)
    points = np.column_stack((random.uniform(-0.5, 0.5, (COUNT, 2)), np.ones(COUNT)))
    points /= np.linalg.norm(points, axis=1, keepdims=True)  # mrcal takes all points at a distance of 1
    model = dspace.CameraModel("cahvore", size=SIZE, C=(0, 0, 0), A=(0, 0, 1), H=(800, 0, 500), V=(0, 800, 375), O=(0, 0, 1),
                               R=(0, -0.03, 0.01), E=(0.006, 0.002, 0), linearity=0.5)
    kind, numbers = "LENSMODEL_CAHVORE_linearity=0.50", np.array((800, 800, 500, 375, 0, 0, 0, -0.03, 0.01, 0.006, 0.002, 0), float)
    apart = np.abs(model.project(points[:1000]) - mrcal.project(points[:1000], kind, numbers)).max()
    times = [(timed(lambda: model.project(points)), timed(lambda: mrcal.project(points, kind, numbers))) for _ in range(STEPS)]
    ours, theirs = (statistics.median(each) for each in zip(*times))
    print(f"lenses: CAHVORE's projection of {COUNT:,} points on {os.cpu_count()} cores {1e3 * ours:.0f} ms, mrcal's on one "
          f"{1e3 * theirs:.0f} ms (pixels agree within "
          f"{apart:.1g}): {theirs / ours:.2f} times as fast (goal >= 2)")


def warp():
    """A second picture of a scene that stands still takes its source views from the first: what remains is the warp."""
    try:
        import cv2
    except ImportError:
        print("lenses: OpenCV is absent (python3-opencv); the warp is not compared")
        return
    cv2.setNumThreads(1)
    model = dspace.CameraModel("brown", size=SIZE, focal=(800, 800), center=(499.5, 374.5), radial=RADIAL)
    with dspace.Session() as session:
        scene = session.scene()
        scene.add_plane(50, 50, position=(0, 0, 6))
        camera = scene.add_camera("camera")
        camera.attach(scene.root)

        def picture():
            return scene.simulate_image(model, camera, color=False, radiance=True, samples=1, tile=1024)

        first = picture()["lens"]
        assert picture()["lens"].source_views == 0
        _, rays = model.rays(np.stack(np.meshgrid(np.arange(SIZE[0], dtype=float), np.arange(SIZE[1], dtype=float)), axis=-1))
        places = (rays[..., :2] / rays[..., 2:] - (rays[..., :2] / rays[..., 2:]).min(axis=(0, 1))) * 800
        x, y = (np.ascontiguousarray(places[..., k], dtype=np.float32) for k in range(2))
        source = np.random.default_rng(5).random((int(y.max()) + 3, int(x.max()) + 3, 3), dtype=np.float32)
        times = [(timed(picture), timed(lambda: cv2.remap(source, x, y, cv2.INTER_LINEAR))) for _ in range(3 * STEPS)]
        ours, theirs = (statistics.median(each) for each in zip(*times))
        print(f"lenses: the warp of {SIZE[0]} x {SIZE[1]} pixels of radiance from {first.source_views} blocks on {os.cpu_count()} cores, with "
              f"the reply and the copy to numpy, {1e3 * ours:.1f} ms, OpenCV's remap with its map ready, one thread, {1e3 * theirs:.1f} ms: "
              f"{ours / theirs:.2f} times as long (goal <= 1.2)")


def tiles(side=4096):
    """One tile has up to 4096 x 4096 pixels."""
    model = dspace.CameraModel("brown", size=(side, side), focal=(0.8 * side,) * 2, center=(0.5 * side - 0.5,) * 2, radial=(-0.1,))
    with dspace.Session() as session:
        scene = session.scene()
        ground = scene.add_terrain(DATA / "field" / "field.tif", mode="clipmap", image=DATA / "field" / "field_color.tif")
        ground.focus([(0, 0)])
        camera = scene.add_camera("camera", eye=(0, 0, 2), target=(10, 0, 1.0))
        times = []
        for step in range(4):
            each = []
            for tile in (512, side):
                camera.look_at(eye=(0, 0, 2), target=(10, 0.5 * step, 1.0))
                scene.time += 1.0  # nothing is left of the picture before
                each.append(timed(lambda tile=tile: scene.simulate_image(model, camera, color=False, radiance=True, samples=1,
                                                                         tile=tile)))
            times.append(each)
        tiled, whole = (statistics.median(each) for each in zip(*times[1:]))
        print(f"lenses: {side} x {side} in tiles of 512 {tiled:.2f} s, in one tile {whole:.2f} s: {tiled / whole:.2f} times as long "
              "(goal <= 1.15)")


def draw():
    models = {"Brown, 64 deg wide": dspace.CameraModel("brown", size=SIZE, focal=(800, 800), center=(499.5, 374.5), radial=RADIAL),
              "fish-eye, 143 deg wide": dspace.CameraModel("equidistant", size=SIZE, focal=(400, 400), center=(499.5, 374.5))}
    with dspace.Session() as session:
        scene = session.scene()
        ground = scene.add_terrain(DATA / "field" / "field.tif", mode="clipmap", image=DATA / "field" / "field_color.tif")
        ground.focus([(0, 0)])
        scene.sun.set(azimuth_deg=300, elevation_deg=20)
        camera = scene.add_camera("camera", eye=(0, 0, 2), target=(10, 0, 1.0), fov_deg=50)
        for name, model in models.items():
            views = scene.simulate_image(model, camera, color=False, radiance=True)["lens"]
            side = round(math.sqrt(views.source_pixels / views.source_views))
            bare = scene.add_viewport((side, side), "camera", name=name)
            bare.set(shadows=True)

            def move(step):
                camera.look_at(eye=(0, 0, 2), target=(10 * math.cos(0.01 * step), 10 * math.sin(0.01 * step), 1.0))

            times = []
            for step in range(STEPS):
                move(step)
                lens = timed(lambda: scene.simulate_image(model, camera, color=False, radiance=True))
                source = 0.0
                for view in range(views.source_views):
                    move(step + 40 * view)  # another direction, as another view has
                    source += timed(lambda: bare.capture(color=False, radiance=True, physical_only=True))
                times.append((lens, source))
            lens, source = (statistics.median(each) for each in zip(*times[1:]))
            print(f"lenses: {name}, {SIZE[0]} x {SIZE[1]}: {1e3 * lens:.0f} ms, bare drawing and reading of {views.source_views} "
                  f"source views of {side} x {side} {1e3 * source:.0f} ms: {lens / source:.2f} times as long (goal <= 1.3)")


if __name__ == "__main__":
    project()
    project_cahvore()
    warp()
    draw()
    tiles()
