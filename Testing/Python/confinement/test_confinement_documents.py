"""Documents that lead GDAL to other files and to servers: a confined process opens none of these and makes no socket.

The trace of `strace` judges. confinement_documents.py makes the documents, a row for each way."""
import http.server
import os
import subprocess
import sys
import threading

import pytest

import confinement_documents
import dspace
import recording_support
import traced_support as traced
from dspace.command_line import confinement
from dspace.proto import commands_pb2 as pb
from served_support import socket_folder
from terrain_support import gdal

FLAT = 'LOCAL_CS["flat",UNIT["metre",1]]'


class NotFound(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        self.send_error(404)

    do_HEAD = do_POST = do_GET

    def log_message(self, *_):
        pass


@pytest.fixture(scope="module")
def server():
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), NotFound) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


@pytest.fixture
def made(tmp_path, server):
    """(the documents, the folder outside)."""
    gdal.DontUseExceptions()
    gdal.PushErrorHandler("CPLQuietErrorHandler")
    documents = confinement_documents.make(tmp_path / "inside", tmp_path / "outside", server)
    gdal.PopErrorHandler()
    gdal.UseExceptions()
    (tmp_path / "inside" / "ground.asc").write_text(confinement_documents.GRID)
    return documents, tmp_path / "outside"


def content(folder):
    return {str(each): each.read_bytes() for each in folder.rglob("*") if each.is_file()}


def test_there_are_150_and_each_leads_out(made, tmp_path):
    """Else the other tests would test nothing: all of GDAL, unconfined, opens a file outside or connects."""
    documents, outside = made
    assert len(documents) >= 150 and len({each.name for each in documents}) == len(documents)
    traced.probe(tmp_path / "trace", documents)
    found = traced.by_document(tmp_path / "trace")
    harmless = [each.name for each in documents
                if not any(traced.opened(line, outside)[1] or traced.outgoing(line) for line in found.get(each.name, []))]
    assert harmless == []


def test_the_kernel_stops_all_of_gdal(made, tmp_path):
    """With every driver: the rules of `dspace serve` alone."""
    documents, outside = made
    before = content(outside)
    rules = confinement.Rules(listen="listen")
    rules.add("write", str(tmp_path / "inside"))
    traced.probe(tmp_path / "trace", documents, [confinement.program(), *rules.words, "--"])
    found = traced.by_document(tmp_path / "trace")
    assert len(found) == len(documents)  # each was tried
    assert [line for line in traced.lines(tmp_path / "trace") if traced.opened(line, outside)[1]] == []
    assert [line for each in found.values() for line in each if line.startswith("connect(") and not line.rstrip().endswith(
        "= -1 EPERM (Operation not permitted)")] == []
    assert content(outside) == before


def test_a_server_opens_none(made, tmp_path):
    documents, outside = made
    before = content(outside)
    inside = tmp_path / "inside"
    process = subprocess.Popen(
        [*traced.command(tmp_path / "trace"), sys.executable, "-W", "ignore", "-m", "dspace", "serve", "--end-with-input",
         "--listen", f"unix:{socket_folder(tmp_path)}/socket", "--allow-root", str(inside)],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    accepted = []
    try:
        address = process.stdout.readline().split()[-1]
        with dspace.connect(address) as session:
            scene = session.scene()
            ground = scene.add_terrain(str(inside / "ground.asc"), name="ground", mode="clipmap", crs=FLAT,
                                       build_overviews=False)
            for each in documents:
                ways = (lambda: ground.add_shapes(each.path, crs=FLAT),) if each.shapes else (
                    lambda: scene.add_terrain(each.path, mode="clipmap", crs=FLAT, pixel_size=1.0, build_overviews=False),
                    lambda: ground.add_image(each.path, crs=FLAT, extent=(0, 0, 8, 8)))
                for way in ways:
                    try:
                        way()
                        accepted.append(each.name)
                    except dspace.Error as error:
                        assert os.path.dirname(each.path) in str(error) or "outside of the folders" in str(error), str(error)
            assert ground.height(1.0, 1.0) == 1.0  # it goes on
    finally:
        process.stdin.close()
        process.wait(60)
        process.stdout.close()
    assert process.returncode == 0
    seen = [traced.opened(line, outside) for line in traced.lines(tmp_path / "trace")]
    assert [path for path, done in seen if done] == []
    assert [path for path, _ in seen if path] == []  # nor was one tried
    assert [line for line in traced.lines(tmp_path / "trace") if traced.outgoing(line)] == []
    assert content(outside) == before
    # Only those whose reference is left alone.
    assert set(accepted) <= {"geojson-crs-link", "geojson-crs-url"}


def commands_of(each, ground):
    """As a recording has them: a document as a terrain, or as shapes on one."""
    commands = [pb.Command(scene="scene"), pb.Command(scene="scene")]
    commands[0].create_scene.SetInParent()
    terrain = commands[1].open_terrain
    terrain.name, terrain.path, terrain.crs = "ground", ground if each.shapes else each.path, FLAT
    terrain.mode, terrain.pixel_size, terrain.build_overviews = terrain.CLIPMAP, 1.0, False
    if each.shapes:
        commands.append(pb.Command(scene="scene"))
        layer = commands[-1].add_terrain_layer
        layer.terrain, layer.shapes.path, layer.shapes.crs = "ground", each.path, FLAT
    return commands


# One of each family: a playback takes seconds.
PLAYED = ["vrt-ComplexSource", "vrt-warped", "vrt-vsicurl", "overview-png", "overview-on-server-tif", "ovr-mrf-tif", "mrf-cached",
          "wms-TMS", "wms-cache-lower", "isis3", "pds", "pds4", "dimap", "hdf5-external", "ogrvrt", "ogrvrt-on-server"]


def test_playback_opens_none(made, tmp_path):
    documents, outside = made
    before = content(outside)
    tried = [each for each in documents if each.name in PLAYED]
    assert len(tried) == len(PLAYED)
    for each in tried:
        folder = tmp_path / "inside" / each.name
        ground = folder / "ground.asc"
        ground.write_text(confinement_documents.GRID)
        recording_support.write_packed(tmp_path / f"{each.name}.dspace", folder, commands_of(each, str(ground)))
        log = tmp_path / f"trace-{each.name}"
        done = subprocess.run([*traced.command(log), sys.executable, "-W", "ignore", "-m", "dspace", "play",
                               str(tmp_path / f"{each.name}.dspace")], capture_output=True, text=True)
        assert done.returncode == 1 and each.name in done.stderr, (each.name, done.stderr)
        assert [line for line in traced.lines(log) if traced.opened(line, outside)[1] or traced.outgoing(line)] == []
    assert content(outside) == before
