"""What shadows cost: the rover drives over streamed ground of the shipped field, chased, 1280 x 720, one sample a pixel.
Each pose is drawn with shadows and without, in turn, and read back: a software renderer goes on after render() has
returned. The camera moves too, so that each frame redraws all shadow maps."""
import pathlib
import statistics
import time

import dspace

DATA = pathlib.Path(__file__).resolve().parents[2] / "Data"
STEPS = 24


def main():
    with dspace.Session() as session:
        scene = session.scene()
        ground = scene.add_terrain(DATA / "field" / "field.tif", mode="clipmap", image=DATA / "field" / "field_color.tif")
        ground.focus([(0, 0)])
        rover = scene.load(DATA / "rover" / "rover.urdf")
        vehicle = dspace.rover.load_vehicle(DATA / "rover" / "rover.urdf")
        scene.sun.set(azimuth_deg=300, elevation_deg=29)
        frame = scene.add_frame("camera")
        scene.add_camera("chase", frame=frame, eye=(-4.5, -2.6, 2.2), target=(0.8, 0, 0.4), fov_deg=42, near=0.05)
        views = {name: scene.add_viewport((1280, 720), "chase", name=name, samples=1) for name in ("plain", "shadows")}
        views["shadows"].set(shadows=True)
        times = {name: [] for name in views}
        for step in range(STEPS):
            x = 0.02 * step
            rover.place(vehicle.solve((x, 0.0, 0.0), ground))
            frame.pose = dspace.Pose(position=(x, 0.0, ground.height(x, 0.0)))
            for name, view in views.items():
                start = time.perf_counter()
                view.image()
                times[name].append(time.perf_counter() - start)
        plain, shadowed = (statistics.median(times[name][4:]) for name in ("plain", "shadows"))
        print(f"shadows: {1e3 * shadowed:.1f} ms a frame against {1e3 * plain:.1f} without: {shadowed / plain:.2f} (goal <= 1.6); "
              f"{1 / shadowed:.0f} frames a second (goal >= 30 on two cores)")


if __name__ == "__main__":
    main()
