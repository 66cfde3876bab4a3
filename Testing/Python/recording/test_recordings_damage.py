"""Damaged recordings: what salvage recovers against SQLite's own account of which page holds what, and what
playback does with the gaps."""
import contextlib
import random
import shutil
import sqlite3
import struct
import warnings

import numpy
import pytest

import dspace
from dspace.command_line import main
from dspace.playback.steps import Gap, Step, StepTimes, steps_of
from dspace.recording.file import RecordingFile
from dspace.proto import commands_pb2 as pb
from recording_support import Row, create_recording, put_rows, salvaged_rows, write_recording

PAGE = 65536


def rows_of(n, first=1):
    """Commands of all sizes, from a few bytes to several pages, whose content follows from their numbers."""
    chance = random.Random(first)
    for i in range(first, first + n):
        command = pb.Command()
        if i % 5 == 0:
            command.set_time.time_s = i / 5
        else:
            size = 30000 + chance.randrange(250000) if i % 17 == 0 else 7000 if i % 6 == 0 else i % 90
            command.create_frame.name = (f"{i} " * size)[:size]
        yield Row(i, float(i // 5), 1e9 + i / 3, command.ListFields()[0][0].number, command.SerializeToString())


def snapshots_of(seqs):
    return [Row(seq, float(seq // 5), 1e9, seq, bytes([seq % 256]) * (80000 if seq == 40 else 200)) for seq in seqs]


def made(path, n=130):
    write_recording(str(path), rows_of(n), snapshots_of((0, 40, 90)))
    return {("command", row.seq): row for row in rows_of(n)} | {
        ("snapshot", row.seq): row for row in snapshots_of((0, 40, 90))}


def pages_of_rows(path):
    """The pages that each row lies on, by SQLite's own walk through its trees (dbstat)."""
    found = {}
    with contextlib.closing(sqlite3.connect(path)) as database:
        for table in ("command", "snapshot"):
            leaves = database.execute("SELECT path, pageno, ncell FROM dbstat WHERE name = ? AND pagetype = 'leaf' "
                                      "ORDER BY path", (table,)).fetchall()
            chains = {}
            for place, page in database.execute("SELECT path, pageno FROM dbstat WHERE name = ? AND "
                                                "pagetype = 'overflow'", (table,)):
                chains.setdefault(place.split("+")[0], set()).add(page)
            seqs = iter([seq for seq, in database.execute(f"SELECT seq FROM {table} ORDER BY seq")])
            for place, page, cells in leaves:
                for cell in range(cells):
                    found[table, next(seqs)] = {page} | chains.pop(f"{place}{cell:03x}", set())
            assert next(seqs, None) is None and not chains
    return found


def salvaged(path):
    commands, snapshots = salvaged_rows(str(path))
    return {("command", seq): row for seq, row in commands.items()} | {
        ("snapshot", seq): row for seq, row in snapshots.items()}


def demand(path, rows, pages, damaged):
    """All rows that lie on none of the damaged pages are brought back, and none that was not written."""
    found = salvaged(path)
    for key, row in found.items():
        assert rows[key] == row
    missing = [key for key, on in pages.items() if not on & damaged and key not in found]
    assert not missing, (sorted(damaged), missing)
    return found


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("whole") / "a.dspace"
    rows = made(path)
    pages = pages_of_rows(path)
    assert set(pages) == set(rows) and max(map(len, pages.values())) >= 3
    assert len(set().union(*pages.values())) > 15
    return path.read_bytes(), rows, pages


def test_any_one_page_may_be_lost(whole, tmp_path):
    data, rows, pages = whole
    chance = random.Random(1)
    bad = tmp_path / "bad.dspace"
    for number in range(1, len(data) // PAGE + 1):
        here = slice(PAGE * (number - 1), PAGE * number)
        flipped = bytearray(data[here])
        flipped[chance.randrange(PAGE)] ^= 1 << chance.randrange(8)
        other = PAGE * chance.randrange(len(data) // PAGE)
        for page in (bytes(PAGE), chance.randbytes(PAGE), bytes(flipped), data[other:other + PAGE]):
            bad.write_bytes(data[:here.start] + page + data[here.stop:])
            demand(bad, rows, pages, {number})


def test_several_pages_may_be_lost(whole, tmp_path):
    data, rows, pages = whole
    chance = random.Random(2)
    bad = tmp_path / "bad.dspace"
    least = len(rows)
    for _ in range(25):
        lost = set(chance.sample(range(1, len(data) // PAGE + 1), chance.randrange(2, 12)))
        parts = [chance.choice((bytes(PAGE), chance.randbytes(PAGE))) if n in lost else data[PAGE * (n - 1):PAGE * n]
                 for n in range(1, len(data) // PAGE + 1)]
        bad.write_bytes(b"".join(parts))
        least = min(least, len(demand(bad, rows, pages, lost)))
    assert least < len(rows) // 2  # much was lost indeed


def test_cut_at_every_page_and_at_odd_bytes(whole, tmp_path):
    data, rows, pages = whole
    chance = random.Random(3)
    bad = tmp_path / "bad.dspace"
    for end in [*range(0, len(data), PAGE), *(chance.randrange(len(data)) | 1 for _ in range(30))]:
        bad.write_bytes(data[:end])
        demand(bad, rows, pages, set(range(end // PAGE + 1, len(data) // PAGE + 1)))


def test_flipped_bits_anywhere(whole, tmp_path):
    data, rows, pages = whole
    chance = random.Random(4)
    bad = tmp_path / "bad.dspace"
    for _ in range(60):
        flipped, damaged = bytearray(data), set()
        for _ in range(chance.choice((1, 2, 5, 20))):
            at = chance.randrange(len(data))
            flipped[at] ^= 1 << chance.randrange(8)
            damaged.add(at // PAGE + 1)
        bad.write_bytes(flipped)
        demand(bad, rows, pages, damaged)


@pytest.fixture(scope="module")
def logged(tmp_path_factory):
    """A recording as a killed process leaves it: a part in the file, the rest in the log beside it, which is in its
    second turn: frames of the first one stand behind those of the second."""
    folder = tmp_path_factory.mktemp("logged")
    path = folder / "a.dspace"
    rows = {}
    with contextlib.closing(create_recording(str(path))) as database:
        database.execute("PRAGMA journal_mode=WAL")
        database.execute("PRAGMA wal_autocheckpoint=0")
        for begin in range(1, 121, 10):
            if begin == 81:
                database.execute("PRAGMA wal_checkpoint(FULL)")
            with database:
                part = list(rows_of(10, begin))
                put_rows(database, "command", part)
                rows |= {("command", row.seq): row for row in part}
        shutil.copy(path, folder / "b.dspace")
        shutil.copy(f"{path}-wal", folder / "b.dspace-wal")
    data, log = (folder / "b.dspace").read_bytes(), (folder / "b.dspace-wal").read_bytes()
    pages = pages_of_rows(path)  # of what is in both
    newest = {}
    for at in range(32, len(log), 24 + PAGE):
        if log[at + 8:at + 16] == log[16:24]:
            newest[struct.unpack(">I", log[at:at + 4])[0]] = at
    assert len(newest) > 3 and len(data) > 5 * PAGE and any(log[at + 8:at + 16] != log[16:24]
                                                            for at in range(32, len(log), 24 + PAGE))
    return data, log, rows, pages, newest


def put_both(tmp_path, data, log):
    (tmp_path / "bad.dspace").write_bytes(data)
    (tmp_path / "bad.dspace-wal").write_bytes(log)
    return tmp_path / "bad.dspace"


def test_with_a_log_beside_it(logged, tmp_path):
    data, log, rows, pages, newest = logged
    chance = random.Random(5)
    assert demand(put_both(tmp_path, data, log), rows, pages, set()) == rows
    # The log's own head, whose numbers say which of its frames count.
    for head in (bytes(32), chance.randbytes(32), log[:16] + bytes(8) + log[24:32]):
        assert demand(put_both(tmp_path, data, head + log[32:]), rows, pages, set()) == rows
    for number, at in newest.items():
        for junk in (bytes(PAGE + 24), chance.randbytes(PAGE + 24), log[at:at + 24] + bytes(PAGE)):
            demand(put_both(tmp_path, data, log[:at] + junk + log[at + 24 + PAGE:]), rows, pages, {number})
    for number in range(1, len(data) // PAGE + 1):
        lost = set() if number in newest else {number}
        demand(put_both(tmp_path, data[:PAGE * (number - 1)] + bytes(PAGE) + data[PAGE * number:], log), rows, pages,
               lost)
    for end in [0, 10, 40, *range(32, len(log), PAGE + 24), *(chance.randrange(len(log)) | 1 for _ in range(20))]:
        demand(put_both(tmp_path, data, log[:end]), rows, pages,
               {number for number, at in newest.items() if at + 24 + PAGE > end})


def test_the_command_says_what_is_lost(whole, tmp_path, capsys):
    data, rows, pages = whole
    victim = next(iter(pages["command", 60]))
    bad, new = tmp_path / "bad.dspace", tmp_path / "new.dspace"
    bad.write_bytes(data[:PAGE * (victim - 1)] + bytes(PAGE) + data[PAGE * victim:])
    assert main(["log", "salvage", str(bad), "--out", str(new)]) == 1
    said = capsys.readouterr().out
    gone = {seq for (table, seq), on in pages.items() if table == "command" and victim in on}
    told = set()
    for line in said.splitlines():
        if line.startswith("lost: commands"):
            first, last = line.split()[2::2]
            told |= set(range(int(first), int(last) + 1))
    assert told == gone and 60 in gone
    with RecordingFile(new) as file:
        file.check()
        assert sorted(seq for first, last in file.lost for seq in range(first, last + 1)) == sorted(gone)
    assert main(["log", "info", str(new)]) == 0 and "lost: commands" in capsys.readouterr().out
    bad.write_bytes(bytes(3 * PAGE))
    assert main(["log", "salvage", str(bad), "--out", str(tmp_path / "none.dspace")]) != 0
    assert not (tmp_path / "none.dspace").exists()


def steps_in(tmp_path, times, snapshots, lost=(), name="s.dspace"):
    """The steps and gaps of a recording of nothing but times, one a command, without some commands."""
    rows = []
    for seq, time in enumerate(times, 1):
        command = pb.Command()
        command.set_time.time_s = time
        rows.append(Row(seq, time, 0.0, 13, command.SerializeToString()))
    path = str(tmp_path / name)
    gone = {seq for first, last in lost for seq in range(first, last + 1)}
    write_recording(path, [row for row in rows if row.seq not in gone],
                    [Row(seq, times[seq - 1] if seq else 0.0, 0.0, 0, b"") for seq in snapshots])
    if lost:
        with sqlite3.connect(path) as database:
            database.execute("INSERT INTO meta VALUES('lost', ?)", (" ".join(f"{a}-{b}" for a, b in lost),))
    with RecordingFile(path) as file:
        return steps_of(file)


def test_which_steps_are_whole(tmp_path):
    times = [float(i) for i in range(1, 11)]
    at = iter(range(100))
    steps = lambda *rest: steps_in(tmp_path, times, *rest, name=f"{next(at)}.dspace")
    assert steps([0]) == ([Step(time, i + 1) for i, time in enumerate(times)], [])
    # Without 4 and 5, and a state after 6: step 3 may lack a command, 6 is there again.
    assert steps([0, 6], [(4, 5)]) == ([Step(1, 1), Step(2, 2), Step(6, 6), Step(7, 7), Step(8, 8), Step(9, 9),
                                        Step(10, 10)], [Gap(4, 6, 3.0, 6.0, 2)])
    # A state exactly at the end of the gap.
    assert steps([0, 5], [(4, 5)])[1] == [Gap(4, 5, 3.0, 5.0, 2)]
    # No state after it.
    assert steps([0, 3], [(4, 5)]) == ([Step(1, 1), Step(2, 2)], [Gap(4, 10, 3.0, None, 2)])
    # Two gaps with a state between them, and with none.
    assert [(gap.first, gap.last) for gap in steps([0, 5, 9], [(3, 3), (7, 8)])[1]] == [(3, 5), (7, 9)]
    assert steps([0, 9], [(3, 3), (7, 8)]) == ([Step(1, 1), Step(9, 9), Step(10, 10)], [Gap(3, 9, 2.0, 9.0, 1)])
    # The beginning is lost, the state with it.
    assert steps([4], [(1, 2)]) == ([Step(time, int(time)) for time in times[3:]], [Gap(1, 4, None, 4.0, 0)])
    # Everything after a state is lost.
    assert steps([0, 10], [(5, 10)])[0][-1] == Step(10, 10)


def test_times_that_go_back_and_come_again():
    times = [0, 1, 2, 3, 0, 1, 2, 5, 6]
    steps = StepTimes(times)
    assert [steps.index_at(at) for at in (0, 0.5, 2.5, 3, 4.9, 5, 100, -1)] == [4, 4, 6, 6, 6, 7, 8, None]
    steps = StepTimes([0, 5, 10, 0, 3])  # the second run ends early
    assert [steps.index_at(at) for at in (2, 3, 5, 7, 10, 11)] == [3, 4, 1, 1, 2, 4]
    assert [StepTimes([1, 1, 1]).index_at(at) for at in (1, 2)] == [2, 2]


def drive(session, begin, end, live):
    scene = session.scene()
    for i in range(begin, end):
        scene.time = float(i)
        scene.frame("rover").pose = dspace.Pose((0.3 * i, 0.02 * i * i, 0.0))
        scene.frame("rover").name  # a request, which is not recorded
        live[float(i)] = session.viewports["view"].image()


def test_playback_goes_on_after_a_gap(tmp_path):
    """The next snapshot brings the state back, and pictures are the live ones to the byte."""
    live = {}
    with dspace.Session() as session:
        scene = session.scene()
        rover = scene.add_frame("rover")
        scene.add_box((1, 2, 0.5), frame=rover, color=(0.8, 0.2, 0.1))
        scene.add_viewport((80, 60), scene.add_camera("c", eye=(-6, -5, 4), target=(1, 0, 0)), name="view")
        with session.record(tmp_path / "one.dspace"):
            drive(session, 0, 8, live)
        with session.record(tmp_path / "two.dspace"):  # begins with a snapshot
            drive(session, 8, 14, live)
    with RecordingFile(tmp_path / "one.dspace") as one, RecordingFile(tmp_path / "two.dspace") as two:
        middle, start = one.last, one.snapshot(0)
        rows = [*one.rows(), *(row._replace(seq=row.seq + middle) for row in two.rows())]
        again = two.snapshot(0)._replace(seq=middle)
    lost = range(rows[8].seq, rows[11].seq + 1)  # within steps 4 and 5
    assert rows[8].time == 4.0 and rows[11].time == 5.0
    path = tmp_path / "run.dspace"
    write_recording(str(path), [row for row in rows if row.seq not in lost], [start, again])
    with pytest.raises(dspace.Corrupt, match="missing"):  # nobody has said that they are lost
        dspace.Playback(path).seek(6.0)
    assert main(["log", "salvage", str(path), "--out", str(tmp_path / "new.dspace")]) == 1
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        run = dspace.Playback(tmp_path / "new.dspace")
    with run:
        assert [type(each.message) for each in told] == [dspace.DspaceWarning] and "3 s to 7 s" in str(told[0].message)
        # That step 3 is whole nobody can say: what is lost may have belonged to it.
        assert run.times == [0.0, 0.0, 1.0, 2.0, 7.0, *map(float, range(8, 14))]
        gap, = run.gaps
        assert (gap.begin, gap.end, gap.first) == (3.0, 7.0, lost[0])
        for at in (2.9, 7.0, 9.5, 1.0, 13.0):
            assert run.seek(at) == int(at)
            assert numpy.array_equal(run.session.viewports["view"].image(), live[float(int(at))]), at
        for at in (3.0, 4.0, 5.0, 6.99):
            with pytest.raises(dspace.Corrupt, match="3 s to 7 s.*commands"):
                run.seek(at)
        seen = []
        run.seek(2.0)
        run.play(0, lambda each: seen.append(each.time))
        assert seen == [7.0, *map(float, range(8, 14))]
    # Steps before and after it are drawn, in the folder's order.
    assert main(["play", str(tmp_path / "new.dspace"), "--out", str(tmp_path / "out"), "--every", "1"]) == 0
    assert len(list((tmp_path / "out").iterdir())) == 10  # 0, 1, 2, 7 to 13 s


def test_packed_files_survive_salvage_or_are_told(tmp_path, capsys):
    (tmp_path / "part.stl").write_text("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                       "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n")
    with dspace.Session() as session:
        session.scene().load(str(tmp_path / "part.stl"))
        session.record(tmp_path / "a.dspace", pack=True).stop()
    assert main(["log", "salvage", str(tmp_path / "a.dspace"), "--out", str(tmp_path / "b.dspace")]) == 0
    (tmp_path / "part.stl").rename(tmp_path / "gone.stl")
    with dspace.Playback(tmp_path / "b.dspace") as run:
        assert len(run.session.scene().objects) == 1
    with contextlib.closing(sqlite3.connect(tmp_path / "a.dspace")) as database:
        database.execute("DELETE FROM content")
        database.commit()
        database.execute("VACUUM")  # else what was deleted is found
        database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    assert main(["log", "salvage", str(tmp_path / "a.dspace"), "--out", str(tmp_path / "c.dspace")]) == 1
    assert "lost: the packed content of" in capsys.readouterr().out
    with pytest.raises(dspace.NotFound, match="part.stl"):
        dspace.Playback(tmp_path / "c.dspace")
