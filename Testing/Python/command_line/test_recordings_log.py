"""`dspace log diff` to a tolerance, against differences put in by hand; `dspace log cat` of what lacks commands."""
import math
import sqlite3

import pytest

from dspace.command_line import main
from dspace.proto import commands_pb2 as pb
from recording_support import Row, write_recording


def recorded(path, commands, start=()):
    rows = [Row(i, 0.5 * i, 1e9, command.ListFields()[-1][0].number, command.SerializeToString())
            for i, command in enumerate(commands, 1)]
    payload = b"".join(bytes([len(each)]) + each for each in (command.SerializeToString() for command in start))
    write_recording(str(path), rows, [Row(0, 0.0, 1e9, len(start), payload)])
    return str(path)


def poses(frames, values):
    command = pb.Command(scene="scene")
    command.set_poses.frame.extend(frames)
    command.set_poses.pose.extend(values)
    return command


def time(at):
    command = pb.Command(scene="scene")
    command.set_time.time_s = at
    return command


def camera(fov=45.0, x=1.0, name="c"):
    """A command whose numbers lie in messages within messages."""
    command = pb.Command(scene="scene")
    command.set_camera.name = name
    command.set_camera.projection.perspective.vertical_fov_deg = fov
    command.set_camera.mount.chase.target.x = x
    return command


@pytest.fixture
def differ(tmp_path, capsys):
    count = iter(range(1000))

    def differ(one, two, tolerance=0.0, starts=((), ())):
        paths = [recorded(tmp_path / f"{next(count)}.dspace", commands, start)
                 for commands, start in zip((one, two), starts)]
        code = main(["log", "diff", *paths, "--tolerance", repr(tolerance)])
        return code, capsys.readouterr().out
    return differ


def test_numbers_of_poses(differ):
    one, two = poses([2, 3], [0.0] * 16), poses([2, 3], [0.0] * 15 + [1e-4])
    code, said = differ([time(1), one], [time(1), two])
    assert code == 1 and "command 2" in said and "set_poses.pose[15] by 0.0001" in said
    assert differ([one], [two], 0.99e-4)[0] == 1
    code, said = differ([one], [two], 1e-4)
    assert code == 0 and "numbers to 0.0001" in said
    assert differ([one], [poses([3, 2], [0.0] * 16)], 10.0)[0] == 1  # frames are no numbers
    code, said = differ([one], [poses([2], [0.0] * 8)], 10.0)
    assert code == 1 and "(2 and 1)" in said


def test_numbers_in_nested_messages_and_whole_numbers(differ):
    code, said = differ([camera()], [camera(fov=45.001)])
    assert code == 1 and "set_camera.projection.perspective.vertical_fov_deg by 0.001" in said
    assert differ([camera()], [camera(fov=45.001)], 0.0011)[0] == 0
    assert differ([camera()], [camera(x=1.002, fov=45.001)], 0.0015)[0] == 1
    assert differ([camera()], [camera(x=1.002, fov=45.001)], 0.0021)[0] == 0
    code, said = differ([camera()], [camera(name="d")], 10.0)
    assert code == 1 and "set_camera.name" in said
    less = camera()
    less.set_camera.ClearField("projection")
    code, said = differ([camera()], [less], 100.0)
    assert code == 1 and "set_camera.projection" in said  # that it is there at all is no number


def test_not_a_number_and_infinities(differ):
    nan, inf = math.nan, math.inf
    assert differ([time(nan)], [time(nan)])[0] == 0
    assert differ([poses([2], [nan] + [0.0] * 7)], [poses([2], [nan] + [0.0] * 7)])[0] == 0
    assert differ([poses([2], [nan] + [0.0] * 7)], [poses([2], [nan] + [1e-9] * 7)], 1e-8)[0] == 0
    assert differ([poses([2], [nan] + [0.0] * 7)], [poses([2], [0.0] * 8)], 1e300)[0] == 1
    assert differ([poses([2], [inf] + [0.0] * 7)], [poses([2], [inf] + [1e-9] * 7)], 1e-8)[0] == 0
    assert differ([poses([2], [inf] + [0.0] * 7)], [poses([2], [-inf] + [0.0] * 7)], 1e300)[0] == 1
    assert differ([poses([2], [0.0] + [0.0] * 7)], [poses([2], [-0.0] + [0.0] * 7)])[0] == 0


def test_order_kinds_and_lengths(differ):
    a, b, c = time(1), camera(), poses([2], [0.0] * 8)
    code, said = differ([a, b, c], [a, c, b], 10.0)
    assert code == 1 and "command 2" in said and "set_camera and set_poses" in said
    code, said = differ([a, b], [a, b, c], 10.0)
    assert code == 1 and "up to command 2" in said and "goes on with set_poses" in said
    assert differ([a, b, c], [a, b], 10.0)[0] == 1
    assert differ([], [])[0] == 0 and differ([], [a], 10.0)[0] == 1
    other = pb.Command(scene="other")
    other.set_time.time_s = 1
    code, said = differ([a], [other], 10.0)
    assert code == 1 and "in scene" in said


def test_fields_that_are_not_known(differ):
    later = pb.Command.FromString(time(1).SerializeToString() + b"\xaa\xfa\x01\x03abc")  # a field 4005
    assert later.SerializeToString() != time(1).SerializeToString()
    code, said = differ([time(1)], [later], 10.0)
    assert code == 1 and "not known" in said
    assert differ([later], [later])[0] == 0


def channel(name, id, scene="scene"):
    command = pb.Command(scene=scene)
    command.create_telemetry.name, command.create_telemetry.id = name, id
    return command


def values(ids, scene="scene"):
    command = pb.Command(scene=scene)
    command.set_telemetry.id.extend(ids)
    command.set_telemetry.value.extend([1.0] * len(ids))
    return command


def test_channels_are_compared_by_name(differ):
    one = [channel("power", 1), channel("charge", 2), values([1, 2])]
    assert differ(one, [channel("power", 7), channel("charge", 9), values([7, 9])])[0] == 0
    assert differ(one, [channel("power", 7), channel("charge", 9), values([9, 7])])[0] == 1
    code, said = differ(one, [channel("power", 7), channel("load", 9), values([7, 9])])
    assert code == 1 and "create_telemetry" in said
    # The same bytes that mean other channels: those before were added in another order.
    both = [channel("charge", 1), channel("power", 2)], [channel("charge", 2), channel("power", 1)]
    assert differ([values([1])], [values([1])], starts=(both[0], both[0]))[0] == 0
    code, said = differ([values([1])], [values([1])], starts=both)
    assert code == 1 and "set_telemetry.id" in said
    # Ids are of a scene, and unknown ones stand for themselves.
    assert differ([channel("power", 1), values([1], "other")], [channel("power", 2), values([1], "other")])[0] == 0
    assert differ([values([1])], [values([2])], 10.0)[0] == 1
    removed = pb.Command(scene="scene")
    removed.remove_scene.SetInParent()
    assert differ([channel("power", 1), removed, channel("load", 2), values([2])],
                  [channel("power", 4), removed, channel("load", 1), values([1])])[0] == 0


def test_beginnings(differ):
    assert differ([], [], starts=([time(1)], [time(1)]))[0] == 0
    code, said = differ([], [], starts=([camera()], [camera(fov=45.001)]))
    assert code == 1 and "begin with different states" in said
    assert differ([], [], 0.002, starts=([camera()], [camera(fov=45.001)]))[0] == 0
    assert differ([], [], 10.0, starts=([camera()], []))[0] == 1


def test_cat_tells_of_lost_commands(tmp_path, capsys):
    path = recorded(tmp_path / "a.dspace", [time(i) for i in range(1, 8)])
    with sqlite3.connect(path) as database:
        database.execute("DELETE FROM command WHERE seq IN (3, 4)")
        database.execute("INSERT INTO meta VALUES('lost', '3-4')")
    assert main(["log", "cat", path]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == ["1", "2", "lost:", "5", "6", "7"] and "3 to 4" in lines[2]
    assert main(["log", "cat", path, "--first", "4", "--last", "5"]) == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == ["lost:", "5"]
