"""`dspace serve` and `dspace play`: confined by default, in full function."""
import glob
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

import numpy
import pytest

import dspace
from dspace.command_line import confinement
from dspace.links.serving import ServerProcess
from served_support import Served, socket_folder
from terrain_support import gdal, write_raster

FLAT = 'LOCAL_CS["flat",UNIT["metre",1]]'
DSPACE = [sys.executable, "-W", "ignore", "-m", "dspace"]


def status(pid):
    return dict(line.split(":\t", 1) for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines() if ":\t" in line)


def is_confined(pid):
    found = status(pid)
    return found["NoNewPrivs"] == "1" and found["Seccomp"] == "2"


def dspace_command(*words, **environment):
    return subprocess.run([*DSPACE, *map(str, words)], capture_output=True, text=True, env={**os.environ, **environment})


def record(path, folder, pack=False):
    """A run of four steps on a small terrain, with a viewport."""
    heights = numpy.add.outer(numpy.arange(9.0), numpy.arange(9.0)).astype(numpy.float32)
    folder.mkdir(exist_ok=True)
    write_raster(folder / "ground.tif", heights)
    with dspace.Session() as session, session.record(path, pack=pack):
        scene = session.scene()
        scene.add_terrain(str(folder / "ground.tif"), name="ground", mode="clipmap", crs=FLAT)
        scene.add_viewport(size=(64, 48), camera=scene.add_camera(eye=(0, -20, 20), target=(0, 0, 8)), name="main")
        for step in range(3):
            scene.time = float(step)
        return session.viewports["main"].image()


# --- The server -------------------------------------------------------------------------------------

def test_a_server_is_confined(tmp_path):
    with ServerProcess([str(tmp_path)]) as server, dspace.connect(server.address) as session:
        assert is_confined(server.pid)
        scene = session.scene()
        viewport = scene.add_viewport(size=(64, 48), camera=scene.add_camera(eye=(4, -4, 3), target=(0, 0, 0)))
        viewport.save(str(tmp_path / "picture.png"))
    assert (tmp_path / "picture.png").stat().st_size > 0


def test_without_confinement_it_says_so(tmp_path):
    with Served(tmp_path, "--no-confinement") as server:
        assert not is_confined(server.process.pid)
        assert "--no-confinement: a file that misuses" in server.log()


def test_a_server_has_the_rights_of_its_options(tmp_path):
    """Not more: it writes into the roots, beside the recording and where its socket is made."""
    for name in ("root", "records", "outside"):
        (tmp_path / name).mkdir()
    with Served(tmp_path, "--allow-root", tmp_path / "root", "--record", tmp_path / "records" / "run.dspace") as server:
        rules = rules_of_serve("--listen", server.listen, "--allow-root", tmp_path / "root", "--record",
                               tmp_path / "records" / "run.dspace")
        with dspace.connect(server.address) as session:
            session.scene().time = 1.0
    assert server.code == 0 and (tmp_path / "records" / "run.dspace").exists()
    pairs = list(zip(rules, rules[1:]))
    written = {path for word, path in pairs if word == "--write"}
    assert written == {str(tmp_path / "root"), str(tmp_path / "records"),
                       os.path.join(os.environ["XDG_CACHE_HOME"], "dspace", "terrain")}
    assert [path for word, path in pairs if word == "--socket"] == [str(socket_folder(tmp_path))]
    assert "--listen-unix" in rules and not {"--listen", "--connect"} & set(rules)
    assert "--listen" in rules_of_serve("--listen", "127.0.0.1:0")
    home = os.path.expanduser("~")
    assert not [path for word, path in pairs if word.startswith("--") and path in ("/", "/home", "/tmp", "/etc", home)]


def rules_of_serve(*words):
    import argparse
    from dspace.command_line import serve
    parser = argparse.ArgumentParser()
    serve.add_arguments(parser)
    return serve.rules_of(parser.parse_args([str(word) for word in words])).words


def test_a_socket_that_a_killed_server_left_is_replaced(tmp_path):
    with Served(tmp_path) as first:
        first.kill()
    with Served(tmp_path) as second, dspace.connect(second.address) as session:
        session.scene()
        with pytest.raises(AssertionError, match="the path exists already"):  # the log of the third one
            Served(tmp_path).__enter__()
        session.scene()


def test_the_temporary_folder_is_removed(tmp_path, monkeypatch):
    """Also that of a server that is killed."""
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    for kill in (False, True):
        with Served(tmp_path) as server:
            folder, = glob.glob(f"{tmp_path}/dspace-confined-*")
            assert os.stat(folder).st_mode & 0o777 == 0o700
            if kill:
                pathlib.Path(folder, "left").write_text("left")
                server.kill()
        wait(lambda: not os.path.exists(folder))


def wait(until):
    end = time.monotonic() + 60
    while not until():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_a_kernel_without_landlock_gets_a_shorter_list_of_formats(tmp_path, monkeypatch):
    """Formats whose files name no others; the server says so."""
    write_raster(tmp_path / "ground.tif", numpy.zeros((9, 9), numpy.float32))
    (tmp_path / "mosaic.vrt").write_text(
        '<VRTDataset rasterXSize="9" rasterYSize="9"><VRTRasterBand dataType="Float32" band="1"><SimpleSource><SourceFilename '
        'relativeToVRT="1">ground.tif</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>')
    gdal.GetDriverByName("ISIS3").CreateCopy(str(tmp_path / "cube.lbl"), gdal.Open(str(tmp_path / "ground.tif")),
                                             options=["DATA_LOCATION=External"])
    expected = {"7": {"ground.tif", "mosaic.vrt", "cube.lbl"}, "0": {"ground.tif"}}
    for abi, accepted in expected.items():
        monkeypatch.setenv("DSPACE_LANDLOCK_ABI", abi)
        opened = set()
        with Served(tmp_path, "--allow-root", tmp_path) as server, dspace.connect(server.address) as session:
            assert is_confined(server.process.pid)  # calls are filtered in any case
            assert ("has no Landlock" in server.log()) == (abi == "0")
            for name in ("ground.tif", "mosaic.vrt", "cube.lbl"):
                try:
                    session.scene().add_terrain(str(tmp_path / name), mode="clipmap", crs=FLAT, build_overviews=False)
                    opened.add(name)
                except dspace.Unsupported as error:
                    assert "accepted here: GTiff" in str(error) and "VRT" not in str(error).split("accepted here")[1]
        (tmp_path / "serve.log").unlink()
        assert opened == accepted


def test_an_installed_script_is_confined(tmp_path):
    """Which executes itself again, wherever it lies."""
    (tmp_path / "bin").mkdir()
    script = tmp_path / "bin" / "dspace"
    script.write_text("import sys\nfrom dspace.command_line import main\nsys.exit(main())\n")
    done = subprocess.run([sys.executable, str(script), "serve", "--listen", "nonsense"], capture_output=True, text=True,
                          cwd=pathlib.Path("/usr"))
    assert done.returncode == 1 and "address 'nonsense'" in done.stderr, done.stderr


def test_a_missing_launcher_is_an_error(tmp_path):
    """Nothing runs unconfined by accident."""
    script = ("import sys\nfrom dspace.command_line import confinement, main\nconfinement._package = lambda: '/nowhere/a/b/c/d'\n"
              "sys.argv = ['dspace', 'serve']\nsys.exit(main())\n")
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.returncode == 1 and "/nowhere/bin/dspace-confine', which confines this command, is missing" in done.stderr
    assert "--no-confinement" in done.stderr


# --- Playback ---------------------------------------------------------------------------------------

@pytest.mark.parametrize("pack", [False, True])
def test_pictures_of_a_confined_playback_are_the_same(tmp_path, pack):
    image = record(tmp_path / "run.dspace", tmp_path / "data", pack)
    if pack:
        shutil.rmtree(tmp_path / "data")
    for words, out in (((), "confined"), (("--no-confinement",), "free")):
        done = dspace_command("play", tmp_path / "run.dspace", "--out", tmp_path / out, *words)
        assert done.returncode == 0, done.stderr
        assert ("--no-confinement: a file" in done.stderr) == bool(words)
    names = sorted(os.listdir(tmp_path / "confined"))
    assert names == [f"{number:06d}.png" for number in range(4)] == sorted(os.listdir(tmp_path / "free"))
    for name in names:
        assert (tmp_path / "confined" / name).read_bytes() == (tmp_path / "free" / name).read_bytes()
    last = gdal.Open(str(tmp_path / "confined" / names[-1])).ReadAsArray()
    assert numpy.array_equal(numpy.moveaxis(last[:3], 0, 2), image[..., :3])


def test_a_recording_that_was_not_closed_is_played(tmp_path):
    """The log of SQLite beside it has the last commands, and its index may be missing."""
    folder = tmp_path / "copy"
    folder.mkdir()
    path = tmp_path / "run.dspace"
    with dspace.Session() as session, session.record(path) as recording:
        scene = session.scene()
        for step in range(3):
            scene.time = float(step)
        recording.flush()
        for end in ("", "-wal"):
            shutil.copy(f"{path}{end}", folder)
    assert (folder / "run.dspace-wal").stat().st_size > 0
    done = dspace_command("play", folder / "run.dspace")
    assert done.returncode == 0 and done.stdout.startswith("4 steps, 0 to 2 s"), done.stderr


def test_playback_may_read_only_what_the_recording_read(tmp_path):
    record(tmp_path / "run.dspace", tmp_path / "data")
    assert confinement.recorded_files(str(tmp_path / "run.dspace")) == [str(tmp_path / "data" / "ground.tif")]
    (tmp_path / "broken.dspace").write_text("x" * 5000)
    assert confinement.recorded_files(str(tmp_path / "broken.dspace")) == []
    for name in ("broken.dspace", "none.dspace"):
        done = dspace_command("play", tmp_path / name, "--out", tmp_path / "out")
        assert done.returncode == 1 and name in done.stderr, done.stderr


# A server of one file, by ranges; a process of its own, since this one waits for it without Python's lock being free.
RANGES = """
import http.server, re, sys
DATA = open(sys.argv[1], "rb").read()
class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    def do_GET(self):
        if not self.path.endswith("/ground.tif"):
            return self.send_error(404)
        part = re.fullmatch(r"bytes=([0-9]+)-([0-9]+)", self.headers.get("Range", ""))
        first, last = (int(part[1]), min(int(part[2]), len(DATA) - 1)) if part else (0, len(DATA) - 1)
        self.send_response(206 if part else 200)
        self.send_header("Content-Length", str(last + 1 - first))
        self.send_header("Accept-Ranges", "bytes")
        if part:
            self.send_header("Content-Range", f"bytes {first}-{last}/{len(DATA)}")
        self.end_headers()
        if self.command == "GET":
            self.wfile.write(DATA[first:last + 1])
    do_HEAD = do_GET
    def log_message(self, *_):
        pass
server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
print(server.server_port, flush=True)
server.serve_forever()
"""


def test_a_raster_on_a_server_needs_the_network(tmp_path):
    record(tmp_path / "unused.dspace", tmp_path / "data")
    server = subprocess.Popen([sys.executable, "-c", RANGES, str(tmp_path / "data" / "ground.tif")], stdout=subprocess.PIPE,
                              text=True)
    try:
        url = f"http://127.0.0.1:{int(server.stdout.readline())}/ground.tif"
        with dspace.Session() as session, session.record(tmp_path / "run.dspace"):
            session.scene().add_terrain(url, name="ground", mode="clipmap", crs=FLAT)
            session.scene().time = 1.0
        allowed = dspace_command("play", tmp_path / "run.dspace", "--allow-network")
        done = dspace_command("play", tmp_path / "run.dspace")
    finally:
        server.kill()
        server.communicate()
    assert allowed.returncode == 0, allowed.stderr
    assert done.returncode == 1 and url in done.stderr
    assert "connections are not allowed; accepted: --allow-network" in done.stderr


def test_a_playback_ends_with_a_signal(tmp_path):
    """The process that was started is the one that plays."""
    record(tmp_path / "run.dspace", tmp_path / "data")
    process = subprocess.Popen([*DSPACE, "play", str(tmp_path / "run.dspace"), "--out", str(tmp_path / "out")],
                               stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline().endswith("000000.png\n")
    if process.poll() is None:
        assert is_confined(process.pid) or process.poll() is not None
        process.send_signal(signal.SIGINT)
    process.stdout.close()
    wait(lambda: process.poll() is not None)


# --- Movies -----------------------------------------------------------------------------------------

def movie_file(path):
    movie = dspace.Movie(size=(64, 48), rate=2, samples=1)
    movie.add_view("main")
    movie.add_key(time=0.0, position=(0, -20, 20), target=(0, 0, 8), run=0.0)
    movie.add_key(time=1.0, position=(5, -20, 20), target=(0, 0, 8), run=2.0)
    movie.save(str(path))


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_confined_movie_of_a_recording_is_the_same(tmp_path, jobs):
    """Its processes that draw, and ffmpeg, have its rights."""
    record(tmp_path / "run.dspace", tmp_path / "data")
    movie_file(tmp_path / "movie.toml")
    for words, out in (((), "confined"), (("--no-confinement",), "free")):
        for name in (f"{out}/pictures", f"{out}/movie.mp4"):
            done = dspace_command("movie", tmp_path / "movie.toml", "--run", tmp_path / "run.dspace", "--out",
                                  tmp_path / name, "--jobs", jobs, *words)
            assert done.returncode == 0, done.stderr
            assert ("--no-confinement: a file" in done.stderr) == bool(words)
        assert sorted(os.listdir(tmp_path / out)) == ["movie.mp4", "pictures"]
    for name in ("frame_000000.png", "frame_000001.png"):
        first, second = ((tmp_path / out / "pictures" / name).read_bytes() for out in ("confined", "free"))
        assert first == second
    assert (tmp_path / "confined" / "movie.mp4").stat().st_size > 0


def test_a_movie_without_landlock_says_so(tmp_path):
    movie_file(tmp_path / "movie.toml")
    done = dspace_command("movie", tmp_path / "movie.toml", "--run", tmp_path / "none.dspace", "--out", tmp_path / "a",
                          DSPACE_LANDLOCK_ABI="0")
    assert done.returncode == 1 and "has no Landlock" in done.stderr and "none.dspace" in done.stderr


def test_a_movie_of_a_function_is_not_confined(tmp_path):
    """It is the user's own code, which may need any file."""
    (tmp_path / "needed").write_text("1")
    (tmp_path / "run.py").write_text(
        "import pathlib\nimport dspace\n\ndef run():\n    session = dspace.Session()\n    scene = session.scene()\n"
        "    assert (pathlib.Path(__file__).parent / 'needed').read_text() == '1'\n    return session, lambda time: None\n")
    movie_file(tmp_path / "movie.toml")
    done = dspace_command("movie", tmp_path / "movie.toml", "--run", f"{tmp_path}/run.py:run", "--out", tmp_path / "out" / "a")
    assert done.returncode == 0, done.stderr


# --- A program that plays ---------------------------------------------------------------------------

PLAYS = """
import os
import pathlib
import sys
import dspace

def readers():
    "How many processes that read models this one has started."
    count = 0
    for place in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            name, rest = place.read_text().rsplit(")", 1)
        except OSError:
            continue
        count += "(dspace-import-w" in name and int(rest.split()[1]) == os.getpid()
    return count

model, run, player = sys.argv[1:]
with dspace.Session() as session, session.record(run):
    scene = session.scene()
    scene.load(model, name="part")
    scene.time = 1.0
    print(readers())
if player == "DspaceQt":
    qt = dspace.vtk.vtkDspacePlayer()
    assert qt.Open(os.fsencode(run), True) is not None
    qt.Go(1)
    print(readers(), qt.GetIndex())
else:
    with dspace.Playback(run) as playback:
        playback.step(1000)
        print(readers(), playback.index)
"""


@pytest.mark.parametrize("player", ["DspaceQt", "dspace.Playback"])
def test_a_program_that_plays_reads_models_apart(tmp_path, player):
    """An STL file is read in the process of its own user's session; one that a recording names never is. DspaceQt plays by
    vtkDspacePlayer. Rasters and shapes of a played recording: test_dataset_gate.py."""
    (tmp_path / "a.stl").write_text("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                                    "endloop\nendfacet\nendsolid a\n")
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", PLAYS, str(tmp_path / "a.stl"), str(tmp_path / "run.dspace"),
                           player], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split("\n")[:2] == ["0", "1 1"]
