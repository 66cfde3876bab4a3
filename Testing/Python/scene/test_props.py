"""Props of VTK as objects: volumes against a closed form, glyphs, image slices, and what is rejected."""
import warnings

import numpy as np
import pytest
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - the classes that draw
import vtkmodules.vtkRenderingVolumeOpenGL2  # noqa: F401
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPiecewiseFunction, vtkPlane, vtkPolyData
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersGeneral import vtkTransformPolyDataFilter
from vtkmodules.vtkFiltersSources import vtkCubeSource
from vtkmodules.vtkRenderingCore import (vtkActor, vtkAssembly, vtkColorTransferFunction, vtkFollower, vtkGlyph3DMapper, vtkImageSlice,
                                         vtkImageSliceMapper, vtkPolyDataMapper, vtkRenderer, vtkVolume,
                                         vtkVolumeProperty)
from vtkmodules.vtkRenderingImage import vtkImageResliceMapper
from vtkmodules.vtkRenderingVolume import vtkFixedPointVolumeRayCastMapper, vtkGPUVolumeRayCastMapper
from vtkmodules.vtkRenderingVolumeOpenGL2 import vtkSmartVolumeMapper

import dspace

OPACITY = 0.4  # of a metre of the fog


@pytest.fixture
def scene():
    with dspace.Session() as session:
        yield session.scene()


def image_of(array, spacing, origin):
    """A vtkImageData of an array (z, y, x)."""
    data = vtkImageData()
    data.SetDimensions(*array.shape[::-1])
    data.SetSpacing(*spacing)
    data.SetOrigin(*origin)
    values = numpy_to_vtk(np.ascontiguousarray(array).ravel(), deep=True)
    data.GetPointData().SetScalars(values)
    return data


def fog(mapper=None, size=2.0, color=(1.0, 0.5, 0.0)):
    """A cube of uniform fog about the origin."""
    n = 33
    data = image_of(np.full((n, n, n), 100, np.uint8), (size / (n - 1),) * 3, (-size / 2,) * 3)
    mapper = mapper or vtkGPUVolumeRayCastMapper()
    mapper.SetInputData(data)
    if mapper.IsA("vtkGPUVolumeRayCastMapper"):
        mapper.SetAutoAdjustSampleDistances(False)
        mapper.SetSampleDistance(0.005)
    opacity = vtkPiecewiseFunction()
    opacity.AddPoint(0, OPACITY)
    opacity.AddPoint(255, OPACITY)
    colors = vtkColorTransferFunction()
    colors.AddRGBPoint(0, *color)
    colors.AddRGBPoint(255, *color)
    look = vtkVolumeProperty()
    look.SetScalarOpacity(opacity)
    look.SetScalarOpacityUnitDistance(1.0)
    look.SetColor(colors)
    look.SetInterpolationTypeToLinear()
    look.ShadeOff()
    volume = vtkVolume()
    volume.SetMapper(mapper)
    volume.SetProperty(look)
    return volume


def fog_color(length, behind, color=(1.0, 0.5, 0.0)):
    """The display colour of `length` metres of fog over a colour, 0 to 255."""
    clear = (1.0 - OPACITY) ** length
    return 255.0 * (np.array(color) * (1.0 - clear) + np.array(behind) * clear)


def over_x(scene, fov_deg=None):
    """A viewport that looks along X from (-10, 0, 0), 1 sample a pixel."""
    size = {"height": 4.0} if fov_deg is None else {"fov_deg": fov_deg}
    scene.add_camera(eye=(-10, 0, 0), target=(0, 0, 0), near=0.1, far=100.0 if fov_deg is None else None, **size)
    view = scene.add_viewport(size=(80, 80), samples=1)
    view.set_background("#000000")
    return view


@pytest.mark.parametrize("fov_deg", [None, 20.0])
@pytest.mark.parametrize("root", [0.0, 1e8])
def test_a_volume_is_cut_by_what_stands_in_it_and_hidden_by_what_stands_before_it(scene, fov_deg, root):
    place = scene.add_frame("place", position=(root, 0, 0))
    scene.add_prop(fog(), frame=place, name="fog")
    size = {"height": 4.0} if fov_deg is None else {"fov_deg": fov_deg}
    scene.add_camera(frame=place, eye=(-10, 0, 0), target=(0, 0, 0), near=0.1,
                     far=100.0 if fov_deg is None else None, **size)
    view = scene.add_viewport(size=(80, 80), samples=1)
    wall = scene.add_box((0.2, 1, 1), frame=place, lit=False, color=(0.0, 0.0, 0.8))
    cases = {5.0: fog_color(2.0, (0, 0, 0.8)),   # behind all of it
             0.3: fog_color(1.2, (0, 0, 0.8)),   # its near face is 0.2 behind the middle
             -0.4: fog_color(0.5, (0, 0, 0.8)),
             -3.0: np.array([0, 0, 0.8]) * 255}  # before all of it
    for x, expected in cases.items():
        wall.set_offset(position=(x, 0, 0))
        image = view.image().astype(float)
        assert np.abs(image[40, 40, :3] - expected).max() < 3, (x, image[40, 40], expected)
    # Beside the wall is the fog over the background; the fog ends where its cube does.
    row = 26 if fov_deg is None else 21
    assert np.abs(view.image()[row, 40, :3] - fog_color(2.0, (0, 0, 0))).max() < 6
    assert view.image()[2, 2, :3].max() == 0
    labels = view.labels()
    assert set(np.unique(labels)) == {0, wall.id}, "fog is in no plane"
    assert view.pick(40, row) is None
    wall.visible = False
    assert np.isinf(view.depth()).all()


def test_surfaces_hide_translucent_props_and_let_them_through(scene):
    view = over_x(scene)
    scene.add_prop(fog(), name="fog")
    pane = scene.add_box((0.1, 2, 2), position=(-3, 0, 0), lit=False, color=(0.0, 1.0, 0.0), opacity=0.5)
    through = view.image()[40, 40, :3].astype(float)
    pane.visible = False
    alone = view.image()[40, 40, :3].astype(float)
    assert through[1] > alone[1] + 40 and 0.3 * alone[0] < through[0] < 0.9 * alone[0], (alone, through)


def test_a_smart_mapper_draws_the_same_fog(scene):
    view = over_x(scene)
    mapper = vtkSmartVolumeMapper()
    mapper.SetRequestedRenderModeToGPU()
    mapper.SetAutoAdjustSampleDistances(False)
    mapper.SetSampleDistance(0.005)
    scene.add_prop(fog(mapper))
    assert np.abs(view.image()[40, 40, :3] - fog_color(2.0, (0, 0, 0))).max() < 3


def glyphs(points, side):
    data = vtkPolyData()
    places = vtkPoints()
    for point in points:
        places.InsertNextPoint(*point)
    data.SetPoints(places)
    cube = vtkCubeSource()
    cube.SetXLength(side), cube.SetYLength(side), cube.SetZLength(side)
    mapper = vtkGlyph3DMapper()
    mapper.SetInputData(data)
    mapper.SetSourceConnection(cube.GetOutputPort())
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    actor.GetProperty().SetColor(0.8, 0.2, 0.4)
    return actor, cube


def test_glyphs_are_where_their_points_are_and_follow_their_pipeline(scene):
    view = over_x(scene)
    actor, cube = glyphs([(0, -1, 0), (0, 1, 0), (2, 0, 1)], 0.5)
    frame = scene.add_frame("frame", position=(0, 0, 0.25))
    arrows = scene.add_prop(actor, frame=frame, name="glyphs")
    box = scene.add_box((0.5, 0.5, 0.5), position=(1, 0, 1.25), name="before")  # hides the third
    depth, labels = view.depth(), view.labels()
    # 20 pixels a metre; X is away, Y left, Z up.
    assert depth[35, 60] == pytest.approx(9.75, rel=1e-5) and labels[35, 60] == arrows.id
    assert depth[35, 20] == pytest.approx(9.75, rel=1e-5) and labels[35, 20] == arrows.id
    assert labels[15, 40] == box.id and depth[15, 40] == pytest.approx(10.75, rel=1e-5)
    assert np.abs(view.image()[35, 60, :3] - np.array([204, 51, 102])).max() <= 1
    pick = view.pick(60, 35)
    assert pick.object == arrows and pick.in_frame == pytest.approx([-0.25, -1.0, 0.0], abs=0.05)
    box.visible = False
    assert view.labels()[15, 40] == arrows.id
    cube.SetXLength(1.5)
    assert view.render()
    assert view.depth()[35, 60] == pytest.approx(9.25, rel=1e-5)
    view.hide("physical")
    assert not view.labels().any()
    assert arrows.bounds[1] > 1.0 and arrows.drawer == "vtk:" + actor.GetClassName() and not arrows.left_out


def test_an_image_slice_has_its_colours_before_and_behind_a_box(scene):
    view = over_x(scene)
    values = np.zeros((1, 2, 2), np.uint8)
    values[0] = [[0, 80], [160, 255]]
    mapper = vtkImageSliceMapper()
    mapper.SetInputData(image_of(np.kron(values, np.ones((1, 8, 8), np.uint8)), (0.2, 0.2, 0.2), (-1.5, -1.5, 0)))
    part = vtkImageSlice()
    part.SetMapper(mapper)
    part.GetProperty().SetColorWindow(255)
    part.GetProperty().SetColorLevel(127.5)
    part.GetProperty().SetInterpolationTypeToNearest()
    # Its X is the scene's -Y (right in the picture), its Y the scene's Z, its normal -X.
    turned = dspace.Pose(quaternion=(0.5, 0.5, -0.5, -0.5)).quaternion
    picture = scene.add_prop(part, name="picture", quaternion=turned)
    box = scene.add_box((0.5, 1.2, 1.2), position=(3, 0, 0), lit=False, color="#ff0000")
    image = view.image()
    seen = {(y, x): int(image[y, x, 0]) for y in (30, 50) for x in (30, 50)}
    assert all(np.ptp(image[y, x, :3]) == 0 for y, x in seen), seen
    assert sorted(seen.values()) == [0, 80, 160, 255], seen
    assert (view.labels()[40, 40], view.depth()[40, 40]) == (picture.id, pytest.approx(10.0, rel=1e-5))
    box.set_offset(position=(-3, 0, 0))
    assert view.labels()[40, 40] == box.id and tuple(view.image()[40, 40, :3]) == (255, 0, 0)


def test_planes_of_mappers_go_with_the_frame(scene):
    """VTK takes clipping planes and the plane of a vtkImageResliceMapper in world coordinates."""
    view = over_x(scene)  # 20 pixels a metre; X is away, Y left, Z up
    frame = scene.add_frame("frame", position=(1.0, 0.5, 0.25), quaternion=(np.sqrt(0.5), 0, 0, np.sqrt(0.5)))
    mapper = vtkImageResliceMapper()
    mapper.SetInputData(image_of(np.full((9, 9, 9), 200, np.uint8), (0.25, 0.25, 0.25), (-1, -1, -1)))
    mapper.SliceFacesCameraOff()
    mapper.SliceAtFocalPointOff()
    mapper.GetSlicePlane().SetNormal(0, 1, 0)  # the scene's -X
    mapper.GetSlicePlane().SetOrigin(0, 0.5, 0)
    part = vtkImageSlice()
    part.SetMapper(mapper)
    picture = scene.add_prop(part, frame=frame, name="picture")
    labels, depth = view.labels(), view.depth()
    rows, columns = np.nonzero(labels == picture.id)
    assert depth[35, 30] == pytest.approx(10.5, rel=1e-5)  # 10 m away is X = 0, the frame at 1, the slice 0.5 nearer
    # 2 m wide, and half a pixel of the image more on each side at most.
    assert abs(columns.mean() - 29.5) < 0.6 and abs(rows.mean() - 34.5) < 0.6 and 39 <= np.ptp(columns) <= 46
    view.image()
    assert mapper.GetSlicePlane().GetOrigin() == (0, 0.5, 0) and not view.render()
    picture.remove()

    cube, plane = vtkCubeSource(), vtkPlane()
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(cube.GetOutputPort())
    plane.SetNormal(1, 0, 0)  # the scene's Y: what is left stays
    mapper.AddClippingPlane(plane)
    actor = vtkActor()
    actor.SetMapper(mapper)
    half = scene.add_prop(actor, frame=frame, name="half")
    columns = np.nonzero(view.labels() == half.id)[1]
    assert (columns.min(), columns.max()) == (20, 29)  # 0.5 m left of the frame
    plane.SetNormal(-1, 0, 0)  # VTK's time leaves it out
    columns = np.nonzero(view.labels() == half.id)[1]
    assert (columns.min(), columns.max()) == (30, 39)
    plane.SetNormal(1, 0, 0)
    actor.GetProperty().LightingOff()
    view.image()
    actor.GetShaderProperty().AddFragmentShaderReplacement(
        "//VTK::Light::Impl", True, "//VTK::Light::Impl\n  fragOutput0.rgb = vec3(0.0, 1.0, 0.0);", False)
    assert view.render() and tuple(view.image()[35, 25, :3]) == (0, 255, 0)
    view.image()
    assert plane.GetNormal() == (1, 0, 0) and not view.render()


def test_ornamental_props_are_not_in_physical_pictures(scene):
    view = over_x(scene)
    actor, _ = glyphs([(0, 0, 0)], 1.0)
    made = scene.add_prop(actor, ornamental=True)
    assert view.image()[40, 40, 0] == 204
    assert view.image(physical_only=True)[40, 40, :3].max() == 0
    assert not view.labels().any() and view.labels(physical_only=False)[40, 40] == made.id
    volume = scene.add_prop(fog(), ornamental=True)
    assert view.image(physical_only=True)[40, 26, :3].max() == 0
    volume.remove()


def with_mapper(prop, mapper):
    prop.SetMapper(mapper)
    return prop


@pytest.mark.parametrize("make, word", [
    (lambda: fog(vtkFixedPointVolumeRayCastMapper()), "vtkFixedPointVolumeRayCastMapper"),
    (vtkFollower, "camera"),
    (vtkActor, "no mapper"),
    (lambda: with_mapper(vtkActor(), vtkPolyDataMapper()), "has no input"),
    (lambda: with_mapper(vtkActor(), vtkGlyph3DMapper()), "has no input"),
    (vtkVolume, "no mapper"),
    (vtkRenderer, "vtkProp3D"),
    (lambda: None, "vtkProp3D"),
    (lambda: "volume", "vtkProp3D"),
])
def test_what_cannot_be_drawn_is_rejected(scene, make, word):
    with pytest.raises(dspace.Error, match=word):
        scene.add_prop(make())
    assert not scene.objects


def test_a_cpu_volume_is_rejected(scene):
    mapper = vtkSmartVolumeMapper()
    mapper.SetRequestedRenderModeToRayCast()
    with pytest.raises(dspace.InvalidArgument, match="CPU"):
        scene.add_prop(fog(mapper))


def test_a_prop_that_something_else_draws_is_rejected(scene):
    actor, _ = glyphs([(0, 0, 0)], 1.0)
    renderer = vtkRenderer()
    renderer.AddActor(actor)
    with pytest.raises(dspace.InvalidArgument, match="object 'mine': .* also in a renderer"):
        scene.add_prop(actor, name="mine")
    renderer.RemoveActor(actor)
    mine = scene.add_prop(actor, name="mine")
    with pytest.raises(dspace.InvalidArgument, match="object 'again'"):
        scene.add_prop(actor, name="again")
    with dspace.Session() as other, pytest.raises(dspace.InvalidArgument, match="scene"):
        other.scene().add_prop(actor)
    assert list(scene.objects) == ["mine"]
    mine.remove()
    assert scene.add_prop(actor, name="mine").name == "mine"


def test_settings_that_a_prop_does_not_have_are_rejected(scene):
    actor, _ = glyphs([(0, 0, 0)], 1.0)
    for settings in ({"color": "#ff0000"}, {"line_width": 2.0}, {"point_size": 3.0}):
        with pytest.raises(dspace.InvalidArgument, match="vtkProperty"):
            scene.add_prop(actor, **settings)
    made = scene.add_prop(actor)
    with pytest.raises(dspace.InvalidArgument, match="vtkProperty"):
        made.color = "#ff0000"
    with pytest.raises(dspace.AlreadyExists):
        scene.add_prop(glyphs([(0, 0, 0)], 1.0)[0], name=made.name)


def test_an_error_of_vtk_is_an_error_of_the_picture(scene):
    view = over_x(scene)
    actor, _ = glyphs([(0, 0, 0)], 1.0)
    scene.add_prop(actor)
    actor.SetMapper(None)
    with pytest.raises(dspace.Error):
        view.image()
        actor.SetMapper(vtkPolyDataMapper())  # without input
        view.image()


def test_a_recording_leaves_it_out_and_its_playback_says_so(tmp_path):
    path = tmp_path / "run.dspace"
    with dspace.Session() as session:
        scene = session.scene()
        with session.record(path):
            with pytest.warns(dspace.DspaceWarning, match="recording .* object 'fog' is drawn by 'vtk:"):
                scene.add_prop(fog(), name="fog")
            scene.add_box((1, 1, 1), name="box")
            scene.time = 1.0
            scene.objects["fog"].set_offset(position=(1, 2, 3))
            scene.time = 2.0
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        with dspace.Playback(path) as run:
            for step in (1, 0, 1):
                run.seek(run.times[step])
            made = run.session.scene().objects["fog"]
            assert made.left_out and made.drawer.startswith("vtk:")
            assert not run.session.scene().objects["box"].left_out
            assert tuple(made.offset[:3, 3]) == (1, 2, 3)
    texts = [str(each.message) for each in told if "fog" in str(each.message)]
    assert len(texts) == 1 and "nothing is drawn" in texts[0], texts


def test_a_recording_that_begins_later_leaves_it_out_too(tmp_path):
    path = tmp_path / "run.dspace"
    with dspace.Session() as session:
        scene = session.scene()
        scene.add_prop(fog(), name="fog")
        scene.add_box((1, 1, 1), name="box")
        session.scene("other").add_prop(fog(), name="smoke")
        with pytest.warns(dspace.DspaceWarning) as told:
            recording = session.record(path)
        texts = [str(each.message) for each in told]
        assert len(texts) == 2 and all(str(path) in text and "leaves out what it draws" in text for text in texts)
        assert "object 'smoke' is drawn by 'vtk:" in texts[0] and "object 'fog'" in texts[1]
        scene.time = 1.0
        recording.stop()
        scene.objects["fog"].remove()
        session.scene("other").objects["smoke"].remove()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            session.record(tmp_path / "without.dspace").stop()
    with pytest.warns(dspace.DspaceWarning, match="fog.*nothing is drawn|nothing is drawn.*fog"):
        with dspace.Playback(path) as run:
            run.seek(run.times[-1])
            assert run.session.scene().objects["fog"].left_out


def test_changes_anywhere_in_a_pipeline_are_seen(scene):
    """Of a second input, of a filter's transform, of an assembly's part, of a volume; without one nothing is drawn."""
    view = over_x(scene)
    actor, cube = glyphs([(0, -1, 0)], 0.5)
    shrink = vtkTransformPolyDataFilter()
    half = vtkTransform()
    shrink.SetTransform(half)
    shrink.SetInputConnection(cube.GetOutputPort())
    actor.GetMapper().SetSourceConnection(shrink.GetOutputPort())
    whole = vtkAssembly()
    whole.AddPart(actor)
    scene.add_prop(whole, name="glyphs")
    smoke = fog()
    smoke.SetPosition(0, 20, 0)
    scene.add_prop(smoke)
    assert view.depth()[40, 60] == pytest.approx(9.75, rel=1e-5)
    assert view.render() and not view.render()
    cube.SetXLength(1.5)
    assert view.render()
    assert view.depth()[40, 60] == pytest.approx(9.25, rel=1e-5)
    half.Scale(2, 1, 1)
    assert view.render()
    assert view.depth()[40, 60] == pytest.approx(8.5, rel=1e-5)
    smoke.GetMapper().GetInput().GetPointData().GetScalars().Modified()
    smoke.GetMapper().GetInput().Modified()
    assert view.render() and not view.render()


# --- Shadows -----------------------------------------------------------------------------------------

def cube(size=(1.0, 1.0, 1.0), opacity=1.0, center=(0.0, 0.0, 0.0)):
    source = vtkCubeSource()
    source.SetXLength(size[0])
    source.SetYLength(size[1])
    source.SetZLength(size[2])
    source.SetCenter(*center)
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetOpacity(opacity)
    return actor


def lit_floor(scene, eye=(4, -3, 4), target=(0.6, 0.6, 0)):
    """A floor under a Sun to the south-west, and its lit fraction in a picture."""
    floor = scene.add_plane(40, 40, color=(1, 1, 1), name="floor")
    scene.sun.set(azimuth_deg=225, elevation_deg=35)
    scene.add_camera("eye", eye=eye, target=target, fov_deg=50, near=0.1)
    view = scene.add_viewport(size=(160, 120), camera="eye", samples=1)

    def lit():
        planes = view.capture(False, lit_fraction=True, label=True, physical_only=True)
        return np.where(planes["label"] == floor.id, planes["lit_fraction"], np.nan)
    return lit


@pytest.mark.parametrize("target", [(0.6, 0.6, 0), (2.0, 2.3, 0)], ids=["in the picture", "outside of it"])
def test_a_prop_throws_the_shadow_of_the_same_box(scene, target):
    """Turned, stretched, and with a matrix of its own."""
    place = scene.add_frame("place", position=(0, 0, 1.2), quaternion=(np.cos(0.3), 0, 0, np.sin(0.3)))
    lit = lit_floor(scene, eye=(4, -3, 4) if target[0] < 1 else (1.0, 1.2, 1.5), target=target)
    bare = lit()
    assert (bare[np.isfinite(bare)] == 1).all()
    box = scene.add_box((1.5, 0.6, 0.8), frame=place, color=(1, 1, 1))
    expected = lit()
    box.remove()
    assert 0.02 < (expected < 0.1).sum() / np.isfinite(expected).sum() < 0.6
    actor = cube((0.75, 0.6, 0.4))
    moved = vtkTransform()
    moved.Scale(1.0, 1.0, 2.0)
    actor.SetUserTransform(moved)
    prop = scene.add_prop(actor, frame=place, stretch=(2, 1, 1))
    drawn = lit()
    both = np.isfinite(expected) & np.isfinite(drawn)
    assert both.mean() > 0.3
    assert (np.abs(drawn - expected)[both] > 0.05).sum() <= 2
    actor.VisibilityOff()
    np.testing.assert_array_equal(lit(), bare)
    actor.VisibilityOn()
    prop.visible = False
    np.testing.assert_array_equal(lit(), bare)


def test_what_of_props_throws_no_shadow(scene):
    lit = lit_floor(scene)
    bare = lit()
    wire = cube()
    wire.GetProperty().SetRepresentationToWireframe()
    dots = cube()
    dots.GetProperty().SetRepresentationToPoints()
    for prop, settings in ((fog(), {}), (cube(opacity=0.5), {}), (cube(), dict(ornamental=True)), (wire, {}), (dots, {})):
        added = scene.add_prop(prop, position=(-6, -6, 6), **settings)  # out of the picture, its shadow in the middle
        np.testing.assert_array_equal(lit(), bare)
        added.remove()
    assembly = vtkAssembly()
    assembly.AddPart(wire)
    added = scene.add_prop(assembly, position=(-6, -6, 6))
    np.testing.assert_array_equal(lit(), bare)
    assert wire.GetVisibility()
    added.remove()
    added = scene.add_prop(cube(), position=(-6, -6, 6))
    assert np.nansum(np.abs(lit() - bare)) > 20
    added.remove()


def test_props_beside_other_things_throw_their_shadows_together(scene, tmp_path):
    """Assemblies and glyphs; over streamed ground, and before meshes and other props are drawn."""
    from terrain_support import write_raster
    ground = scene.add_terrain(write_raster(tmp_path / "level.tif", np.zeros((65, 65)), 0.5), mode="clipmap", color=(1, 1, 1))
    scene.sun.set(azimuth_deg=180, elevation_deg=45)
    scene.add_camera("down", eye=(0, 2, 20), target=(0, 2, 0), up=(0, 1, 0), height=12, near=1)
    view = scene.add_viewport(size=(120, 120), camera="down", samples=1)
    assembly = vtkAssembly()
    assembly.AddPart(cube())
    assembly.AddPart(cube(center=(-2, 0, 0)))
    points = vtkPoints()
    points.InsertNextPoint(2, 0, 0)
    places = vtkPolyData()
    places.SetPoints(points)
    mapper = vtkGlyph3DMapper()
    mapper.SetInputData(places)
    part = cube()  # a connection does not keep it
    mapper.SetSourceConnection(part.GetMapper().GetInputConnection(0, 0))
    mapper.ScalingOff()
    glyphs = vtkActor()
    glyphs.SetMapper(mapper)
    scene.add_prop(glyphs, position=(0, 0, 3))
    scene.add_prop(assembly, position=(0, 0, 3))
    scene.add_box((1, 1, 1), position=(4, 0, 3), color=(1, 1, 1))
    planes = view.capture(False, lit_fraction=True, label=True)
    lit = np.where(planes["label"] == ground.object.id, planes["lit_fraction"], np.nan)
    column = lambda x: int((x + 6) * 10)  # noqa: E731
    row = int((8 - 3) * 10)  # shadows lie 3 m to the north of what throws them
    for x in (-2, 0, 2, 4):
        assert lit[row, column(x)] == 0, x
        assert lit[row, column(x) + 10] == 1, x
    # As by hand: a cube's shadow is 1 m wide and 2 m long, and its upper edge hides nothing of it here.
    shadow = (lit < 0.5).sum() / 100
    assert abs(shadow - 4 * 2.0) < 0.4, shadow
