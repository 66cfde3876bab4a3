"""A scene for other programs: glTF files, read without Dspace, and vtkActors; and bad input."""
import json
import struct

import numpy as np
import pytest

import dspace


def gltf_of(path):
    """The JSON and the arrays of a GLB, by the specification (glTF 2.0, sections 4 and 3.6)."""
    data = path.read_bytes()
    magic, version, length = struct.unpack_from("<III", data)
    assert magic == 0x46546C67 and version == 2 and length == len(data)
    size, kind = struct.unpack_from("<II", data, 12)
    assert kind == 0x4E4F534A
    document = json.loads(data[20:20 + size])
    binary = data[28 + size:]

    def accessor(index):
        each = document["accessors"][index]
        view = document["bufferViews"][each["bufferView"]]
        kind = {5126: "<f4", 5125: "<u4"}[each["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[each["type"]]
        return np.frombuffer(binary, kind, each["count"] * width, view.get("byteOffset", 0)).reshape(-1, width)

    return document, accessor


def node_of(document, name):
    return next(node for node in document["nodes"] if node.get("name") == name)


def test_a_file_has_frames_and_objects(scene, tmp_path):
    arm = scene.add_frame("arm", position=(1, 2, 3))
    scene.add_box((1, 2, 3), name="box", frame=arm, color=(0.5, 0, 0), lit=False)
    scene.export(tmp_path / "a.glb")
    document, accessor = gltf_of(tmp_path / "a.glb")
    assert node_of(document, "arm")["translation"] == [1, 2, 3]
    np.testing.assert_allclose(document["nodes"][0]["rotation"], [-np.sqrt(0.5), 0, 0, np.sqrt(0.5)])  # Z to Y
    box = node_of(document, "box")
    assert document["nodes"].index(box) in node_of(document, "arm")["children"]
    primitive = document["meshes"][box["mesh"]]["primitives"][0]
    points = accessor(primitive["attributes"]["POSITION"])
    np.testing.assert_allclose(points.max(axis=0), (0.5, 1, 1.5))
    assert len(accessor(primitive["indices"])) == 36
    material = document["materials"][primitive["material"]]
    assert "KHR_materials_unlit" in material["extensions"]
    np.testing.assert_allclose(material["pbrMetallicRoughness"]["baseColorFactor"],
                               (((0.5 + 0.055) / 1.055) ** 2.4, 0, 0, 1), atol=1e-6)


def test_lights_are_written_and_read_again(scene, tmp_path):
    """Pi lux show a white matt surface as 1 in glTF, as an intensity of 1 does here."""
    arm = scene.add_frame("arm", position=(0, 0, 5))
    scene.add_box((1, 1, 1), name="box")
    scene.lights["sun"].set(direction=(0, 0, -1), intensity=2, color=(1, 0.5, 0))
    scene.add_light("lamp", kind="point", frame=arm, position=(1, 2, 3), attenuation=(0, 0, 4), intensity=8)
    scene.add_light("sky", kind="ambient", intensity=0.25)
    scene.add_light("off", kind="point", attenuation=(0, 0, 1), enabled=False)
    scene.export(tmp_path / "a.glb")
    document, _ = gltf_of(tmp_path / "a.glb")
    assert document["extensionsUsed"] == ["KHR_lights_punctual"]
    lights = {light["name"]: light for light in document["extensions"]["KHR_lights_punctual"]["lights"]}
    assert sorted(lights) == ["lamp", "sun"]  # the ambient light has no counterpart
    assert lights["sun"]["type"] == "directional" and lights["sun"]["intensity"] == pytest.approx(2 * np.pi)
    np.testing.assert_allclose(lights["sun"]["color"], (1, ((0.5 + 0.055) / 1.055) ** 2.4, 0), atol=1e-6)
    assert lights["lamp"]["type"] == "point" and lights["lamp"]["intensity"] == pytest.approx(2 * np.pi)
    node = next(node for node in document["nodes"] if node.get("name") == "lamp")
    assert document["nodes"].index(node) in node_of(document, "arm")["children"] and node["translation"] == [1, 2, 3]
    assert document["asset"]["extras"]["ambient"] == pytest.approx([scene.lights["sky"].intensity] * 3, abs=1e-6)
    loaded = scene.load(tmp_path / "a.glb", frames=True, lights=True, name="again")
    assert sorted(loaded.lights) == ["again/lamp", "again/sun"]
    assert scene.lights["again/lamp"].intensity == pytest.approx(8 / 4)
    assert scene.lights["again/sun"].intensity == pytest.approx(2)
    np.testing.assert_allclose(scene.lights["again/sun"].color, (1, 0.5, 0), atol=1e-6)
    scene.add_light("bulb", kind="point", position=(0, 0, 7), intensity=3)  # as bright everywhere
    with pytest.warns(dspace.DspaceWarning, match="light 'bulb' falls off"):
        scene.export(tmp_path / "b.glb")
    scene.export(tmp_path / "c.glb", lights=False)
    assert "extensions" not in gltf_of(tmp_path / "c.glb")[0]
    with pytest.raises(dspace.WrongType, match="lights"):
        scene.export(tmp_path / "d.glb", lights=1)


def test_a_recording_becomes_an_animation(tmp_path):
    with dspace.Session() as session:
        scene = session.scene()
        frame = scene.add_frame("f")
        scene.add_sphere(1, frame=frame)
        with session.record(tmp_path / "a.dspace"):
            for x, time in enumerate((10.0, 11.0, 12.0, 13.0)):
                scene.time = time
                frame.pose = dspace.Pose((x, 0, 0))
                if x == 2:
                    scene.add_frame("late", frame, position=(0, 5, 0))
    with dspace.Playback(tmp_path / "a.dspace") as run:
        run.export(tmp_path / "all.glb", start=10)
        run.export(tmp_path / "some.glb", start=10.5, end=12, step=0.5)
        for bad in ({"start": 13, "end": 10}, {"step": 0}, {"step": 1e-9}, {"start": -5, "end": 12}):
            with pytest.raises(dspace.InvalidArgument):
                run.export(tmp_path / "bad.glb", **bad)
        assert not (tmp_path / "bad.glb").exists()
    document, accessor = gltf_of(tmp_path / "all.glb")
    (animation,) = document["animations"]
    (channel,) = animation["channels"]  # "late" stands still
    assert document["nodes"][channel["target"]["node"]]["name"] == "f"
    sampler = animation["samplers"][channel["sampler"]]
    np.testing.assert_allclose(accessor(sampler["input"])[:, 0], (0, 1, 2, 3))
    np.testing.assert_allclose(accessor(sampler["output"]), [(x, 0, 0) for x in range(4)])
    assert document["asset"]["extras"]["start_s"] == 10
    document, accessor = gltf_of(tmp_path / "some.glb")
    sampler = document["animations"][0]["samplers"][0]
    np.testing.assert_allclose(accessor(sampler["input"])[:, 0], (0, 0.5, 1, 1.5))
    np.testing.assert_allclose(accessor(sampler["output"])[:, 0], (0, 1, 1, 2))  # steps as recorded


def test_bad_exports(scene, tmp_path, refused):
    frame = scene.add_frame("f")
    scene.add_sphere(1, frame=frame)
    path = tmp_path / "a.glb"
    with refused(dspace.InvalidArgument, "all of them, or none"):
        scene.export(path, times=[0, 1])
    with refused(dspace.InvalidArgument, "(2, 1, 7)"):
        scene.export(path, times=[0, 1], frames=[frame], poses=np.zeros((2, 1, 7)))
    with refused(dspace.InvalidArgument, "scale 0"):
        scene.export(path, times=[0, 1], frames=[frame], poses=np.zeros((2, 1, 8)))
    with refused(dspace.InvalidArgument, "triangle budget"):
        scene.export(path, triangle_budget=0)
    with refused(dspace.Io, "absent"):
        scene.export(tmp_path / "absent" / "a.glb")
    with refused(dspace.InvalidArgument, ".obj"):
        scene.export(tmp_path / "a.obj")
    assert list(tmp_path.iterdir()) == []


def test_actors_follow_the_scene(scene):
    from vtkmodules import vtkRenderingCore as vtk
    frame = scene.add_frame("f", position=(1, 0, 0))
    scene.add_fragment("parts")
    box = scene.add_box((1, 1, 1), frame=frame, color=(1, 0.5, 0), lit=False, fragment="parts")
    scene.add_label("words", name="words")
    renderer = vtk.vtkRenderer()
    with scene.to_vtk(renderer) as shown:
        assert renderer.GetActors().GetNumberOfItems() == shown.actors.GetNumberOfItems() == 1
        assert shown.left_out == ["words"]
        actor = renderer.GetActors().GetItemAsObject(0)
        assert actor.GetProperty().GetColor() == pytest.approx((1, 0.5, 0)) and not actor.GetProperty().GetLighting()
        frame.pose = dspace.Pose((4, 5, 6))
        np.testing.assert_allclose(actor.GetCenter(), (4, 5, 6))
        box.color = (0, 0, 1)
        box.visible = False
        shown.update()
        assert shown.actors.GetNumberOfItems() == 0
    assert renderer.GetActors().GetNumberOfItems() == 0
    box.visible = True
    actors = scene.fragments["parts"].to_actors()
    assert actors.actors.GetNumberOfItems() == 1
    with pytest.raises(dspace.WrongType, match="a vtkRenderer"):
        scene.to_vtk(7)
    with pytest.raises(dspace.NotFound):
        scene.to_vtk(renderer, fragment="nothing")
    actors.release()
