"""Scenes, servers and watchers that go while others still hold what belongs to them."""
import os
import signal
import subprocess
import sys
import time

import dspace
from served_support import Served, stand_still
from test_watching import EYE, SIZE, build, follow, watched


def test_vantages_without_a_viewport_sleep_with_their_scene(tmp_path):
    with watched(tmp_path) as (server, session, watcher):
        scene = watcher.scenes["scene"]
        scene.add_camera("eye", vantage=scene.add_vantage("viewer:x"), frame="cart", eye=(0.0, -6.0, 2.0),
                         target=(0.0, 0.0, 0.0))
        watcher.add_view("closed", size=SIZE, **EYE).remove()
        session.viewports["view"].remove()
        session.scene().remove()
        while "scene" in watcher.scenes:
            assert watcher.update(20.0)

        def back():
            scene = watcher.scenes["scene"]
            assert {"viewer:x", "viewer:closed"} <= set(scene.vantages) and not watcher.viewports
            assert scene.vantages["viewer:x"].cameras["eye"].frame == scene.frame("cart")

        session.scene().add_frame("first")  # the others have other ids than they had
        build(session)
        follow(watcher, session)
        back()
        session.scene().remove()
        while "scene" in watcher.scenes:
            assert watcher.update(20.0)
        server.kill()  # the next state is a snapshot's
        while watcher.connected:
            watcher.update(0.2)
        with Served(tmp_path), dspace.connect(server.address, name="next", timeout=20.0) as session:
            build(session)
            follow(watcher, session)
            back()


def test_a_click_does_not_wait_for_a_server_that_stands_still(tmp_path):
    with watched(tmp_path) as (server, _, watcher):
        view = watcher.add_view("mine", size=SIZE)
        view.event("press", 80, 60, button="left")
        stand_still(server.process.pid)
        try:
            began = time.monotonic()
            assert view.event("release", 80, 60, button="left").object_name == "ball"
            assert time.monotonic() - began < 20.0  # of the thirty of the watcher's timeout
        finally:
            server.process.send_signal(signal.SIGCONT)


OUTLASTS = """
from dspace._core.replies import to_reply
from dspace import vtk
from dspace.proto import commands_pb2 as pb

server = vtk.vtkDspaceServer()
session = server.GetSession()
del server
command = pb.Command()
command.create_scene.SetInParent()
reply = to_reply(session.Execute(command.SerializeToString()))
assert not reply.HasField("error") and not reply.warning, reply
"""


def test_a_session_outlasts_its_server():
    """What is freed is overwritten, so that using it is seen."""
    subprocess.run([sys.executable, "-W", "ignore", "-c", OUTLASTS], check=True, timeout=120,
                   env={**os.environ, "MALLOC_PERTURB_": "165"})
