"""Vehicles of a frames.json, and what is said of a glTF that nothing is turned for."""
import json
import os
import pathlib
import warnings

import numpy as np
import pytest

import dspace
from dspace.rover import load_vehicle

REAL = pathlib.Path(os.environ.get("DSPACE_DATA") or "/nonexistent") / "models"
SHIPPED = pathlib.Path(os.environ.get("DSPACE_SHIPPED_DATA") or "Data")
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def frame(name, parent, at=(0, 0, 0), **more):
    return {"name": name, "parent": parent, "translation_m": list(at), "joint_axis": None, **more}


GOOD = [frame("body", None, (0, 0, 0.5), mesh="part.obj"),
        frame("arm", "body", (1, 2, 3), mesh="part.obj", mirror=True),
        frame("hand", "arm", (0, 0, 1), mesh="part.obj", mesh_rotated_180_about_z=True)]


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "part.obj").write_text(TRIANGLE)
    return tmp_path


def write(folder, frames):
    (folder / "frames.json").write_text(json.dumps({"vehicle": "v", "frames": frames}))
    return folder


@pytest.mark.parametrize("named", ("folder", "file", "text"))
def test_a_folder_of_parts_becomes_frames(scene, folder, named):
    write(folder, GOOD)
    path = {"folder": folder, "file": folder / "frames.json", "text": str(folder)}[named]
    vehicle = scene.load(path, position=(10, 0, 0))
    assert isinstance(vehicle, dspace.Assembly) and vehicle.name == folder.name
    assert list(vehicle.frames) == ["body", "arm", "hand"] and len(vehicle.objects) == 3
    assert np.allclose(vehicle.frames["hand"].world_pose.position, (11, 2, 4.5), atol=1e-15)
    # The corner (1, 1, 0) of a mirrored and of a turned mesh, by hand.
    body, arm, hand = (t.frame.world_pose.matrix @ t.offset @ (1, 1, 0, 1) for t in vehicle.objects)
    assert np.allclose(body[:3], (11, 1, 0.5)) and np.allclose(arm[:3], (12, 1, 3.5))
    assert np.allclose(hand[:3], (10, 1, 4.5))
    with pytest.raises(dspace.NotFound, match="leg"):
        vehicle.frames["leg"]
    vehicle.frames["arm"].position = (0, 0, 0)
    assert np.allclose(vehicle.frames["hand"].world_pose.position, (10, 0, 1.5), atol=1e-15)
    vehicle.remove()
    assert not scene.frames


def test_it_is_placed_scaled_and_turned_as_a_urdf_is(scene, folder):
    write(folder, GOOD)
    parent = scene.add_frame("parent", position=(0, 0, 7))
    vehicle = scene.load(folder, frame=parent, name="mine", scale=2, up="y", ornamental=True)
    assert vehicle.frame.path == "parent/mine"
    # The file's (1, 2, 3.5) is twice as far, its Y up: x 2, y -7, z 4, on the parent.
    assert np.allclose(vehicle.frames["arm"].world_pose.position, (2, -7, 11), atol=1e-14)
    assert all(thing.ornamental for thing in vehicle.objects)


BAD = [
    ("'frames' of at least one", []),
    ("frames[0]: is 3; accepted: an object", [3]),
    ("frames[0]: 'name' is missing", [{}]),
    ("frames[0]: 'name' is ''", [frame("", None)]),
    ("frames[1] 'arm': 'parent' is missing", [GOOD[0], {"name": "arm", "translation_m": [0, 0, 0]}]),
    ("frames[1]: the name 'body' is taken", [GOOD[0], frame("body", "body")]),
    ("'parent' is 'leg', which is no frame", [GOOD[0], frame("arm", "leg")]),
    ("'parent' is null in ['body', 'arm']", [GOOD[0], frame("arm", None)]),
    ("'parent' is null in no frame", [frame("a", "b"), frame("b", "a")]),
    ("frame 'a': 'parent' leads round in a circle", [GOOD[0], frame("a", "b"), frame("b", "a")]),
    ("frames[0] 'body': 'translation_m' is [0, 0]", [frame("body", None, (0, 0))]),
    ("'translation_m' is [0, nan, 0]", [frame("body", None, (0, np.nan, 0))]),
    ("'translation_m' is missing", [{"name": "body", "parent": None}]),
    ("'joint_axis' is 'w'; accepted: 'x', 'y', 'z' or null", [{**GOOD[0], "joint_axis": "w"}]),
    ("'mesh' is 3; accepted: the name of a file", [{**GOOD[0], "mesh": 3}]),
    ("'mirror' is 'no'; accepted: true or false", [{**GOOD[0], "mirror": "no"}]),
    ("'mesh_rotated_180_about_z' is 1;", [{**GOOD[0], "mesh_rotated_180_about_z": 1}]),
    ("'wheel_radius_m' is -1; accepted: a number above 0", [{**GOOD[0], "wheel_radius_m": -1}]),
]


@pytest.mark.parametrize("text,frames", BAD)
def test_a_malformed_file_is_refused_by_frame_and_key(scene, refused, folder, text, frames):
    write(folder, frames)
    with refused(dspace.Corrupt, text):
        scene.load(folder)
    with pytest.raises(ValueError, match="frames.json"):
        load_vehicle(folder)


def test_what_fails_on_the_way_leaves_nothing(scene, refused, folder):
    with refused(dspace.NotFound, "frames.json"):
        scene.load(folder)  # a folder without one
    write(folder, [*GOOD, frame("foot", "arm", mesh="absent.obj")])
    with refused(dspace.NotFound, "absent.obj"):
        scene.load(folder)
    write(folder, [*GOOD, frame("a/b", "arm")])
    with refused(dspace.InvalidArgument, "a/b"):
        scene.load(folder)
    for text in ("", "{", "[]", '{"frames": {}}', "[" * 100000):
        (folder / "frames.json").write_text(text)
        with refused(dspace.Corrupt, "frames.json"):
            scene.load(folder / "frames.json")
    write(folder, GOOD)
    with refused(dspace.InvalidArgument, "levels"):
        scene.load(folder, levels=[("part.obj", 0)])
    with refused(dspace.WrongType, "color"):
        scene.load(folder, color=(1, 0, 0))


@pytest.mark.parametrize("model,parts", (("rocky7_vrml", 13), ("viper_obj", 17)))
@pytest.mark.filterwarnings("ignore")
def test_real_vehicles_stand_as_they_are_solved(scene, model, parts):
    if not (REAL / model).exists():
        pytest.skip(f"real data absent: set DSPACE_DATA to the folder that has models/{model}")
    vehicle = scene.load(REAL / model)
    assert len(vehicle.objects) == parts
    solver = load_vehicle(REAL / model)
    state = solver.solve((3, 4, 30), lambda xy: 0.1 * np.asarray(xy)[:, 0])
    vehicle.place(state)
    assert np.allclose(vehicle.pose.position, state.position)
    # Each wheel's centre, which the solver gives in the world, is its frame's place.
    for wheel in solver.suspension.wheels:
        place = vehicle.frames[wheel.link].world_pose.position
        assert np.allclose(place, state.wheel_centers[wheel.name], atol=1e-6)
    with pytest.raises(dspace.WrongType, match="solve"):
        vehicle.place(3)


def test_up_is_hinted_for_gltf_and_never_guessed(scene, folder):
    path = SHIPPED / "rover" / "wheel.glb"
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        plain = scene.load(path)
    assert len(caught) == 1 and caught[0].filename == __file__
    assert "wheel.glb" in str(caught[0].message) and "up='y'" in str(caught[0].message)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        said = scene.load(path, up="z")
        turned = scene.load(path, up="y")
        (folder / "a.obj").write_text(TRIANGLE)
        scene.load(folder / "a.obj")
    assert np.allclose(plain.box, said.box)  # as the file is
    low, high = np.asarray(said.box)
    assert np.allclose(turned.box, [[low[0], -high[2], low[1]], [high[0], -low[2], high[1]]])
