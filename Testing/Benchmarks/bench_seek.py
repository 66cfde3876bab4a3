"""Seeking in a recording of ten million poses: 10,000 steps of 1,000 frames."""
import pathlib
import random
import statistics
import tempfile
import time

import numpy as np

import dspace

FRAMES, STEPS = 1000, 10000


def main():
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "long.dspace"
        with dspace.Session() as session:
            scene = session.scene()
            frames = [scene.add_frame(f"f{i}") for i in range(FRAMES)]
            poses = np.zeros((FRAMES, 8))
            poses[:, 3] = poses[:, 7] = 1
            with session.record(path) as recording:
                began = time.perf_counter()
                for i in range(STEPS):
                    scene.time = 0.01 * i
                    poses[:, 0] = i
                    scene.set_poses(frames, poses)
                driven = time.perf_counter() - began
            size = path.stat().st_size
            assert recording.counts["written"] == recording.counts["accepted"]
        began = time.perf_counter()
        with dspace.Playback(path) as run:
            opened = time.perf_counter() - began
            chance = random.Random(1)
            taken = []
            for _ in range(30):
                i = chance.randrange(STEPS)
                began = time.perf_counter()
                run.seek(0.01 * i)
                taken.append(time.perf_counter() - began)
                assert run.session.scene().frame("f7").pose.position[0] == i
    print(f"recording {STEPS * FRAMES} poses: {driven:.1f} s, {size / 1e6:.0f} MB; opened in {opened:.2f} s; "
          f"{len(taken)} seeks: {statistics.median(taken):.3f} s ({min(taken):.3f}..{max(taken):.3f})")


if __name__ == "__main__":
    main()
