"""Viewers that watch a simulation have cameras of their own and send it the events of their users."""
import contextlib
import warnings

import numpy as np
import pytest

import dspace
from dspace.telemetry.viewer_events import pose_of
from served_support import Served
from terrain_support import ROOT


SIZE = (160, 120)
EYE = {"eye": (2.0, 8.0, 6.0), "target": (0.0, 0.0, 1.0), "fov_deg": 30.0}


def build(session):
    """A red ball on a frame, a green post, and a camera."""
    scene = session.scene()
    cart = scene.add_frame("cart")
    ball = scene.add_frame("ball", cart)
    scene.add_sphere(1.0, frame=ball, color="#e02020", name="ball")
    scene.add_box((0.4, 0.4, 4.0), position=(0.0, 3.0, 2.0), color="#20c020", name="post")
    scene.add_camera("main", eye=(9.0, 0.0, 3.0), target=(0.0, 0.0, 0.0))
    return scene


def alone(change):
    """What change(scene), which returns a viewport, shows in a session of this process."""
    with dspace.Session() as session:
        return change(build(session)).image()


@contextlib.contextmanager
def watched(tmp_path, *arguments):
    """A server, a simulation with a viewport "view", and a watcher of it."""
    with Served(tmp_path, *arguments) as server, dspace.connect(server.address, name="drive", timeout=20.0) as session:
        build(session).add_viewport(SIZE, "main", name="view")
        with dspace.watch(server.address, name="eyes") as watcher:
            yield server, session, watcher


def follow(watcher, session):
    """Applies all that the simulation has done."""
    session.scene().add_frame("mark")
    while "scene" not in watcher.scenes or "mark" not in watcher.scenes["scene"].frames:
        assert watcher.update(20.0), watcher.error
    session.scene().frame("mark").remove()
    while "mark" in watcher.scenes["scene"].frames:
        assert watcher.update(20.0), watcher.error
    assert watcher.error == ""


def drag(view):
    """Left drag from the ball on."""
    view.event("press", 80, 60, button="left")
    for x in (90, 100, 110):
        view.event("move", x, 66)
    view.event("release", 110, 66, button="left")


def test_a_viewer_looks_from_where_it_likes(tmp_path):
    with watched(tmp_path) as (_, session, watcher):
        before = session.viewports["view"].image()
        mine = watcher.add_view("mine", size=SIZE, **EYE)
        assert mine.name == "viewer:mine"
        wanted = alone(lambda scene: scene.add_viewport(SIZE, scene.add_camera("mine", **EYE)))
        assert np.array_equal(mine.image(), wanted) and not np.array_equal(wanted, before)
        # One that follows a frame, as the simulation moves it.
        chase = {"frame": "cart", "chase": {"offset": (-6.0, 2.0, 2.0)}}
        behind = watcher.add_view("behind", size=SIZE, **chase)
        session.scene().set_poses(["cart"], [[3.0, 1.0, 0.0, 0.6, 0.0, 0.0, 0.8]])
        follow(watcher, session)

        def moved(scene):
            scene.set_poses(["cart"], [[3.0, 1.0, 0.0, 0.6, 0.0, 0.0, 0.8]])
            return scene.add_viewport(SIZE, scene.add_camera("chase", **chase))
        assert np.array_equal(behind.image(), alone(moved))
        behind.camera.look_at(EYE["eye"], EYE["target"])
        # Nothing of it is in the server, whose things are nobody's here.
        assert list(session.viewports) == ["view"] and list(session.scene().vantages) == ["main"]
        for refused in (lambda: watcher.scenes["scene"].cameras["main"].look_at((1, 1, 1), (0, 0, 0)),
                        lambda: watcher.viewports["view"].event("wheel", 80, 60, wheel=1.0),
                        lambda: watcher.scenes["scene"].add_vantage("mine"),
                        lambda: watcher.scenes["scene"].add_camera("theirs", eye=(1, 1, 1), target=(0, 0, 0))):
            with pytest.raises(dspace.Unsupported, match="begin with 'viewer:'"):
                refused()
        with pytest.raises(dspace.AlreadyExists):
            watcher.add_view("mine")
        with pytest.raises(dspace.NotFound):
            watcher.add_view("lost", frame="nowhere", eye=(1, 1, 1), target=(0, 0, 0))
        watcher.add_view("lost", frame="cart", eye=(1, 1, 1), target=(0, 0, 0)).remove()


def test_a_person_moves_the_camera_of_a_view_alone(tmp_path):
    with watched(tmp_path) as (_, session, watcher):
        mine, other = watcher.add_view("mine", size=SIZE), watcher.add_view("other", size=SIZE)
        plain = watcher.viewports["view"].image()
        mine.event("move", 20, 20)  # a pointer that passes
        mine.event("press", 80, 60, button="left")
        mine.event("release", 80, 60, button="left")
        assert mine.vantage == "main" and np.array_equal(mine.image(), plain)
        # It still looks through the simulation's camera, wherever that goes.
        session.scene().cameras["main"].look_at((7.0, -4.0, 2.0), (0.0, 1.0, 0.0))
        follow(watcher, session)
        there = watcher.viewports["view"].image()
        assert np.array_equal(mine.image(), there) and not np.array_equal(there, plain)
        drag(mine)
        turned = mine.image()

        def dragged(scene):
            scene.cameras["main"].look_at((7.0, -4.0, 2.0), (0.0, 1.0, 0.0))
            view = scene.add_viewport(SIZE, "main")
            drag(view)
            return view
        assert np.array_equal(turned, alone(dragged)) and not np.array_equal(turned, there)
        for view in (other, watcher.viewports["view"], session.viewports["view"]):
            assert np.array_equal(view.image(), there)
        session.scene().cameras["main"].look_at((9.0, 0.0, 3.0), (0.0, 0.0, 0.0))
        follow(watcher, session)
        assert np.array_equal(mine.image(), turned)  # it goes its own way
        mine.vantage = "main"
        assert np.array_equal(mine.image(), plain)  # until it is brought back
        mine.event("wheel", 80, 60, wheel=2.0)
        assert not np.array_equal(mine.image(), plain)


def test_views_outlast_the_server(tmp_path):
    with watched(tmp_path) as (server, session, watcher):
        mine = watcher.add_view("mine", size=SIZE, **EYE)
        riding = watcher.add_view("riding", size=SIZE, frame="cart", eye=(0.0, -6.0, 2.0), target=(0.0, 0.0, 0.0))
        orbited = watcher.add_view("orbited", size=SIZE)
        drag(orbited)
        mine.set_table("note", {"seen": "by me"}, anchor="top right")
        mine.set_background("#203040")
        session.scene().set_poses(["cart"], [[2.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0]])
        follow(watcher, session)
        views = (mine, riding, orbited)
        before = [view.image() for view in views]
        server.kill()
        while watcher.connected:
            watcher.update(0.2)
        watcher.update()
        lost = [view.image() for view in views]
        assert [np.array_equal(a, b) for a, b in zip(lost, before)] == [False] * 3  # a banner
        assert watcher.add_view("late", size=SIZE, **EYE).image().shape == (120, 160, 3)
        with Served(tmp_path) as _:
            while not watcher.connected or watcher.scenes:
                watcher.update(0.2)  # the new one has no scene, and for a while no frames
            assert not watcher.viewports
            with dspace.connect(server.address, name="next", timeout=20.0) as session:
                session.scene().add_frame("first")  # the others have other ids than they had
                follow(watcher, session)
                assert not watcher.viewports
                scene = build(session)
                scene.set_poses(["cart"], [[2.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0]])
                follow(watcher, session)
                assert [np.array_equal(view.image(), b) for view, b in zip(views, before)] == [True] * 3
                scene.set_poses(["cart"], [[0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0]])
                follow(watcher, session)
                assert riding.camera.frame == watcher.scenes["scene"].frame("cart")
                assert not np.array_equal(riding.image(), before[1])  # it rides on
                # A simulation that begins again in the same server.
                scene.remove()
                build(session).set_poses(["cart"], [[2.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0]])
                follow(watcher, session)
                assert [np.array_equal(view.image(), b) for view, b in zip(views, before)] == [True] * 3


def test_what_the_simulation_removes_goes(tmp_path):
    with watched(tmp_path) as (_, session, watcher):
        scene = session.scene()
        riding = watcher.add_view("riding", size=SIZE, frame="cart", eye=(0.0, -6.0, 2.0), target=(0.0, 3.0, 1.0))
        looking = watcher.add_view("looking", size=SIZE)
        scene.set_poses(["cart"], [[2.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0]])
        follow(watcher, session)
        scene.frame("cart").remove()
        follow(watcher, session)

        def without(scene):
            scene.frame("cart").remove()
            eye = scene.add_camera("eye", eye=(2.0, -5.0, 2.0), target=(2.0, 4.0, 1.0))
            return scene.add_viewport(SIZE, eye)
        difference = np.abs(riding.image().astype(int) - alone(without))
        assert (difference > 2).mean() < 1e-3  # the camera to rounding: a pixel at an edge may differ
        session.viewports["view"].remove()
        scene.cameras["main"].remove()
        follow(watcher, session)
        assert sorted(watcher.viewports) == ["viewer:looking", "viewer:riding"]
        assert looking.name in watcher.viewports
        scene.remove()
        session.scene("another").add_frame("f")
        while "another" not in watcher.scenes or not watcher.scenes["another"].frames:
            assert watcher.update(20.0)
        assert watcher.error == "" and not watcher.viewports
        watcher.add_view("riding", size=SIZE, eye=(1, 1, 1), target=(0, 0, 0))  # the only scene
        build(session)
        follow(watcher, session)
        assert sorted(watcher.viewports) == ["viewer:looking", "viewer:riding"]
        assert watcher.viewports["viewer:riding"].scene.name == "another"


def test_a_viewer_has_a_style_of_terrain_of_its_own(tmp_path):
    """And the simulation removes what it likes: the fragment that the style is in, then the terrain."""
    with watched(tmp_path, "--allow-root", str(ROOT / "Data")) as (_, session, watcher):
        scene = session.scene()
        terrain = scene.add_terrain(ROOT / "Data/field/field.tif", mode="clipmap", name="field")
        fragment = scene.add_fragment("own", ornamental=True)
        follow(watcher, session)
        mine = watcher.add_view("mine", size=SIZE, eye=(0.0, 0.1, 60.0), target=(0.0, 0.0, 0.0))
        plain, before = mine.image(), session.viewports["view"].image()
        seen = watcher.scenes["scene"].terrains["field"]
        seen.set_style(color_by="slope", contours=dict(interval=0.5, fragment="own"), viewport=mine)
        colored = mine.image()
        assert not np.array_equal(colored, plain)
        assert np.array_equal(session.viewports["view"].image(), before) and fragment.members == []
        with pytest.raises(dspace.Error, match="style_terrain"):
            seen.set_style(contours=1)  # that of all viewports is the simulation's
        with pytest.raises(dspace.Error, match="style_terrain_in_viewport"):
            seen.set_style(contours=1, viewport="view")
        fragment.remove()
        follow(watcher, session)
        assert np.array_equal(mine.image(), plain)
        seen.set_style(color_by="slope", viewport=mine)
        terrain.remove()
        follow(watcher, session)
        assert not np.array_equal(mine.image(), plain)


def test_what_people_do_reaches_the_simulation(tmp_path):
    with watched(tmp_path) as (_, session, watcher):
        heard, picked, edited, cart = [], [], [], session.scene().frame("cart")
        session.on_event(heard.append)
        session.on_event(picked.append, kind="picked")
        session.on_edited("speed", edited.append, low=0.0, high=2.0, unit="m/s")
        view, scene = watcher.add_view("mine", size=SIZE), watcher.scenes["scene"]
        hit = watcher.viewports["view"].pick(80, 60, send=True)
        assert hit.object.name == "ball"
        assert watcher.viewports["view"].pick(1, 1, send=True) is None  # the sky is no event
        view.event("press", 80, 60, button="left")
        assert view.event("release", 80, 60, button="left").object_name == "ball"
        watcher.select([scene.objects["ball"], scene.objects["post"]])
        watcher.select([])
        watcher.answer("deploy?", "go")
        for value, unit in ((2.0, "m/s"), (2.0001, "m/s"), (1.0, ""), (-0.5, "m/s"), (0.0, "m/s")):
            watcher.edited("speed", value, unit)
        watcher.dragged("sample 3", position=(1.0, 2.0, 3.0), done=False)
        watcher.dragged(scene.frame("cart"), pose=dspace.Pose((0.5, 0, 0), (0.6, 0, 0, 0.8)),
                        relative_to=scene.frame("cart/ball"))
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            while len(heard) < 12:
                assert session.process_events(wait=20.0)
        assert [each.WhichOneof("kind") for each in heard] == (
            ["picked"] * 2 + ["selection"] * 2 + ["answer"] + ["edited"] * 5 + ["dragged"] * 2)
        assert {getattr(each, "from") for each in heard} == {"eyes"}
        assert [each.picked.viewport for each in picked] == ["view", "viewer:mine"]
        ball = session.scene().objects["ball"]
        for each in picked:
            assert (each.picked.scene, each.picked.pick.object) == ("scene", ball.id)
            assert abs(np.linalg.norm([getattr(each.picked.pick.in_root, axis) for axis in "xyz"]) - 1.0) < 0.02
        assert list(heard[2].selection.object) == [ball.id, session.scene().objects["post"].id]
        assert not heard[3].selection.object
        assert edited == [2.0, 0.0]  # what is out of bounds or in another unit is left, and said
        assert len(told) == 3 and all("eyes has entered" in str(each.message) for each in told)
        first, last = heard[10].dragged, heard[11].dragged
        assert (first.goal, first.scene, first.frame, first.relative_to, first.done) == (
            "sample 3", "scene", 0, 0, False)
        assert pose_of(first.pose) == dspace.Pose((1.0, 2.0, 3.0))
        assert (last.goal, last.frame, last.done) == ("cart", cart.id, True)
        assert last.relative_to == session.scene().frame("cart/ball").id
        assert pose_of(last.pose) == dspace.Pose((0.5, 0, 0), (0.6, 0, 0, 0.8))


def test_changes_of_frames_are_told_to_a_viewer(tmp_path):
    with watched(tmp_path) as (server, session, watcher):
        heard = []
        token = watcher.scenes["scene"].on_frame_change(lambda event: heard.append((event.type, list(event.ids))))
        scene = session.scene()
        cart = scene.frame("cart").id
        added = scene.add_frame("added")
        scene.set_poses(["cart"], [[1.0, 0, 0, 1, 0, 0, 0]])
        added.name = "renamed"
        added.remove()
        while len(heard) < 4:
            assert watcher.update(20.0), heard
        assert heard == [("created", [added.id]), ("poses_changed", [cart]), ("renamed", [added.id]),
                         ("removed", [added.id])]
        server.kill()  # and on after a snapshot, and in a scene of that name that is made later
        while watcher.connected:
            watcher.update(0.2)
        with Served(tmp_path), dspace.connect(server.address, name="next", timeout=20.0) as session:
            while not watcher.connected or watcher.scenes:
                watcher.update(0.2)
            heard.clear()
            frame = session.scene().add_frame("later")
            while not heard:
                assert watcher.update(20.0)
            assert heard == [("created", [frame.id])]
            assert watcher.scenes["scene"].remove_listener(token)
            frame.remove()
            follow(watcher, session)
            assert len(heard) == 1


def test_what_is_no_event_is_refused(tmp_path):
    with watched(tmp_path) as (_, session, watcher):
        from dspace.proto import service_pb2
        for bad in (float("nan"), float("inf")):
            with pytest.raises(dspace.InvalidArgument):
                watcher.edited("speed", bad)
            event = service_pb2.ViewerEvent()
            event.edited.name, event.edited.value = "speed", bad
            with pytest.raises(dspace.InvalidArgument, match="value 'speed'"):
                watcher.send_event(event)  # by the server, whatever the viewer is
        event = service_pb2.ViewerEvent()
        event.dragged.goal = "arm"
        event.dragged.pose.rotation.w = 2.0
        with pytest.raises(dspace.InvalidArgument, match="goal 'arm'"):
            watcher.send_event(event)
        with pytest.raises(dspace.InvalidArgument, match="accepted: up to 1048576"):
            watcher.answer("deploy?", "g" * (1 << 20))
        with pytest.raises(dspace.WrongType):
            watcher.dragged("arm", relative_to="cart")
        with pytest.raises(dspace.InvalidArgument, match="'dragged'"):
            session.on_event(print, kind="drag")
        with pytest.raises(dspace.InvalidArgument, match="low <= high"):
            session.on_edited("speed", print, low=1.0, high=0.0)
        for call in (lambda: session.on_edited("", print), lambda: session.edited("", 1.0)):
            with pytest.raises(dspace.InvalidArgument, match="one that is not empty"):
                call()
        assert session.process_events(wait=0.0) == []
        session.close()
        while watcher.simulation is not None:
            watcher.update(5.0)
        with pytest.raises(dspace.NotFound, match="has no driver"):
            watcher.answer("deploy?", "go")


def test_an_edited_value_is_in_the_unit_of_its_channel():
    with dspace.Session() as session:
        scene, heard = session.scene(), []
        session.on_event(lambda event: heard.append((event.edited.value, event.edited.unit)), kind="edited")
        scene.telemetry.add("drive/speed", unit="m/s")
        scene.telemetry.add("mode", kind="choice", labels={0: "idle", 2: "drive"})
        scene.telemetry.add("note", kind="text")
        session.edited("drive/speed", 0.5)
        session.edited("drive/speed", 0.25, "m/s")
        session.edited("mode", 2)
        session.edited("free", 1.5, "kg")
        session.edited("free", 2.5)
        for name, value, unit, message in (("drive/speed", 0.5, "km/h", "unit is 'km/h'; accepted: 'm/s'"),
                                           ("drive/speed", 0.5, "", "accepted: 'm/s'"),
                                           ("mode", 1, None, "accepted: 0 \\(idle\\), 2 \\(drive\\)"),
                                           ("note", 1, None, "accepted: a channel of numbers")):
            with pytest.raises(dspace.InvalidArgument, match=message):
                session.edited(name, value, unit)
        session.process_events()
        assert heard == [(0.5, "m/s"), (0.25, "m/s"), (2.0, ""), (1.5, "kg"), (2.5, "")]


def test_a_session_of_ones_own_hears_itself():
    with dspace.Session() as session:
        view = build(session).add_viewport(SIZE, "main")
        heard = []
        session.on_event(lambda event: heard.append(event.WhichOneof("kind")))
        view.pick(80, 60, send=True)
        session.answer("deploy?", "go")
        assert heard == [] and len(session.process_events()) == 2 and heard == ["picked", "answer"]
        assert session.process_events() == []


def changed(a, b):
    """The rectangle in which two pictures differ: left, top, right, bottom; None where they do not."""
    rows, columns = np.nonzero((a != b).any(axis=2))
    return (columns.min(), rows.min(), columns.max(), rows.max()) if rows.size else None


def test_the_banner_covers_no_table_and_fits(tmp_path):
    with Served(tmp_path) as server, dspace.watch(server.address) as watcher:
        for name in ("drive", "x" * 200, "模拟"):  # the font has no such letters
            with dspace.connect(server.address, name=name, timeout=20.0) as session:
                if "scene" not in session.scenes:
                    camera = build(session).cameras["main"]
                    for side, size in (("wide", (640, 200)), ("small", SIZE), ("tiny", (48, 32))):
                        view = session.scene().add_viewport(size, camera, name=side)
                        if side != "tiny":
                            view.set_table("speed", {"speed": "0.2 m/s"}, anchor="bottom left")
                follow(watcher, session)
            mine = watcher.add_view("mine", size=SIZE)
            before = {each.name: each.image() for each in watcher.viewports.values()}
            while watcher.simulation is not None:
                assert watcher.update(20.0)
            later = watcher.add_view("later", size=SIZE)
            assert np.array_equal(later.image(), mine.image())  # whenever it was made
            for each, was in before.items():
                left, top, right, bottom = changed(was, watcher.viewports[each].image())
                height, width = was.shape[:2]
                assert 4 <= left and right < width - 4 or each == "tiny", (name, each, left, right)
                if each in ("wide", "small"):  # at the top, for there is a table at the bottom
                    assert top >= 4 and bottom < 36, (name, each, top, bottom)
                else:
                    assert top > height - 36 and bottom < height - 4 or each == "tiny", (name, each, top, bottom)
                if each == "wide":
                    assert right - left > (100 if name == "模拟" else 300)
            with dspace.connect(server.address, name="next", timeout=20.0) as session:
                follow(watcher, session)
                for each, was in before.items():
                    assert np.array_equal(watcher.viewports[each].image(), was)
            later.remove()
            mine.remove()


def test_a_viewer_says_why_it_is_refused(tmp_path):
    """By a server that was restarted and lets no viewer in; once there is one that does, it follows."""
    with Served(tmp_path) as server:
        with dspace.watch(server.address, name="eyes", timeout=20.0) as watcher:
            assert watcher.error == ""
            server.kill()
            with Served(tmp_path, "--max-connections", "1"):
                while not watcher.error:
                    watcher.update(0.1)
                assert "viewers already" in watcher.error and not watcher.connected
            with Served(tmp_path):
                while not watcher.connected:
                    watcher.update(0.1)
                assert watcher.error == ""


@pytest.mark.parametrize("smoothing", [0.0, 0.7])
def test_a_viewer_that_is_behind_shows_what_who_kept_up_shows(tmp_path, smoothing):
    """Steps that later ones make needless are left out, but where a camera's lag depends on them."""
    with watched(tmp_path) as (_, session, watcher):
        scene = session.scene()
        cart = scene.frame("cart")
        scene.add_camera("behind", frame=cart, chase={"offset": (-6.0, 0.0, 3.0), "smoothing_s": smoothing})
        scene.add_viewport(SIZE, "behind", name="chase")
        follow(watcher, session)
        before = watcher.viewports["chase"].image()
        session.wait = False
        for step in range(300):
            scene.time = 0.01 * step
            scene.set_poses([cart], [[0.02 * step, np.sin(0.05 * step), 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]])
        session.flush()
        session.wait = True
        came = watcher.sequence
        while watcher.sequence < came + 600:
            assert watcher.update(20.0), watcher.error
        image = watcher.viewports["chase"].image()
        assert (image != before).any()
        assert (image == session.viewports["chase"].image()).all()
        own = watcher.scenes["scene"].frame("cart").pose.position
        assert own == pytest.approx((0.02 * 299, np.sin(0.05 * 299), 0.0), abs=0)
