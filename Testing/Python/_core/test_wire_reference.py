"""Documentation/Commands.md is what the .proto files say, and what commands answer."""
import importlib.util
import pathlib
import subprocess
import sys

import numpy as np

import dspace
from dspace._core import traits
from dspace.clients.local import LocalClient
from needs import needs_program

SOURCE = pathlib.Path(__file__).parents[3]
SCRIPT = SOURCE / "Documentation" / "make_commands.py"


def test_the_page_is_up_to_date():
    needs_program("protoc", "protobuf-compiler")
    run = subprocess.run([sys.executable, str(SCRIPT), "--check"], stderr=subprocess.PIPE, text=True)
    assert run.returncode == 0, run.stderr
    page = (SOURCE / "Documentation" / "Commands.md").read_text(encoding="utf-8")
    from dspace.proto import commands_pb2
    for field in commands_pb2.Command.DESCRIPTOR.oneofs_by_name["command"].fields:
        assert f"| [{field.name}](#{field.message_type.name.lower()}) | {field.number} | " in page
        assert f"\n`{field.name}`, {field.number} in Command; " in page


def test_a_comment_of_several_lines_belongs_to_its_own_field():
    page = (SOURCE / "Documentation" / "Commands.md").read_text(encoding="utf-8")
    for row in ("| `level_size` | 20 | uint32 | cells per side of a clipmap's levels, a multiple of 4 from 12 to 252; 0: 124 |",
                "| `byte_budget` | 21 | uint64 | of its tiles in memory; 0: 256 MiB |",
                "| `normal` | 2 | repeated double | x y z per point, unit, in the terrain's frame |"):
        assert f"\n{row}\n" in page
    specification = importlib.util.spec_from_file_location("make_commands", SCRIPT)
    maker = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(maker)
    assert maker.joined("  int32 a = 1; // one,\n               // two\n  // of b\n  int32 b = 2;\n") == (
        "  int32 a = 1; // one, two\n  // of b\n  int32 b = 2;\n")


def test_results_are_those_that_commands_answer(monkeypatch, field):
    seen = {}
    finish = LocalClient.finish

    def noted(self, command, reply):
        if not reply.HasField("error"):
            seen.setdefault(command.WhichOneof("command"), set()).add(reply.WhichOneof("result"))
        return finish(self, command, reply)

    monkeypatch.setattr(LocalClient, "finish", noted)
    with dspace.Session() as session:
        scene = session.scene()
        frame, other = scene.add_frame("frame"), scene.add_frame("other")
        frame.name = "renamed"
        frame.reparent(other)
        scene.set_poses([frame], np.array([[1.0, 0, 0, 1, 0, 0, 0]]))
        scene.poses([frame])
        ball = scene.add_sphere(1.0, frame=frame, color="red")
        ball.visible, ball.frame, ball.bounds, scene.objects
        scene.add_label("text")
        scene.add_trail(capacity=10).append([[0, 0, 0]])
        scene.add_light("lamp", "point")
        scene.lights, scene.fragments, scene.vantages, scene.robots, scene.terrains, session.scenes
        terrain = scene.add_terrain(field, name="field")
        terrain.height(0.0, 0.0)
        camera = scene.add_camera("main", eye=(9.0, -9.0, 7.0), target=(0.0, 0.0, 1.0))
        camera.pose, camera.activate()
        view = scene.add_viewport((64, 48), camera)
        view.image(), view.pick(32, 24), view.render(), view.size, session.viewports, session.statistics
        view.event("wheel", 32, 24, wheel=1.0)
        view.event("move", 32, 24)
        view.set_table("table", {"a": 1})
        scene.time = 1.0
        scene.time
        ball.remove()
        other.remove()
        view.remove()
    assert len(seen) > 35
    for command, results in seen.items():
        accepted = set(traits.results(command))
        if command == "viewport_event" or not accepted:
            accepted.add(None)
        assert results <= accepted, command
