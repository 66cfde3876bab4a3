"""Recordings that bring their files along: everything that is read is noted, packed, unpacked and checked."""
import contextlib
import hashlib
import json
import os
import pathlib
import shutil
import sqlite3
import struct
import subprocess
import sys
import warnings
import zlib

import numpy
import pytest

import dspace
from dspace.command_line import main
from dspace.recording.assets import RecordedFiles
from dspace.recording.file import RecordingFile
from dspace.proto import commands_pb2 as pb
from needs import lacks, needs_module
from recording_support import Asset, Content, Row, create_recording, put_assets, put_contents, put_rows, write_recording
from terrain_support import gdal

ogr = needs_module("osgeo.ogr", "python3-gdal")
osr = needs_module("osgeo.osr", "python3-gdal")

TETRA = "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nvt 0 0\nvt 1 0\nvt 0 1\n"
FACES = "f 1/1 2/2 3/3\nf 1/1 2/2 4/3\nf 1/1 3/2 4/3\nf 2/1 3/2 4/3\n"


def picture(path, color):
    pixels = numpy.zeros((3, 8, 8), numpy.uint8)
    pixels[:] = numpy.array(color, numpy.uint8)[:, None, None]
    pixels[:, ::2, ::2] //= 2
    memory = gdal.GetDriverByName("MEM").Create("", 8, 8, 3)
    memory.WriteArray(pixels)
    gdal.GetDriverByName("PNG").CreateCopy(str(path), memory)
    (path.parent / (path.name + ".aux.xml")).unlink(missing_ok=True)


def heights(path, driver, west, shift):
    y, x = numpy.mgrid[0:40, 0:20]
    data = gdal.GetDriverByName(driver).Create(str(path), 20, 40, 1, gdal.GDT_Float32)
    data.SetGeoTransform((west, 1, 0, 20, 0, -1))
    data.GetRasterBand(1).WriteArray((numpy.sin(0.4 * x + shift) + 0.02 * y).astype(numpy.float32))


def gltf(folder):
    """A quad whose buffer and texture are files of their own, one of them above it."""
    positions = struct.pack("<12f", 0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0)
    coordinates, indices = struct.pack("<8f", 0, 0, 1, 0, 1, 1, 0, 1), struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    (folder / "quad 1.bin").write_bytes(positions + coordinates + indices)
    part = lambda offset, length: {"buffer": 0, "byteOffset": offset, "byteLength": length}
    (folder / "quad.gltf").write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
        "materials": [{"doubleSided": True, "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}], "images": [{"uri": "../shared/green.png"}],
        "buffers": [{"uri": "quad%201.bin", "byteLength": 92}],
        "bufferViews": [part(0, 48), part(48, 32), part(80, 12)],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [2, 2, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}]}))


def files(root):
    """Files that name files that name files, by relative, absolute and package names; and all of these."""
    for name in ("models", "shared", "robot/urdf", "robot/meshes", "maps/deep", "shapes"):
        (root / name).mkdir(parents=True)
    picture(root / "shared/red.png", (250, 30, 30))
    picture(root / "shared/green.png", (30, 250, 30))
    picture(root / "shared/blue.png", (30, 30, 250))
    gltf(root / "models")
    (root / "models/tetra.obj").write_text("mtllib tetra.mtl\n" + TETRA + "usemtl m\n" + FACES)
    (root / "models/tetra.mtl").write_text("newmtl m\nKd 1 1 1\nmap_Kd ../shared/red.png\n")
    (root / "models/box.wrl").write_text(
        '#VRML V2.0 utf8\nShape { appearance Appearance { material Material { } texture ImageTexture { url '
        '"../shared/blue.png" } } geometry Box { size 1 1 1 } }\n')
    (root / "robot/meshes/part.obj").write_text("mtllib part.mtl\n" + TETRA + "usemtl m\n" + FACES)
    (root / "robot/meshes/part.mtl").write_text("newmtl m\nKd 1 0.5 0\n")
    (root / "robot/meshes/far.obj").write_text(TETRA + FACES)
    (root / "robot/urdf/rover.urdf").write_text(
        '<robot name="r"><link name="base"><visual><geometry><mesh filename="package://robot/meshes/part.obj"/>'
        '</geometry></visual></link><link name="arm"><visual><origin xyz="0 0 2"/><geometry>'
        f'<mesh filename="{root}/robot/meshes/far.obj"/></geometry></visual></link>'
        '<joint name="j" type="fixed"><parent link="base"/><child link="arm"/></joint></robot>')
    heights(root / "maps/deep/west.bin", "ENVI", -20, 0.0)
    heights(root / "maps/east.tif", "GTiff", 0, 0.5)
    gdal.BuildVRT(str(root / "maps/deep/inner.vrt"), [str(root / "maps/deep/west.bin")])
    sources = "".join(
        f'<SimpleSource><SourceFilename relativeToVRT="{int(not name.startswith("/"))}">{name}</SourceFilename>'
        f'<SrcRect xOff="0" yOff="0" xSize="20" ySize="40"/><DstRect xOff="{x}" yOff="0" xSize="20" ySize="40"/>'
        "</SimpleSource>" for x, name in ((0, f"{root}/maps/deep/inner.vrt"), (20, "east.tif")))
    (root / "maps/ground.vrt").write_text(
        '<VRTDataset rasterXSize="40" rasterYSize="40"><GeoTransform>-20, 1, 0, 20, 0, -1</GeoTransform>'
        f'<VRTRasterBand dataType="Float32" band="1">{sources}</VRTRasterBand></VRTDataset>')
    shapes = gdal.GetDriverByName("ESRI Shapefile").Create(str(root / "shapes/line.shp"), 0, 0, 0, 0)
    layer = shapes.CreateLayer("line")
    feature = ogr.Feature(layer.GetLayerDefn())
    feature.SetGeometry(ogr.CreateGeometryFromWkt("LINESTRING (-15 -15, 15 15)"))
    layer.CreateFeature(feature)
    del feature, layer, shapes
    return sorted(str(each) for each in root.rglob("*") if each.is_file() and each.suffix != ".cpg")


def build(session, root):
    scene = session.scene()
    terrain = scene.add_terrain(str(root / "maps/ground.vrt"), mode="clipmap", crs="LOCAL_CS[\"flat\",UNIT[\"metre\",1]]")
    terrain.add_shapes(str(root / "shapes/line.shp"), pixels=4)
    for i, name in enumerate(("models/quad.gltf", "models/tetra.obj", "models/box.wrl")):
        frame = scene.add_frame(f"f{i}", position=(3.0 * i - 3, 2, 3))
        scene.load(str(root / name), frame=frame)
    scene.load(str(root / "robot/urdf/rover.urdf"), frame=scene.add_frame("robot", position=(0, -5, 2)))
    camera = scene.add_camera("camera", eye=(-6, -14, 14), target=(0, 0, 1))
    scene.add_viewport((160, 120), camera, name="view")
    scene.time = 1.0
    return session.viewports["view"].image()


@pytest.fixture
def packed(tmp_path):
    """(recording, picture, files): recorded with pack=True, and the files then gone."""
    root = tmp_path / "here"
    names = files(root)
    with dspace.Session() as session:
        build(session, root)
        with session.record(tmp_path / "run.dspace", pack=True):
            live = session.viewports["view"].image()
            session.scene().time = 2.0
    return tmp_path / "run.dspace", live, names


def played(path):
    with dspace.Playback(path) as run:
        run.step(1000)
        return run.session.viewports["view"].image()


def test_a_packed_recording_replays_where_none_of_its_files_are(packed, tmp_path):
    path, live, names = packed
    assert len(numpy.unique(live.reshape(-1, live.shape[-1]), axis=0)) > 100  # there is something to see
    with RecordingFile(path) as file:
        file.check()
        noted = {os.path.realpath(asset.path): asset for asset in file.assets if asset.state == "read"}
    assert sorted(each for each in noted if not each.endswith(".cpg")) == names
    for each in names:  # an independent sum
        with open(each, "rb") as whole:
            assert noted[each].sha256 == hashlib.sha256(whole.read()).digest() and noted[each].packed
    os.rename(tmp_path / "here", tmp_path / "away")
    shutil.copy(path, tmp_path / "copy.dspace")
    assert numpy.array_equal(played(tmp_path / "copy.dspace"), live)


def test_packed_later_it_is_the_same(packed, tmp_path, capsys):
    _, live, names = packed
    path = str(tmp_path / "plain.dspace")
    with dspace.Session() as session, session.record(path) as recording:
        build(session, tmp_path / "here")
        recording.flush()
        assert main(["log", "pack", path]) == 1 and "in use" in capsys.readouterr().err  # somebody writes it
    assert not any(asset.packed for asset in RecordingFile(path).assets)
    assert main(["log", "pack", path, "--out", str(tmp_path / "new.dspace")]) == 0
    assert main(["log", "pack", path]) == 0 and main(["log", "info", path]) == 0
    assert capsys.readouterr().out.count(", packed") == len(names) + sum(
        asset.path.endswith(".cpg") for asset in RecordingFile(path).assets)
    os.rename(tmp_path / "here", tmp_path / "away")
    for each in ("plain.dspace", "new.dspace"):
        assert numpy.array_equal(played(tmp_path / each), live)
    # A part of it brings them along too.
    assert main(["log", "cut", path, "--out", str(tmp_path / "cut.dspace")]) == 0
    assert numpy.array_equal(played(tmp_path / "cut.dspace"), live)


def test_files_that_files_name_are_checked(packed, tmp_path):
    path = tmp_path / "plain.dspace"
    with dspace.Session() as session, session.record(path):
        build(session, tmp_path / "here")
    for name in ("shared/red.png", "models/quad 1.bin", "robot/meshes/far.obj", "maps/deep/west.bin",
                 "maps/deep/west.hdr", "shapes/line.dbf"):
        changed = tmp_path / "here" / name
        before = changed.read_bytes()
        changed.write_bytes(before[:-1] + bytes([before[-1] ^ 1]))
        with pytest.raises(dspace.Corrupt, match=f"{os.path.basename(name)}.*has changed"):
            dspace.Playback(path)
        with pytest.raises(dspace.Corrupt, match="has changed"):
            main_pack(path, tmp_path / f"no-{changed.name}.dspace")
        changed.write_bytes(before)
    played(path)
    # What was not there must not be there either: the picture would be another one.
    (tmp_path / "here/models/tetra.mtl").unlink()
    with dspace.Session() as session, session.record(tmp_path / "less.dspace"):
        session.scene().load(str(tmp_path / "here/models/tetra.obj"))
    dspace.Playback(tmp_path / "less.dspace").close()
    (tmp_path / "here/models/tetra.mtl").write_text("newmtl m\nKd 1 1 1\n")
    with pytest.raises(dspace.Corrupt, match="tetra.mtl.*did not exist"):
        dspace.Playback(tmp_path / "less.dspace")


def main_pack(path, out):
    from dspace.command_line import log_pack

    class Options:
        pass
    options = Options()
    options.file, options.out = str(path), str(out)
    log_pack.pack(options)


def test_a_file_that_changes_before_it_is_recorded_is_told(tmp_path):
    model = tmp_path / "tetra.obj"
    model.write_text(TETRA + FACES)
    with dspace.Session() as session:
        session.scene().load(str(model))
        model.write_text(TETRA.replace("2", "3") + FACES)
        with session.record(tmp_path / "run.dspace", pack=True) as recording:
            recording.flush()
        assert not recording.failure
    with RecordingFile(tmp_path / "run.dspace") as file:
        assert [(asset.path, asset.state, asset.packed) for asset in file.assets] == [(str(model), "changed", False)]
    with pytest.raises(dspace.Corrupt, match="changed between"):
        dspace.Playback(tmp_path / "run.dspace")


def forged(path, assets, commands=()):
    """A recording of (path, content) assets, as somebody might make one who means harm."""
    write_recording(str(path), [], [])
    with sqlite3.connect(path) as database:
        put_rows(database, "snapshot", [Row(0, 0.0, 0.0, 0, b"")])
        put_rows(database, "command", [Row(i + 1, 0.0, 0.0, command.ListFields()[-1][0].number,
                                           command.SerializeToString()) for i, command in enumerate(commands)])
        for number, (name, content) in enumerate(assets, 1):
            asset = Asset(number, name, "read", len(content), hashlib.sha256(content).digest(), True)
            put_assets(database, [asset])
            put_contents(database, [Content(number, number, 0, len(content), content)])


def everything(root):
    return {str(each): each.read_bytes() if each.is_file() and not each.is_symlink() else None
            for each in root.rglob("*")}


def test_nothing_is_written_outside_of_its_folder(tmp_path, monkeypatch):
    scratch, victim = tmp_path / "scratch", tmp_path / "victim"
    scratch.mkdir()
    victim.mkdir()
    (victim / "file").write_text("untouched")
    (tmp_path / "link").symlink_to(victim)
    monkeypatch.setenv("TMPDIR", str(scratch))
    names = [f"{victim}/file", f"/../../../..{victim}/file2", f"{tmp_path}/link/file3", "/a/./b/../../../../../x",
             f"/x/{'../' * 30}{str(victim)[1:]}/file4", "//etc/passwd", f"{scratch}/dspace-unpacked-x/../../victim/file5"]
    forged(tmp_path / "a.dspace", [(name, b"harm") for name in names])
    before = everything(victim)
    with RecordingFile(tmp_path / "a.dspace") as file:
        with contextlib.closing(RecordedFiles(file)) as unpacked:
            assert os.stat(unpacked.folder).st_mode & 0o077 == 0
            inside = [each for each in scratch.rglob("*") if each.is_file()]
            assert len(inside) == len(names) and all(each.read_bytes() == b"harm" for each in inside)
            assert not any(each.is_symlink() for each in scratch.rglob("*"))
        assert list(scratch.iterdir()) == []  # nothing stays
        assert everything(victim) == before
        assert {each for each in os.listdir(tmp_path) if "dspace" not in each} == {"link", "scratch", "victim"}
    for number, names in enumerate((["relative"], ["../up"], [""], ["/a\0b"], ["/twice", "/./twice"], ["/a", "/a/b"],
                                    ["/a/b", "/a"])):
        forged(tmp_path / f"{number}.dspace", [(name, b"harm") for name in names])
        with pytest.raises(dspace.Corrupt), RecordingFile(tmp_path / f"{number}.dspace") as file:
            RecordedFiles(file)
        assert list(scratch.iterdir()) == [] and everything(victim) == before
    # Names that differ in their case are two files.
    forged(tmp_path / "case.dspace", [("/Name", b"one"), ("/name", b"two")])
    with RecordingFile(tmp_path / "case.dspace") as file, contextlib.closing(RecordedFiles(file)) as unpacked:
        assert open(unpacked.place("/Name"), "rb").read() == b"one"
        assert open(unpacked.place("/name"), "rb").read() == b"two"


def test_no_more_is_unpacked_than_is_said(tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    forged(tmp_path / "a.dspace", [("/a", b"x")])
    with sqlite3.connect(tmp_path / "a.dspace") as database:
        size = 1 << 20
        for number in range(8):
            put_contents(database, [Content(number + 2, 1, 1 + number * size, size, zlib.compress(bytes(size)))])
    with pytest.raises(dspace.Corrupt, match="'/a' is damaged at byte 1"), RecordingFile(tmp_path / "a.dspace") as file:
        RecordedFiles(file)


def test_nothing_stands_in_for_projs_own(tmp_path):
    for number, names in enumerate((["/x/a.gsb", "/x/proj.db"], ["/x/proj/proj.ini"], ["/proj/a.tif", "/proj/proj.db"])):
        forged(tmp_path / f"{number}.dspace", [(name, b"harm") for name in names])
        with pytest.raises(dspace.Corrupt, match="replace PROJ's own"), \
                RecordingFile(tmp_path / f"{number}.dspace") as file:
            RecordedFiles(file)
    forged(tmp_path / "other.dspace", [("/x/a.gsb", b"a grid"), ("/y/proj.db", b"whose folder PROJ never sees")])
    with RecordingFile(tmp_path / "other.dspace") as file:
        RecordedFiles(file).close()


def test_no_command_of_a_recording_writes_files(tmp_path):
    save = pb.Command(scene="scene")
    save.save_image.viewport, save.save_image.path = "view", str(tmp_path / "harm.png")
    forged(tmp_path / "a.dspace", [], [save])
    with pytest.raises(dspace.Corrupt, match="save_image.*changes nothing"):
        dspace.Playback(tmp_path / "a.dspace").step(1)
    assert not (tmp_path / "harm.png").exists()
    # And a path of a packed one that was not packed is that of no other file.
    (tmp_path / "other.obj").write_text(TETRA + FACES)
    with dspace.Session() as session, session.record(tmp_path / "c.dspace"):
        session.scene().load(str(tmp_path / "other.obj"))
    with RecordingFile(tmp_path / "c.dspace") as file:
        commands = [pb.Command.FromString(row.payload) for row in file.rows()]
    forged(tmp_path / "b.dspace", [("/some/file", b"x")], commands)
    with pytest.raises(dspace.Corrupt, match="dspace-unpacked-"):
        dspace.Playback(tmp_path / "b.dspace").step(1)


def test_damaged_content_is_refused(packed, tmp_path):
    path, _, _ = packed
    with sqlite3.connect(path) as database:
        rows = database.execute("SELECT id, data FROM content").fetchall()
    for number, data in rows[:4]:
        shutil.copy(path, tmp_path / "bad.dspace")
        with sqlite3.connect(tmp_path / "bad.dspace") as database:
            database.execute("UPDATE content SET data = ? WHERE id = ?", (data[:-1] + bytes([data[-1] ^ 4]), number))
        with pytest.raises(dspace.Corrupt, match="damaged at byte 0"):
            dspace.Playback(tmp_path / "bad.dspace")
    # A part that unpacks into more than it says, with a checksum that holds.
    shutil.copy(path, tmp_path / "bomb.dspace")
    with sqlite3.connect(tmp_path / "bomb.dspace") as database:
        database.execute("DELETE FROM content WHERE asset = 1")
        put_contents(database, [Content(1, 1, 0, 100, zlib.compress(bytes(10 ** 8)))])
    with pytest.raises(dspace.Corrupt, match="damaged at byte 0"):
        dspace.Playback(tmp_path / "bomb.dspace")


def test_large_files_are_packed_in_parts(tmp_path):
    """Of 4 MiB, compressed where it pays; a file that is not is left as it is."""
    chance = numpy.random.default_rng(1)
    content = {"noise.bin": chance.bytes(9 * 1024 * 1024 + 5), "zeros.bin": bytes(10 * 1024 * 1024), "empty.bin": b""}
    for name, data in content.items():
        (tmp_path / name).write_bytes(data)
    path = tmp_path / "a.dspace"
    with contextlib.closing(create_recording(str(path))) as database, database:
        put_rows(database, "snapshot", [Row(0, 0.0, 0.0, 0, b"")])
        for number, (name, data) in enumerate(content.items(), 1):
            asset = Asset(number, str(tmp_path / name), "read", len(data), hashlib.sha256(data).digest(), False)
            put_assets(database, [asset])
    main_pack(path, tmp_path / "b.dspace")
    assert path.stat().st_size < 2 ** 20 and 9 * 2 ** 20 < (tmp_path / "b.dspace").stat().st_size < 11 * 2 ** 20
    for name in content:
        (tmp_path / name).unlink()
    with RecordingFile(tmp_path / "b.dspace") as file:
        with contextlib.closing(sqlite3.connect(file.path)) as database:
            assert database.execute("SELECT count(*) FROM content WHERE asset = 1").fetchall() == [(3,)]
        with contextlib.closing(RecordedFiles(file)) as unpacked:
            for name, data in content.items():
                with open(unpacked.place(str(tmp_path / name)), "rb") as whole:
                    assert whole.read() == data


def test_real_models_replay_elsewhere(tmp_path):
    """A robot of many meshes, some of whose buffers were never published, OBJ with materials, VRML with pictures."""
    data = os.path.join(os.environ.get("DSPACE_DATA") or "/nonexistent", "models")
    if not os.path.isdir(data):
        pytest.skip("real data absent: set DSPACE_DATA to the folder that has models")
    names = ("m2020_rover/m2020.urdf", "viper_obj/viper_wheel.obj", "pathfinder_vrml/lander2.wrl")
    here = tmp_path / "models"
    for name in names:
        shutil.copytree(os.path.join(data, os.path.dirname(name)), here / os.path.dirname(name))
    path = tmp_path / "run.dspace"
    with warnings.catch_warnings(), dspace.Session() as session, session.record(path, pack=True):
        warnings.simplefilter("ignore")  # of what is absent
        scene = session.scene()
        for i, name in enumerate(names):
            scene.load(str(here / name), frame=scene.add_frame(f"f{i}", position=(6 * i - 6, 0, 0)))
        scene.add_viewport((160, 120), scene.add_camera("c", eye=(0, -15, 8), target=(0, 0, 0)), name="view")
        scene.time = 1.0
        live = session.viewports["view"].image()
    here.rename(tmp_path / "gone")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert numpy.array_equal(played(path), live)
    with RecordingFile(path) as file:
        states = [asset.state for asset in file.assets]
    assert states.count("read") > 50 and "absent" in states and set(states) == {"read", "absent"}


def test_grids_of_datum_shifts_come_along(tmp_path):
    """PROJ's grid from the German DHDN to WGS 84: without it shapes are elsewhere, here by 0.2 m."""
    proj = pathlib.Path("/usr/share/proj")
    if not (proj / "BETA2007.gsb").exists() or not (proj / "proj.db").exists():
        lacks("proj-data")
    here = tmp_path / "here"
    here.mkdir()
    german, degrees = (osr.SpatialReference() for _ in range(2))
    german.ImportFromEPSG(31467)
    degrees.ImportFromEPSG(4326)
    for each in (german, degrees):
        each.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    data = gdal.GetDriverByName("GTiff").Create(str(here / "ground.tif"), 40, 40, 1, gdal.GDT_Float32)
    data.SetGeoTransform((3571400, 1, 0, 5540720, 0, -1))  # about 10° E, 50° N
    data.SetProjection(german.ExportToWkt())
    del data
    # Through the middle of the ground, as PROJ has it with the grid.
    latitude = osr.CoordinateTransformation(german, degrees).TransformPoint(3571420, 5540700)[1]
    path = json.dumps({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {}, "geometry": {
        "type": "LineString", "coordinates": [[9.99, latitude], [10.01, latitude]]}}]})
    (here / "line.geojson").write_text(path)
    with dspace.Session() as session, session.record(tmp_path / "run.dspace", pack=True):
        scene = session.scene()
        terrain = scene.add_terrain(str(here / "ground.tif"), mode="clipmap")
        terrain.add_shapes(str(here / "line.geojson"), pixels=4, line=(1, 0, 0))
        camera = scene.add_camera("camera", eye=(0, -1, 60), target=(0, 0, 0))
        scene.add_viewport((160, 120), camera, name="view")
        scene.time = 1.0
        live = session.viewports["view"].image()
    with RecordingFile(tmp_path / "run.dspace") as file:
        grids = [asset for asset in file.assets if asset.path.endswith("BETA2007.gsb")]
        assert [(each.path, each.state, each.packed) for each in grids] == [(str(proj / "BETA2007.gsb"), "read", True)]
    # Where PROJ has its database and no grids.
    (tmp_path / "proj").mkdir()
    (tmp_path / "proj/proj.db").symlink_to(proj / "proj.db")
    here.rename(tmp_path / "away")
    script = ("import sys, numpy, dspace\n"
              "with dspace.Playback(sys.argv[1]) as run:\n"
              "    run.step(1000)\n"
              "    numpy.save(sys.argv[2], run.session.viewports['view'].image())\n")
    environment = {**os.environ, "PROJ_DATA": str(tmp_path / "proj"), "PROJ_LIB": str(tmp_path / "proj")}
    subprocess.run([sys.executable, "-W", "ignore", "-c", script, str(tmp_path / "run.dspace"), str(tmp_path / "a.npy")],
                   check=True, env=environment)
    assert numpy.array_equal(numpy.load(tmp_path / "a.npy"), live)
    red = (live[..., 0] > 150) & (live[..., 1] < 90)
    assert 200 < red.sum() < 5000
    # And without the grid it would be another picture: the line is elsewhere.
    with sqlite3.connect(tmp_path / "run.dspace") as database:
        database.execute("DELETE FROM content WHERE asset = ?", (grids[0].id,))
        database.execute("DELETE FROM asset WHERE id = ?", (grids[0].id,))
    subprocess.run([sys.executable, "-W", "ignore", "-c", script, str(tmp_path / "run.dspace"), str(tmp_path / "b.npy")],
                   check=True, env=environment)
    assert not numpy.array_equal(numpy.load(tmp_path / "b.npy"), live)
