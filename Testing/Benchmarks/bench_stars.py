"""What 100,000 stars cost: the demo field and the sky over it, 1280 x 720, one sample a pixel, with the stars shown by a gain
and without them, in turn, read back. The camera turns, so that each frame is drawn anew."""
import math
import pathlib
import statistics
import time

import dspace
import numpy as np
from dspace.stars import StarCatalog

DATA = pathlib.Path(__file__).resolve().parents[2] / "Data"
STEPS = 24
COUNT = 100_000


def random_stars():
    """Evenly over the sphere, as many of each magnitude as the sky has: 10^(0.5 V) or so."""
    random = np.random.default_rng(7)
    declination = np.degrees(np.arcsin(random.uniform(-1, 1, COUNT)))
    magnitude = 8.5 + 2.0 * np.log10(random.uniform(1e-5, 1, COUNT))
    return StarCatalog(random.uniform(0, 360, COUNT), declination, magnitude, random.uniform(-0.3, 1.8, COUNT))


def main():
    with dspace.Session() as session:
        scene = session.scene()
        ground = scene.add_terrain(DATA / "field" / "field.tif", mode="clipmap", image=DATA / "field" / "field_color.tif")
        ground.focus([(0, 0)])
        scene.sun.set(azimuth_deg=300, elevation_deg=10)
        scene.add_fragment("sky")
        scene.add_stars(random_stars(), gain=1e6, fragment="sky")
        camera = scene.add_camera("camera", eye=(0, 0, 2), target=(10, 0, 3.0), fov_deg=50)
        views = {name: scene.add_viewport((1280, 720), "camera", name=name, samples=1) for name in ("plain", "stars")}
        views["plain"].hide("sky")
        times = {name: [] for name in views}
        for step in range(STEPS):
            camera.look_at(eye=(0, 0, 2), target=(10 * math.cos(0.01 * step), 10 * math.sin(0.01 * step), 3.0))
            for name, view in views.items():
                start = time.perf_counter()
                view.image()
                times[name].append(time.perf_counter() - start)
        plain, shown = (statistics.median(times[name][4:]) for name in ("plain", "stars"))
        print(f"stars: a frame with {COUNT:,} stars {1e3 * shown:.1f} ms, without {1e3 * plain:.1f} ms: {shown / plain - 1:.1%} "
              "more (goal <= 10%)")


if __name__ == "__main__":
    main()
