"""What a new user gets wrong: each is refused, naming the object, the value and what is accepted."""
import threading

import numpy as np
import pytest

import dspace

SIZE = (64, 48)
EYE = dict(eye=(0, 0, 5), target=(0, 0, 0), up=(0, 1, 0))
ARM = """<robot name="arm"><link name="base"/><link name="wheel"/>
<joint name="axle" type="continuous"><parent link="base"/><child link="wheel"/>
<axis xyz="0 0 1"/></joint></robot>"""


@pytest.fixture
def view(scene):
    return scene.add_viewport(SIZE, scene.add_camera("camera", **EYE), name="view")


@pytest.fixture
def arm(scene, tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text(ARM)
    return scene.load(path)


# --- Things of other scenes --------------------------------------------------------------------


def things_of(scene):
    """What may be handed about, of a scene in which all have the names that `scene` has, too."""
    scene.add_fragment("group")
    return dict(frame=scene.add_frame("frame"), camera=scene.add_camera("camera", **EYE),
                fragment=scene.fragments["group"], vantage=scene.vantages["main"])


def uses_of(scene, view, theirs):
    """Every way to use `theirs` in another scene: (what is named, call)."""
    frame, camera = theirs["frame"], theirs["camera"]
    fragment, vantage = theirs["fragment"], theirs["vantage"]
    own = scene["own"]
    box = scene.objects["box"]
    row = [0, 0, 0, 1, 0, 0, 0, 1]

    def set(thing, name, value):
        return lambda: setattr(thing, name, value)

    return [
        ("camera 'camera'", set(view, "camera", camera)),
        ("camera 'camera'", lambda: scene.add_viewport(SIZE, camera)),
        ("vantage 'main'", lambda: scene.add_viewport(SIZE, vantage=vantage)),
        ("vantage 'main'", set(view, "vantage", vantage)),
        ("vantage 'main'", lambda: scene.add_camera("new", vantage=vantage)),
        ("fragment 'group'", lambda: view.hide(fragment)),
        ("fragment 'group'", lambda: view.show(fragment)),
        ("fragment 'group'", lambda: view.image(hide=[fragment])),
        ("fragment 'group'", lambda: view.save("no.png", hide=fragment)),
        ("fragment 'group'", lambda: scene.add_sphere(1, fragment=fragment)),
        ("fragment 'group'", set(box, "fragment", fragment)),
        ("frame 'frame'", set(box, "frame", frame)),
        ("frame 'frame'", lambda: scene.add_sphere(1, frame=frame)),
        ("frame 'frame'", lambda: scene.add_frame("f", frame)),
        ("frame 'frame'", lambda: own.reparent(frame)),
        ("frame 'frame'", lambda: own.pose_in(frame)),
        ("frame 'frame'", lambda: scene.set_poses([own, frame], [row, row])),
        ("frame 'frame'", lambda: scene.poses([frame])),
        ("frame 'frame'", lambda: view.pick(1, 1, frame=frame)),
        ("frame 'frame'", lambda: scene.cameras["camera"].attach(frame)),
        ("frame 'frame'", lambda: scene.cameras["camera"].chase(frame)),
        ("frame 'frame'", lambda: scene.cameras["camera"].look_at((1, 0, 0), (0, 0, 0), frame=frame)),
        ("frame 'frame'", lambda: scene.add_light("lamp", frame=frame)),
    ]


def check_uses(scene, view, theirs, refused, where):
    scene.add_frame("own")
    scene.add_box((1, 1, 1), name="box")
    for what, use in uses_of(scene, view, theirs):
        text = f"{what} is in another scene, {where}; accepted: one of scene 'scene'"
        with refused(dspace.InvalidArgument, text):
            use()


def test_things_of_another_scene(session, scene, view, refused):
    things_of(scene)
    check_uses(scene, view, things_of(session.scene("other")), refused, "'other'")


def test_things_of_another_session(scene, view, refused):
    things_of(scene)
    with dspace.Session() as other:
        check_uses(scene, view, things_of(other.scene()), refused, "'scene' of another session")


def test_a_camera_brings_its_vantage(scene, view, refused):
    scene.add_vantage("side")
    above = scene.cameras["camera"]
    beside = scene.add_camera("camera", vantage="side", eye=(5, 0, 0), target=(0, 0, 0))
    view.camera = beside
    assert view.vantage == "side" and view.camera == beside != above
    view.camera = above
    assert view.vantage == "main" and view.camera == above
    with refused(dspace.InvalidArgument, "camera 'camera' is of vantage 'side'; accepted: one of 'main'"):
        scene.add_viewport(SIZE, beside, vantage="main")


def test_what_is_no_camera_frame_or_fragment(scene, view, refused):
    with refused(dspace.WrongType, "viewport 'view': the camera is 5; accepted: a dspace.Camera"):
        view.camera = 5
    for bad in (1.5, True, [1], scene.add_box((1, 1, 1))):
        with refused(dspace.WrongType, "accepted: a Frame, a Robot, an Assembly, a path or an id"):
            scene.add_sphere(1, frame=bad)
    for hide in (5, [5], None):
        with refused(dspace.WrongType, "fragment"):
            view.image(hide=hide)
    assert view.image(hide="ornamental").shape == (48, 64, 3)
    assert view.image(hide=scene.fragments["ornamental"]).shape == (48, 64, 3)
    frame = scene.add_frame("f")
    with refused(dspace.WrongType, "frame 'f': the parent is None; accepted: a frame of its scene"):
        frame.reparent(None)


# --- Values of commands ------------------------------------------------------------------------


def test_numbers_and_words(scene, view, refused):
    for text, use in (
            ("viewport 'v': width is -1; accepted: an integer from 1 to 16384",
             lambda: scene.add_viewport((-1, 5), name="v")),
            ("viewport 'view': width is -1", lambda: setattr(view, "size", (-1, 5))),
            ("the size is (1.5, 2); accepted: (width, height), two integers from 1 to 16384",
             lambda: setattr(view, "size", (1.5, 2))),
            ("the size is 'big'", lambda: setattr(view, "size", "big")),
            ("the size is None", lambda: scene.add_viewport(None)),
            ("the position is (1,)", lambda: setattr(view, "position", (1,))),
            ("sphere 'ball': resolution is -1; accepted: an integer from 3 to 1024",
             lambda: scene.add_sphere(1, resolution=-1, name="ball")),
            ("sphere: resolution is 4.5", lambda: scene.add_sphere(1, resolution=4.5)),
            ("sphere: radius is 'big'; accepted: a number", lambda: scene.add_sphere("big")),
            ("sphere: radius is 1000000", lambda: scene.add_sphere(10**400)),
            ("box: the size is 3; accepted: 3 numbers", lambda: scene.add_box(3)),
            ("trail: capacity is -1; accepted: an integer from 2 to 10000000",
             lambda: scene.add_trail(capacity=-1)),
            ("label: font_size is -1; accepted: an integer from 4 to 200",
             lambda: scene.add_label("a", font_size=-1)),
            ("text table 't': font_size is -1; accepted: an integer from 4 to 200",
             lambda: view.set_table("t", {"a": 1}, font_size=-1)),
            ("text table 't': a row is 5", lambda: view.set_table("t", [5])),
            ("viewport 'view': quality is -1; accepted: an integer from 1 to 100",
             lambda: view.save("a.jpg", quality=-1)),
            ("quality is 1000000000; accepted: 1 to 100", lambda: view.save("a.jpg", quality=10**9)),
            ("viewport 'view': radius is -1; accepted: an integer from 0 to 256",
             lambda: view.pick(1, 1, radius=-1)),
            ("radius is 1000000000", lambda: view.pick(1, 1, radius=10**9)),
            ("viewport 'view': samples is True", lambda: setattr(view, "samples", True)),
            ("viewport 'view': x is 'left'; accepted: a number", lambda: view.pick("left", 1)),
            ("viewport 'view': type is 'jump'; accepted: 'move', 'press'", lambda: view.event("jump")),
            ("camera 'c': the projection is {'fov_deg': 40, 'height': 3}; accepted: one of",
             lambda: scene.add_camera("c", fov_deg=40, height=3)),
            ("camera 'c': fov_deg is 'wide'; accepted: a number",
             lambda: scene.add_camera("c", fov_deg="wide")),
            ("camera 'camera': the eye is (1, 2); accepted: 3 numbers",
             lambda: scene.cameras["camera"].look_at((1, 2), (0, 0, 0))),
            ("time 'now': its year is not 4 digits", lambda: setattr(scene, "time", "now")),
            ("name is 5; accepted: a str", lambda: scene.add_frame(5)),
            ("name is 5; accepted: a str", lambda: scene.add_sphere(1, name=5)),
            ("name is '\\ud800'; accepted: a str", lambda: scene.add_frame("\ud800")),
            ("model: the path is 5; accepted: a path", lambda: scene.load(5))):
        with refused(dspace.InvalidArgument, text):
            use()


def test_wrong_types_are_type_errors_and_bad_values_value_errors(scene):
    with pytest.raises(TypeError):
        scene.add_sphere("big")
    with pytest.raises(ValueError):
        scene.add_sphere(1, resolution=-1)
    with pytest.raises(dspace.Error) as caught:
        scene.add_sphere(1, resolution=-1)
    assert not isinstance(caught.value, TypeError) and caught.value.object == "sphere"


def test_unknown_keywords_show_public_names_only(scene, arm, refused, tmp_path):
    for text, use in (
            ("light 'a': unknown keyword 'colour'; accepted: kind, frame",
             lambda: scene.add_light("a", colour=(1, 1, 1))),
            ("light 'sun': unknown keyword 'colour'", lambda: scene.lights["sun"].set(colour=1)),
            ("camera 'c', chase: unknown keyword 'distance'; accepted: offset, target, axes",
             lambda: scene.add_camera("c", chase=dict(distance=3))),
            ("a URDF: unknown keyword 'opacity'; accepted: name, fragment, position",
             lambda: scene.load(tmp_path / "arm.urdf", name="other", opacity=0.5)),
            ("sphere: unknown keyword 'colour'; accepted: frame, name",
             lambda: scene.add_sphere(1, colour=(1, 1, 1)))):
        with refused(dspace.WrongType, text):
            use()


def test_colours(scene, view, refused):
    box = scene.add_box((1, 1, 1), color="red")
    assert box.color == (1, 0, 0)
    for given, want in (("#ff8000", (1, 128 / 255, 0)), ("darkslategrey", (47 / 255, 79 / 255, 79 / 255)),
                        ("DarkSlateGray", (47 / 255, 79 / 255, 79 / 255)), ((0.1, 0.2, 0.3), (0.1, 0.2, 0.3))):
        box.color = given
        assert box.color == pytest.approx(want, abs=1e-12)
    for bad in ("rot", "#12", "#gg0000", "", 5, (1, 1), (1, 1, 1, 1)):
        with refused(dspace.InvalidArgument, "accepted: red, green and blue from 0 to 1, '#rrggbb', or"):
            box.color = bad
    with refused(dspace.InvalidArgument, "object 'box'"):
        box.color = "rot"
    view.set_background("blue")
    box.remove()
    assert (view.image() == (0, 0, 255)).all()


def test_only_bools_are_true_or_false(scene, view, refused):
    box = scene.add_box((1, 1, 1), name="box")
    for text, use in (
            ("object 'box': visible is 'no'; accepted: True or False",
             lambda: setattr(box, "visible", "no")),
            ("visible is 0", lambda: scene.add_box((1, 1, 1), visible=0)),
            ("viewport 'view': ornaments is 'no'", lambda: setattr(view, "ornaments", "no")),
            ("viewport 'view': visible is None", lambda: setattr(view, "visible", None)),
            ("light 'sun': enabled is 'no'", lambda: scene.lights["sun"].set(enabled="no")),
            ("fragment 'physical': visible is 1",
             lambda: setattr(scene.fragments["physical"], "visible", 1)),
            ("physical_only is 'yes'", lambda: view.image(physical_only="yes"))):
        with refused(dspace.WrongType, text):
            use()
    box.visible = np.bool_(False)
    assert not box.visible


# --- Names that there are not ------------------------------------------------------------------


def test_of_many_names_those_like_the_one_given_are_named(scene, refused):
    for name in ("mast", "mast/pan", "mast/tilt", *(f"wheel_{k}" for k in range(20))):
        scene.add_frame(name.split("/")[-1], parent=scene.frames[name.split("/")[0]] if "/" in name else None)
    with refused(dspace.NotFound, "near matches: 'mast'; there are 23"):
        scene.frames["mst"]
    with refused(dspace.NotFound, "near matches: 'mast/pan'; there are 23"):
        scene.frames["head/pan"]
    with refused(dspace.NotFound, "there are: 'mast'"):
        scene.frames["zzzzzz"]
    with refused(dspace.NotFound, "there are: 'mast'"):
        scene.frames[7]


def test_messages_say_what_to_do_instead(scene, refused):
    """What a new user tried first."""
    with refused(dspace.WrongType, "the size is 640; accepted: (width, height)"):
        scene.add_viewport(640, 480)
    box = scene.add_box((1, 1, 1))
    for name in ("position", "pose", "quaternion"):
        with pytest.raises(AttributeError, match="objects move with their frame.*add_frame"):
            setattr(box, name, (1, 2, 3))
    with refused(dspace.InvalidArgument, "dspace.CameraModel.read(path) reads files"):
        dspace.CameraModel("navcam.json")
    with refused(dspace.WrongType, "colors is 'viridis'; accepted: a list of colours"):
        scene.add_viewport().set_color_bar("bar", "viridis", 0, 1)


def test_what_there_is_is_named(session, scene, view, arm, refused):
    scene.add_vantage("side")
    for things, text in ((scene.robots, "robot 'zzz': there is no such robot; there are: 'arm'"),
                         (arm.links, "link 'zzz': there is no such link; there are: 'base', 'wheel'"),
                         (arm.joints, "joint 'zzz': there is no such joint; there are: 'axle'"),
                         (scene.lights, "there are: 'sky', 'sun'"), (scene.frames, "'arm/base'"),
                         (scene.fragments, "'physical'"), (scene.vantages, "'side'"),
                         (scene.cameras, "there are: 'camera'"), (scene.terrains, "there are: none"),
                         (scene.objects, "there are: none"), (session.scenes, "there are: 'scene'"),
                         (session.viewports, "there are: 'view'")):
        for kind in (KeyError, dspace.NotFound):
            with refused(kind, "'zzz'"):
                things["zzz"]
        try:
            things["zzz"]
        except dspace.Error as error:
            if "sun" not in text:
                assert text in str(error)
        assert "zzz" not in things and things.get("zzz") is None
    with refused(dspace.NotFound, "link 'zzz'"):
        arm.link_pose("zzz")
    fragment = scene.add_fragment("gone")
    fragment.remove()
    with refused(dspace.NotFound, "fragment 'gone': it is in scene 'scene' no more"):
        fragment.ornamental


def test_a_closed_session_raises_a_dspace_error(session):
    session.close()
    with pytest.raises(dspace.Error, match="closed"):
        session.scene()
    with pytest.raises(dspace.Closed):
        session.render()


def test_another_thread_is_refused(session, scene, view):
    errors = []

    def use():
        for call in (lambda: scene.add_frame("f"), view.image, session.close, lambda: view.vtk):
            try:
                call()
            except dspace.WrongThread as error:
                errors.append(str(error))

    thread = threading.Thread(target=use, name="other")
    thread.start()
    thread.join()
    assert len(errors) == 4 and all("'other'; accepted: the thread that made it" in e for e in errors)
    assert list(scene.frames) == [] and view.image().shape == (48, 64, 3)


def test_what_python_itself_refuses_is_pythons_own():
    """As Start.md has it: fixed parameters are Python's, options by name are ours."""
    for call in (lambda: dspace.connect(bogus=1), lambda: dspace.connect()):
        with pytest.raises(TypeError) as found:
            call()
        assert not isinstance(found.value, dspace.Error)
    with dspace.Session() as session:
        scene = session.scene()
        with pytest.raises(AttributeError) as found:
            scene.add_frame("f").children = ()
        assert not isinstance(found.value, dspace.Error)
        with pytest.raises(dspace.WrongType, match="unknown keyword 'bogus'"):
            scene.add_box((1, 1, 1), bogus=1)


def test_messages_say_what_to_do(scene, tmp_path):
    with pytest.raises(dspace.NotFound, match=r"it has no frames.json; accepted: the folder of a frames.json, or a model"):
        scene.load(tmp_path)
    (tmp_path / "hull.OBJ").write_text("")
    with pytest.raises(dspace.NotFound, match="such as 'hull.OBJ' there"):
        scene.load(tmp_path)
    with pytest.raises(dspace.NotFound, match="there is no such file"):
        scene.load(tmp_path / "none" / "frames.json")
    with pytest.raises(dspace.NotFound, match=r"it has no camera; add one first \(Scene.add_camera"):
        scene.add_viewport((64, 48)).image()
    scene.add_frame("rover").add_frame("mast")
    with pytest.raises(dspace.NotFound, match="near matches: 'rover'"):
        scene.frame("rovre")
    with pytest.raises(dspace.NotFound, match="near matches: 'rover/mast'"):
        scene.frame("rover/mats")
