"""Saved files are complete or absent. On a full disk the error names the file, an earlier file stays as it was, no
temporary file is left, and the process goes on."""
import contextlib
import os
import pathlib
import re
import resource
import stat
import subprocess
import sys
import tempfile

import numpy as np
import pytest

import dspace
from dspace._core.files import AtomicFile, atomic_write
from needs import needs_module
from served_support import Served

ROOM = 400  # bytes, fewer than any of the files has
FIELD = "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n0 0 0\n0 1 0\n0 0 0\n"


@contextlib.contextmanager
def full_disk(pid, room=ROOM):
    """In a `with` statement: no file that the process writes may become larger than `room` bytes."""
    before = resource.prlimit(pid, resource.RLIMIT_FSIZE)
    resource.prlimit(pid, resource.RLIMIT_FSIZE, (room, before[1]))
    try:
        yield
    finally:
        resource.prlimit(pid, resource.RLIMIT_FSIZE, before)


def content(folder):
    return {path.name: path.read_bytes() for path in pathlib.Path(folder).iterdir()}


def check_full_disk(session, folder, pid):
    """Saves with room, without, and with room again, in a session for which the process `pid` writes."""
    folder = pathlib.Path(folder)
    (folder / "field.asc").write_text(FIELD)
    out = folder / "out"
    out.mkdir()
    scene = session.scene()
    terrain = scene.add_terrain(folder / "field.asc", subdivisions=3)
    terrain.track({"left": [(-0.5, 0.0), (0.5, 0.0)]}, width=0.1, sinkage=0.01)
    places = np.random.default_rng(1).uniform(-1, 1, (500, 3))
    scene.add_points(places, point_size=4, color=(0.8, 0.6, 0.1))
    view = scene.add_viewport((200, 150), scene.add_camera(eye=(4, 1, 2), target=(0, 0, 0)))
    saves = {name: view.save for name in ("a.png", "a.jpg", "a.tif", "a.exr")}
    saves.update({"depth.exr": lambda path: view.save(path, plane="depth"),
                  "label.png": lambda path: view.save(path, plane="label"),
                  "tracks.geojson": terrain.save_tracks})
    for name, save in saves.items():
        save(out / name)
    before = content(out)
    assert list(saves) == sorted(before, key=list(saves).index) and min(map(len, before.values())) > ROOM
    # What is saved from here on differs from what is there.
    scene.add_points(places + 0.3, point_size=3, color=(0.1, 0.6, 0.9))
    terrain.track({"right": [(-0.5, 0.4), (0.5, 0.4)]}, width=0.1, sinkage=0.01)
    saves.update({"new.jpg": view.save, "new.png": view.save})
    with full_disk(pid):
        for name, save in saves.items():
            with pytest.raises(dspace.Io, match="cannot be written: File too large") as error:
                save(out / name)
            assert f"file '{out / name}'" in str(error.value)
            assert view.image().shape[:2] == (150, 200)  # the session goes on
        assert content(out) == before
    for name, save in saves.items():
        save(out / name)
    after = content(out)
    assert sorted(after) == sorted(saves)
    assert [name for name in before if after[name] == before[name]] == []


def local(folder):
    with dspace.Session() as session:
        check_full_disk(session, folder, os.getpid())
    print("the process goes on")


def test_a_full_disk_in_a_session(tmp_path):
    """In another process, because a library might end it."""
    words = f"import sys; sys.path[:0] = {sys.path!r}; import test_saving; test_saving.local({str(tmp_path)!r})"
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", words], capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout == "the process goes on\n", done.stderr


def test_a_full_disk_in_a_served_session(tmp_path):
    with Served(tmp_path, "--allow-root", str(tmp_path)) as server, dspace.connect(server.address) as session:
        check_full_disk(session, tmp_path, server.process.pid)
        assert server.process.poll() is None


@pytest.mark.parametrize("name", ("a.png", "a.tif", "a.jpg"))
def test_what_was_saved_can_be_read(scene, tmp_path, name):
    gdal = needs_module("osgeo.gdal", "python3-gdal")
    gdal.UseExceptions()
    scene.add_box((1, 2, 3), color=(0.8, 0.3, 0.1))
    view = scene.add_viewport((200, 150), scene.add_camera(eye=(5, 4, 3), target=(0, 0, 0)))
    view.save(tmp_path / name)
    read = np.moveaxis(gdal.Open(str(tmp_path / name)).ReadAsArray(), 0, -1)
    np.testing.assert_allclose(read.astype(int), view.image()[..., :3].astype(int), atol=40 if name == "a.jpg" else 0)


def test_pictures_are_not_written_to_what_is_no_file(scene, tmp_path):
    view = scene.add_viewport((32, 24), scene.add_camera(eye=(5, 0, 0), target=(0, 0, 0)))
    (tmp_path / "folder.png").mkdir()
    os.mkfifo(tmp_path / "pipe.png")
    (tmp_path / "away.png").symlink_to(tmp_path / "none.png")
    for name, says in (("folder.png", "it is a folder"), ("pipe.png", "a pipe"), ("none/a.png", "there is no folder"),
                       ("away.png", "a link to a file that exists"), ("x" * 252 + ".png", "File name too long")):
        with pytest.raises(dspace.Io, match=says) as error:
            view.save(tmp_path / name)
        assert f"file '{tmp_path / name}'" in str(error.value)
    assert sorted(each.name for each in tmp_path.iterdir()) == ["away.png", "folder.png", "pipe.png"]
    view.save(tmp_path / ("x" * 251 + ".png"))
    (tmp_path / "link.png").symlink_to("file.png")
    (tmp_path / "file.png").write_text("earlier")
    view.save(tmp_path / "link.png")
    assert (tmp_path / "link.png").is_symlink()
    assert (tmp_path / "file.png").read_bytes() == (tmp_path / ("x" * 251 + ".png")).read_bytes()


# --- Python's writer -------------------------------------------------------------------------------

def test_a_file_appears_when_it_is_complete(tmp_path):
    path = tmp_path / "a"
    with AtomicFile(path) as file:
        file.write(b"0123")
        file.write(bytearray(b"4567"))
        assert not path.exists() and os.path.dirname(file.temporary) == str(tmp_path)
    assert content(tmp_path) == {"a": b"01234567"}
    with pytest.raises(KeyError), AtomicFile(path) as file:
        file.write(b"new")
        raise KeyError
    with AtomicFile(path) as file:  # a program that makes it again
        os.unlink(file.temporary)
        pathlib.Path(file.temporary).write_bytes(b"by a program")
    assert content(tmp_path) == {"a": b"by a program"}


def test_python_on_a_full_disk(tmp_path):
    path = tmp_path / "a"
    atomic_write(path, b"before")
    with full_disk(0):
        with pytest.raises(dspace.Io, match="movie 'a': it cannot be written: File too large; accepted: .* free space"):
            atomic_write(path, b"x" * (ROOM + 1), "movie 'a'")
        assert content(tmp_path) == {"a": b"before"}
        atomic_write(path, b"x" * ROOM)
    atomic_write(path, b"x" * (ROOM + 1))
    assert content(tmp_path) == {"a": b"x" * (ROOM + 1)}


def test_python_rejects_paths(tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("before")
    (tmp_path / "away").symlink_to("none")
    (tmp_path / "loop").symlink_to("loop")
    os.mkfifo(tmp_path / "pipe")
    there = sorted(each.name for each in tmp_path.iterdir())
    for name, says in (("folder", "it is a folder"), ("folder/", "it names a folder"), ("none/a", "there is no folder"),
                       ("file/a", "Not a directory"), ("pipe", "a pipe"), ("away", "a link to a file that exists"),
                       ("loop", "Too many levels"), ("x" * 256, "File name too long")):
        with pytest.raises(dspace.Io, match=says) as error:
            atomic_write(f"{tmp_path}/{name}", b"new")
        assert f"file '{tmp_path}/{name}'" in str(error.value)
    with pytest.raises(dspace.Io, match="is a device"):
        atomic_write("/dev/full", b"new")
    with pytest.raises(dspace.Io, match="its path is empty"):
        atomic_write("", b"new")
    with pytest.raises(dspace.InvalidArgument, match="zero byte"):
        atomic_write(f"{tmp_path}/a\0b", b"new")
    assert sorted(each.name for each in tmp_path.iterdir()) == there and (tmp_path / "file").read_text() == "before"


@pytest.fixture
def open_folder():
    """A folder that every user may write. pytest's own is below one of this user alone."""
    with tempfile.TemporaryDirectory(prefix="dspace-test-") as folder:
        os.chmod(folder, 0o777)
        yield pathlib.Path(folder)


def test_python_needs_permission(open_folder):
    """In another process, which gives up what the superuser may."""
    folder = open_folder / "locked"
    folder.mkdir()
    (folder / "a").write_text("before")
    (open_folder / "b").write_text("before")
    (open_folder / "b").chmod(0o444)
    folder.chmod(0o555)
    words = f"""
import os, sys
sys.path[:0] = {sys.path!r}
import dspace.errors
from dspace._core.files import atomic_write
os.chdir({str(open_folder)!r})
if os.geteuid() == 0:
    os.seteuid(65534)
for path in ("locked/a", "locked/c", "b"):
    try:
        atomic_write(path, b"new")
    except dspace.errors.Io as error:
        print(error)
atomic_write("d", b"new")
"""
    done = subprocess.run([sys.executable, "-c", words], capture_output=True, text=True)
    folder.chmod(0o755)
    assert done.returncode == 0 and done.stdout.count("Permission denied") == 3, done.stderr
    assert content(folder) == {"a": b"before"} and (open_folder / "b").read_text() == "before"
    assert (open_folder / "d").read_text() == "new"


def test_links_modes_and_names(tmp_path):
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "file").write_text("before")
    (tmp_path / "link").symlink_to("there/file")
    atomic_write(tmp_path / "link", b"new")
    assert (tmp_path / "link").is_symlink() and content(tmp_path / "there") == {"file": b"new"}

    def mode(name):
        return stat.S_IMODE((tmp_path / name).stat().st_mode)

    before = os.umask(0o027)
    try:
        atomic_write(tmp_path / "mode", b"new")
    finally:
        os.umask(before)
    assert mode("mode") == 0o640
    (tmp_path / "mode").chmod(0o604)
    atomic_write(tmp_path / "mode", b"newer")
    assert mode("mode") == 0o604
    for name in ("x" * 255, "x" * 63 + "\u00e4" * 96, os.fsdecode(b"\xff" * 200)):
        atomic_write(tmp_path / name, b"new")
        assert (tmp_path / name).read_bytes() == b"new"
    assert len(list(tmp_path.iterdir())) == 6


def test_a_new_file_replaces_nothing(tmp_path):
    path = tmp_path / "a"
    atomic_write(path, b"first", new=True)
    for other in (path, tmp_path / "link"):
        with contextlib.suppress(FileExistsError):
            other.symlink_to("none")
        with pytest.raises(dspace.AlreadyExists, match="there is such a file; accepted: a new file"):
            atomic_write(other, b"second", new=True)
    path.unlink()
    with pytest.raises(dspace.AlreadyExists), AtomicFile(path, new=True) as file:
        file.write(b"second")
        path.write_bytes(b"somebody else's")
    assert path.read_bytes() == b"somebody else's"
    assert sorted(each.name for each in tmp_path.iterdir()) == ["a", "link"]


# --- No other writers ------------------------------------------------------------------------------

PYTHON_WRITES = re.compile(r"\bopen\(.*[\"'][wxa]b?\+?[\"']|\.write_text\(|\.write_bytes\("
                           r"|\bos\.(replace|rename|link)\(|\bshutil\.(copy|move)|\bnp\.save")
CXX_WRITES = re.compile(r"\bofstream\b|\bfopen\(|\brename\(|\bO_CREAT\b|\bcopy_file\(|VSIFOpenL\([^)]*\"[wa]")
# The writers themselves, and what writes no file that a user keeps.
OTHERS = {"Wrapping/Python/dspace/_core/files.py": 3, "Libraries/Core/dspace/AtomicFile.cxx": 2,
          "Wrapping/Python/dspace/batches/folder.py": 1,  # a lock, without content
          "TileFile.cxx": 2,  # a partial map that stays for the next run, and gets its name once it is complete
          "Wrapping/Python/dspace/command_line/camera.py": 1,  # numpy's format in memory, which atomic_write() saves
          "Wrapping/Python/dspace/command_line/confinement.py": 1,  # the empty index of a log of SQLite
          "CallFilter.cxx": 1,  # rejects the flag
          "SettingsFile.cxx": 1,  # renames damaged settings, which AtomicFile then writes again
          "RecordedFiles.cxx": 1}  # unpacks into a folder of its own, which is removed at the end


def test_every_writer_uses_the_one():
    root, found = pathlib.Path(__file__).resolve().parents[3], {}
    for folder, pattern, writes in (("Libraries", "*.cxx", CXX_WRITES),
                                    ("Wrapping/Python/dspace", "*.py", PYTHON_WRITES),
                                    ("Examples/rover_drive", "*.py", PYTHON_WRITES)):
        for path in (root / folder).rglob(pattern):
            count = len(writes.findall(path.read_text()))
            if count and "Testing" not in path.relative_to(root).parts:
                name = path.name if path.name in OTHERS else str(path.relative_to(root))
                found[name] = count
    assert found == OTHERS
