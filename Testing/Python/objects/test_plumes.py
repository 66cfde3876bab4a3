"""Plumes: particles where the numbers of the simulation put them, the same each time."""
import math

import numpy as np
import pytest

import dspace


@pytest.fixture
def scene():
    with dspace.Session() as session:
        yield session.scene("plumes")


def test_as_many_particles_as_the_rate_makes(scene):
    plume = scene.add_plume(lifetime=2.0, spread_deg=15)
    plume.set(rate=100.0, speed=10.0)
    scene.time = 1.0
    assert plume.update() == 101  # the first at 0, the last at 1 s
    scene.time = 5.0
    positions, ages = plume.particles()
    assert len(ages) == 200 and ages.max() < 2.0
    distances = np.linalg.norm(positions, axis=1)
    assert np.all(np.abs(distances - 10.0 * ages) <= 1.0 * ages + 1e-12)  # within a tenth of the speed
    moved = ages > 0
    angles = np.degrees(np.arccos(positions[moved, 2] / distances[moved]))
    assert angles.max() <= 15 + 1e-9 and angles.max() > 13
    # Evenly over the solid angle: half of it lies within acos((1 + cos 15) / 2).
    half = np.degrees(math.acos((1 + math.cos(math.radians(15))) / 2))
    assert 0.4 < (angles < half).mean() < 0.6


def test_the_rate_may_change_and_end(scene):
    plume = scene.add_plume(lifetime=10.0)
    plume.set(rate=10.0, speed=1.0, time=0.0)
    plume.set(rate=40.0, time=1.0)
    plume.set(rate=0.0, time=2.0)
    ages = plume.particles(3.0)[1]
    assert np.sum(ages > 2.0) == 10 and np.sum(ages <= 2.0) == 40  # each once, also those of the times of changes
    assert ages.min() >= 1.0
    assert len(plume.particles(12.5)[1]) == 0
    with pytest.raises(dspace.InvalidArgument, match="go back"):
        plume.set(rate=1.0, time=1.5)
    plume.clear()
    plume.set(rate=1.0, time=0.0)


def test_dust_falls(scene):
    plume = scene.add_plume(spread_deg=0.0, acceleration=(0, 0, -1.62), lifetime=4.0)
    plume.set(rate=50.0, speed=2.0)
    positions, ages = plume.particles(4.0)
    ballistic = positions[:, 2] + 0.5 * 1.62 * ages**2
    assert np.all(np.abs(ballistic - 2.0 * ages) <= 0.2 * ages + 1e-12)
    assert np.abs(positions[:, :2]).max() < 1e-12


def test_the_same_numbers_give_the_same_picture(scene):
    camera = scene.add_camera("camera", eye=(20, 0, 5), target=(0, 0, 5))
    view = scene.add_viewport((161, 161), camera)
    images = []
    for i in range(2):
        plume = scene.add_plume(name=f"plume {i}", color="white", lifetime=1.5)
        for step in range(20):
            plume.set(rate=200.0 + step, speed=6.0, time=0.1 * step)
        plume.update(1.9)
        images.append(view.image())
        assert plume.mesh.ornamental
        plume.mesh.remove()
    assert np.array_equal(*images) and images[0].max() > 100
    other = scene.add_plume(seed=1, physical=True)
    other.set(rate=200.0, speed=6.0)
    assert not other.mesh.ornamental
    assert not np.allclose(other.particles(1.0)[0][:50], scene_particles(scene))


def scene_particles(scene):
    plume = scene.add_plume()
    plume.set(rate=200.0, speed=6.0, time=0.0)
    return plume.particles(1.0)[0][:50]


def test_bad_numbers_are_rejected(scene):
    for arguments in ({"axis": (0, 0, 0)}, {"spread_deg": 91}, {"lifetime": 0}, {"seed": -1}, {"acceleration": (0, 0, math.nan)}):
        with pytest.raises(dspace.InvalidArgument):
            scene.add_plume(**arguments)
    plume = scene.add_plume()
    for arguments in ({"rate": -1}, {"rate": 1e9}, {"speed": -1}, {"speed": math.inf}, {"time": math.nan}):
        with pytest.raises(dspace.InvalidArgument, match="plume"):
            plume.set(**arguments)
