"""Text in files that is not UTF-8: read, served, recorded and played back, in UTF-8."""
import os
import subprocess
import sys
import warnings

import numpy as np
import pytest

import dspace
from dspace._core import wire
from dspace.proto import commands_pb2 as pb
from served_support import Served
from terrain_support import gdal

LATIN, NAME = b"M\xe4st", "Mäst"
FACES = b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"
WKT = ('PROJCS["M?st",GEOGCS["Mond",DATUM["D",SPHEROID["S",1737400,0]],PRIMEM["Reference_Meridian",0],'
       'UNIT["Degree",0.0174532925199433]],PROJECTION["Equirectangular"],PARAMETER["standard_parallel_1",0],'
       'PARAMETER["central_meridian",0],UNIT["metre",1]]')


def obj(folder):
    (folder / "a.mtl").write_bytes(b"newmtl " + LATIN + b"\nKd 1 0 0\nmap_Kd absent" + LATIN + b".png\n")
    path = folder / "a.obj"
    path.write_bytes(b"mtllib a.mtl\ng " + LATIN + b"\nusemtl " + LATIN + b"\n" + FACES + b"f 1 2 3\n")
    return path


def vrml(folder):
    path = folder / "a.wrl"
    path.write_bytes(b"#VRML V2.0 utf8\nDEF " + LATIN + b" Transform { children Shape { geometry Box { } } }\n"
                     b'Inline { url "' + LATIN + b'.wrl" }\n')
    return path


def gltf(folder):
    (folder / "a.bin").write_bytes(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4").tobytes())
    path = folder / "a.gltf"
    path.write_bytes(b"""{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "NAME", "mesh": 0}], "meshes": [{"name": "NAME", "primitives": [{"attributes":
        {"POSITION": 0}, "material": 0}]}], "materials": [{"name": "NAME", "pbrMetallicRoughness":
        {"baseColorTexture": {"index": 0}}}], "textures": [{"source": 0}], "images": [{"uri": "NAME.png"}],
        "buffers": [{"uri": "a.bin", "byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
        "max": [1, 1, 0]}]}""".replace(b"NAME", LATIN))
    return path


def urdf(folder):
    path = folder / "a.urdf"
    path.write_bytes(b'<?xml version="1.0" encoding="ISO-8859-1"?><robot name="' + LATIN + b'"><link name="base"/>'
                     b'<link name="' + LATIN + b'"><visual><geometry><box size="1 1 1"/></geometry></visual>'
                     b'<visual><geometry><mesh filename="' + LATIN + b'.stl"/></geometry></visual></link>'
                     b'<joint name="' + LATIN + b'" type="continuous"><parent link="base"/><child link="' + LATIN +
                     b'"/></joint></robot>')
    return path


def tiff(folder):
    path = folder / "a.tif"
    data = gdal.GetDriverByName("GTiff").Create(str(path), 33, 33, 1, gdal.GDT_Float32)
    data.SetGeoTransform((0, 1, 0, 33, 0, -1))
    data.SetProjection(WKT)
    data.GetRasterBand(1).SetUnitType("m")
    data.GetRasterBand(1).WriteArray(np.add.outer(np.arange(33.0), np.arange(33.0)))
    data = None  # writes it
    # GDAL's Python takes no text that is not UTF-8: the name is changed in the file.
    written = path.read_bytes()
    assert written.count(b"M?st") == 1
    path.write_bytes(written.replace(b"M?st", LATIN))
    return path


def load(scene, path):
    """Loads a file of any of these kinds; returns texts that came of it, warnings among them."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        if path.suffix == ".urdf":
            robot = scene.load(str(path))
            texts = [robot.name, *robot.links, *robot.joints]
        elif path.suffix == ".tif":
            terrain = scene.add_terrain(str(path), vertical_datum="relative")
            texts = [terrain.crs]
        else:
            texts = [scene.load(str(path)).name]
    return texts + [str(each.message) for each in caught]


KINDS = pytest.mark.parametrize("make", [obj, vrml, gltf, urdf, tiff], ids=lambda make: make.__name__)


@KINDS
def test_read(scene, tmp_path, make):
    texts = load(scene, make(tmp_path))
    assert any(NAME in text for text in texts), texts
    assert not any("Ã" in text for text in texts), texts  # no UTF-8 taken for another encoding
    assert scene.objects  # all that is there can still be asked for
    with pytest.raises(dspace.NotFound):
        scene.load(str(tmp_path / "absent.obj"))


@KINDS
def test_a_warning_names_the_file(scene, tmp_path, make):
    """But for the URDF, which declares its encoding."""
    said = sorted(text for text in load(scene, make(tmp_path)) if "Windows-1252" in text)
    names = {obj: ["a.mtl", "a.obj"], vrml: ["a.wrl"], gltf: ["a.gltf"], urdf: [], tiff: [NAME]}[make]
    assert len(said) == len(names) and all(name in text for name, text in zip(names, said)), said


def test_an_encoding_that_a_urdf_declares(scene, tmp_path):
    path = tmp_path / "a.urdf"
    path.write_bytes('<?xml version="1.0" encoding="windows-1251"?><robot name="a"><link name="Марс"/></robot>'
                     .encode("windows-1251"))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert list(scene.load(str(path)).links) == ["Марс"]


def test_texts_of_kernels_and_shapes(scene, tmp_path):
    kernel = tmp_path / "a.tf"  # the data of a kernel are ASCII, its comments anything
    kernel.write_bytes(b"KPL/FK\n" + LATIN + b"\n\\begindata\nFRAME_MAEST = 1400000\nFRAME_1400000_NAME = 'MAEST'\n"
                       b"FRAME_1400000_CLASS = 4\nFRAME_1400000_CLASS_ID = 1400000\nFRAME_1400000_CENTER = 399\n"
                       b"TKFRAME_1400000_RELATIVE = 'J2000'\nTKFRAME_1400000_SPEC = 'MATRIX'\n"
                       b"TKFRAME_1400000_MATRIX = ( 1 0 0 0 1 0 0 0 1 )\n")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        scene.kernels.load(str(kernel))
    assert any("a.tf" in str(each.message) and "Windows-1252" in str(each.message) for each in caught)
    assert "MAEST" in str(scene.kernels.frames)
    with pytest.raises(dspace.Corrupt, match="accepted: printable ASCII"):
        (tmp_path / "b.tf").write_bytes(b"KPL/FK\n\\begindata\nFRAME_NAME = '" + LATIN + b"'\n")
        scene.kernels.load(str(tmp_path / "b.tf"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        terrain = scene.add_terrain(str(tiff(tmp_path)), vertical_datum="relative", mode="clipmap")
    shapes = tmp_path / "a.geojson"
    shapes.write_bytes(b'{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"stroke": "' + LATIN +
                       b'"}, "geometry": {"type": "LineString", "coordinates": [[1, 1], [9, 9]]}}]}')
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        terrain.add_shapes(str(shapes), crs=terrain.crs)
    said = [str(each.message) for each in caught]
    assert any("'stroke' is 'Mäst'" in text for text in said), said
    assert scene.objects


DRIVE = """
import pathlib, sys
import dspace, test_text_encoding as t
with dspace.connect(sys.argv[1], timeout=60) as session:
    scene = session.scene()
    texts = t.load(scene, pathlib.Path(sys.argv[2]))
    assert any(t.NAME in text for text in texts), texts
    scene.time = 1.0
    assert scene.objects
    with dspace.watch(sys.argv[1], timeout=60) as watcher:
        while "scene" not in watcher.scenes or watcher.scenes["scene"].time != 1.0:
            watcher.update(0.1)
        assert sorted(watcher.scenes["scene"].objects) == sorted(scene.objects)
    print("done")
"""


@KINDS
def test_served(tmp_path, make):
    """In a process of its own, with a limit of time: it used to hang for good."""
    path = make(tmp_path)
    with Served(tmp_path, "--allow-root", str(tmp_path)) as server:
        environment = dict(os.environ, PYTHONPATH=os.pathsep.join([os.path.dirname(__file__), *sys.path]))
        done = subprocess.run([sys.executable, "-W", "ignore", "-c", DRIVE, server.address, str(path)],
                              env=environment, capture_output=True, text=True, timeout=120)
    assert done.stdout == "done\n", done.stderr


@KINDS
@pytest.mark.parametrize("pack", [False, True], ids=["plain", "packed"])
def test_recorded_and_played_back(tmp_path, make, pack):
    (tmp_path / "files").mkdir()
    path = make(tmp_path / "files")
    with dspace.Session() as session:
        scene = session.scene()
        with session.record(tmp_path / "a.dspace", pack=pack):
            load(scene, path)
            scene.time = 1.0
            scene.add_frame("after")
            scene.time = 2.0
        objects = sorted(scene.objects)
        assert objects
    if pack:
        path.unlink()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with dspace.Playback(tmp_path / "a.dspace") as run:
            assert run.times == [0.0, 1.0, 2.0]
            run.seek(2.0)
            played = run.session.scenes["scene"]
            assert sorted(played.objects) == objects and "after" in played.frames


def test_names_of_files_that_are_not_utf8(scene, tmp_path):
    """Python's str of such a name has surrogates, which no message can hold; what a file names is UTF-8."""
    path = os.fsencode(tmp_path) + b"/" + LATIN + b".obj"
    with open(path, "wb") as file:
        file.write(FACES + b"f 1 2 3\n")
    with pytest.raises(dspace.InvalidArgument, match="whole characters"):
        scene.load(os.fsdecode(path))
    assert not scene.objects


WORKING_FOLDER = """
import os, sys
import dspace
os.chdir(os.fsdecode(bytes.fromhex(sys.argv[1])))
with dspace.Session() as session:
    scene = session.scene()
    for call in (lambda: scene.load("a.obj"), lambda: scene.load("a.urdf"),
                 lambda: scene.add_terrain("a.tif")):
        try:
            call()
        except dspace.Unsupported as error:
            assert "is not UTF-8" in str(error) and "Mäst" in str(error), error
        else:
            raise AssertionError("nothing was raised")
    assert not scene.objects
print("done")
"""


def test_a_working_folder_whose_name_is_not_utf8(tmp_path):
    folder = os.fsencode(tmp_path) + b"/" + LATIN
    os.mkdir(folder)
    plain = tmp_path / "plain"
    plain.mkdir()
    for make in (obj, urdf, tiff):
        make(plain)
    for name in os.listdir(plain):
        os.rename(plain / name, os.path.join(folder, os.fsencode(name)))
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", WORKING_FOLDER, folder.hex()],
                          env=dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path)), capture_output=True, text=True,
                          timeout=120)
    assert done.stdout == "done\n", done.stderr


def test_messages_that_protobuf_does_not_take():
    """Errors of protobuf never leave as they are."""
    foreign = b"\n\x01\xe4"  # a Command whose scene is Latin-1
    with pytest.raises(dspace.Corrupt, match="recording 'a': its 3 bytes are not a Command message"):
        wire.command_of(foreign, "recording 'a'")
    with pytest.raises(dspace.Internal, match="reply: its 3 bytes are not a Reply message"):
        wire.decode(pb.Reply, b"\x12\x01\xe4", "reply", dspace.Internal)
    assert wire.command_of(wire.encode(pb.Command(scene="ä"))).scene == "ä"

    class Large:
        def SerializeToString(self):
            raise wire.EncodeError("too large")

    with pytest.raises(dspace.Resource, match="command: it has more than 2 GiB"):
        wire.encode(Large())


def test_a_vrml_that_crashed_the_process(scene, refused, tmp_path):
    path = tmp_path / "a.wrl"
    path.write_text("#VRML V2.0 utf8\nShape { geometry DEF A Box { } geometry Sphere { } }\nShape { geometry USE A }\n")
    with refused(dspace.Corrupt, "field 'geometry' of Shape is given twice"):
        scene.load(str(path))
