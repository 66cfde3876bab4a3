"""Frames through Python against closed forms."""
import numpy as np
import pytest

import dspace
from dspace.frames.poses import matrix_of_quaternion, quaternion_of_matrix


def random_pose(rng):
    q = rng.normal(size=4)
    return dspace.Pose(rng.normal(size=3) * 10, q / np.linalg.norm(q), rng.uniform(0.5, 2))


def test_poses_are_matrices():
    rng = np.random.default_rng(1)
    for _ in range(50):
        a, b = random_pose(rng), random_pose(rng)
        np.testing.assert_allclose((a @ b).matrix, a.matrix @ b.matrix, atol=1e-12)
        np.testing.assert_allclose(a.inverse().matrix, np.linalg.inv(a.matrix), atol=1e-12)
        points = rng.normal(size=(5, 3))
        homogeneous = np.c_[points, np.ones(5)]
        np.testing.assert_allclose(a.apply(points), (homogeneous @ a.matrix.T)[:, :3], atol=1e-12)
        back = quaternion_of_matrix(matrix_of_quaternion(a.quaternion))
        assert abs(abs(back @ a.quaternion) - 1) < 1e-12
        np.testing.assert_allclose(dspace.Pose.from_matrix(a.matrix).matrix, a.matrix, atol=1e-12)
        np.testing.assert_allclose(dspace.Pose.from_rpy_deg(*a.rpy_deg).rotation, a.rotation,
                                   atol=1e-12)


def test_tree(scene):
    rover = scene.add_frame("rover", position=(1, 2, 3))
    mast = rover.add_frame("mast", quaternion=(0, 0, 0, 1))
    camera = mast.add_frame("camera", position=(1, 0, 0), scale=2)
    assert camera.path == "rover/mast/camera"
    assert scene["rover/mast"] == mast == rover["mast"]
    assert camera.parent == mast and rover.children == [mast] and scene.root.parent is None
    assert list(scene.frames) == ["rover", "rover/mast", "rover/mast/camera"]
    np.testing.assert_allclose(camera.world_pose.position, (0, 2, 3), atol=1e-15)
    np.testing.assert_allclose(rover.pose_in(camera).position, (-0.5, 0, 0), atol=1e-15)
    mast.name = "arm"
    assert camera.path == "rover/arm/camera"
    camera.reparent(scene.root, keep="world")
    np.testing.assert_allclose(camera.position, (0, 2, 3), atol=1e-15)
    camera.reparent(rover)
    np.testing.assert_allclose(camera.position, (0, 2, 3), atol=1e-15)
    rover.remove()
    assert scene.frames == {}
    assert "not in the scene" in repr(camera)


def test_many_frames_at_once(scene):
    rng = np.random.default_rng(2)
    rover = scene.add_frame("rover")
    rows = np.array([random_pose(rng).row for _ in range(4)])
    ids = scene.add_frames(["a", "b", "c", "d"], rover, rows)
    assert list(scene.frames) == ["rover", "rover/a", "rover/b", "rover/c", "rover/d"]
    assert [frame.id for frame in rover.children] == ids.tolist()
    np.testing.assert_allclose(scene.poses(ids, relative_to=rover), rows, atol=1e-15)
    more = scene.add_frames(("x", "y"), [scene["rover/a"], "rover/b"], rows[:2, :7])
    np.testing.assert_array_equal(scene["rover/b/y"].position, rows[1, :3])
    scene.add_frames(["below"] * 2, more)
    scene.add_frames(["top"])
    assert scene["rover/a/x/below"].parent == scene["rover/a/x"] and scene["top"].position.tolist() == [0, 0, 0]
    before = list(scene.frames)
    for wrong, kind, says in (
            (lambda: scene.add_frames(["new", "a"], rover), dspace.AlreadyExists, "'rover/a'"),
            (lambda: scene.add_frames(["new", "a/b"]), dspace.InvalidArgument, "'a/b'"),
            (lambda: scene.add_frames([]), dspace.InvalidArgument, "one name or more"),
            (lambda: scene.add_frames("new"), dspace.WrongType, "a list of names"),
            (lambda: scene.add_frames(["new", 3]), dspace.WrongType, "3"),
            (lambda: scene.add_frames(["new", "\udce4"]), dspace.InvalidArgument, "whole characters"),
            (lambda: scene.add_frames(["m", "n", "o"], more), dspace.InvalidArgument, "2 parents"),
            (lambda: scene.add_frames(["m", "n"], rover, rows), dspace.InvalidArgument, "4 poses"),
            (lambda: scene.add_frames(["m"], rover, np.zeros((1, 6))), dspace.InvalidArgument, "shape"),
            (lambda: scene.add_frames(["m"], 10 ** 6 + np.arange(1)), dspace.NotFound, "1000000")):
        with pytest.raises(kind, match=says):
            wrong()
        assert list(scene.frames) == before


def test_properties(scene):
    f = scene.add_frame("f")
    f.position = (1, 2, 3)
    f.rotate("z", 90)
    f.scale = 2
    np.testing.assert_allclose(f.quaternion, (np.sqrt(0.5), 0, 0, np.sqrt(0.5)), atol=1e-15)
    np.testing.assert_allclose(f.pose.apply((1, 0, 0)), (1, 4, 3), atol=1e-15)
    f.rpy_deg = (10, 20, 30)
    np.testing.assert_allclose(f.rpy_deg, (10, 20, 30), atol=1e-12)
    f.rotation = np.diag([1.0, -1, -1])
    np.testing.assert_allclose(np.abs(f.quaternion), (0, 1, 0, 0), atol=1e-15)
    with pytest.raises(ValueError, match="read-only"):
        f.position[0] = 5
    assert repr(f).startswith("<dspace.Frame 'f', Pose(position=(1, 2, 3)")


def test_thousands_of_poses_in_one_call(scene):
    rng = np.random.default_rng(2)
    frames = [scene.add_frame(f"f{i}") for i in range(2000)]
    rows = np.array([random_pose(rng).row for _ in frames])
    scene.set_poses(frames, rows)
    np.testing.assert_allclose(scene.poses(frames), rows, atol=1e-15)
    ids = np.array([f.id for f in frames])
    scene.set_poses(ids, rows[::-1, :7])
    back = scene.poses(ids, relative_to=scene.root)
    np.testing.assert_allclose(back[:, :7], rows[::-1, :7], atol=1e-15)
    assert (back[:, 7] == 1).all()


def test_arrays_on_the_wire_are_protobufs_own():
    from dspace._core import wire
    from dspace.proto import commands_pb2 as pb
    rng = np.random.default_rng(3)
    for n in (0, 1, 15, 16, 300):
        quick, slow = pb.Command(), pb.Command()
        ids, poses = rng.integers(1, 2**40, n, dtype=np.uint64), rng.normal(size=(n, 8))
        wire.put_array(quick.set_poses, "frame", ids)
        wire.put_array(quick.set_poses, "pose", poses)
        slow.set_poses.frame.extend(ids.tolist())
        slow.set_poses.pose.extend(poses.ravel().tolist())
        assert quick.set_poses == slow.set_poses
        np.testing.assert_array_equal(wire.get_array(quick.set_poses, "pose"), poses.ravel())
        reply = pb.PosesReply() if hasattr(pb, "PosesReply") else pb.Reply().poses
        reply.pose.extend(poses.ravel().tolist())
        np.testing.assert_array_equal(wire.get_array(reply, "pose"), poses.ravel())


def test_bad_input(scene, refused):
    a = scene.add_frame("a")
    b = a.add_frame("b")
    with refused(dspace.AlreadyExists, "a"):
        scene.add_frame("a")
    with refused(ValueError, "x/y"):
        scene.add_frame("x/y")
    with refused(dspace.InvalidArgument, "a"):
        a.reparent(b)
    with refused(dspace.InvalidArgument, "'a'"):
        a.quaternion = (2, 0, 0, 0)
    with refused(dspace.InvalidArgument, "a/b"):
        b.position = (np.nan, 0, 0)
    with refused(dspace.InvalidArgument, "a/b"):
        scene.set_poses([a, b], [[1, 0, 0, 1, 0, 0, 0, 1], [0, 0, 0, 1, 0, 0, 0, -1]])
    with refused(dspace.InvalidArgument, "1 poses for 2 frames"):
        scene.set_poses([a, b], np.zeros((1, 8)))
    with refused(LookupError, "nowhere"):
        scene["nowhere"]
    with refused(dspace.InvalidArgument, "root"):
        scene.root.remove()
    with refused(ValueError, "accepted: 3 numbers"):
        a.position = (1, 2)
    with refused(ValueError, "'sideways'"):
        a.reparent(scene.root, keep="sideways")
    b.remove()
    with refused(dspace.NotFound):
        b.position


def test_scenes_do_not_mix(session, scene):
    other = session.scene("other")
    frame = other.add_frame("f")
    with pytest.raises(ValueError, match="another scene"):
        scene.add_frame("g", parent=frame)
    assert set(session.scenes) == {"scene", "other"}
    other.remove()
    assert set(session.scenes) == {"scene"}
    with pytest.raises(dspace.NotFound, match="other"):
        frame.position


def test_a_closed_session_says_so():
    session = dspace.Session()
    scene = session.scene()
    session.close()
    session.close()
    with pytest.raises(RuntimeError, match="closed"):
        scene.add_frame("f")
    assert "closed" in repr(session)


def test_vtk_follows(scene):
    a = scene.add_frame("a", position=(1, 0, 0))
    b = a.add_frame("b", position=(0, 1, 0))
    transform = b.vtk
    assert transform.TransformPoint(0, 0, 0) == (1, 1, 0)
    a.position = (5, 0, 0)
    assert transform.TransformPoint(0, 0, 0) == (5, 1, 0)
    b.reparent(scene.root)
    assert transform.TransformPoint(0, 0, 0) == (0, 1, 0)
    frame = scene.vtk.GetFrame(b.id)
    b.remove()
    assert not frame.GetAlive() and scene.vtk.GetFrame(b.id) is None
