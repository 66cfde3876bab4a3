"""Steps whose times were added up: what finds a step by its time finds the one that is meant, and all find the same."""
import bisect
import math
import sqlite3
import warnings

import pytest

import dspace
from dspace.command_line import main
from dspace.movies.draw import open_run
from dspace.playback.steps import StepTimes
from dspace.recording.file import RecordingFile
from dspace.proto import commands_pb2 as pb
from recording_support import Row, write_recording

COUNT, STEP = 2000, 0.001
SET_TIME = pb.Command.SET_TIME_FIELD_NUMBER


def added_up(count, begin=0.0, step=STEP):
    times = [begin]
    while len(times) < count:
        times.append(times[-1] + step)
    return times


def record(path, times):
    """Frame f is at x = n, and the telemetry "n" is n, from step n on."""
    with dspace.Session() as session, session.record(path):
        scene = session.scene()
        scene.add_camera("c", eye=(0, -5, 0), target=(0, 0, 0))
        scene.add_viewport((16, 16), "c", name="view")
        frame, channel = scene.add_frame("f"), scene.telemetry.add("n")
        for n, time in enumerate(times):
            scene.time = time
            frame.pose = dspace.Pose((n, 0, 0))
            channel.value = n
    return path


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    times = added_up(COUNT)
    assert times[1000] > 1.0 and times[1000] - 1.0 < 1e-12  # late by a rounding
    return record(tmp_path_factory.mktemp("rounding") / "a.dspace", times)


def shown(session):
    return session.scenes["scene"].frame("f").pose.position[0]


def steps_in(path):
    """The times that are set in a recording, in order."""
    with RecordingFile(path) as file:
        return [row.time for row in file.rows(file.first) if row.kind == SET_TIME]


def test_each_time_finds_its_step(path):
    """n / 1000 finds step n, in playback, movies and telemetry."""
    with dspace.Playback(path) as run:
        times, series = run.times[1:], run.telemetry("n")
        assert times == added_up(COUNT)
        for n in range(COUNT):
            assert run._steps.index_at(n / 1000) == n + 1
            assert series.at(n / 1000) == n
            if n:
                assert series.at((n - 0.01) / 1000) == n - 1  # what is before it is before it
        movie = open_run(run)
        for n in (999, 1000, 1001, 1999, 1000, 3):
            assert run.seek(n / 1000) == times[n] and shown(run.session) == n  # its own time is returned
            run.seek(0.0)
            movie.advance(n / 1000)
            assert shown(run.session) == n


def test_values_that_are_set_rarely_go_by_the_steps(tmp_path):
    """A rounding is one of the simulation's steps, not of the time between two values."""
    with dspace.Session() as session, session.record(tmp_path / "a.dspace"):
        channel = session.scene().telemetry.add("n", value=1.0)
        for n, time in enumerate(added_up(1100)):
            session.scene().time = time
            if n == 1000:
                channel.value = 2.0
    with dspace.Playback(tmp_path / "a.dspace") as run:
        for at, value in ((1.0, 2.0), (1.0 - 5e-5, 1.0), (0.999, 1.0), (1.001, 2.0)):
            run.seek(at)
            assert run.telemetry("n").at(at) == run.session.scenes["scene"].telemetry["n"].value == value, at


def test_play_ends_with_the_step_that_is_meant(path):
    with dspace.Playback(path) as run:
        times = run.times[1:]
        for speed in (0, 1e9):
            run.seek(0.998)
            run.play(speed, until=1.0)
            assert run.time == times[1000]
        # Back: a step that is early by a rounding is at the time, too.
        early = next(n for n in range(1200, COUNT) if times[n] < n / 1000)
        for speed in (-math.inf, -1e9):
            run.seek((early + 3) / 1000)
            run.play(speed, until=early / 1000)
            assert run.time == times[early]
            run.seek(1.003)
            run.play(speed, until=1.0)
            assert run.time == times[1000]


def test_what_dspace_play_and_log_cut_find(path, tmp_path, capsys):
    times = added_up(COUNT)
    with dspace.Playback(path) as run:
        run.seek(times[1000])
        run.session.viewports["view"].save(str(tmp_path / "meant.png"))
    assert main(["play", str(path), "--at", "1", "--out", str(tmp_path / "at")]) == 0
    assert main(["play", str(path), "--at", "1"]) == 0 and "at 1 s viewports: 'view'" in capsys.readouterr().out
    assert (tmp_path / "at/000000.png").read_bytes() == (tmp_path / "meant.png").read_bytes()
    early = next(n for n in range(1200, COUNT) if times[n] < n / 1000)
    for n in (1000, early):
        cut = str(tmp_path / f"{n}.dspace")
        assert main(["log", "cut", str(path), "--to", repr(n / 1000), "--out", cut]) == 0
        assert steps_in(cut) == times[:n + 1]
        with dspace.Playback(cut) as run:
            assert run.step(COUNT * 2) and shown(run.session) == n
    # A part of one step has all of its commands.
    one = str(tmp_path / "one.dspace")
    assert main(["log", "cut", str(path), "--from", "1", "--to", "1", "--out", one]) == 0
    with dspace.Playback(one) as run:
        assert run.seek(1.0) == times[1000] and shown(run.session) == 1000


def test_a_part_begins_with_the_step_that_is_meant(tmp_path):
    """With a state after each step, so that the part has no others before it."""
    path, cut = tmp_path / "a.dspace", str(tmp_path / "cut.dspace")
    times = [0.5, 0.75, 1.0000000000000007, 1.25]
    rows, states = [], [Row(0, 0.0, 0.0, 0, b"")]
    for seq, time in enumerate(times, 1):
        command = pb.Command()
        command.set_time.time_s = time
        rows.append(Row(seq, time, 0.0, SET_TIME, command.SerializeToString()))
        states.append(Row(seq, time, 0.0, 0, b""))
    write_recording(str(path), rows, states)
    for begin in ("1", "1.0000000000000007", "1.000000000000001"):
        (tmp_path / "cut.dspace").unlink(missing_ok=True)
        assert main(["log", "cut", str(path), "--from", begin, "--out", cut]) == 0
        assert steps_in(cut) == times[2:], begin


def test_a_span_wholly_outside_is_refused(path, tmp_path, capsys):
    last = added_up(COUNT)[-1]  # the steps begin at 0
    out = str(tmp_path / "cut.dspace")
    for options in (["--from", "2.5"], ["--from", "2.5", "--to", "3"], ["--to", "-0.5"], ["--from", "-2", "--to", "-1"]):
        assert main(["log", "cut", str(path), *options, "--out", out]) == 1
        assert "accepted: within" in capsys.readouterr().err and not (tmp_path / "cut.dspace").exists()
    for number, options in enumerate((["--from", "-1", "--to", "3"], ["--from", repr(last + 1e-9)],
                                      ["--to", "-1e-9"], ["--to", "inf"])):  # in part, or by a rounding
        assert main(["log", "cut", str(path), *options, "--out", f"{out}{number}"]) == 0, options


def test_a_step_that_is_lost_is_not_replaced_by_the_one_before(tmp_path):
    path = record(tmp_path / "a.dspace", added_up(1100))
    with sqlite3.connect(path) as database:
        last, = database.execute("SELECT max(seq) FROM command WHERE kind = ? AND time < 1.0005",
                                 (SET_TIME,)).fetchone()
        database.execute("DELETE FROM command WHERE seq = ?", (last + 1,))
        database.execute("INSERT INTO meta VALUES('lost', ?)", (f"{last + 1}-{last + 1}",))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", dspace.DspaceWarning)
        with dspace.Playback(path) as run:
            assert run.seek(0.999) < 0.9995 and shown(run.session) == 999
            with pytest.raises(dspace.Corrupt, match="commands are lost"):
                run.seek(1.0)


def test_times_as_large_as_ephemeris_seconds():
    """A double's spacing is 1.2e-7 s there."""
    for step in (1e-3, 1e-4, 1e-5):
        times = [8e8 + n * step for n in range(500)]
        steps = StepTimes(times)
        for n, time in enumerate(times):
            for asked in (time, math.nextafter(time, 0.0), math.nextafter(time, 1e9)):
                assert steps.index_at(asked) == n
            assert steps.index_at(time + 0.9 * step) == n
    times = [8e8]  # as close as can be
    while len(times) < 20:
        times.append(math.nextafter(times[-1], 1e9))
    assert [StepTimes(times).index_at(time) for time in times] == list(range(20))


LATE = 1.0000000000000007


@pytest.mark.parametrize("times, asked, index", [
    ([0.0, 0.9, LATE, LATE, 1.1], 1.0, 3),                # the newest of one time
    ([0.1 + 0.2, 0.5], 0.3, 0), ([0.1 + 0.2, 0.5], 0.29, None),  # the first of all
    ([LATE], 1.0, None), ([0.1 + 0.2], 0.3, 0),           # alone: two spacings
    ([0.0, 1.0, 2.0, 0.0, 0.5, 1.0 - 1e-15], 1.0, 5),     # a later run that reaches it but for a rounding
    ([0.0, 1.0, 2.0, 0.0, 0.5, 1.0 - 1e-3], 1.0, 1),
    ([0.0, 1.0, 2.0, 1e-15, 1.0], 0.0, 3),
    ([0.0, 1.0, 1.0 + 1e-7, 2.0], 1.0, 1),                # the exact one
    ([0.0, 1.0, 1.0 + 1e-7, 2.0], 1.0 - 1e-6, 1),         # each by its own step
    ([0.0, 1.0, 1.0 + 1e-7, 2.0], 1.0 + 5e-8, 1),
    ([0.0, 1.0, 1.0 + 1e-7, 2.0], 1.0 + 1e-7 - 5e-11, 2),
    ([0.0, 1000.0], 1000.0 - 0.9e-4, 1), ([0.0, 1000.0], 1000.0 - 1.1e-4, 0),  # at most 0.1 ms
])
def test_ends_of_runs_and_close_steps(times, asked, index):
    """The same cases as for the C++ reader (TestPlayback)."""
    assert StepTimes(times).index_at(asked) == index


def test_going_back_the_exact_step_wins():
    times = [0.0, 10.0, 10.0 + 1e-5, 20.0]
    assert not StepTimes(times).is_at(1, 10.0 + 1e-5) and StepTimes(times).is_at(2, 10.0 + 1e-5)


@pytest.mark.parametrize("step", (0.001, 0.01, 0.1, 1.0 / 3.0))
def test_sums_of_other_steps(step):
    times = added_up(2001, 0.0, step)
    steps = StepTimes(times)
    for n in range(1, 2001):
        assert steps.index_at(n * step) == n
        assert steps.index_at((n - 0.01) * step) == n - 1
        assert bisect.bisect_right(times, times[n]) == n + 1
