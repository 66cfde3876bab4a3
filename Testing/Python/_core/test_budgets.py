"""The limits of dspace.limits: their names, what is rejected, and that a file beyond one is an error that names it."""
import json
import struct
import subprocess
import sys
import zlib

import numpy as np
import pytest

import dspace
from needs import needs_module
from served_support import Served


@pytest.fixture
def limits():
    before = dspace.limits.get()
    yield before
    dspace.limits.set(**before)


def chunk(kind, content):
    return (struct.pack(">I", len(content)) + kind + content
            + struct.pack(">I", zlib.crc32(kind + content)))


def grey_png(side):
    """A PNG of zeros: small, whatever its size is."""
    header = struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0)
    pack = zlib.compressobj(1)
    rows = b"".join(pack.compress(bytes(side + 1)) for _ in range(side)) + pack.flush()
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", rows) + chunk(b"IEND", b"")


def test_limits_are_known(limits):
    assert limits == {"image_pixels": 128 << 20, "block_bytes": 256 << 20, "message_elements": 8 << 20,
                      "import_memory": 4 << 30, "import_seconds": 300, "raster_pixels": 1 << 50, "mosaic_files": 20000,
                      "mosaic_bytes": 64 << 20, "open_memory": 512 << 20, "texture_bytes": 512 << 20,
                      "open_seconds": 15}


def test_limits_are_set_together_or_not_at_all(limits):
    dspace.limits.set(image_pixels=1000, import_seconds=7)
    assert dspace.limits.get() == {**limits, "image_pixels": 1000, "import_seconds": 7}
    for wrong, kind in (({"pixels": 1}, dspace.InvalidArgument), ({"image_pixels": 0}, dspace.InvalidArgument),
                        ({"image_pixels": 1.5}, dspace.errors.WrongType),
                        ({"image_pixels": -1}, dspace.InvalidArgument),
                        ({"block_bytes": 5, "image_pixels": 1 << 62}, dspace.InvalidArgument)):
        with pytest.raises(kind) as caught:
            dspace.limits.set(**wrong)
        assert list(wrong)[-1] in str(caught.value)
        assert dspace.limits.get() == {**limits, "image_pixels": 1000, "import_seconds": 7}


def test_large_texture_is_an_error_that_names_the_limit(limits, scene, tmp_path):
    """729 kB that would take gigabytes."""
    path = tmp_path / "large.png"
    path.write_bytes(grey_png(16000))
    box = scene.add_box((1, 1, 1))
    with pytest.raises(dspace.Resource, match="16000 x 16000.* the limit image_pixels is 134217728"):
        box.set_material(texture=str(path))
    small = tmp_path / "small.png"
    small.write_bytes(grey_png(20))
    box.set_material(texture=str(small))


def test_large_block_of_a_raster_is_an_error_that_names_the_limit(limits, scene, tmp_path):
    gdal = needs_module("osgeo.gdal", "python3-gdal")  # an independent writer
    path = str(tmp_path / "large.tif")
    made = gdal.GetDriverByName("GTiff").Create(path, 30000, 30000, 1, gdal.GDT_Float32,
                                                ["COMPRESS=DEFLATE", "BLOCKYSIZE=30000", "SPARSE_OK=TRUE"])
    made.SetGeoTransform((0, 1, 0, 0, 0, -1))
    made.FlushCache()
    del made
    with pytest.raises(dspace.Resource, match="30000 x 30000 pixels of 4 bytes; the limit block_bytes is 268435456"):
        scene.add_terrain(path)
    assert not scene.terrains


def test_vrml_that_replaces_a_node_is_an_error(scene, tmp_path):
    """Coin ends the process at this text."""
    path = tmp_path / "twice.wrl"
    path.write_text("#VRML V2.0 utf8\nShape { geometry DEF B Box { } geometry Sphere { } }\n"
                    "Shape { geometry USE B }\n")
    with pytest.raises(dspace.Corrupt, match="twice.wrl"):
        scene.load(str(path))
    good = tmp_path / "good.wrl"
    good.write_text("#VRML V2.0 utf8\nShape { geometry Box { } }\n")
    scene.load(str(good))


def test_all_formats_can_be_read_apart(scene, tmp_path):
    path = tmp_path / "a.stl"
    path.write_text("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                    "endfacet\nendsolid a\n")
    dspace.limits.read_models_apart()
    try:
        assert scene.load(str(path)) is not None
    finally:
        dspace.limits.read_models_apart(False)
    with pytest.raises(dspace.errors.WrongType):
        dspace.limits.read_models_apart("yes")


@pytest.mark.parametrize("apart", [False, True])
@pytest.mark.parametrize("kind", ["obj", "gltf", "wrl"])
def test_textures_of_a_model_together(limits, tmp_path, kind, apart):
    """Two textures of 64 x 64 grey pixels, decoded to the same bytes each."""
    for name in ("a", "b"):
        (tmp_path / f"{name}.png").write_bytes(grey_png(64))
    path = tmp_path / f"model.{kind}"
    if kind == "wrl":
        path.write_text("#VRML V2.0 utf8\n" + "".join(
            f'Shape {{ appearance Appearance {{ texture ImageTexture {{ url "{name}.png" }} }} geometry Box {{ }} }}\n' for name in "ab"))
    elif kind == "obj":
        (tmp_path / "m.mtl").write_text("newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd b.png\n")
        path.write_text("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\nusemtl b\nf 1/1 2/1 3/1\n")
    else:
        corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0)], "<f4").tobytes() + bytes(24)
        (tmp_path / "m.bin").write_bytes(corners)
        path.write_text(json.dumps({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "buffers": [{"uri": "m.bin", "byteLength": 60}], "bufferViews": [{"buffer": 0, "byteLength": 36},
                                                                             {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                          {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": i} for i in (0, 1)]}],
            "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}} for i in (0, 1)],
            "textures": [{"source": i} for i in (0, 1)], "images": [{"uri": "a.png"}, {"uri": "b.png"}]}))
    def load():
        with dspace.Session() as session:  # a session keeps the models that it has read
            session.scene().load(str(path), up="y")

    dspace.limits.read_models_apart(apart)
    try:
        load()
        dspace.limits.set(texture_bytes=64 * 64)
        with pytest.raises(dspace.Resource, match=f"model.{kind}.*textures.*the limit texture_bytes is 4096, which"):
            load()
        dspace.limits.set(texture_bytes=2 * 64 * 64)
        load()
    finally:
        dspace.limits.read_models_apart(False)


def write_stl(path, triangles):
    """Triangles side by side."""
    kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("count", "<u2")])
    data = np.zeros(triangles, kind)
    data["normal"] = (0, 0, 1)
    data["corners"] = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    data["corners"][:, :, 0] += np.arange(triangles)[:, None]
    path.write_bytes(bytes(80) + struct.pack("<I", triangles) + data.tobytes())


def test_server_reads_models_apart_within_its_limits(tmp_path):
    """An STL that needs more than 64 MiB ends the process that reads it, and the server goes on."""
    large, small = tmp_path / "large.stl", tmp_path / "small.stl"
    write_stl(large, 1000000)
    write_stl(small, 2)
    with Served(tmp_path, "--allow-root", str(tmp_path), "--limit", "import_memory=67108864") as served, \
            dspace.connect(served.address) as session:
        scene = session.scene()
        with pytest.raises(dspace.Resource, match="large.stl.* the limit import_memory is 67108864"):
            scene.load(str(large))
        scene.load(str(small))
        assert len(scene.objects) == 1


def test_limit_of_a_server_that_is_none_is_rejected(tmp_path):
    for given, part in (("pixels=1", "there is no such limit|pixels"), ("image_pixels", "NAME=VALUE"),
                        ("image_pixels=-1", "NAME=VALUE")):
        done = subprocess.run([sys.executable, "-m", "dspace", "serve", "--limit", given], capture_output=True,
                              text=True, timeout=60)
        assert done.returncode == 1 and len(done.stderr.splitlines()) == 1
        assert any(word in done.stderr for word in part.split("|"))


def test_server_rejects_a_command_of_too_many_elements(tmp_path):
    """Before it is parsed: 60 MB of empty messages would take gigabytes."""
    from dspace.proto import commands_pb2 as pb
    with Served(tmp_path, "--limit", "message_elements=1000") as served, dspace.connect(served.address) as session:
        scene = session.scene()
        command = pb.Command()
        for _ in range(2000):
            command.set_text_table.row.add()
        with pytest.raises(dspace.Resource, match="too many elements; the limit message_elements is 1000"):
            session.execute(command)
        scene.add_frame("after")
        assert list(scene.frames) == ["after"]
