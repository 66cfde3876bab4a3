"""Rasters and shapes that lead to other files, opened by a server and out of a packed recording: what they lead to is
neither read nor changed."""
import base64
import contextlib
import ctypes
import os
import struct
import subprocess
import sys
import zlib

import numpy
import pytest

import dspace
from dspace.links.serving import ServerProcess
from dspace.proto import commands_pb2 as pb
from recording_support import write_packed
from terrain_support import gdal

GRID = "ncols 4\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 1\n" + "1 2 3 4\n" * 4
FLAT = 'LOCAL_CS["flat",UNIT["metre",1]]'

# Of 1,648 bytes, made with libhdf5 (H5Pset_external): 4 x 4 floats whose bytes are in another file, named by "/" and
# 199 times "n".
HDF5 = ("eNrr9HBx4+WS4mIAAQ4OBhYGAQZk8B8KCthQ+TD5BCjNCKU7oPQKJpg4I1hOAiouCDUfXV1IkKsrSPV/NACzR4MVQnMwjIKRCDxcHQNAdASUD0ul"
        "J5hQ1WWkZqZnlBTD06MHhfYyMrBDzGKE8TUgNBNEgAWqDhfNDEz5IJWCCvJQMQUGcQ4G8XqoPCswRYPkmZggBrIDzWeEWgfKOQYs2NO9AwNMHJKz"
        "mBlhOcYBRZ0QVCfIvFhB5mwGBguqxMMNtHwfwIKqTj9veACYf4L9/F1A8QGLBwXm0TxJDgAAfX2RNQ==")


def tiff(path, value):
    data = gdal.GetDriverByName("GTiff").Create(str(path), 64, 64, 1, gdal.GDT_Byte)
    data.SetGeoTransform((0, 1, 0, 64, 0, -1))
    data.GetRasterBand(1).Fill(value)


def mrf(inside, outside):
    """A cache of another raster: what it reads there is appended to the file that it names."""
    tiff(outside / "source.tif", 7)
    (outside / "victim").write_text("untouched")
    (inside / "a.mrf").write_text(
        f'<MRF_META><CachedSource><Source>{outside}/source.tif</Source></CachedSource><Raster><Size x="64" y="64" '
        'c="1"/><PageSize x="64" y="64" c="1"/><Compression>NONE</Compression><DataType>Byte</DataType>'
        f"<DataFile>{outside}/victim</DataFile><IndexFile>{outside}/victim.idx</IndexFile></Raster>"
        '<GeoTags><BoundingBox minx="0" miny="0" maxx="64" maxy="64"/></GeoTags></MRF_META>')
    return "a.mrf"


def hdf5(inside, outside):
    """Its heights are the bytes of another file."""
    (outside / "secret").write_bytes(struct.pack("<16f", *range(16)))
    name = os.fsencode(outside / "secret")
    content = zlib.decompress(base64.b64decode(HDF5))
    (inside / "a.h5").write_bytes(content.replace(b"/" + b"n" * 199, name.ljust(200, b"\0")))
    return "a.h5"


def wms(inside, outside):
    """Tags in lower case, tiles of the disk, and a folder for them to be written to."""
    memory = gdal.GetDriverByName("MEM").Create("", 64, 64, 1)
    memory.GetRasterBand(1).Fill(9)
    gdal.GetDriverByName("PNG").CreateCopy(str(outside / "secret-0.png"), memory)
    (outside / "secret-0.png.aux.xml").unlink(missing_ok=True)
    (inside / "a.xml").write_text(
        f'<gdal_wms><service name="TMS"><serverurl>file://{outside}/secret-${{z}}.png</serverurl></service><datawindow>'
        "<upperleftx>0</upperleftx><upperlefty>64</upperlefty><lowerrightx>64</lowerrightx><lowerrighty>0</lowerrighty>"
        "<tilelevel>0</tilelevel><sizex>64</sizex><sizey>64</sizey></datawindow><blocksizex>64</blocksizex>"
        f"<blocksizey>64</blocksizey><bandscount>1</bandscount><cache><path>{outside}/cache</path></cache></gdal_wms>")
    return "a.xml"


def overview(inside, outside):
    """Its side file names another raster as its overview."""
    tiff(inside / "a.tif", 3)
    tiff(outside / "secret.tif", 5)
    (inside / "a.tif.aux.xml").write_text('<PAMDataset><Metadata domain="OVERVIEWS"><MDI key="OVERVIEW_FILE">'
                                          f"{outside}/secret.tif</MDI></Metadata></PAMDataset>")
    return "a.tif"


def shapes(inside, outside):
    """For the word of PDS4 GDAL reads more of the file's head than others look at: there is the VRT's word."""
    (outside / "secret.json").write_text('{"type":"FeatureCollection","features":[{"type":"Feature","properties":{},'
                                         '"geometry":{"type":"LineString","coordinates":[[0,0],[3,3]]}}]}')
    (inside / "a.vrt").write_text(
        "<!-- Product_Observational " + " " * 1200 + '-->\n<OGRVRTDataSource><OGRVRTLayer name="secret"><SrcDataSource>'
        f"{outside}/secret.json</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>")
    return "a.vrt"


ATTACKS = {each.__name__: each for each in (mrf, hdf5, wms, overview, shapes)}
SAID = {"mrf": "its format is 'MRF'", "hdf5": "its format is '", "wms": "its format is 'WMS'", "overview": "OVERVIEW_FILE",
        "shapes": "its format is '"}


@contextlib.contextmanager
def watched(folder):
    """A list that has, at the end, the names in a folder that any process opened, read, changed or made: inotify's."""
    libc = ctypes.CDLL(None, use_errno=True)
    descriptor = libc.inotify_init1(os.O_NONBLOCK)
    assert descriptor >= 0 and libc.inotify_add_watch(descriptor, os.fsencode(folder), 0xFFF & ~0x18) >= 0
    names = []
    try:
        yield names
        with contextlib.suppress(BlockingIOError):
            while data := os.read(descriptor, 1 << 16):
                while data:
                    mask, size = struct.unpack_from("4xI4xI", data)
                    if not mask & 0x40000000:  # the folder itself may be looked at
                        names.append(os.fsdecode(data[16:16 + size].rstrip(b"\0")))
                    data = data[16 + size:]
    finally:
        os.close(descriptor)


@pytest.fixture(params=ATTACKS)
def attack(request, tmp_path):
    """(its name, the folder that is allowed, the file in it, the folder that is not)."""
    inside, outside = tmp_path / "inside", tmp_path / "outside"
    inside.mkdir()
    outside.mkdir()
    (inside / "ground.asc").write_text(GRID)
    name = ATTACKS[request.param](inside, outside)
    return request.param, inside, inside / name, outside


def opened(scene, name, inside, path):
    """As an attacker's simulation does."""
    if name == "shapes":
        terrain = scene.add_terrain(str(inside / "ground.asc"), mode="clipmap", crs=FLAT, build_overviews=False)
        terrain.add_shapes(str(path), crs=FLAT)
    else:
        more = {"pixel_size": 1.0} if name == "hdf5" else {}
        terrain = scene.add_terrain(str(path), mode="clipmap", crs=FLAT, build_overviews=False, **more)
        terrain.heights(numpy.zeros((1, 2)))


def content(folder):
    return {str(each): each.read_bytes() for each in folder.rglob("*") if each.is_file()}


def test_without_confinement_it_would_lead_out(attack):
    """Else the other tests would test nothing."""
    name, inside, path, outside = attack
    before = content(outside)
    with watched(outside) as touched, dspace.Session() as session:
        opened(session.scene(), name, inside, path)
    assert touched
    assert (content(outside) != before) == (name in ("mrf", "wms"))


def test_a_server_rejects_it(attack):
    name, inside, path, outside = attack
    before = content(outside)
    with watched(outside) as touched:
        with ServerProcess([str(inside)]) as server, dspace.connect(server.address) as session:
            scene = session.scene()
            with pytest.raises(dspace.Error) as error:
                opened(scene, name, inside, path)
            # And goes on.
            scene.add_terrain(str(inside / "ground.asc"), name="ground", mode="clipmap", crs=FLAT)
    assert str(path) in str(error.value) and SAID[name] in str(error.value)
    assert touched == [] and content(outside) == before


def commands_for(name, inside, path):
    ground = pb.Command(scene="scene")
    ground.open_terrain.name = "ground"
    ground.open_terrain.path = str(inside / "ground.asc" if name == "shapes" else path)
    ground.open_terrain.crs, ground.open_terrain.build_overviews = FLAT, False
    ground.open_terrain.mode = ground.open_terrain.CLIPMAP
    commands = [pb.Command(scene="scene"), ground]
    commands[0].create_scene.SetInParent()
    if name == "hdf5":
        ground.open_terrain.pixel_size = 1.0
    if name == "shapes":
        commands.append(pb.Command(scene="scene"))
        commands[-1].add_terrain_layer.terrain = "ground"
        commands[-1].add_terrain_layer.shapes.path = str(path)
        commands[-1].add_terrain_layer.shapes.crs = FLAT
    return commands


def test_a_packed_recording_is_rejected(attack, tmp_path):
    name, inside, path, outside = attack
    write_packed(tmp_path / "run.dspace", inside, commands_for(name, inside, path))
    before = content(outside)
    with watched(outside) as touched, pytest.raises(dspace.Corrupt) as error:
        with dspace.Playback(tmp_path / "run.dspace") as run:
            run.step(1000)
    assert path.name in str(error.value) and SAID[name] in str(error.value)
    assert touched == [] and content(outside) == before


@pytest.mark.parametrize("attack", ["mrf", "wms"], indirect=True)  # documents that GDAL takes as a name
def test_a_recording_gives_no_document_as_a_name(attack, tmp_path):
    """Nor where nothing is packed."""
    name, inside, path, outside = attack
    before = content(outside)
    (tmp_path / "nothing").mkdir()
    for number, text in enumerate((path.read_text().strip(), "/vsimem/a", f"MRF:1:{path}")):
        write_packed(tmp_path / f"{number}.dspace", tmp_path / "nothing", commands_for(name, inside, text))
        with watched(outside) as touched, pytest.raises(dspace.Corrupt, match="accepted here|no such file"):
            dspace.Playback(tmp_path / f"{number}.dspace").close()
        assert touched == [] and content(outside) == before


def test_dspace_play_rejects_it(attack, tmp_path):
    name, inside, path, outside = attack
    write_packed(tmp_path / "run.dspace", inside, commands_for(name, inside, path))
    with watched(outside) as touched:
        done = subprocess.run([sys.executable, "-m", "dspace", "play", str(tmp_path / "run.dspace")],
                              capture_output=True, text=True)
    assert done.returncode == 1 and path.name in done.stderr and SAID[name] in done.stderr
    assert touched == []


@pytest.mark.parametrize("attack", ["mrf", "hdf5", "wms", "shapes"], indirect=True)  # the other one is a GeoTIFF
def test_a_confined_process_opens_no_other_formats(attack):
    """Whoever asks GDAL, and also once its drivers have been registered again."""
    name, inside, path, outside = attack
    script = ("import sys\nfrom dspace import vtk\nvtk.vtkDspaceSession().ConfineProcess()\nfrom osgeo import gdal\n"
              "gdal.AllRegister()\n"
              "print(gdal.OpenEx(sys.argv[1]) is None, gdal.OpenEx(sys.argv[2]) is not None)")
    with watched(outside) as touched:
        done = subprocess.run([sys.executable, "-W", "ignore", "-c", script, str(path), str(inside / "ground.asc")],
                              capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["True", "True"] and touched == []


def mosaic(folder, source):
    (folder / "a.vrt").write_text(
        '<VRTDataset rasterXSize="4" rasterYSize="4"><GeoTransform>0, 1, 0, 4, 0, -1</GeoTransform><VRTRasterBand '
        'dataType="Float32" band="1"><SimpleSource><SourceFilename relativeToVRT="1">'
        f"{source}</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>")
    return folder / "a.vrt"


def test_a_mosaic_of_allowed_files_is_served_and_played(tmp_path):
    (tmp_path / "ground.asc").write_text(GRID)
    path = mosaic(tmp_path, "ground.asc")
    xy = numpy.array([[1.0, 0.5], [0.0, 0.0]])
    with dspace.Session() as session:
        local = session.scene().add_terrain(str(path), mode="clipmap", crs=FLAT).heights(xy)
    assert numpy.isfinite(local).all()
    with ServerProcess([str(tmp_path)]) as server, dspace.connect(server.address) as session:
        terrain = session.scene().add_terrain(str(path), mode="clipmap", crs=FLAT)
        assert numpy.array_equal(terrain.heights(xy), local)
    with dspace.Session() as session, session.record(tmp_path / "run.dspace", pack=True):
        session.scene().add_terrain(str(path), name="ground", mode="clipmap", crs=FLAT)
    os.rename(tmp_path / "ground.asc", tmp_path / "gone")
    with dspace.Playback(tmp_path / "run.dspace") as run:
        run.step(1000)
        assert numpy.array_equal(run.session.scene().terrains["ground"].heights(xy), local)


def test_a_mosaic_of_an_attack_is_rejected(tmp_path):
    (tmp_path / "inside").mkdir()
    (tmp_path / "outside").mkdir()
    path = mosaic(tmp_path / "inside", mrf(tmp_path / "inside", tmp_path / "outside"))
    with watched(tmp_path / "outside") as touched:
        with ServerProcess([str(tmp_path / "inside")]) as server, dspace.connect(server.address) as session:
            with pytest.raises(dspace.Unsupported, match="a.mrf.*its format is 'MRF'"):
                session.scene().add_terrain(str(path), mode="clipmap", crs=FLAT)
    assert touched == []


def test_a_program_that_plays_keeps_its_own_rasters(tmp_path):
    """A Playback restricts its own commands, not the process."""
    (tmp_path / "inside").mkdir()
    (tmp_path / "outside").mkdir()
    path = tmp_path / "inside" / hdf5(tmp_path / "inside", tmp_path / "outside")
    commands = commands_for("hdf5", tmp_path / "inside", path)[:1]
    write_packed(tmp_path / "run.dspace", tmp_path / "inside", commands)
    with dspace.Playback(tmp_path / "run.dspace") as run:
        run.step(1000)
        assert gdal.Open(str(path)).ReadAsArray().sum() == 120.0
        with dspace.Session() as session:
            session.scene().add_terrain(str(path), mode="clipmap", crs=FLAT, pixel_size=1.0)


def test_a_server_rejects_what_would_take_too_long(tmp_path):
    """Mosaics of mosaics, ten-fold and five deep, and a raster of the largest size that GDAL knows. It goes on at once."""
    (tmp_path / "m0.asc").write_text(GRID)
    for level in range(1, 6):
        inner = "m0.asc" if level == 1 else f"m{level - 1}.vrt"
        path = mosaic(tmp_path, inner)
        text = path.read_text()
        begin, end = text.index("<SimpleSource>"), text.index("</VRTRasterBand>")
        (tmp_path / f"m{level}.vrt").write_text(text[:begin] + text[begin:end] * 10 + text[end:])
    large = mosaic(tmp_path, "m0.asc")
    large.write_text(large.read_text().replace('Size="4"', 'Size="2147483647"'))
    with ServerProcess([str(tmp_path)]) as server, dspace.connect(server.address) as session:
        scene = session.scene()
        with pytest.raises(dspace.Resource, match="makes more files be opened.*the limit mosaic_files is 20000"):
            scene.add_terrain(str(tmp_path / "m5.vrt"), mode="clipmap", crs=FLAT)
        with pytest.raises(dspace.Resource, match="2147483647 x 2147483647 pixels; the limit raster_pixels is"):
            scene.add_terrain(str(large), mode="clipmap", crs=FLAT)
        ground = scene.add_terrain(str(tmp_path / "m2.vrt"), mode="clipmap", crs=FLAT, build_overviews=False)
        assert numpy.isfinite(ground.height(1.0, 0.5))
    with dspace.Session() as session, pytest.raises(dspace.Resource, match="the limit raster_pixels is"):
        session.scene().add_terrain(str(large), mode="clipmap", crs=FLAT)
