"""The data that ships: as its generators make it, sound, and distributed as its README says."""
import json
import struct
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest

from needs import needs_module

DATA = Path(__file__).resolve().parents[3] / "Data"
sys.path.append(str(DATA / "generators"))
sys.path.append(str(DATA.parent / "Wrapping" / "Python"))

import make_field  # noqa: E402
import make_rover  # noqa: E402

gdal = needs_module("osgeo.gdal", "python3-gdal")
MESHES = sorted(p.name for p in (DATA / "rover").iterdir() if p.suffix in (".glb", ".gltf"))


# --- rover ---------------------------------------------------------------------------------------

def read_gltf(path):
    """The document and its accessors as arrays: an independent reader of what write_gltf writes."""
    raw = path.read_bytes()
    if path.suffix == ".glb":
        magic, version, size = struct.unpack_from("<4sII", raw)
        assert (magic, version, size) == (b"glTF", 2, len(raw))
        n = struct.unpack_from("<I", raw, 12)[0]
        document, blob = json.loads(raw[20:20 + n]), raw[28 + n:]
    else:
        document = json.loads(raw)
        blob = (path.parent / document["buffers"][0]["uri"]).read_bytes()
    assert document["buffers"][0]["byteLength"] == len(blob)
    arrays = []
    for a in document["accessors"]:
        view = document["bufferViews"][a["bufferView"]]
        kind = {5126: "<f4", 5123: "<u2"}[a["componentType"]]
        width = {"VEC3": 3, "VEC2": 2, "SCALAR": 1}[a["type"]]
        arrays.append(np.frombuffer(blob, kind, a["count"] * width, view["byteOffset"]).reshape(-1, width))
    return document, arrays


def primitives(path):
    document, arrays = read_gltf(path)
    for mesh in document["meshes"]:
        for p in mesh["primitives"]:
            yield (arrays[p["attributes"]["POSITION"]].astype(float),
                   arrays[p["attributes"]["NORMAL"]].astype(float), arrays[p["indices"]].reshape(-1, 3))


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("rover")
    make_rover.make(folder)
    return folder


@pytest.mark.parametrize("name", MESHES)
def test_meshes_are_as_generated(made, name):
    for (p, n, t), (q, m, u) in zip(primitives(DATA / "rover" / name), primitives(made / name), strict=True):
        assert np.array_equal(t, u)
        assert np.abs(p - q).max() < 1e-6 and np.abs(n - m).max() < 1e-4


def test_rest_of_the_rover_is_as_generated(made):
    shipped = {p.name for p in (DATA / "rover").iterdir()} - {"README.md"}
    assert shipped == {p.name for p in made.iterdir()}
    assert (DATA / "rover" / "rover.urdf").read_text() == (made / "rover.urdf").read_text()
    read = lambda folder: gdal.Open(str(folder / "deck.png")).ReadAsArray()
    assert np.array_equal(read(DATA / "rover"), read(made))
    assert sum(p.stat().st_size for p in (DATA / "rover").iterdir()) < 1_000_000


@pytest.mark.parametrize("name", MESHES)
def test_meshes_are_closed_and_wound_outwards(name):
    for p, n, t in primitives(DATA / "rover" / name):
        assert np.abs(np.linalg.norm(n, axis=1) - 1).max() < 1e-5
        _, weld = np.unique(np.round(p, 6), axis=0, return_inverse=True)
        w = weld.ravel()[t]
        # Every edge is run as often one way as the other.
        edges = np.concatenate([w[:, [0, 1]], w[:, [1, 2]], w[:, [2, 0]]])
        ways, count = np.unique(edges, axis=0, return_counts=True)
        table = {tuple(e): c for e, c in zip(ways.tolist(), count)}
        assert all(table.get((b, a)) == c for (a, b), c in table.items())
        # Components by welded vertices; each encloses a positive volume.
        label = np.arange(w.max() + 1)
        while True:
            least = label[w].min(axis=1)
            before = label.copy()
            for k in range(3):
                np.minimum.at(label, w[:, k], least)
            if np.array_equal(before, label):
                break
        six = np.einsum("ni,ni->n", p[t[:, 0]], np.cross(p[t[:, 1]], p[t[:, 2]]))
        volume = np.bincount(label[w[:, 0]], six / 6, minlength=len(label))
        assert (volume[np.unique(label)] > 0).all()
        # Normals stand on the side that the winding says.
        face = np.cross(p[t[:, 1]] - p[t[:, 0]], p[t[:, 2]] - p[t[:, 0]])
        assert (np.einsum("ni,nki->nk", face, n[t]) > 0).all()


def test_urdf_is_one_tree_with_files_and_limits():
    robot = ElementTree.parse(DATA / "rover" / "rover.urdf").getroot()
    links = [e.get("name") for e in robot.findall("link")]
    joints = robot.findall("joint")
    names = [j.get("name") for j in joints]
    assert len(set(links)) == len(links) and len(set(names)) == len(names)
    children = [j.find("child").get("link") for j in joints]
    assert sorted(children) == sorted(set(links) - {"chassis"})  # one parent each, root chassis
    parent = {j.find("child").get("link"): j.find("parent").get("link") for j in joints}
    for link in links:
        steps = 0
        while link != "chassis":
            link, steps = parent[link], steps + 1
            assert steps <= len(links)
    for mesh in robot.iter("mesh"):
        assert (DATA / "rover" / mesh.get("filename")).exists()
    for j in joints:
        if j.get("type") == "revolute":
            assert float(j.find("limit").get("lower")) < float(j.find("limit").get("upper"))
        if j.find("mimic") is not None:
            assert j.find("mimic").get("joint") in names
            assert float(j.find("mimic").get("multiplier")) == -1.0
    readme = (DATA / "rover" / "README.md").read_text(encoding="utf-8")
    assert [n for n in names if f"`{n}`" not in readme] == []


# --- field ---------------------------------------------------------------------------------------

@pytest.fixture(scope="module")
def field():
    data = gdal.Open(str(DATA / "field" / "field.tif"))
    return data, data.ReadAsArray()


def test_field_is_as_generated(field):
    z = make_field.heights()
    off = np.abs(z.astype(float) - field[1])
    assert off.max() <= make_field.Field.quantum  # rounding of the FFT may move a height by one step
    assert (off > 0).mean() < 1e-4
    color = gdal.Open(str(DATA / "field" / "field_color.tif")).ReadAsArray()
    assert (color != make_field.colours(field[1])).mean() < 1e-3
    assert (DATA / "field" / "field.tif").stat().st_size < 2_000_000


def test_field_georeference(field):
    data, z = field
    f = make_field.Field
    assert z.shape == (f.posts, f.posts) and z.dtype == np.float32
    assert np.array_equal(z / np.float32(f.quantum), np.round(z / np.float32(f.quantum)))
    g = data.GetGeoTransform()
    assert np.allclose(g, (-100.1, 0.2, 0, 100.1, 0, -0.2), atol=1e-9)  # posts from -100 to 100 m
    srs = data.GetSpatialRef()
    assert srs.IsProjected() and srs.GetLinearUnits() == 1.0
    assert srs.GetSemiMajor() == 1737400.0 and srs.GetInvFlattening() == 0.0
    assert "Moon" in srs.GetAttrValue("GEOGCS")
    assert data.GetMetadataItem("VERTICAL_DATUM") == "sphere:1737400"


def test_crater_sizes_follow_the_stated_power_law():
    f = make_field.Field
    d = make_field.crater_catalogue()[:, 2]
    assert d.min() >= f.smallest and d.max() <= f.largest

    # Maximum likelihood for a power law cut off at both ends, on a fine scan of exponents.
    b = np.linspace(1.5, 2.5, 2001)
    likelihood = (np.log(b) - np.log(f.smallest ** -b - f.largest ** -b)) * len(d) - (b + 1) * np.log(d).sum()
    fitted = b[np.argmax(likelihood)]
    assert abs(fitted - f.exponent) < 3 * f.exponent / np.sqrt(len(d))  # three standard errors
    side = (f.posts - 1) * f.spacing + 2 * f.largest
    for size in (1.0, 3.0, 8.0):
        expected = f.coefficient * side ** 2 * (size ** -f.exponent - f.largest ** -f.exponent)
        assert abs((d >= size).sum() - expected) < 4 * np.sqrt(expected)


def test_fresh_craters_have_published_proportions():
    for diameter in (5.0, 30.0):
        s = np.linspace(0, 4, 4001)
        z = make_field.fresh_profile(s, diameter)
        km = diameter / 1000
        assert z.max() - z[0] == pytest.approx(196 * km ** 1.010, rel=1e-6)
        assert z.max() == pytest.approx(36 * km ** 1.014, rel=1e-2)
        assert s[np.argmax(z)] == pytest.approx(1.0, abs=2e-3)


def test_wear_moves_soil_but_loses_none():
    s, z = make_field.worn_profiles([1e-6, 0.05, 0.3], 10.0)
    volume = (z * s).sum(axis=1)
    assert np.allclose(volume, volume[0], rtol=1e-9)
    depth = z.max(axis=1) - z[:, 0]
    assert depth[0] > depth[1] > depth[2] > 0


def test_relief_has_the_stated_roughness():
    f = make_field.Field
    z = make_field.fractal_relief()
    rms = lambda lag: np.sqrt(np.mean((z[:, lag:] - z[:, :-lag]) ** 2))
    assert rms(5) == pytest.approx(f.deviation, rel=0.05)  # over 1 m
    slope = np.log(rms(20) / rms(5)) / np.log(4)
    assert slope == pytest.approx(f.hurst, abs=0.08)


def test_suggested_route_is_drivable(field):
    from dspace.rover import GridTerrain, Path as Route, load_vehicle
    route = json.loads((DATA / "field" / "route.json").read_text())
    path = Route(route["way_points_m"], route["speed_m_per_s"], route["ramp_s"])
    terrain = GridTerrain.from_file(DATA / "field" / "field.tif")
    rover = load_vehicle(DATA / "rover" / "rover.urdf")
    states = rover.drive(path, np.linspace(0, path.duration, 400), terrain)
    assert max(s.tilt_deg for s in states) < 25
    assert not any(s.beyond_limits for s in states)
    assert max(s.residual for s in states) < 1e-3
    assert np.abs([s.position[:2] for s in states]).max() < 90
