"""Which instants of a recording there are: resets, several scenes, no time at all; and while it is written."""
import time

import numpy
import pytest

import dspace
from dspace.command_line import main
from dspace.playback.steps import steps_of
from dspace.recording.file import RecordingFile


def place(session):
    return session.scene().frame("f").pose.position[0]


def test_time_that_goes_back(tmp_path):
    """A simulation that is reset: the latest run that reaches a time is shown."""
    with dspace.Session() as session:
        frame = session.scene().add_frame("f")
        with session.record(tmp_path / "a.dspace"):
            for x, time in enumerate((0.0, 1.0, 2.0, 3.0, 0.0, 1.0)):
                session.scene().time = time
                frame.pose = dspace.Pose((x, 0, 0))
    with dspace.Playback(tmp_path / "a.dspace") as run:
        assert run.times == [0.0, 0.0, 1.0, 2.0, 3.0, 0.0, 1.0]  # the first is what was there before
        for at, x in ((0.5, 4), (1.0, 5), (1.5, 1), (2.0, 2), (3.0, 3), (99.0, 5)):
            run.seek(at)
            assert place(run.session) == x, at
        with pytest.raises(dspace.InvalidArgument, match="accepted: 0.0 on"):
            run.seek(-0.1)
        run.seek(0.0)
        assert run.index == 5 and run.step(-2) == -2 and run.time == 2.0 and place(run.session) == 2
        seen = []
        run.seek(2.0)
        run.play(0, lambda each: seen.append((each.time, place(each.session))))
        assert seen == [(3.0, 3), (0.0, 4), (1.0, 5)]


def test_no_time_at_all(tmp_path):
    """All is one step, at the time that was there."""
    with dspace.Session() as session:
        session.scene().time = 7.0
        frame = session.scene().add_frame("f")
        with session.record(tmp_path / "a.dspace"):
            for x in range(5):
                frame.pose = dspace.Pose((x, 0, 0))
        session.record(tmp_path / "empty.dspace").stop()  # no command at all
    for name, last in (("a.dspace", 4), ("empty.dspace", 4)):
        with dspace.Playback(tmp_path / name) as run:
            assert run.times == [7.0] and run.duration == 0.0 and run.step(3) == 0
            assert run.seek(8.0) == 7.0 and place(run.session) == last
            run.play(0, lambda each: pytest.fail("there is no other step"))
    with dspace.Session() as session:
        session.record(tmp_path / "nothing.dspace").stop()
    with dspace.Playback(tmp_path / "nothing.dspace") as run:
        assert run.times == [0.0] and not run.session.scenes


def test_several_scenes_with_times_of_their_own(tmp_path):
    with dspace.Session() as session:
        one, two = session.scene("one"), session.scene("two")
        frames = one.add_frame("f"), two.add_frame("f")
        with session.record(tmp_path / "a.dspace"):
            for i in range(4):
                one.time = float(i)
                frames[0].pose = dspace.Pose((i, 0, 0))
                two.time = 1000.0 + i
                frames[1].pose = dspace.Pose((10 * i, 0, 0))
    at = lambda run, name: session_place(run, name)
    with dspace.Playback(tmp_path / "a.dspace") as run:  # any scene's
        assert run.times[1:] == [0.0, 1000.0, 1.0, 1001.0, 2.0, 1002.0, 3.0, 1003.0]
        assert run.step(4) == 4 and run.time == 1001.0 and (at(run, "one"), at(run, "two")) == (1, 10)
    with dspace.Playback(tmp_path / "a.dspace", scene="one") as run:
        assert run.times[1:] == [0.0, 1.0, 2.0, 3.0] and run.seek(2.5) == 2.0
        assert (at(run, "one"), at(run, "two")) == (2, 20)  # all that came until its next time
    with dspace.Playback(tmp_path / "a.dspace", scene="two") as run:
        assert run.times[1:] == [1000.0, 1001.0, 1002.0, 1003.0]
        run.seek(1002.0)
        assert (at(run, "one"), at(run, "two")) == (3, 20)
    with pytest.raises(dspace.NotFound, match="no scene 'none'; there are: 'one', 'two'"):
        dspace.Playback(tmp_path / "a.dspace", scene="none")


def session_place(run, name):
    return run.session.scenes[name].frame("f").pose.position[0]


def test_while_it_is_written(tmp_path):
    """A reader sees whole steps only, takes in what has come since, and does not hold up the writer."""
    path = tmp_path / "a.dspace"
    before, since = time.time(), time.monotonic()
    with dspace.Session() as session:
        frame = session.scene().add_frame("f")
        with session.record(path, commit_every=0.001) as recording:
            recording.flush()
            with dspace.Playback(path) as run:
                seen = 0
                for i in range(400):
                    session.scene().time = 0.5 * i
                    frame.pose = dspace.Pose((i, 0, 0))
                    if i % 40 == 0:
                        recording.flush()
                        seen += run.update()
                        assert run.times[-1] == 0.5 * i and len(run.times) == seen + 1
                        run.seek(0.5 * i)
                        assert place(run.session) == i
                        run.seek(0.0)
                        assert place(run.session) == 0
            recording.flush()
            with RecordingFile(path) as file:
                file.check()
                assert file.last == recording.counts["written"] == 800
    after, lasted = time.time(), time.monotonic() - since
    with RecordingFile(path) as file:
        walls = numpy.array([row.wall for row in file.rows()])
        assert numpy.all(numpy.diff(walls) >= 0)
        # Seconds since 1970, also where the clock was set meanwhile.
        assert min(before, after - lasted) - 1 <= walls[0] and walls[-1] <= max(after, before + lasted) + 1


def test_what_comes_while_the_steps_are_read_is_of_no_step_before_it(tmp_path, monkeypatch):
    """Each question to the file sees one more step than the one before. That each question has one answer, whoever
    writes, TestPlayback proves."""
    path, ask = tmp_path / "a.dspace", RecordingFile._ask
    with dspace.Session() as session:
        frame = session.scene().add_frame("f")
        with session.record(path, commit_every=0.001) as recording:
            def go_on():
                session.scene().time += 1.0
                frame.pose = dspace.Pose((session.scene().time, 0, 0))
                recording.flush()

            def asked(file, name, *values):
                found = ask(file, name, *values)
                go_on()
                return found

            go_on()
            go_on()
            with monkeypatch.context() as patched, RecordingFile(path) as file:
                patched.setattr(RecordingFile, "_ask", asked)
                for scene in (None, "scene"):
                    steps, gaps = steps_of(file, scene)
                    patched.setattr(RecordingFile, "_ask", ask)
                    for step in steps:
                        assert step.time == max((row.time for row in file.rows(1, step.end)), default=0.0)
                    assert len(steps) > 2 and not gaps
                    patched.setattr(RecordingFile, "_ask", asked)
                end = session.scene().time
                assert main(["log", "cut", str(path), "--to", str(end + 1), "--out", str(tmp_path / "cut.dspace")]) == 0
    with RecordingFile(tmp_path / "cut.dspace") as cut:
        assert max(row.time for row in cut.rows()) <= end + 1


@pytest.mark.parametrize("pack", (True, False))
def test_files_that_come_while_it_is_written_are_unpacked_or_checked(tmp_path, pack):
    solid = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"
    for name in "abc":
        (tmp_path / f"{name}.stl").write_text(solid)
    path = tmp_path / "run.dspace"
    with dspace.Session() as session, session.record(path, commit_every=0.001, pack=pack) as recording:
        recording.flush()
        with dspace.Playback(path) as run:  # no file is noted yet
            for count, name in enumerate("abc", 1):
                session.scene().time += 1.0
                session.scene().load(str(tmp_path / f"{name}.stl"))
                recording.flush()
                if pack:
                    (tmp_path / f"{name}.stl").unlink()
                elif name == "b":  # not what was recorded
                    (tmp_path / "b.stl").write_text(solid.replace("1 0 0", "2 0 0"))
                    with pytest.raises(dspace.Corrupt, match="b.stl"):
                        run.update()
                    assert len(run.times) == 2
                    return
                assert run.update() == 1
                run.seek(float(count))
                assert len(run.session.scene().objects) == count
