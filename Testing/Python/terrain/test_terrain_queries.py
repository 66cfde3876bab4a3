"""Aspect, roughness and rays through Python: a plane and a ball of which all is known."""
import numpy as np
import pytest

import dspace
from terrain_support import FIELD, gdal, real, write_raster
from vtkmodules.util.numpy_support import vtk_to_numpy

EAST, NORTH = 0.2, -0.1  # rise, metres a metre


@pytest.fixture
def plane(scene, tmp_path):
    """Tilted ground of 200 x 200 m about the origin, a post a metre; a metre of noise in one corner."""
    x, y = np.meshgrid(np.arange(200) - 99.5, 99.5 - np.arange(200))
    z = EAST * x + NORTH * y
    corner = (x > 60) & (y > 60)
    z[corner] += np.where((np.indices(z.shape).sum(axis=0) % 2 == 0)[corner], 1.0, -1.0)
    return scene.add_terrain(write_raster(tmp_path / "plane.tif", z.astype(np.float32)),
                             mode="clipmap")


def test_aspect_is_the_way_down(plane):
    x, y = np.array([-50.0, 3.3, 40.7]), np.array([10.0, -60.2, -20.9])
    expected = np.degrees(np.arctan2(-EAST, -NORTH)) % 360
    np.testing.assert_allclose(plane.aspect_deg(x, y), expected, atol=1e-3)
    assert plane.aspect_deg(0.0, 0.0) == pytest.approx(expected, abs=1e-3)
    np.testing.assert_allclose(plane.slope_deg(x, y), np.degrees(np.arctan(np.hypot(EAST, NORTH))),
                               atol=1e-3)


def test_roughness_is_what_a_plane_leaves(plane):
    np.testing.assert_allclose(plane.roughness([-50.0, 0.0], [0.0, -40.0], 8.0), 0.0, atol=1e-4)
    # Ones and minus ones in turn: their root mean square about any plane of many of them is 1.
    assert plane.roughness(80.0, 80.0, 10.0) == pytest.approx(1.0, abs=0.01)


def test_rays_meet_the_plane_where_they_must(plane):
    random = np.random.default_rng(5)
    origins = random.uniform((-40, -40, 30), (20, 20, 60), (500, 3))
    directions = random.normal(size=(500, 3)) + (0, 0, -2)
    normal = np.array((-EAST, -NORTH, 1.0))
    unit = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    with np.errstate(divide="ignore"):
        expected = -(origins @ normal) / (unit @ normal)
    met = origins + expected[:, None] * unit
    inside = (expected > 0) & (np.abs(met[:, :2]) < 55).all(axis=1)
    assert inside.sum() > 100
    distances = plane.intersect(origins, directions)
    np.testing.assert_allclose(distances[inside], expected[inside], atol=1e-4)
    near = plane.intersect(origins, directions, maximum=20.0)
    np.testing.assert_array_equal(np.isfinite(near), np.isfinite(distances) & (distances <= 20.0))
    assert plane.intersect((0, 0, 50), (0, 0, 1)) == np.inf
    assert plane.intersect((0, 0, -50), (0, 0, 2)) == pytest.approx(50.0, abs=1e-4)  # from below


def test_rays_meet_mars(scene):
    mars = scene.add_terrain(real("mars_mola_megt90n000cb_4ppd_m.tif"), on_body=True,
                             vertical_datum="sphere:3396190")
    outside = np.array([[5e6, 0, 0], [0, -5e6, 0], [0, 0, 5e6]])
    distances = mars.intersect(outside, -outside)
    ground = 3396190 + mars.height(*outside.T)
    np.testing.assert_allclose(5e6 - distances, ground, atol=0.01)
    assert np.isinf(mars.intersect(outside[0], (0, 1, 0)))


def test_bad_queries_are_refused(scene, plane):
    for call in (lambda: plane.roughness(0, 0, -1), lambda: plane.roughness(0, 0, "wide"),
                 lambda: plane.intersect((0, 0, 1), (0, 0, 0)), lambda: plane.intersect((0, 0), (1, 0)),
                 lambda: plane.intersect((0, 0, np.nan), (0, 0, 1)),
                 lambda: plane.intersect((0, 0, 1), (0, 0, -1), maximum=-2)):
        with pytest.raises(dspace.Error):
            call()
    mesh = scene.add_terrain(FIELD, name="mesh", mode="triangles")
    with pytest.raises(dspace.Unsupported, match="clipmap"):
        mesh.roughness(0, 0, 5)
    assert np.isfinite(mesh.intersect((0, 0, 500), (0, 0, -1)))
    assert 0 <= mesh.aspect_deg(3, 4) <= 360


# --- The ground as polydata --------------------------------------------------------------------

def test_polydata_of_a_clipmap_is_its_posts(scene, tmp_path, refused):
    """Points lie where queries have the ground, with the raster's heights; the budget chooses the level; holes stay."""
    z = np.random.default_rng(6).uniform(0, 0.5, (64, 48)).astype(np.float32)
    z[10, 20] = -999
    data = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "rough.tif"), 48, 64, 1, gdal.GDT_Float32)
    data.SetGeoTransform((0, 1, 0, 64, 0, -1))
    data.GetRasterBand(1).SetNoDataValue(-999)
    data.GetRasterBand(1).WriteArray(z)
    del data  # writes it
    frame = scene.add_frame("site", position=(1e9, 2, 3), quaternion=(0.5, 0.5, 0.5, 0.5))
    ground = scene.add_terrain(tmp_path / "rough.tif", mode="clipmap", name="ground", frame=frame,
                               vertical_datum="relative", vertical_scale=1)
    whole = ground.object.to_polydata()
    points = vtk_to_numpy(whole.GetPoints().GetData())
    assert whole.GetNumberOfPolys() == 2 * 63 * 47 - 6  # six triangles meet at the hole
    assert points.dtype == float and len(points) == 64 * 48 - 1
    map = ground.to_map(points)
    column, row = np.floor(map[:, 0]).astype(int), np.floor(64 - map[:, 1]).astype(int)
    np.testing.assert_allclose(map[:, 2], z[row, column], atol=1e-4)
    np.testing.assert_allclose(points[:, 2], ground.height(points[:, 0], points[:, 1]), atol=1e-4)
    normals = vtk_to_numpy(whole.GetPointData().GetNormals())
    assert (normals[:, 2] > 0).all()
    coarse = ground.object.to_polydata(triangles=2000)
    assert 0 < coarse.GetNumberOfPolys() <= 2000
    corners = vtk_to_numpy(whole.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    a, b, c = (points[corners[:, k]] for k in range(3))
    assert (np.cross(b - a, c - a)[:, 2] > 0).all()  # counter-clockwise from above
    with refused(dspace.InvalidArgument, "triangles is 0"):
        ground.object.to_polydata(triangles=0)
    with refused(dspace.WrongType, "triangle_budget"):
        ground.object.to_polydata(triangles=2.5)
    box = scene.add_box((1, 1, 1), name="box")
    assert box.to_polydata(triangles=5).GetNumberOfPolys() == 12


def test_polydata_of_triangles_keeps_the_budget(scene, tmp_path):
    z = np.random.default_rng(7).uniform(0, 0.5, (100, 100)).astype(np.float32)
    ground = scene.add_terrain(write_raster(tmp_path / "rough.tif", z), mode="triangles")
    assert ground.object.to_polydata().GetNumberOfPolys() == ground.triangles
    assert 0 < ground.object.to_polydata(triangles=3000).GetNumberOfPolys() <= 3000
