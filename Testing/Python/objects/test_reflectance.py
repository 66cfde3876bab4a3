"""Photometric models of materials: what is drawn, what is read back, recordings, terrain; bad input by name."""
import numpy as np
import pytest

import dspace

MODELS = ("metallic-roughness", "lambert", "lommel-seeliger", "lunar-lambert", "hapke")


def display(linear):
    """sRGB of linear light (IEC 61966-2-1), 0 to 255."""
    return 255 * (12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055)


@pytest.fixture
def lit(session):
    """A scene with one light, 60 degrees from the normal of a plate that the camera sees straight on."""
    scene = session.scene("lit", lights=False)
    scene.add_light("sun", kind="directional", direction=(-np.sqrt(3) / 2, 0, -0.5))
    camera = scene.add_camera(eye=(0, 0, 5), target=(0, 0, 0), up=(0, 1, 0), height=4)
    view = scene.add_viewport((40, 40), camera, samples=1)
    view.fill = 0.0
    plate = scene.add_plane(10, 10, color=(1, 1, 1), metallic=0.0, roughness=1.0)
    return scene, view, plate


def test_each_model_is_its_formula(lit):
    _, view, plate = lit

    def shown():
        return int(view.image()[20, 20, 0])

    assert plate.reflectance is None
    assert abs(shown() - display(0.5)) <= 1  # Lambert: cos i
    plate.reflectance = "lommel-seeliger"
    assert abs(shown() - display(2 * 0.5 / 1.5)) <= 1
    plate.reflectance = {"model": "lunar-lambert", "lunar_weight": 0.25}
    assert abs(shown() - display(0.25 * 2 / 3 + 0.75 * 0.5)) <= 1
    plate.reflectance = "lunar-lambert"  # L at 60 degrees: 1 - 1.14 + 0.8712 - 0.31536
    assert abs(shown() - display(0.41584 * 2 / 3 + 0.58416 * 0.5)) <= 1
    # Smooth and isotropic, w = 1: H of Hapke (2002), r0 = 1; B(60) = B0 / (1 + tan 30 / h).
    plate.set_material(reflectance={"model": "hapke", "single_scattering_albedo": 1.0, "phase_asymmetry": 0.0,
                                    "opposition_amplitude": 1.0, "opposition_width": 0.1, "roughness_deg": 0.0})

    def h(x):
        return 1 / (1 - x * (1 + (1 - 2 * x) / 2 * np.log((1 + x) / x)))

    expected = 0.25 * 0.5 / 1.5 * (1 / (1 + 10 / np.sqrt(3)) + h(0.5) * h(1))
    assert abs(shown() - display(expected)) <= 1
    # Metal and roughness do not count but in the default model.
    plate.set_material(reflectance="lambert", roughness=0.2, metallic=1.0)
    assert abs(shown() - display(0.5)) <= 1
    plate.reflectance = None
    assert abs(shown() - display(0.5)) > 5


def test_it_reads_as_it_was_set(scene):
    ball = scene.add_sphere(1.0, reflectance="hapke")
    assert ball.reflectance["model"] == "hapke" and ball.reflectance["roughness_deg"] == 23.4
    ball.reflectance = {"model": "hapke", "phase_partition": -0.5}
    # A later one replaces the earlier one whole.
    ball.reflectance = dict(model="lunar-lambert")
    assert ball.reflectance == {"model": "lunar-lambert"}
    for model in MODELS:
        ball.reflectance = model
        assert ball.reflectance["model"] == model
    part = scene.add_mesh(np.eye(3), [[0, 1, 2]], reflectance="lommel-seeliger")
    assert part.reflectance == {"model": "lommel-seeliger"}


def test_recordings_and_snapshots_keep_it(tmp_path):
    path = tmp_path / "run.dspace"
    hapke = {"model": "hapke", "single_scattering_albedo": 0.2, "phase_asymmetry": 0.3, "phase_partition": 0.1,
             "opposition_amplitude": 2.0, "opposition_width": 0.05, "roughness_deg": 20.0}
    with dspace.Session() as session:
        scene = session.scene()
        ball = scene.add_sphere(1.0, name="ball", reflectance={"model": "lunar-lambert", "lunar_weight": 0.5})
        with session.record(path):
            scene.time = 1.0
            ball.reflectance = hapke
            scene.time = 2.0
    with dspace.Playback(path) as playback:
        playback.seek(1.0)
        ball = playback.session.scene().objects["ball"]
        playback.seek(2.0)
        assert ball.reflectance == hapke


def test_terrain_takes_it(scene, field):
    for mode in ("triangles", "clipmap"):
        grounds = {}
        for reflectance in (None, "lambert", "lommel-seeliger"):
            ground = scene.add_terrain(field, name=f"{mode} {reflectance}", color=(1, 1, 1), mode=mode,
                                       reflectance=reflectance)
            camera = scene.add_camera(f"{mode} {reflectance}", eye=(0, 0, 30), target=(0, 0, 0), up=(0, 1, 0), height=8)
            view = scene.add_viewport((20, 20), camera, samples=1)
            view.fill = 0.0
            grounds[reflectance] = view.image()
            ground.object.visible = False
        assert np.array_equal(grounds[None], grounds["lambert"])
        assert grounds["lommel-seeliger"][10, 10, 0] > grounds["lambert"][10, 10, 0] + 2


def test_bad_reflectance_is_rejected(scene, refused):
    ball = scene.add_sphere(1.0, name="ball")
    with refused(dspace.InvalidArgument, "'shiny'"):
        ball.reflectance = "shiny"
    with refused(dspace.InvalidArgument, "a model's name, or a dict"):
        ball.reflectance = {"lunar_weight": 0.5}
    with refused(dspace.WrongType, "unknown keyword 'weight'"):
        ball.reflectance = {"model": "lunar-lambert", "weight": 0.5}
    with refused(dspace.WrongType, "unknown keyword 'lunar_weight'"):
        ball.reflectance = {"model": "hapke", "lunar_weight": 0.5}
    for name, value in (("single_scattering_albedo", 1.1), ("phase_asymmetry", 1.0), ("phase_partition", -1.5),
                        ("opposition_amplitude", -1.0), ("opposition_width", 0.0), ("roughness_deg", 61.0),
                        ("roughness_deg", float("nan"))):
        with refused(dspace.InvalidArgument, f"{name} is {value:g}; accepted: "):
            ball.reflectance = {"model": "hapke", name: value}
    with refused(dspace.InvalidArgument, "lunar_weight is 2; accepted: 0 to 1"):
        scene.add_sphere(1.0, name="other", reflectance={"model": "lunar-lambert", "lunar_weight": 2})


def test_planes_of_light_and_exposure(lit):
    scene, view, plate = lit
    plate.reflectance = "lommel-seeliger"
    unit = 1361 / np.pi
    assert np.allclose(view.radiance(), unit * 2 / 3, rtol=1e-4)
    assert np.allclose(view.incidence(), 60, atol=1e-3) and np.allclose(view.phase(), 60, atol=1e-3)
    assert np.allclose(view.emission(), 0, atol=1e-3)
    view.set(exposure=0.5)
    assert abs(int(view.image()[20, 20, 0]) - display(1 / 3)) <= 1
    view.set(tone="filmic")
    x = 1 / 3
    assert abs(int(view.image()[20, 20, 0]) - display(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14))) <= 1
    view.set(tone="linear", automatic_exposure=True, exposure=1.0)
    assert abs(int(view.image()[20, 20, 0]) - display(0.6)) <= 1
    scene.lights["sun"].intensity = 1e-3
    assert abs(int(view.image()[20, 20, 0]) - display(0.6)) <= 1
    assert np.allclose(view.radiance(), 1e-3 * unit * 2 / 3, rtol=1e-4)
