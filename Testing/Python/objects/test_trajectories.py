"""Trajectories: states, moving axes, frames that follow, windows of time, recordings, bad input."""
import math
import os

import numpy as np
import pytest

import dspace
from dspace.trajectories import Conic, Pointing, States, local, read_states, rotating, turning

EARTH = 3.986004418e14


def circle(times, radius=7e6, inclination=0.0, phase=0.0):
    """Positions and velocities of a circular orbit, closed form."""
    rate = math.sqrt(EARTH / radius**3)
    angle = rate * np.asarray(times, float) + phase
    i = math.radians(inclination)
    x, y = np.cos(angle), np.sin(angle)
    p = radius * np.stack((x, y * math.cos(i), y * math.sin(i)), axis=-1)
    v = radius * rate * np.stack((-y, x * math.cos(i), x * math.sin(i)), axis=-1)
    return p, v


def states_of(step=60.0, count=60, **orbit):
    times = step * np.arange(count)
    return States(times, *circle(times, **orbit))


@pytest.fixture
def session():
    with dspace.Session() as session:
        yield session


@pytest.fixture
def scene(session):
    return session.scene("orbits")


def test_states_between_those_of_a_table_are_those_of_the_orbit(scene):
    line = scene.add_trajectory(states_of(inclination=50), name="craft")
    times = np.linspace(0.0, 59 * 60.0, 601)
    p, v = line.states(times)
    truth = circle(times, inclination=50)
    assert np.abs(p - truth[0]).max() < 1e-4
    assert np.abs(v - truth[1]).max() < 1e-5
    assert line.span == (0.0, 59 * 60.0)
    one = line.states(90.0)
    assert one[0].shape == (3,)
    assert np.allclose(one[0], circle(90.0, inclination=50)[0], atol=1e-4)
    assert line.ornamental and line.name == "craft"


def test_osculating_elements_of_a_published_state(scene):
    # D. Vallado, "Fundamentals of Astrodynamics and Applications", 4th ed., example 2-5.
    orbit = scene.orbit((6524834, 6862875, 6448296), (4901.327, 5533.756, -1976.341), EARTH)
    assert orbit.semi_major_axis == pytest.approx(36127.343e3, abs=100)
    assert orbit.eccentricity == pytest.approx(0.832853, abs=1e-6)
    assert orbit.inclination_deg == pytest.approx(87.870, abs=1e-3)
    assert orbit.ascending_node_deg == pytest.approx(227.898, abs=1e-3)
    assert orbit.periapsis_argument_deg == pytest.approx(53.38, abs=6e-3)
    assert orbit.true_anomaly_deg == pytest.approx(92.335, abs=1e-3)
    line = scene.add_trajectory(states_of(inclination=50))
    about = line.orbit(600.0, EARTH)
    assert about.inclination_deg == pytest.approx(50.0, abs=1e-9)
    assert about.period_s == pytest.approx(2 * math.pi * math.sqrt(7e6**3 / EARTH), rel=1e-9)


def test_another_craft_stands_still_in_local_axes(scene):
    """A craft ahead on the same circle stands still in the local vertical of the one behind it."""
    chief = states_of()
    ahead = scene.add_trajectory(states_of(phase=1e-3), relative_to=local(chief, "lvlh"))
    p, v = ahead.states(np.linspace(0.0, 3000.0, 31))
    expected = 7e6 * np.array((math.sin(1e-3), 0.0, 1.0 - math.cos(1e-3)))
    assert np.abs(p - expected).max() < 1e-3
    assert np.abs(v).max() < 1e-5
    up = scene.add_trajectory(states_of(phase=1e-3), relative_to=local(chief, "rtn")).states(600.0)[0]
    assert np.allclose(up, (-expected[2], expected[0], 0.0), atol=1e-3)


def test_two_bodies_stand_still_in_rotating_axes(scene):
    moon = States(3600.0 * np.arange(100), *circle(3600.0 * np.arange(100), radius=3.844e8, inclination=20))
    line = scene.add_trajectory(moon, relative_to=rotating(None, moon, share=0.0121506))
    p, v = line.states(np.linspace(0, 99 * 3600.0, 50))
    assert np.abs(p - ((1 - 0.0121506) * 3.844e8, 0, 0)).max() < 1e-3
    assert np.abs(v).max() < 1e-6


def test_a_site_stands_still_in_turning_axes(scene):
    rate = 7.2921159e-5
    times = 600.0 * np.arange(60)
    half = 0.5 * rate * times
    turns = np.stack((np.cos(half), 0 * half, 0 * half, np.sin(half)), axis=-1)
    site = 6378137.0 * np.stack((np.cos(rate * times), np.sin(rate * times), 0 * times), axis=-1)
    line = scene.add_trajectory(States(times, site), relative_to=turning(times, turns))
    p, v = line.states(np.linspace(0, times[-1], 77))
    assert np.abs(p - (6378137.0, 0, 0)).max() < 1e-3
    assert np.abs(v).max() < 1e-4


def test_a_frame_moves_with_the_scenes_time_and_points(scene):
    base = scene.add_frame("earth", position=(1e6, 0, 0))
    line = scene.add_trajectory(states_of(inclination=50), frame=base, name="craft")
    frame = line.add_frame("bus", Pointing())
    assert frame.path == "earth/bus"
    for time in (0.0, 333.0, 2000.0):
        scene.time = time
        p, v = circle(time, inclination=50)
        pose = frame.pose
        assert np.allclose(pose.position, p, atol=1e-4)
        rows = scene.poses([frame], relative_to="earth")[0]
        axis = rotate(rows[3:7], (0, 0, 1))
        assert np.allclose(axis, -p / np.linalg.norm(p), atol=1e-9)  # Z to the centre
        assert np.allclose(rotate(rows[3:7], (1, 0, 0)), v / np.linalg.norm(v), atol=1e-9)
    with pytest.raises(dspace.InvalidArgument, match="follows object 'craft'"):
        frame.position = (0, 0, 0)
    with pytest.raises(dspace.InvalidArgument, match="follows object 'craft'"):
        frame.remove()
    with pytest.raises(dspace.InvalidArgument, match="earth/bus"):
        line.frame = scene.root
    with pytest.warns(dspace.DspaceWarning, match="no state"):
        scene.time = 1e6
    assert np.allclose(frame.pose.position, circle(59 * 60.0, inclination=50)[0], atol=1e-4)
    line.move(None)
    assert np.allclose(frame.pose.position, 0.0)
    line.move(frame)
    line.remove()
    assert np.allclose(frame.pose.position, 0.0)


def rotate(q, v):
    w, u = q[0], np.array(q[1:])
    v = np.array(v, float)
    return v + 2 * np.cross(u, np.cross(u, v) + w * v)


def test_an_attitude_of_a_table(scene):
    line = scene.add_trajectory(states_of())
    angles = np.array((0.0, 1.0))
    quaternions = np.stack((np.cos(angles / 2), np.sin(angles / 2), 0 * angles, 0 * angles), axis=-1)
    frame = line.add_frame("bus", ((0.0, 100.0), quaternions))
    scene.time = 50.0
    assert np.allclose(rotate(scene.poses([frame])[0][3:7], (0, 1, 0)), (0, math.cos(0.5), math.sin(0.5)), atol=1e-12)


def look_down(scene, height=4e7, size=301):
    camera = scene.add_camera("camera", eye=(0, 0, height), target=(0, 0, 0), up=(0, 1, 0), fov_deg=40)
    return scene.add_viewport((size, size), camera)


def pixel(point, height=4e7, size=301):
    focal = 0.5 * size / math.tan(math.radians(20))
    depth = height - point[2]
    return (size - 1) / 2 + focal * point[0] / depth, (size - 1) / 2 - focal * point[1] / depth


def near(image, point, reach=2):
    x, y = (int(round(v)) for v in pixel(point))
    return image[y - reach:y + reach + 1, x - reach:x + reach + 1].max()


def test_the_line_is_where_the_orbit_is_within_its_window(scene):
    line = scene.add_trajectory(states_of(count=98), color="red", before=1000.0, after=500.0, line_width=2)
    view = look_down(scene)
    scene.time = 3000.0
    image = view.image()
    for offset, seen in ((-1100, False), (-900, True), (0, True), (450, True), (600, False)):
        assert (near(image, circle(3000.0 + offset)[0]) > 200) == seen, offset
    assert image[..., 1].max() == 0  # red
    line.set(before=math.inf, after=math.inf, color="white")
    image = view.image()
    for time in np.linspace(0, 97 * 60, 30):
        assert near(image, circle(time)[0]) > 200
    assert line.states(0.0)[0][0] == pytest.approx(7e6)


def test_colors_by_value_and_by_phase(scene):
    times = 60.0 * np.arange(98)
    scene.add_trajectory(states_of(count=98), values=(times, times), colormap=("red", "blue"), line_width=3)
    view = look_down(scene)
    image = view.image()
    x, y = (int(round(v)) for v in pixel(circle(100.0)[0]))  # not where the end of the orbit meets its beginning
    assert image[y, x, 0] > 200 and image[y, x, 2] < 60
    x, y = (int(round(v)) for v in pixel(circle(97 * 30.0)[0]))
    assert 90 < image[y, x, 0] < 165 and 90 < image[y, x, 2] < 165
    scene.objects["trajectory"].remove()
    scene.add_trajectory(states_of(count=98), phases=[(0, "red"), (2000, "lime")], line_width=3)
    image = view.image()
    for time, channel in ((100.0, 0), (1950.0, 0), (2050.0, 1), (5000.0, 1)):
        x, y = (int(round(v)) for v in pixel(circle(time)[0]))
        assert image[y, x, channel] > 200 and image[y, x, 1 - channel] < 60, time


def test_osculating_orbits_are_whole(scene):
    line = scene.add_trajectory(states_of(count=10), osculating=True, mu=EARTH, line_width=2)
    image = look_down(scene).image()
    for time in np.linspace(0, 5800, 20):  # the table knows the first nine minutes
        assert near(image, circle(time)[0]) > 200, time
    with pytest.raises(dspace.InvalidArgument, match="osculating"):
        line.set(fade=True)


def labels_of(scene, **settings):
    line = scene.add_trajectory(states_of(count=98), **settings)
    return line


def test_tick_labels_do_not_pile_up(scene):
    view = look_down(scene, size=601)
    bare = view.image().astype(int)
    labels_of(scene, tick_interval=10.0, clock="seconds", tick_size=0, color="white")
    many = view.image()
    # 590 labels would make a solid ring; those with room leave the dark between them.
    covered = (np.abs(many.astype(int) - bare).max(axis=2) > 0).mean()
    assert 0.01 < covered < 0.05


def test_it_is_recorded_and_in_snapshots(session, scene, tmp_path):
    base = scene.add_frame("earth")
    with session.record(tmp_path / "run.dspace"):
        line = scene.add_trajectory(states_of(count=98), frame=base, color="red", fade=True, before=2000.0, line_width=3,
                                    tick_interval=600.0)
        bus = line.add_frame("bus", Pointing())
        scene.add_box((4e5, 4e5, 4e5), frame=bus)
        view = look_down(scene)
        images = []
        for time in (1000.0, 4000.0):
            scene.time = time
            images.append(view.image())
        scene.time = 5000.0  # what follows belongs to this step
        line.set(color="cyan")
        images.append(view.image())
    name = view.name
    with dspace.Playback(tmp_path / "run.dspace") as playback:
        for time, image in zip((1000.0, 4000.0, 5000.0), images):
            playback.seek(time)
            assert np.array_equal(playback.session.viewports[name].image(), image), time


def test_a_table_in_csv(tmp_path):
    path = tmp_path / "states.csv"
    path.write_text("Time,x,y,z,note\n0.5,1,2,3,a\n\n1.5,4,5,6,b\n")
    states = read_states(path, scale=1000.0, epoch=100.0)
    assert states.times.tolist() == [100.5, 101.5]
    assert states.positions.tolist() == [[1e3, 2e3, 3e3], [4e3, 5e3, 6e3]]
    assert states.velocities is None and states.interpolation == "lagrange" and states.degree == 1
    path.write_text("jd,px,py,pz,u,v,w\n2451545.0,1,2,3,4,5,6\n2451546.0,1,2,3,4,5,6\n")
    names = dict(zip(("time", "x", "y", "z", "vx", "vy", "vz"), ("jd", "px", "py", "pz", "u", "v", "w")))
    states = read_states(path, names, julian=True)
    assert states.times.tolist() == [0.0, 86400.0]
    assert states.velocities.tolist() == [[4, 5, 6]] * 2 and states.degree == 3
    for text, words in (("", "empty"), ("a,b\n1,2\n", "time, x, y, z"), ("t,x,y,z\n1,2,3\n", "line 2"),
                        ("t,x,y,z\n1,2,3,four\n", "'four'"), ("t,x,y,z\n1,2,3,nan\n", "finite"),
                        ("t,x,y,z,vx\n1,2,3,4,5\n", "vy, vz")):
        path.write_text(text)
        with pytest.raises(dspace.Error, match=words):
            read_states(path)
    with pytest.raises(dspace.NotFound):
        read_states(tmp_path / "absent.csv")


def test_bad_input_changes_nothing(scene):
    line = scene.add_trajectory(states_of(), name="craft")
    before = len(scene.objects)
    good = states_of()
    for arguments, words in (
            (dict(path=Conic((7e6, 0, 0), (0, 7.5e3, 0), EARTH)), "conic needs both"),
            (dict(path=Conic((7e6, 0, 0), (0, 7.5e3, 0), -1.0), begin=0, end=1), "GM"),
            (dict(path=good, begin=-5.0), "craft|trajectory"),
            (dict(path=good, begin=100.0, end=50.0), "begin before the end"),
            (dict(path=good, flatness=2.0), "flatness"),
            (dict(path=good, opacity=1.5), "opacity"),
            (dict(path=good, before=-1.0), "before"),
            (dict(path=good, tick_interval=-1.0), "ticks"),
            (dict(path=good, tick_interval=1e-6), "ticks"),
            (dict(path=good, osculating=True), "mu"),
            (dict(path=good, relative_to="moon"), "relative_to"),
            (dict(path=good, values=(np.zeros(2), np.zeros(2))), "ascending"),
            (dict(path=good, position=(1, 0, 0)), "offset"),
            (dict(path=3.0), "path"),
            (dict(path=States([0.0, 0.0], [[1, 0, 0]] * 2, degree=1)), "ascending"),
            (dict(path=good, relative_to=rotating(None, None)), "both of its bodies"),
            (dict(path="absent.oem"), "absent.oem")):
        with pytest.raises(dspace.Error, match=words):
            scene.add_trajectory(**arguments)
        assert len(scene.objects) == before, arguments
    with pytest.raises(dspace.InvalidArgument, match="accepted: 0.000 to 3540.000"):
        line.states(4000.0)
    with pytest.raises(dspace.InvalidArgument, match="child of frame"):
        line.move(scene.add_frame("a").add_frame("b"))
    with pytest.raises(dspace.InvalidArgument, match="parallel"):
        line.add_frame("c", Pointing(axis=(0, 0, 1), second_axis=(0, 0, 2)))
    with pytest.raises(dspace.InvalidArgument, match="not a trajectory"):
        dspace.Trajectory(scene, scene.add_box((1, 1, 1)).id).states(0.0)


def test_artemis_is_farthest_where_nasa_said(scene):
    folder = os.environ.get("DSPACE_DATA")
    path = os.path.join(folder or "", "ephemeris", "artemis1_orion_asflown_20221213_OEM.asc")
    if not folder or not os.path.exists(path):
        pytest.skip("real data absent: set DSPACE_DATA")
    line = scene.add_trajectory(path)
    assert line.source == {"center": "EARTH", "frame": "J2000", "object": "EM1"}
    begin, end = line.span
    times = np.arange(begin, end, 60.0)
    distances = np.linalg.norm(line.states(times)[0], axis=1)
    assert distances.max() == pytest.approx(438585.5e3, abs=60.0)
    # 2022-11-28T21:04:34 UTC is 69.184 s behind TDB; the file's rows are four minutes apart.
    farthest = (np.datetime64("2022-11-28T21:04:34") - np.datetime64("2000-01-01T12:00:00")).astype(float) + 69.184
    assert times[distances.argmax()] == pytest.approx(farthest, abs=150.0)


def test_quaternions_of_all_turns():
    from dspace.objects.trajectories import quaternions_of
    random = np.random.default_rng(3)
    q = random.normal(size=(200, 4))
    q[:4] = np.eye(4)  # none, and half turns about each axis
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    matrices = np.stack([np.stack([rotate(each, axis) for axis in np.eye(3)], axis=1) for each in q])
    found = quaternions_of(matrices)
    assert np.abs(np.abs(np.sum(found * q, axis=1)) - 1).max() < 1e-14


def test_paths_and_axes_of_the_ephemeris(scene):
    """The Moon's path of sampled states against the ephemeris itself between them; its far side stays in MOON_ME."""
    begin, end = scene.tdb("2022-11-16T00:00"), scene.tdb("2022-12-11T00:00")
    moon = scene.body_path("moon", "earth", begin, end, step=6 * 3600.0)
    line = scene.add_trajectory(moon, name="moon")
    times = np.linspace(begin, end, 5001)
    assert np.abs(line.states(times)[0] - scene.ephemeris("moon", "earth", times).position).max() < 0.01
    # The Earth about the Moon in the Moon's axes: within its optical librations (8 degrees) of longitude 0.
    earth = scene.body_path("earth", "moon", begin, end, step=6 * 3600.0)
    seen = scene.add_trajectory(earth, relative_to=scene.turning_axes("MOON_ME", begin, end, step=3600.0)).states(times)[0]
    assert np.degrees(np.arctan2(np.hypot(seen[:, 1], seen[:, 2]), seen[:, 0])).max() < 11.0
    exact = np.einsum("nij,nj->ni", scene.reference_frames.rotation("J2000", "MOON_ME", times),
                      scene.ephemeris("earth", "moon", times).position)
    assert np.abs(seen - exact).max() < 50.0  # a turn at constant rate over an hour: 1e-7 rad
    with pytest.raises(dspace.Error):
        scene.body_path("moon", "earth", end, begin)
    with pytest.raises(dspace.Error):
        scene.body_path("no such body", "earth", begin, end)
