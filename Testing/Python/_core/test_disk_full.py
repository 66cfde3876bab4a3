"""A disk that is really full: a file system of 32 MiB, with room for a part of each file, page by page. Nothing
that existed is lost, every failure is an error that names the file, and no temporary file is left.

Mounting needs the superuser, or a kernel that gives users name spaces of their own (unshare -rm). Where neither is so, the
tests skip; test_saving.py limits the size of files instead."""
import json
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import dspace

SIZE = 32 << 20  # bytes of the disk
PAGE = 4096  # bytes, in which tmpfs counts
UNSHARE = ["unshare", "-m"] if os.geteuid() == 0 else ["unshare", "-rm"]
MOUNT = 'mount -t tmpfs -o size=%d none "$1" && shift && exec "$@"' % SIZE


def on_small_disk(folder, *words, **options):
    """Runs a command with a small disk at `folder`, which only this command and its children see."""
    return subprocess.run([*UNSHARE, "sh", "-c", MOUNT, "sh", str(folder), *words], capture_output=True, text=True,
                          timeout=500, **options)


@pytest.fixture(scope="module", autouse=True)
def small_disks(tmp_path_factory):
    try:
        done = on_small_disk(tmp_path_factory.mktemp("probe"), "true")
    except FileNotFoundError:
        pytest.skip("unshare is not installed")
    if done.returncode != 0:
        pytest.skip(f"a small disk cannot be mounted: {done.stderr.strip()}")


class Disk:
    """In the process that has it mounted."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.filler = self.folder / "filler"

    def leave(self, room):
        """Fills it up to `room` bytes."""
        self.filler.unlink(missing_ok=True)
        state = os.statvfs(self.folder)
        with open(self.filler, "wb") as file:
            os.posix_fallocate(file.fileno(), 0, max(state.f_bavail * state.f_frsize - room, 1))

    def free(self):
        self.filler.unlink(missing_ok=True)

    def content(self):
        return {path.name: path.read_bytes() for path in self.folder.iterdir() if path != self.filler}

    def check(self, save, name, steps=8):
        """Saves with room, with less room than that at `steps` sizes, and with room again."""
        path = self.folder / name
        save(path)
        pages = -(-path.stat().st_size // PAGE)
        before = self.content()
        failures = 0
        for room in sorted({pages * step // steps for step in range(steps)}):
            self.leave(room * PAGE)
            try:
                save(path)
            except dspace.Error as error:
                assert isinstance(error, (dspace.Io, dspace.Resource)), (name, error)
                assert name in str(error), (name, error)
                failures += 1
            else:
                raise AssertionError(f"{name} was saved in {room} of {pages} pages")
            now = self.content()
            assert now == before, (name, room, sorted(now))
        assert failures == len({pages * step // steps for step in range(steps)})
        self.free()
        save(path)
        assert self.content().keys() == before.keys()
        path.unlink()


# --- Each of these runs in a process of its own ---------------------------------------------------

def pictures(disk):
    with dspace.Session() as session:
        scene = session.scene()
        chance = np.random.default_rng(1)
        scene.add_points(chance.uniform(-1, 1, (3000, 3)), point_size=4, color=(0.8, 0.6, 0.1))
        view = scene.add_viewport((300, 200), scene.add_camera(eye=(4, 1, 2), target=(0, 0, 0)))
        for name in ("a.png", "a.jpg", "a.tif", "a.exr"):
            disk.check(view.save, name)
        disk.check(lambda path: view.save(path, plane="depth"), "depth.exr")
        disk.check(lambda path: view.save(path, plane="label"), "label.png", steps=2)
        disk.check(lambda path: session.sheet([view], path=path), "sheet.png")
        disk.check(scene.export, "a.glb")


def measurements(disk):
    import terrain_support
    y, x = np.mgrid[0:60, 0:60]
    source = pathlib.Path(os.environ["HERE"]) / "ground.tif"
    terrain_support.write_raster(source, (3 * np.sin(0.3 * x) * np.cos(0.2 * y)).astype(np.float32))
    with dspace.Session() as session:
        scene = session.scene()
        ground = scene.add_terrain(source, name="ground", pixel_size=1.0)
        ground.track({f"wheel {i}": [(10.0, 1.0 + i / 2), (40.0, 1.0 + i / 2)] for i in range(60)}, width=0.1,
                     sinkage=0.01)
        disk.check(ground.save_tracks, "tracks.geojson")
        # What there is of a map stays for the next run, and the map as a whole appears or does not.
        path = disk.folder / "map.tif"
        make = lambda: scene.horizon_map(ground, path, azimuths=16, threads=1)
        disk.leave(20 * PAGE)
        try:
            make()
        except dspace.Error as error:
            assert "map.tif" in str(error), error
        else:
            raise AssertionError("a map was written where there is no room")
        assert not path.exists()
        disk.free()
        make()
        assert path.exists()
    model = dspace.CameraModel("pinhole", focal=(500, 500), center=(319.5, 239.5), size=(640, 480), name="n" * 9000)
    disk.check(model.save, "model.json", steps=2)
    report = dspace.Report("Site")
    report.section("Rows").table([{"a": i, "b": i / 7} for i in range(500)])
    disk.check(report.write, "report.html")


def movies(disk):
    from dspace.movies.encode import Encoder
    chance = np.random.default_rng(1)
    frames = [chance.integers(0, 255, (64, 96, 3), dtype=np.uint8) for _ in range(10)]

    def save(path):
        with Encoder(path, (96, 64), 10, quick=True) as encoder:
            for frame in frames:
                encoder.add(frame)

    disk.check(save, "a.mp4", steps=3)
    movie = dspace.Movie(size=(96, 64))
    for i in range(200):
        movie.add_key(time=i / 10, position=(i, 0.1, 0.2), quaternion=(1, 0, 0, 0))
    disk.check(movie.save, "movie.toml", steps=3)


def recorded(path, pack=False, steps=400):
    with dspace.Session() as session:
        scene = session.scene()
        frames = [scene.add_frame(f"f{i}").id for i in range(200)]
        scene.add_camera("c", eye=(3, -3, 2), target=(0, 0, 0))
        scene.add_viewport((64, 48), "c", name="view")
        poses = np.tile((0, 0, 0, 1.0, 0, 0, 0, 1), (200, 1))
        with session.record(path, pack=pack):
            for number in range(steps):
                scene.time = number / 10
                poses[:, 0] = number
                scene.set_poses(np.array(frames, dtype=np.uint64), poses)


def recordings(disk):
    from dspace.command_line import main
    from dspace.recording.file import RecordingFile
    outside = pathlib.Path(os.environ["HERE"]) / "whole.dspace"
    recorded(outside)
    with RecordingFile(outside) as file:
        last = file.last
    for pack in (False, True):
        for room in (0, 1, 8, 16, 32, 64, 128, 200):
            path = disk.folder / "a.dspace"
            disk.leave(room * PAGE)
            try:
                recorded(path, pack)
            except dspace.Error as error:
                assert "a.dspace" in str(error), error
            else:
                raise AssertionError(f"a recording was written in {room} pages")
            disk.free()
            if path.exists():  # what could be written is a whole beginning
                with RecordingFile(path) as file:
                    file.check()
                    assert file.last < last
                assert path.stat().st_size > 0
            for each in disk.folder.iterdir():
                each.unlink()
    for words in (["cut", outside, "--from", "1", "--to", "30"], ["pack", outside], ["salvage", outside]):
        out = disk.folder / "out.dspace"
        for room in (0, 1, 8, 32, 64, 128):
            disk.leave(room * PAGE)
            assert main(["log", *map(str, words), "--out", str(out)]) == 1, (words, room)
            assert not disk.content(), (words, room)
        disk.free()
        assert main(["log", *map(str, words), "--out", str(out)]) == 0
        with RecordingFile(out) as file:
            file.check()
        out.unlink()
    # Pictures of a recording: those that could be written are whole, and the command fails.
    out = disk.folder / "pictures"
    disk.leave(20 * PAGE)
    assert main(["play", str(outside), "--out", str(out), "--every", "1"]) == 1
    for path in out.iterdir():
        assert path.read_bytes().endswith(b"IEND\xaeB`\x82"), path
    telemetry = pathlib.Path(os.environ["HERE"]) / "telemetry.dspace"
    with dspace.Session() as session:
        scene = session.scene()
        with session.record(telemetry):
            scene.telemetry.add("power", unit="W")
            for number in range(2000):
                scene.time = number / 10
                scene.telemetry.set({"power": number})
    disk.free()
    disk.leave(2 * PAGE)
    csv = disk.folder / "t.csv"
    assert main(["log", "telemetry", str(telemetry), "--csv", str(csv)]) == 1 and not csv.exists()


def child(name, folder):
    globals()[name](Disk(folder))
    print("done")


@pytest.mark.parametrize("name", ["pictures", "measurements", "movies", "recordings"])
def test_nothing_is_lost_on_a_full_disk(tmp_path, name):
    if name == "movies":
        from needs import needs_program
        needs_program("ffmpeg", "ffmpeg")
    disk = tmp_path / "disk"
    disk.mkdir()
    words = (f"import sys; sys.path[:0] = {json.dumps(sys.path)}; import test_disk_full; "
             f"test_disk_full.child({name!r}, {str(disk)!r})")
    done = on_small_disk(disk, sys.executable, "-W", "ignore", "-c", words, env=dict(os.environ, HERE=str(tmp_path)))
    assert done.returncode == 0 and done.stdout.endswith("done\n"), done.stdout[-2000:] + done.stderr[-6000:]
