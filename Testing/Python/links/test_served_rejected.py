"""Servers, links and recordings reject bad input; a server that cannot start leaves no files and no process."""
import socket

import pytest

import dspace
from dspace.command_line import main
from dspace.links.serving import ServerProcess
from served_support import Served, socket_folder


def raised(kind, call):
    with pytest.raises(dspace.Error) as found:
        call()
    assert type(found.value) is kind, repr(found.value)
    return str(found.value)


@pytest.fixture
def taken(tmp_path):
    """A socket that somebody listens on."""
    path = socket_folder(tmp_path) / "taken"
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(str(path))
        listener.listen()
        yield f"unix:{path}"


def test_a_server_that_cannot_start_leaves_no_recording(tmp_path, taken, capsys):
    path = tmp_path / "run.dspace"
    for address in (taken, "nonsense", f"unix:{socket_folder(tmp_path)}/no/socket"):
        assert main(["serve", "--listen", address, "--record", str(path)]) == 1
        assert capsys.readouterr().err.count("\n") == 1
        assert not [each for each in tmp_path.iterdir() if each.name.startswith("run")]
    # What was there before stays, and the same command with another address goes on.
    with Served(tmp_path, "--record", str(path)) as server, dspace.connect(server.address) as session:
        session.scene().time = 1.0
    before = path.read_bytes()
    assert main(["serve", "--listen", taken, "--record", str(path)]) == 1
    assert "there is such a file" in capsys.readouterr().err and path.read_bytes() == before
    with dspace.Playback(path) as run:
        assert run.times[-1] == 1.0


@pytest.mark.parametrize("words, says", [
    (["--max-frames", "0"], "--max-frames 0; accepted: 1 or more"),
    (["--max-frames", "-3"], "--max-frames -3; accepted: 1"),
    (["--max-rate", "-1"], "--max-rate -1; accepted: any number above 0"),
    (["--max-rate", "nan"], "--max-rate nan; accepted"),
    (["--max-message", "0"], "--max-message 0; accepted: 1024 to"),
    (["--max-connections", "0"], "--max-connections 0; accepted"),
    (["--max-connections", "9" * 30], "accepted: 1 to 1000"), (["--record", ""], "--record ''; accepted: a new file"),
    (["--make-test-certificates", "/proc/x"], "certificates '/proc/x': No such file or directory; accepted"),
    (["--make-test-certificates", __file__], "accepted: a folder that may be made")])
def test_values_of_the_command_line(tmp_path, capsys, words, says):
    assert main(["serve", "--listen", "nonsense", *words]) == 1
    said = capsys.readouterr().err
    assert says in said and said.count("\n") == 1


def test_server_processes_refuse_by_name(tmp_path):
    for words, kind in ((dict(roots="/tmp"), dspace.WrongType), (dict(roots=5), dspace.WrongType),
                        (dict(roots=[5]), dspace.WrongType), (dict(roots=[], record=5), dspace.WrongType),
                        (dict(roots=[], record=""), dspace.InvalidArgument),
                        (dict(roots=[], pack="no"), dspace.WrongType),
                        (dict(roots=[], timeout=0), dspace.InvalidArgument)):
        said = raised(kind, lambda: ServerProcess(**words))
        assert said.startswith("server: ") and "accepted" in said


def test_times_to_wait(tmp_path):
    for timeout in (1e300, 0, -1, float("nan"), float("inf")):
        for call in (dspace.connect, dspace.watch):
            said = raised(dspace.InvalidArgument, lambda: call(f"unix:{socket_folder(tmp_path)}/nobody", timeout=timeout))
            assert f"the timeout is {timeout!r}; accepted: seconds above 0, up to 1e6" in said
    with Served(tmp_path) as server, dspace.connect(server.address) as session:
        session.scene()
        raised(dspace.InvalidArgument, lambda: session.process_events(float("nan")))
        raised(dspace.WrongType, lambda: session.execute(5))
        with dspace.watch(server.address) as watcher:
            assert "the wait is nan" in raised(dspace.InvalidArgument, lambda: watcher.update(float("nan")))
            said = raised(dspace.InvalidArgument, lambda: watcher.add_view(""))
            assert "the view's name is ''; accepted: any that is not empty" in said and not watcher.viewports


def test_a_session_that_is_recorded_says_so(tmp_path):
    with dspace.Session() as session, session.record(tmp_path / "a.dspace"):
        said = raised(dspace.AlreadyExists, lambda: session.record(tmp_path / "b.dspace"))
        assert "a.dspace" in said and "one recording at a time" in said and not (tmp_path / "b.dspace").exists()


def test_addresses_have_no_character_of_code_0():
    for follow in (dspace.connect, dspace.watch):
        assert raised(dspace.InvalidArgument, lambda: follow("unix:/tmp/a\0b")).endswith("without a character of code 0")


def test_what_waits_is_not_carried_out_after_a_refusal(tmp_path):
    with Served(tmp_path) as server, dspace.connect(server.address) as session:
        scene = session.scene()
        frame = scene.add_frame("a")
        for i in range(1, 30):
            session.wait = False
            scene.set_poses([frame], [[float("nan"), 0, 0, 1, 0, 0, 0, 1]])
            session.wait = True
            with pytest.raises(dspace.InvalidArgument, match="finite"):
                scene.time = float(i)
            assert scene.time == i - 1
            scene.time = float(i)
