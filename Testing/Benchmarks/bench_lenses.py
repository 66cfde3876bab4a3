"""Lenses: the projection of a million points by Brown's model against OpenCV's projectPoints, and a picture through a lens
against drawing and reading the same source views, in turn."""
import math
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
    print(f"lenses: Brown's projection of {COUNT:,} points {1e3 * ours:.0f} ms, OpenCV's projectPoints from Python, which also "
          f"computes derivatives, {1e3 * theirs:.0f} ms: {theirs / ours:.2f} times as fast (goal >= 2)")


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
    draw()
