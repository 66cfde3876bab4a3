"""Models whose nodes are frames: posed by hand, by their animations, recorded, served."""
import base64
import json
import math
import struct

import numpy as np
import pytest

import dspace

HALF = math.sqrt(0.5)


def gltf(folder, scale=(1, 1, 1)):
    """A bus with two wings, of which one turns a quarter about Y in 2 s and slides in steps; a lamp on the bus."""
    parts = [struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0),           # a triangle
             struct.pack("<3f", 0, 1, 2),                             # times
             struct.pack("<12f", 0, 0, 0, 1, 0, HALF, 0, HALF, 0, 1, 0, 0),   # rotations: 0, 90, 180 deg about Y
             struct.pack("<9f", 0, 0, 0, 0, 0, 1, 0, 0, 2),           # steps along Z
             struct.pack("<27f", *[0] * 3, 0, 0, 0, 3, 0, 0,          # in-tangent, value, out-tangent
                         -3, 0, 0, 1, 0, 0, 0, 0, 0, *[0] * 3, 1, 0, 0, *[0] * 3)]
    views, offset = [], 0
    for part in parts:
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(part)})
        offset += len(part)
    kinds = [(3, "VEC3"), (3, "SCALAR"), (3, "VEC4"), (3, "VEC3"), (9, "VEC3")]
    document = {
        "asset": {"version": "2.0"},
        "extensionsRequired": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"name": "lamp", "type": "point", "intensity": 4}]}},
        "buffers": [{"byteLength": offset, "uri": "data:application/octet-stream;base64,"
                     + base64.b64encode(b"".join(parts)).decode()}],
        "bufferViews": views,
        "accessors": [{"bufferView": i, "componentType": 5126, "count": n, "type": kind}
                      for i, (n, kind) in enumerate(kinds)],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"name": "bus/1", "children": [1, 2, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}},
                  {"name": "wing", "translation": [1, 0, 0], "scale": list(scale), "mesh": 0},
                  {"name": "wing", "translation": [-1, 0, 0], "mesh": 0, "children": [4]},
                  {"name": "boom", "translation": [0, 5, 0]},
                  {"name": "tip", "translation": [0, 0, 3]}],
        "animations": [
            {"name": "turn", "samplers": [{"input": 1, "output": 2}, {"input": 1, "output": 3, "interpolation": "STEP"}],
             "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}},
                          {"sampler": 1, "target": {"node": 3, "path": "translation"}}]},
            {"name": "bend", "samplers": [{"input": 1, "output": 4, "interpolation": "CUBICSPLINE"}],
             "channels": [{"sampler": 0, "target": {"node": 3, "path": "translation"}}]}],
        "scenes": [{"nodes": [0]}]}
    path = folder / "array.gltf"
    path.write_text(json.dumps(document))
    return str(path)


def test_each_node_is_a_frame(scene, tmp_path):
    model = scene.load(gltf(tmp_path), frames=True, up="z", name="probe", position=(10, 0, 0))
    assert list(model.frames) == ["bus_1", "wing", "wing 2", "boom", "tip"]
    assert model.original_names["bus_1"] == "bus/1" and model.original_names["wing 2"] == "wing"
    assert list(model.objects) == ["wing", "wing 2"]
    assert [(each.name, each.duration_s) for each in model.animations] == [("turn", 2.0), ("bend", 2.0)]
    assert model.frames["tip"].path.endswith("probe/bus_1/wing 2/tip")
    np.testing.assert_allclose(model.frames["tip"].world_pose.position, (9, 0, 3), atol=1e-12)
    # By hand: a part turns with what hangs on it.
    wing = model.frames["wing 2"]
    wing.pose = wing.pose @ dspace.Pose(quaternion=(HALF, 0, HALF, 0))  # a quarter about Y: Z to X
    np.testing.assert_allclose(model.frames["tip"].world_pose.position, (12, 0, 0), atol=1e-12)
    # Again, in the same place.
    assert scene.load(gltf(tmp_path), frames=True, up="z", name="probe 2").frame.name == "probe 2"


def test_the_geometry_is_that_of_the_single_object(scene, tmp_path):
    path = gltf(tmp_path, scale=(2, 3, 4))
    model = scene.load(path, frames=True, up="y", scale=0.5)
    assert all(frame.scale == 1.0 for frame in model.frames.values())  # the file's are in the objects
    view = scene.add_viewport((96, 72), scene.add_camera(eye=(4, -5, 3), target=(0, 0, 0)))
    parts = view.image()
    model.remove()
    whole = scene.load(path, up="y", scale=0.5)
    assert np.abs(view.image().astype(int) - parts).max() <= 1
    whole.remove()
    assert np.abs(view.image().astype(int) - parts).max() > 50


def test_animations_against_closed_forms(scene, tmp_path):
    model = scene.load(gltf(tmp_path), frames=True, up="z")
    boom, wing = model.frames["boom"], model.frames["wing 2"]
    for time in (-1, 0, 0.25, 1, 1.5, 2, 9):
        model.pose_at(time, "turn")
        angle = math.radians(90 * min(max(time, 0), 2))
        expected = (math.cos(angle / 2), 0, math.sin(angle / 2), 0)
        assert abs(np.dot(wing.pose.quaternion, expected)) == pytest.approx(1, abs=1e-7)
        np.testing.assert_allclose(wing.pose.position, (-1, 0, 0), atol=1e-7)
        np.testing.assert_allclose(boom.pose.position, (0, 0, math.floor(min(max(time, 0), 2))), atol=1e-7)
    # Hermite: from 0 with slope 3 to 1 with slope -3 in the first second.
    for t in (0, 0.25, 0.5, 0.9):
        model.pose_at(t, model.animations[1])
        x = 3 * (t**3 - 2 * t**2 + t) + (3 * t**2 - 2 * t**3) - 3 * (t**3 - t**2)
        np.testing.assert_allclose(boom.pose.position, (x, 0, 0), atol=1e-6)
    wing.pose = dspace.Pose(position=(7, 7, 7))
    model.pose_at(0, "bend")  # moves the boom alone
    np.testing.assert_allclose(wing.pose.position, (7, 7, 7))


def test_lights_on_request(scene, tmp_path):
    path = gltf(tmp_path)
    with pytest.warns(dspace.DspaceWarning, match="left out: 1 light"):
        scene.load(path, frames=True, up="z")
    model = scene.load(path, frames=True, lights=True, up="z", name="lit")
    assert model.lights == ["lit/lamp"]
    lamp = scene.lights["lit/lamp"]
    assert lamp.kind == "point" and lamp.intensity == pytest.approx(4 / np.pi)
    model.remove()
    assert "lit/lamp" not in scene.lights


def test_what_is_rejected(scene, tmp_path):
    path = gltf(tmp_path)
    model = scene.load(path, frames=True, up="z", lights=True)
    with pytest.raises(dspace.NotFound, match="no animation 'run'; it has: 'turn', 'bend'"):
        model.pose_at(1, "run")
    with pytest.raises(dspace.InvalidArgument, match="finite"):
        model.pose_at(float("nan"))
    with pytest.raises(dspace.InvalidArgument, match="node of a model"):
        model.frames["tip"].remove()
    with pytest.raises(dspace.InvalidArgument, match="whose nodes are frames"):
        model.objects["wing"].remove()
    with pytest.raises(dspace.InvalidArgument, match="same on each axis"):
        scene.load(path, frames=True, up="z", stretch=(1, 2, 1))
    with pytest.raises(dspace.InvalidArgument, match="frames=True"):
        scene.load(path, lights=True, up="z")
    with pytest.raises(dspace.InvalidArgument, match="one"):
        scene.load(path, frames=True, up="z", levels=[(path, 0)])


def poses_of(model):
    return np.array([np.concatenate((frame.world_pose.position, frame.world_pose.quaternion))
                     for frame in model.frames.values()])


def test_a_scale_that_a_frame_cannot_hold(scene, tmp_path):
    document = json.loads(open(gltf(tmp_path)).read())
    document["animations"][0]["channels"] = [{"sampler": 1, "target": {"node": 1, "path": "scale"}}]
    path = tmp_path / "scaled.gltf"
    path.write_text(json.dumps(document))
    model = scene.load(str(path), frames=True, up="z")
    with pytest.warns(dspace.DspaceWarning, match="node 'wing' differently along its axes"):
        model.pose_at(2)  # (0, 0, 2)


def test_recorded_and_played(tmp_path):
    path = gltf(tmp_path)
    with dspace.Session() as session, session.record(tmp_path / "run.dspace"):
        scene = session.scene()
        scene.time = 0
        model = scene.load(path, frames=True, lights=True, up="z", name="probe")
        scene.time = 1
        model.pose_at(0.5)
        scene.time = 2
        model.frames["tip"].pose = dspace.Pose(position=(0, 0, 9))
        model.frame.position = (1, 2, 3)
        scene.time = 3
        expected = scene.poses(list(scene.frames.values()))
    with dspace.Playback(tmp_path / "run.dspace") as run:
        for at in (3, 0, 3):
            run.seek(at)
        scene = run.session.scene()
        np.testing.assert_array_equal(scene.poses(list(scene.frames.values())), expected)
        assert "probe/lamp" in scene.lights


def test_text_of_vrml_is_drawn(scene, tmp_path):
    path = tmp_path / "words.wrl"
    path.write_text('#VRML V2.0 utf8\nBackground { } Shape { geometry Text { string [ "Dspace" ] } }')
    with pytest.warns(dspace.DspaceWarning, match="left out: 1 Background"):
        words = scene.load(path)
    assert words.triangles > 100
