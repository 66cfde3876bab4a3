"""What is drawn after a snapshot is what was drawn before it: viewports, tables, colour bars, terrain's tracks, styles
and layers, texts, telemetry, at random. (TestLedger does the same for what needs no pictures.)"""
import random

import numpy as np
import pytest

import dspace
from dspace.recording.file import commands_of
from dspace.proto import commands_pb2 as pb
from terrain_support import write_raster

COLORS = ("#d04020", "#20a040", "#3060d0", "#c0b020")


class Player:
    """Does one thing after another at random; counts what was done, by name."""

    def __init__(self, session, seed, folder):
        self.session, self.random, self.folder = session, random.Random(seed), folder
        self.done = {}
        self.scene = session.scene()
        x, y = np.meshgrid(np.arange(48.0), np.arange(48.0))
        self.raster = write_raster(folder / f"ground_{seed}.tif", 2.0 * np.sin(x / 7) * np.cos(y / 5))
        self.box = self.scene.add_frame("box", position=(0, 0, 3))
        self.scene.add_box((2, 2, 2), frame=self.box, color="#d04020")
        self.scene.add_camera("near", eye=(14, -14, 12), target=(0, 0, 0))
        self.scene.add_camera("above", eye=(0.1, 0, 40), target=(0, 0, 0))
        self.label = None
        self.open()

    def open(self):
        self.terrain = self.scene.add_terrain(self.raster, name="ground", mode="clipmap", level_size=28)

    def name(self, what, n=3):
        return f"{what}{self.random.randrange(n)}"

    def one_of(self, named):
        return self.random.choice(list(named.values())) if named else None

    def place(self):
        return self.random.uniform(-12, 12), self.random.uniform(-12, 12)

    # --- What may be done ----------------------------------------------------------------------

    def viewport(self):
        name = self.name("view", 2)
        if name not in self.session.viewports:
            self.scene.add_viewport((96, 72), self.random.choice(("near", "above")), name=name, samples=1)

    def drop_viewport(self):
        viewport = self.one_of(self.session.viewports)
        if viewport and self.random.random() < 0.3:
            viewport.remove()

    def set_viewport(self):
        viewport = self.one_of(self.session.viewports)
        if viewport is None:
            return
        what = self.random.randrange(7)
        if what == 0:
            viewport.size = (self.random.choice((80, 96)), self.random.choice((60, 72)))
        elif what == 1:
            viewport.set_background(self.random.choice(COLORS), top=self.random.choice((None, *COLORS)))
        elif what == 2:
            viewport.corner_axes = self.random.random() < 0.5
        elif what == 3:
            viewport.ornaments = self.random.random() < 0.5
        elif what == 4:
            viewport.fill = self.random.random()
        elif what == 5:
            viewport.set(exposure=self.random.uniform(0.5, 2), tone=self.random.choice(("linear", "filmic")))
        else:
            viewport.camera = self.random.choice(("near", "above"))

    def sun(self):
        what = self.random.randrange(4)
        if what == 0:
            self.scene.sun.set(azimuth_deg=self.random.uniform(0, 360), elevation_deg=self.random.uniform(-5, 90),
                               terrain=self.terrain)
        elif what == 1:
            self.scene.sun.set(direction=(*self.place(), 9), frame=self.box)
        elif what == 2:
            self.scene.sun.set(distance_au=self.random.uniform(1, 2), radius_deg=self.random.random())
        elif "sun" in self.scene.lights and self.random.random() < 0.2:
            self.scene.lights["sun"].remove()

    def hide(self):
        viewport = self.one_of(self.session.viewports)
        if viewport:
            (viewport.hide if self.random.random() < 0.5 else viewport.show)("ornamental")

    def table(self):
        viewport = self.one_of(self.session.viewports)
        if viewport:
            channel = self.one_of(self.scene.telemetry)
            value = str(self.random.random()) if channel is None else (channel, self.random.randrange(4))
            viewport.set_table(self.name("table"), [("value", value)], anchor=self.random.choice(("top left", "top right")))

    def drop_table(self):
        viewport = self.one_of(self.session.viewports)
        if viewport:
            try:
                viewport.remove_table(self.name("table"))
            except dspace.NotFound:
                pass

    def bar(self):
        viewport = self.one_of(self.session.viewports)
        if viewport:
            viewport.set_color_bar(self.name("bar", 2), COLORS[:self.random.randrange(2, 4)], 0, self.random.uniform(1, 9),
                                   length=40, horizontal=self.random.random() < 0.5)

    def drop_bar(self):
        viewport = self.one_of(self.session.viewports)
        if viewport:
            try:
                viewport.remove_color_bar(self.name("bar", 2))
            except dspace.NotFound:
                pass

    def track(self):
        self.terrain.track({self.name("wheel"): [self.place(), self.place()]}, width=0.6,
                           sinkage=self.random.uniform(0.1, 0.4), wall=0.2, begin=self.random.random() < 0.5)

    def clear(self):
        if self.random.random() < 0.3:
            self.terrain.clear_tracks()

    def style(self):
        what = self.random.randrange(4)
        self.terrain.set_style(**({}, {"color_by": "height"}, {"contours": 0.5}, {"tracks": "#d04020"})[what])

    def layer(self):
        self.terrain.add_noise(wavelength=self.random.uniform(2, 9), seed=self.random.randrange(9), contrast=0.8,
                               opacity=self.random.random(), visible=self.random.random() < 0.8)

    def false_color(self):
        self.terrain.add_false_color(self.raster, colors=COLORS[:3], opacity=self.random.uniform(0.2, 1))

    def change_layer(self):
        layers = list(self.terrain.layers)
        if not layers:
            return
        layer = self.random.choice(layers)
        what = self.random.randrange(4)
        if what == 0:
            layer.opacity = self.random.random()
        elif what == 1:
            layer.visible = self.random.random() < 0.6
        elif what == 2:
            layer.position = self.random.randrange(len(layers))
        else:
            layer.remove()

    def reopen(self):
        if self.random.random() < 0.15:
            self.terrain.remove()
            self.open()

    def text(self):
        if self.label is None:
            self.label = self.scene.add_label("first", frame=self.box, name="label")
        elif self.random.random() < 0.2:
            self.label.remove()
            self.label = None
        else:
            self.label.set(self.name("label ", 99))

    def telemetry(self):
        channels = self.scene.telemetry
        name = self.name("rover/value")
        if name not in channels:
            channels.add(name, unit=self.random.choice(("", "W", "m/s")))
        elif self.random.random() < 0.15:
            channels[name].remove()
        else:
            channels.set({name: self.random.uniform(-99, 99)})

    def event(self):
        self.scene.log_event("note", self.name("text ", 99), frame=self.box)

    def move(self):
        self.scene.time = self.scene.time + self.random.random()
        self.box.position = (*self.place(), 3)

    def play(self, steps):
        doings = [getattr(self, name) for name in (
            "viewport", "drop_viewport", "set_viewport", "sun", "hide", "table", "drop_table", "bar", "drop_bar", "track",
            "clear", "style", "layer", "false_color", "change_layer", "reopen", "text", "telemetry", "event", "move")]
        for _ in range(steps):
            doing = self.random.choice(doings)
            doing()
            self.done[doing.__name__] = self.done.get(doing.__name__, 0) + 1


def state_of(session):
    """Pictures of all viewports, and what can be asked of tracks, layers, telemetry and events."""
    scene = session.scenes["scene"]
    asked = {kind: str(scene._ask(kind)) for kind in ("list_telemetry", "list_events", "list_questions", "get_time")}
    for name, viewport in session.viewports.items():
        planes = viewport.capture(color=True, depth=True, label=True)
        for plane, data in planes.items():
            asked[name, plane] = data
    return asked


def differences(one, two):
    assert one.keys() == two.keys()
    return [key for key in one if not np.array_equal(one[key], two[key])]


def rebuild(session, path):
    """Takes all away, and makes it of a recording's snapshot."""
    with session.record(path):
        pass
    with dspace.RecordingFile(path) as file:
        commands = [pb.Command.FromString(each) for each in commands_of(file.snapshot(0))]
    for viewport in list(session.viewports.values()):
        viewport.remove()
    session.scenes["scene"].remove()
    for command in commands:
        session.execute(command)


@pytest.mark.parametrize("seed", range(2))
def test_a_snapshot_draws_the_same(tmp_path, seed):
    with dspace.Session() as session:
        player = Player(session, seed, tmp_path)
        for part in range(3):
            player.play(50)
            player.viewport()
            wanted = state_of(session)
            rebuild(session, tmp_path / f"{part}.dspace")
            assert differences(state_of(session), wanted) == [], (seed, part)
    assert len(player.done) > 15 and sum(player.done.values()) == 150
    pictures = [data for key, data in wanted.items() if key[-1] == "color"]
    assert len(np.unique(pictures[0].reshape(-1, pictures[0].shape[-1]), axis=0)) > 20  # of something
