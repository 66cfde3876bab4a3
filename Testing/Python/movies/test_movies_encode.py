"""Movie files are whole or not there: a full disk, a killed ffmpeg and odd names."""
import os
import subprocess
import sys

import numpy as np
import pytest

import dspace
from dspace._core.png import png
from dspace.movies.encode import Encoder, encode
from dspace.movies.folder import FRAME
from movies_support import SIZE, flight, run  # noqa: F401  (run: a fixture)

COUNT = 40
# In ffmpeg's place: it gets the words of `change`, may write files of so many bytes, and is told of a full disk.
PROGRAM = '''#!{python}
import os, resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, ({room}, {room}))
words = ["ffmpeg"] + sys.argv[1:]
{change}
os.execv({ffmpeg!r}, words)
'''


def pictures():
    """Noise, so that files are large."""
    random = np.random.default_rng(5)
    return [np.kron(random.integers(0, 256, (16, 24, 3)), np.ones((4, 4, 1))).astype(np.uint8) for _ in range(COUNT)]


def write(how, folder, path):
    if how == "encode":
        folder.mkdir(exist_ok=True)
        for number, picture in enumerate(pictures()):
            (folder / (FRAME % number)).write_bytes(png(picture))
        encode(str(folder / FRAME), path, SIZE, 10, COUNT)
    else:
        with Encoder(path, SIZE, 10) as movie:
            for picture in pictures():
                movie.add(picture)


@pytest.fixture
def instead(tmp_path, monkeypatch):
    """instead(room, change): another ffmpeg from now on; instead(): the one that there was."""
    import shutil
    found, before = shutil.which("ffmpeg"), os.environ["PATH"]
    place = tmp_path / "programs"
    place.mkdir()

    def put(room=1 << 40, change=""):
        program = place / "ffmpeg"
        program.write_text(PROGRAM.format(python=sys.executable, room=room, ffmpeg=found, change=change))
        program.chmod(0o755)
        monkeypatch.setenv("PATH", f"{place}{os.pathsep}{before}")

    return put


@pytest.mark.parametrize("ending", (".mp4", ".webm"))
@pytest.mark.parametrize("how", ("encode", "Encoder"))
def test_a_full_disk_is_no_movie(tmp_path, instead, ending, how):
    """Whatever part of the file had room, also where nothing but its end had none."""
    out = tmp_path / f"a{ending}"
    write(how, tmp_path / "work", out)
    size = out.stat().st_size
    out.unlink()
    for part in (0.02, 0.5, 0.95, 0.995):
        instead(room=int(part * size))
        with pytest.raises(dspace.Io, match="ffmpeg"):
            write(how, tmp_path / "work", out)
        assert not list(tmp_path.glob("a*")), part
    instead()
    write(how, tmp_path / "work", out)
    assert out.stat().st_size == size


def test_a_full_disk_costs_no_picture(run, tmp_path, instead):
    out = tmp_path / "a.mp4"
    movie = flight()
    instead(room=2000)
    with pytest.raises(dspace.Io, match="ffmpeg failed"):
        movie.make(run, out)
    assert not out.exists()
    instead()
    assert movie.make(run, out) == 0 and out.exists()


@pytest.mark.parametrize("how", ("encode", "Encoder"))
@pytest.mark.parametrize("change, says", [
    ("words[-1:-1] = ['-frames:v', '25']", "it holds 25 of 40 pictures"),
    ("open(words[-1], 'w').write('no movie'); sys.exit(0)", "it holds none of 40 pictures"),
    ("sys.stderr.write('all is not well\\n')", "ffmpeg failed: all is not well"),
    ("os.kill(os.getpid(), signal.SIGKILL)", "ffmpeg"),
])
def test_what_ffmpeg_calls_done_is_looked_at(tmp_path, instead, how, change, says):
    instead(change=change)
    with pytest.raises(dspace.Io, match=f"{says}|ffmpeg ended early" if how == "Encoder" else says):
        write(how, tmp_path / "work", tmp_path / "a.mp4")
    assert not list(tmp_path.glob("a*"))


@pytest.mark.parametrize("name", ("12:30.mp4", "-x.webm", "a%03d b.mp4"))
@pytest.mark.parametrize("how", ("encode", "Encoder"))
def test_names_are_taken_as_they_are(tmp_path, monkeypatch, how, name):
    monkeypatch.chdir(tmp_path)
    write(how, tmp_path / "work", name)
    assert (tmp_path / name).stat().st_size > 1000 and not list(tmp_path.glob("*.part"))


def test_a_movie_without_a_picture_is_none(tmp_path):
    with pytest.raises(dspace.InvalidArgument, match="no picture; accepted: one or more"):
        with Encoder(tmp_path / "a.mp4", SIZE, 25):
            pass
    assert not list(tmp_path.iterdir())


def test_encoding_tells_how_far_it_is(run, tmp_path):
    told = []
    flight().make(run, tmp_path / "a.webm", encoding=lambda *now: told.append(now))
    assert [done for done, _, _ in told] == sorted(done for done, _, _ in told)
    assert told[-1][:2] == (12, 12) and all(seconds >= 0 for _, _, seconds in told)
    script = tmp_path / "a.toml"
    flight().save(script)
    done = subprocess.run([sys.executable, "-W", "ignore", "-m", "dspace", "movie", str(script), "--run", run, "--out",
                           str(tmp_path / "b.mp4")], capture_output=True, text=True)
    assert done.returncode == 0 and "12 of 12, all drawn" in done.stderr
    assert done.stderr.strip().splitlines()[-1] == "dspace: encoding: 12 of 12, all written"


def test_what_is_missing_at_the_end_is_told_at_the_beginning(run, tmp_path, monkeypatch):
    told = []
    movie = flight()
    (tmp_path / "file").write_text("")
    with pytest.raises(dspace.Io, match="accepted: a folder that may be written"):
        movie.make(run, tmp_path / "file" / "a.mp4", work=tmp_path / "work", progress=lambda *now: told.append(now))
    assert movie.make(run, tmp_path / "new" / "folder" / "a.mp4", work=tmp_path / "work") == 12
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(dspace.NotFound, match="ffmpeg is not installed"):
        movie.make(run, tmp_path / "b.mp4", progress=lambda *now: told.append(now))
    assert not told and not (tmp_path / "b.mp4.work").exists()
