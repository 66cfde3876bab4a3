"""What a stream of poses at 1 kHz costs the thread that draws: its own CPU time a picture, against one step
a picture, in turns. (Against a scene that stands still it would be against drawing nothing: such a picture is
kept.) The thread is a viewer's: it applies what has come (update) and draws the picture of 640 x 480 (image)
thirty times a second. The work of other threads (those of the link, and those in which llvmpipe fills pixels)
is not in it. Every one of the frames moves and carries a box."""
import os
import pathlib
import signal
import statistics
import subprocess
import sys
import tempfile
import time

import dspace
from dspace.links.serving import ServerProcess

TURNS, DRAWN, RATE = 9, 45, 30.0

# Streams at 1 kHz while a file is there, else a step a picture.
DRIVER = """
import os, sys, time
import numpy as np
import dspace
address, flag, n = sys.argv[1], sys.argv[2], int(sys.argv[3])
with dspace.connect(address) as session:
    scene = session.scene()
    frames = [scene.add_frame(f"f{i}") for i in range(n)]
    for i, frame in enumerate(frames):
        scene.add_box((0.2, 0.2, 0.2), frame=frame)
    poses = np.zeros((n, 8))
    poses[:, 3] = poses[:, 7] = 1
    poses[:, 1] = np.arange(n) % 32 - 16.0
    poses[:, 2] = np.arange(n) // 32 - 16.0
    scene.set_poses(frames, poses)
    camera = scene.add_camera("main", eye=(60.0, 0.0, 10.0), target=(0.0, 0.0, 0.0))
    scene.add_viewport((640, 480), camera, name="view")
    print("ready", flush=True)
    session.wait = False
    due = time.monotonic()
    step = 0
    while True:
        step += 1
        poses[:, 0] = 0.3 * np.sin(0.01 * step + np.arange(n))
        scene.set_poses(frames, poses)
        due += 0.001 if os.path.exists(flag) else 1 / 30
        time.sleep(max(0.0, due - time.monotonic()))
"""


def turn(watcher, viewport):
    """CPU milliseconds a picture of this thread: applying, drawing; and steps a second that came."""
    applying = drawing = 0.0
    first, began = watcher.sequence, time.monotonic()
    for i in range(DRAWN):
        start = time.thread_time()
        watcher.update(0.0)
        middle = time.thread_time()
        viewport.image()
        drawing += time.thread_time() - middle
        applying += middle - start
        time.sleep(max(0.0, began + (i + 1) / RATE - time.monotonic()))
    rate = (watcher.sequence - first) / (time.monotonic() - began)
    return 1e3 * applying / DRAWN, 1e3 * drawing / DRAWN, rate


def measure(count):
    with tempfile.TemporaryDirectory() as folder, ServerProcess([folder]) as server:
        flag = pathlib.Path(folder) / "stream"
        driver = subprocess.Popen([sys.executable, "-W", "ignore", "-c", DRIVER, server.address, str(flag),
                                   str(count)], stdout=subprocess.PIPE, text=True)
        try:
            assert driver.stdout.readline() == "ready\n"
            with dspace.watch(server.address) as watcher:
                while "view" not in watcher.viewports:
                    watcher.update(1.0)
                viewport = watcher.viewports["view"]
                turn(watcher, viewport)
                still, moving = [], []
                for i in range(2 * TURNS):
                    if i % 2:
                        flag.touch()
                    else:
                        flag.unlink(missing_ok=True)
                    time.sleep(0.3)
                    watcher.update(0.0)
                    (moving if i % 2 else still).append(turn(watcher, viewport))
        finally:
            driver.send_signal(signal.SIGKILL)
            driver.wait()
            driver.stdout.close()
    growth = [sum(m[:2]) / sum(s[:2]) - 1 for s, m in zip(still, moving)]
    middle = [statistics.median(column) for column in zip(*still)], [statistics.median(column)
                                                                     for column in zip(*moving)]
    (apply0, draw0, rate0), (apply1, draw1, rate) = middle
    print(f"{count} frames, {rate0:.0f} -> {rate:.0f} steps a second: the drawing thread's CPU time a picture grows "
          f"by {100 * statistics.median(growth):.1f} % ({100 * min(growth):.1f} to {100 * max(growth):.1f}, goal < 5); "
          f"applying {apply0:.2f} -> {apply1:.2f} ms, drawing {draw0:.2f} -> {draw1:.2f} ms", flush=True)


def main():
    for count in (10, 100, 1000):
        measure(count)


if __name__ == "__main__":
    os.environ["PYTHONWARNINGS"] = "ignore"
    main()
